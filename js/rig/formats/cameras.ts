/** Checks the cameras of files and converts their distortion to OpenCV's order. */
import { badFile } from "../../errors.js";
import type { NamedCamera } from "../types.js";
import { lensNamed } from "./lenses.js";
import { MOST_SIDE } from "./limits.js";
import type { Numbers } from "./numbers.js";
import { type ReaderWarning, digits, warning } from "../warnings.js";

/** A camera as a file states it, before it is checked. */
export interface RawCamera {
  name?: string | undefined;
  focal: Numbers;
  centre: Numbers;
  skew?: number | undefined;
  model?: string | undefined;
  distortion?: Numbers | undefined;
  /** Whether the model's name cannot be that of a product. */
  isLens?: boolean | undefined;
  /** Whether the coefficients have Brown's names and OpenCV's order, whatever the model. */
  isByName?: boolean | undefined;
  /** Whether the file names k1 to k4, but neither tangential coefficients nor further radial ones. */
  isFourRadial?: boolean | undefined;
  width?: number | undefined;
  height?: number | undefined;
}

/** Names of a lens's coefficients in OpenCV's order, of Brown's model and of a fisheye. */
export const BROWN_NAMES = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
export const FISHEYE_NAMES = ["k1", "k2", "k3", "k4"];

/** The intrinsics from a matrix in row order, which has three columns, or four if it is a projection. */
export const ofMatrix = (k: Numbers, columns = 3): Required<Pick<RawCamera, "focal" | "centre" | "skew">> => ({
  focal: [k[0] ?? NaN, k[columns + 1] ?? NaN],
  centre: [k[2] ?? NaN, k[columns + 2] ?? NaN],
  skew: k[1],
});

