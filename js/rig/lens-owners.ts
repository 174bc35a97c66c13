/** Finds the camera to which a lens in a separate file belongs: its file has a similar name. Loaded if a folder has such files. */
import { BimodalError } from "../errors.js";
import { cameraOf } from "./formats/cameras.js";
import { isIntrinsics, isLens, wordsOf } from "./formats/names.js";
import { type LensFile, unused } from "./lens-files.js";
import { folderOf, stem } from "./names.js";
import type { TextOfFrame } from "./perframe.js";
import type { NamedCamera } from "./types.js";
import { type ReaderWarning, ofFile } from "./warnings.js";

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
