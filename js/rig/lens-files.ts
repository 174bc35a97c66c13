/**
 * Lenses in separate files: "D_color.txt" beside "K_color.txt", "dist.npy" beside "mtx.npy", as users of OpenCV save them. A lens belongs to
 * the camera whose file has a similar name. Loaded if a folder has such files.
 */
import { BimodalError } from "../errors.js";
import { cameraOf } from "./formats/cameras.js";
import { isIntrinsics, isLens, wordsOf } from "./formats/names.js";
import { smallArray } from "./formats/npy-matrix.js";
import { type Numbers, numberOf } from "./formats/numbers.js";
import { folderOf, isLensFile, stem } from "./names.js";
import type { TextOfFrame } from "./perframe.js";
import type { NamedCamera, NamedFile } from "./types.js";
import { type ReaderWarning, ofFile, warning } from "./warnings.js";

export interface LensFile {
  file: string;
  values: Numbers;
}

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

/** The numbers of a NumPy array of one row or column. */
function listOf(bytes: Uint8Array): number[] | undefined {
  const array = smallArray(bytes);
  return array && (array.axes.length < 2 || array.axes.includes(1)) ? array.values : undefined;
}

/** The coefficients in a file with the name of a lens, if it has nothing else. */
export function lensOf({ name, bytes }: NamedFile): LensFile | undefined {
  if (bytes.length > LONGEST) return undefined;
  const values = listOf(bytes) ?? written(new TextDecoder().decode(bytes));
  return values !== undefined && COUNTS.includes(values.length) ? { file: name, values } : undefined;
}

/** The warning about a lens that was not used, with the reason if it is known. */
const unused = (file: string, reason = ""): ReaderWarning =>
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

/** Words that state only that a file belongs to a camera. */
const PLAIN = new Set(["camera", "cam", "calib", "calibration", "params", "parameters", "matrix"]);

/** The folder of a file and the camera that its name refers to, without the words for intrinsics and lenses. */
function owner(path: string): string {
  const name = stem(path);
  const words = wordsOf(isLens(name) ?? isIntrinsics(name) ?? name).filter((word) => !PLAIN.has(word));
  return `${folderOf(path)}${words.join(" ")}`;
}

/** Gives each lens to the camera without distortion whose file has a similar name, and returns what was read from each file. */
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
    if (said instanceof BimodalError) {
      warnings.push(unused(lens.file, `, because ${said.message}`));
      return [];
    }
    warnings.push(...said.map((each) => ofFile(lens.file, each)));
    return [{ name: lens.file, says: `the distortion of the camera "${camera.name ?? ""}"`, warnings: said }];
  });
}

/** Puts the lens into the camera. Returns the warnings about the lens, or why it cannot be used. */
function bend(camera: NamedCamera, { values }: LensFile): ReaderWarning[] | BimodalError {
  const said: ReaderWarning[] = [];
  const { fx, fy, cx, cy } = camera.camera;
  try {
    camera.camera = cameraOf({ name: camera.name, focal: [fx, fy], centre: [cx, cy], distortion: values }, said).camera;
  } catch (error) {
    if (error instanceof BimodalError) return error;
    throw error;
  }
  // The camera's file has already caused the warnings about its intrinsics.
  return said.filter(({ code }) => code === "distortion-guessed");
}