/** Words for a fisheye, in a file or in its name; "not a fisheye" and "fisheye: false" deny it. */
const FISHEYE_WORD =
  /(?<!\b(?:no|not|non)[\s_-]{1,3}(?:an?\s)?)(?:fish[\s_-]?eye|equidistant|kannala)(?![\w"']{0,10}\s*[:=]\s*(?:false|0\b|no\b|none))/i;

/** Longest focal length of a camera, pixels. */
const LONGEST = 1e6;

/** Coefficients in OpenCV's numbers: 4, 5 or 8; further ones (thin prism, tilt) have to be zero. */
function brown(values: Numbers): Numbers | undefined {
  const used = values.slice(0, 8);
  if (values.length > 14 || values.slice(8).some((value) => value !== 0))
    throw badFile("its distortion has thin-prism or tilt terms, which are not supported");
  while (used.length > 0 && used.at(-1) === 0) used.pop();
  if (used.length === 0) return undefined;
  const length = used.length <= 4 ? 4 : used.length <= 5 ? 5 : 8;
  return Array.from({ length }, (_, index) => used[index] ?? 0);
}

/** A size in a camera's name, as in "color 1280x720". */
function sizeInName(name = ""): { width?: number; height?: number } {
  const [, width, height] = /(?:^|[ _])(\d{2,5})[xX](\d{2,5})(?![\dxX])/.exec(name) ?? [];
  return width === undefined ? {} : { width: Number(width), height: Number(height) };
}

function sizeOf(raw: RawCamera): { width: number; height: number } | undefined {
  const { width, height } = raw.width === undefined && raw.height === undefined ? sizeInName(raw.name) : raw;
  if (width === undefined && height === undefined) return undefined;
  const isSide = (side: number) => Number.isInteger(side) && side > 0 && side <= 4 * MOST_SIDE;
  if (width === 0 && height === 0) return undefined;
  if (width === undefined || height === undefined)
    throw badFile(
      `its camera states only the ${width === undefined ? "height" : "width"} of its images, ${width ?? height}; both are needed`,
    );
  if (!isSide(width) || !isSide(height)) throw badFile(`its camera has the invalid image size ${width}x${height}`);
  return { width, height };
}

/** The camera; it throws where the numbers are not those of a camera. */
export function cameraOf(raw: RawCamera, warnings: ReaderWarning[]): NamedCamera {
  const [fx = NaN, fy = fx] = raw.focal;
  const [cx = NaN, cy = NaN] = raw.centre;
  const of = raw.name === undefined ? "its camera" : `its camera "${raw.name}"`;
  if (!(fx > 0 && fy > 0 && fx < LONGEST && fy < LONGEST))
    throw badFile(`${of} has the focal lengths ${fx} and ${fy}; both must be above zero, in pixels`);
  if (!(Math.abs(cx) < LONGEST && Math.abs(cy) < LONGEST)) throw badFile(`${of} has the principal point ${cx}, ${cy}`);
  const size = sizeOf(raw);
  const label = raw.name === undefined ? "The camera" : `The camera "${raw.name}"`;
  if (size !== undefined && (cx < 0 || cy < 0 || cx > size.width || cy > size.height))
    warnings.push(
      warning(
        "principal-point",
        `${label} has its principal point outside its image (${digits(cx)}, ${digits(cy)} of ${size.width}x${size.height}).`,
        { cx, cy },
      ),
    );
  if (size === undefined && (cx <= 0 || cy <= 0))
    warnings.push(
      warning(
        "principal-point",
        `${label} has the principal point ${digits(cx)}, ${digits(cy)}, which is outside any image.`,
        {
          cx,
          cy,
        },
      ),
    );
  if (fx < 2 || fy < 2)
    warnings.push(
      warning(
        "focal-length-normalised",
        `${label} has a focal length of ${digits(fx)}, which looks normalised by the image's size; pixels are needed.`,
        { fx, fy },
      ),
    );
  if (Math.abs(fx / fy - 1) > 0.1)
    warnings.push(
      warning(
        "pixels-not-square",
        `${label} has pixels that are not square (fx ${fx.toFixed(1)}, fy ${fy.toFixed(1)}).`,
        {
          fx,
          fy,
        },
      ),
    );
  if (raw.skew !== undefined && Math.abs(raw.skew) > 1e-6 * fx)
    warnings.push(
      warning("skew-ignored", `${label} has skewed axes (${raw.skew}); the skew is ignored.`, { skew: raw.skew }),
    );
  const lens = lensOf(raw, label, warnings);
  return { ...(raw.name !== undefined && { name: raw.name }), camera: { fx, fy, cx, cy, ...lens }, ...size };
}

type Lens = { model?: "fisheye"; distortion?: Numbers };

/** Positions of a fisheye's coefficients k1 to k4 in a list by Brown's names. */
const FISHEYE_OF_BROWN = [0, 1, 4, 5];

function fisheye({ distortion, isByName = false }: RawCamera, label: string, warnings: ReaderWarning[]): Lens {
  const values = distortion ?? [];
  if (distortion === undefined)
    warnings.push(
      warning(
        "distortion-guessed",
        `${label} has a fisheye lens without coefficients, which were read as zeros. Write k1 k2 k3 k4 into the camera.`,
      ),
    );
  const four = isByName ? FISHEYE_OF_BROWN.map((index) => values[index] ?? 0) : values;
  if (four.length !== 0 && four.length !== 4 && four.slice(4).some((value) => value !== 0))
    throw badFile(`its fisheye lens has ${four.length} coefficients; k1 k2 k3 k4 are needed`);
  return { model: "fisheye", distortion: [0, 1, 2, 3].map((index) => four[index] ?? 0) };
}

/** The lens by its name. If the name is unknown, the camera is not silently read as Brown's model or as a camera without lens. */
function lensOf(raw: RawCamera, label: string, warnings: ReaderWarning[]): Lens {
  const { distortion: values = [] } = raw;
  const written = (raw.model ?? "").trim();
  if (!values.every((value) => Number.isFinite(value) && Math.abs(value) < 1e6))
    throw badFile("its distortion contains something other than numbers");
  const { family, meaning } = lensNamed(written);
  const bent = values.some((value) => value !== 0);
  if (family === "fisheye") return fisheye(raw, label, warnings);
  if (family === "other" || (family === undefined && bent))
    throw badFile(
      `its lens model "${written.slice(0, 40)}"${meaning === undefined ? "" : ` (${meaning})`} is not supported; Brown's and Kannala-Brandt's are`,
    );
  if (family === undefined && raw.isLens === true)
    warnings.push(
      warning(
        "distortion-guessed",
        `${label} has the unknown lens model "${written.slice(0, 40)}" and was read without distortion.`,
        { model: written.slice(0, 40) },
      ),
    );
  if (!bent) return {};
  if (family === "realsense")
    warnings.push(
      warning(
        "lens-approximated",
        `${label} has RealSense's "${written}" lens, which is read as Brown's, as librealsense projects it; the two differ by products of coefficients.`,
        { model: written },
      ),
    );
  const isFour = raw.isFourRadial === true || (values.length === 4 && raw.isByName !== true);
  if (isFour && written === "") warnings.push(ofFour(label, raw));
  return withBrown(brown(values.length === 3 ? radial(values, label, warnings) : values));
}

/** Four coefficients without a lens model: cv2.fisheye writes four, and so do calibrations of Brown's model without k3. */
function ofFour(label: string, { name, isFourRadial = false }: RawCamera): ReaderWarning {
  const [what, as] = isFourRadial
    ? ["the coefficients k1 k2 k3 k4 without p1 p2 and without a lens model", "Brown's"]
    : ["four distortion coefficients without a lens model", "k1 k2 p1 p2 of Brown's"];
  return warning(
    "distortion-guessed",
    `${label} has ${what}. They were read as ${as}, but may be those of a fisheye (Kannala-Brandt). Write the model into the camera, as "distortion_model": "equidistant" or "plumb_bob".`,
    { isFour: true, camera: name },
  );
}

const isOfFour = ({ isFour }: ReaderWarning): boolean => isFour === true;

/** Reads the four coefficients of cameras without a lens model as those of a fisheye, if `says` mentions one. */
export function asFisheye(cameras: NamedCamera[], warnings: ReaderWarning[], says: string): void {
  if (!FISHEYE_WORD.test(says)) return;
  for (const [index, { camera: name }] of [...warnings].entries()) {
    const doubt = warnings[index];
    const found = cameras.find((each) => each.name === name && each.camera.model === undefined);
    if (doubt === undefined || !isOfFour(doubt) || found === undefined) continue;
    const values = found.camera.distortion ?? [];
    const four = values.length === 4 ? values : FISHEYE_OF_BROWN.map((at) => values[at] ?? 0);
    found.camera = { ...found.camera, model: "fisheye", distortion: Array.from(four) };
    const of = name === undefined ? "The camera" : `The camera "${String(name)}"`;
    warnings[index] = warning(
      "distortion-guessed",
      `${of} has four distortion coefficients without a lens model. They were read as those of a fisheye (Kannala-Brandt), because the file or its name mentions one. Write the model into the camera, as "distortion_model": "equidistant" or "plumb_bob".`,
    );
  }
}

/** Three coefficients are radial, because tangential ones come in pairs. */
function radial([k1 = 0, k2 = 0, k3 = 0]: Numbers, label: string, warnings: ReaderWarning[]): Numbers {
  warnings.push(
    warning(
      "distortion-guessed",
      `${label} has three distortion coefficients, which were read as k1 k2 k3. Write five (k1 k2 p1 p2 k3) to say which they are.`,
    ),
  );
  return [k1, k2, 0, 0, k3];
}

const withBrown = (distortion: Numbers | undefined): Lens => (distortion === undefined ? {} : { distortion });
