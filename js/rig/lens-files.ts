/** Lenses in separate files: "D_color.txt" beside "K_color.txt", "dist.npy" beside "mtx.npy", as users of OpenCV save them. */
import { cameraOf } from "./formats/cameras.js";
import { type Numbers, numberOf } from "./formats/numbers.js";
import { isIntrinsics, isLens, wordsOf } from "./formats/names.js";
import { lensArray } from "./formats/npy-matrix.js";
import { folderOf, stem } from "./names.js";
import type { TextOfFrame } from "./perframe.js";
import type { NamedCamera, NamedFile } from "./types.js";
import { type ReaderWarning, ofFile, warning } from "./warnings.js";

export interface LensFile {
  file: string;
  values: Numbers;
}

/** Names of files of a lens's coefficients alone. */
const LENS_FILE = /(?:^|[_.-])(?:d|(?:camera[_-]?)?dist(?:ortion)?(?:[_-]?coeff?\w*)?|coeffs?)(?=[_.-])/i;
const isLensFile = (path: string): boolean => LENS_FILE.test(path.replace(/^.*[/\\]/, ""));

/** How many coefficients OpenCV's lenses have. */
const COUNTS = [4, 5, 8, 12, 14];
const LONGEST = 4000;

/** The numbers of a text of numbers alone, with or without a name before them, or of the one matrix of OpenCV's YAML. */
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

/** Words that say no more than that a file is a camera's. */
const PLAIN = new Set(["camera", "cam", "calib", "calibration", "params", "parameters", "matrix"]);

/** The folder of a file and which camera its name says that it is of, without the words for intrinsics and lenses. */
function owner(path: string): string {
  const name = stem(path);
  const words = wordsOf(isLens(name) ?? isIntrinsics(name) ?? name).filter((word) => !PLAIN.has(word));
  return `${folderOf(path)}${words.join(" ")}`;
}

const unused = (file: string): ReaderWarning =>
  ofFile(
    file,
    warning(
      "distortion-unused",
      "By its name it holds the distortion of a lens, which was not used. Write the camera's intrinsics and distortion into one file.",
    ),
  );

/** The lens of a file that could not be read is missing from its camera. */
export function doubtLenses(warnings: ReaderWarning[]): void {
  for (const { code, file } of [...warnings])
    if (code === "file-left-out" && file !== undefined && isLensFile(file)) warnings.push(unused(file));
}

/** Gives each lens to the one camera without distortion whose file is called like it; what was done is said of each file. */
export function giveLenses(
  lenses: readonly LensFile[],
  texts: readonly TextOfFrame[],
  warnings: ReaderWarning[],
): { name: string; says: string; warnings: ReaderWarning[] }[] {
  return lenses.flatMap((lens) => {
    const own = texts.filter(({ file, cameras }) => cameras.length > 0 && owner(file) === owner(lens.file));
    const [camera, ...others] = own.flatMap(({ cameras }) => cameras);
    if (camera === undefined || others.length > 0 || camera.camera.distortion !== undefined) {
      warnings.push(unused(lens.file));
      return [];
    }
    const said = bend(camera, lens);
    warnings.push(...said.map((each) => ofFile(lens.file, each)));
    return [{ name: lens.file, says: `the distortion of the camera "${camera.name ?? ""}"`, warnings: said }];
  });
}

/** Puts the lens into the camera; returns the warnings about it. */
function bend(camera: NamedCamera, { values }: LensFile): ReaderWarning[] {
  const said: ReaderWarning[] = [];
  const { fx, fy, cx, cy } = camera.camera;
  camera.camera = cameraOf({ name: camera.name, focal: [fx, fy], centre: [cx, cy], distortion: values }, said).camera;
  // Of the intrinsics the camera's file has warned.
  return said.filter(({ code }) => code === "distortion-guessed");
}
