/** COLMAP's cameras.txt: a line for each camera, "ID MODEL WIDTH HEIGHT PARAMS[]". */
import { BimodalError, badFile } from "../../errors.js";
import { type RawCamera, cameraOf } from "./cameras.js";
import { linesOf } from "./colmap-lines.js";
import { type Numbers, numberOf } from "./numbers.js";
import type { Calibration } from "./tree.js";
import { warning } from "../warnings.js";

const LINE = /^\s*(\d+)\s+([A-Z][A-Z_]+)\s+(\d+)\s+(\d+)((?:\s+\S+)*)\s*$/;
/** COLMAP's principal points are measured from the corner of the first pixel, OpenCV's from its centre; pixels. */
export const CORNER = 0.5;

interface Model {
  focals: 1 | 2;
  /** The positions, among OpenCV's coefficients, of the parameters beyond focal lengths and principal point. */
  lens: number[];
  fisheye?: true;
}
const MODELS: Record<string, Model> = {
  SIMPLE_PINHOLE: { focals: 1, lens: [] },
  PINHOLE: { focals: 2, lens: [] },
  SIMPLE_RADIAL: { focals: 1, lens: [0] },
  RADIAL: { focals: 1, lens: [0, 1] },
  OPENCV: { focals: 2, lens: [0, 1, 2, 3] },
  FULL_OPENCV: { focals: 2, lens: [0, 1, 2, 3, 4, 5, 6, 7] },
  OPENCV_FISHEYE: { focals: 2, lens: [0, 1, 2, 3], fisheye: true },
  SIMPLE_RADIAL_FISHEYE: { focals: 1, lens: [0], fisheye: true },
  RADIAL_FISHEYE: { focals: 1, lens: [0, 1], fisheye: true },
};

export const isColmap = (text: string): boolean => LINE.test(linesOf(text.slice(0, 4096))[0] ?? "");

function readLine(line: string): RawCamera {
  const [, id = "", name = "", width, height, rest = ""] = LINE.exec(line) ?? [];
  const model = Object.hasOwn(MODELS, name) ? MODELS[name] : undefined;
  if (model === undefined)
    throw badFile(
      id === ""
        ? `it has a line that is not a camera: ${line.slice(0, 60)}`
        : `its camera ${id} has the model ${name}, which is not supported`,
    );
  const values: (number | undefined)[] = rest
    .trim()
    .split(/\s+/)
    .filter((part) => part !== "")
    .map(numberOf);
  const needed = model.focals + 2 + model.lens.length;
  if (values.length !== needed || values.includes(undefined))
    throw badFile(`its camera ${id} (${name}) needs ${needed} numbers, but has ${values.length}`);
  const numbers = values as Numbers;
  const distortion = new Array<number>(model.lens.length).fill(0);
  model.lens.forEach((place, index) => (distortion[place] = numbers[model.focals + 2 + index] ?? 0));
  const centre = numbers.slice(model.focals, model.focals + 2).map((value) => value - CORNER);
  return {
    name: id,
    focal: numbers.slice(0, model.focals),
    centre,
    distortion,
    model: model.fisheye ? "fisheye" : "opencv",
    width: Number(width),
    height: Number(height),
  };
}

/** Cameras with unsupported models are left out with a warning, unless no other camera is in the file. */
export function readColmap(text: string): Calibration {
  const found: Calibration = { cameras: [], poses: [], warnings: [] };
  let reason: unknown;
  for (const line of linesOf(text)) {
    const name = LINE.exec(line)?.[2];
    const isKnown = name === undefined || Object.hasOwn(MODELS, name);
    try {
      found.cameras.push(cameraOf(readLine(line), found.warnings));
    } catch (error) {
      if (isKnown || !(error instanceof BimodalError)) throw error;
      reason ??= error;
      found.warnings.push(warning("camera-left-out", `${error.message}; this camera was left out.`, { model: name }));
    }
  }
  if (found.cameras.length === 0 && reason !== undefined) throw reason;
  return found;
}
