/** Lenses in separate files: "D_color.txt" beside "K_color.txt", "dist.npy" beside "mtx.npy", as users of OpenCV save them. */
import { type Numbers, numberOf } from "./formats/numbers.js";
import { lensArray } from "./formats/npy-matrix.js";
import type { NamedFile } from "./types.js";
import { type ReaderWarning, ofFile, warning } from "./warnings.js";

export interface LensFile {
  file: string;
  values: Numbers;
}

/** Names of files that hold only the coefficients of a lens. */
const LENS_FILE = /(?:^|[_.-])(?:d|(?:camera[_-]?)?dist(?:ortion)?(?:[_-]?coeff?\w*)?|coeffs?)(?=[_.-])/i;
const isLensFile = (path: string): boolean => LENS_FILE.test(path.replace(/^.*[/\\]/, ""));

/** Possible numbers of coefficients of OpenCV's lenses. */
const COUNTS = [4, 5, 8, 12, 14];
const LONGEST = 4000;

/** The numbers of a text that holds only numbers, with or without a name before them, or of the one matrix in OpenCV's YAML. */
function written(text: string): Numbers | undefined {
  const [only, ...others] = [...text.matchAll(/\bdata:\s*\[([^\]]*)\]/g)];
  if (others.length > 0) return undefined;
  const plain = text.replace(/(?:#|%).*$/gm, "").replace(/^[\s{"']*[A-Za-z]\w*["']?\s*[:=]/, "");
  const parts = (only?.[1] ?? plain).split(/[\s,;[\](){}]+/).filter((part) => part !== "");
  const values = parts.map(numberOf);
  return values.every((value) => value !== undefined) ? values : undefined;
}

/** The coefficients in a file that has nothing else, by its name and content. */
export function lensOf({ name, bytes }: NamedFile): LensFile | undefined {
  if (!isLensFile(name) || bytes.length > LONGEST) return undefined;
  const values = lensArray(bytes) ?? written(new TextDecoder().decode(bytes));
  return values !== undefined && COUNTS.includes(values.length) ? { file: name, values } : undefined;
}

/** The warning about a lens that was not used, with the reason if it is known. */
export const unused = (file: string, reason = ""): ReaderWarning =>
  ofFile(
    file,
    warning(
      "distortion-unused",
      `Its name says that it holds the distortion of a lens, which was not used${reason}. Write the camera's intrinsics and distortion into one file.`,
    ),
  );

/** If a file of a lens could not be read, its camera lacks the lens. */
export function doubtLenses(warnings: ReaderWarning[]): void {
  for (const { code, file } of [...warnings])
    if (code === "file-left-out" && file !== undefined && isLensFile(file)) warnings.push(unused(file));
}
