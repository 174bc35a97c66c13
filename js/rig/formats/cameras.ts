/** Cameras as files write them: checked, with their distortion by OpenCV's names. */
import { badFile } from "../../errors.js";
import type { NamedCamera } from "../types.js";
import { MOST_SIDE } from "./limits.js";
import type { Numbers } from "./numbers.js";
import { type ReaderWarning, warning } from "../warnings.js";

/** What a file says of a camera, before it is checked. */
export interface RawCamera {
  name?: string | undefined;
  focal: Numbers;
  centre: Numbers;
  skew?: number | undefined;
  model?: string | undefined;
  distortion?: Numbers | undefined;
  width?: number | undefined;
  height?: number | undefined;
}

/** Names of a lens's coefficients in OpenCV's order, of Brown's model and of a fisheye. */
export const BROWN_NAMES = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
export const FISHEYE_NAMES = ["k1", "k2", "k3", "k4"];

/** The members of a matrix of intrinsics, row by row with three columns, or four of a projection. */
export const ofMatrix = (k: Numbers, columns = 3): Required<Pick<RawCamera, "focal" | "centre" | "skew">> => ({
  focal: [k[0] ?? NaN, k[columns + 1] ?? NaN],
  centre: [k[2] ?? NaN, k[columns + 2] ?? NaN],
  skew: k[1],
});

/** Files call the same model by many names. */
const BROWN =
  /^(|none|pinhole(camera)?|plumb[_ ]?bob|radtan\d?|radial-?tangential\d?|brown|brown[_ ]?conrady|opencv|rational([_ ]?polynomial)?|full_opencv|perspective|standard|thin_prism|tilted)$/;
const FISHEYE = /^(fisheye|equidistant(camera)?|equid?4?|kannala[_ ]?brandt[48]?|opencv_fisheye)$/;
/** librealsense's variants; it projects both as Brown's (its older versions followed the second the other way), but for products of terms. */
const REALSENSE = /^(modified|inverse)[_ ]?brown[_ ]?conrady$/;
/** Short names of lens models that are not supported, with what they stand for. */
const OTHERS: Record<string, string> = {
  ds: "double sphere",
  eucm: "extended unified",
  ucm: "unified",
  omni: "omnidirectional",
  mei: "omnidirectional",
  fov: "field of view",
  atan: "field of view",
  ftheta: "F-theta",
  scaramuzza: "Scaramuzza's polynomial",
  fisheyeradtanthinprism: "Aria's Fisheye624: make linear pictures by projectaria_tools",
};

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
      `its camera gives only the ${width === undefined ? "height" : "width"} of its images, ${width ?? height}`,
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
        `${label} has its principal point outside its image (${cx}, ${cy} of ${size.width}x${size.height}).`,
        { cx, cy },
      ),
    );
  if (size === undefined && (cx <= 0 || cy <= 0))
    warnings.push(
      warning("principal-point", `${label} has the principal point ${cx}, ${cy}, which is outside any image.`, {
        cx,
        cy,
      }),
    );
  if (fx < 2 || fy < 2)
    warnings.push(
      warning(
        "focal-length-normalised",
        `${label} has a focal length of ${fx}, which looks normalised by the image's size; pixels are needed.`,
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

function lensOf(
  { model: written = "", distortion: values = [] }: RawCamera,
  label: string,
  warnings: ReaderWarning[],
): Lens {
  if (!values.every((value) => Number.isFinite(value) && Math.abs(value) < 1e6))
    throw badFile("its distortion contains something other than numbers");
  const model = written.trim().toLowerCase();
  const bent = values.some((value) => value !== 0);
  if (FISHEYE.test(model)) {
    if (values.length !== 0 && values.length !== 4 && values.slice(4).some((value) => value !== 0))
      throw badFile(`its fisheye lens has ${values.length} coefficients; k1 k2 k3 k4 are needed`);
    return { model: "fisheye", distortion: [0, 1, 2, 3].map((index) => values[index] ?? 0) };
  }
  if (!bent) return {};
  if (REALSENSE.test(model))
    warnings.push(
      warning(
        "lens-approximated",
        `${label} has RealSense's "${written.trim()}" lens, which is read as Brown's, as librealsense projects it; the two differ by products of coefficients.`,
        { model: written.trim() },
      ),
    );
  else if (!BROWN.test(model))
    throw badFile(
      `its lens model "${written.slice(0, 40)}"${Object.hasOwn(OTHERS, model) ? ` (${OTHERS[model]})` : ""} is not supported; Brown's and Kannala-Brandt's are`,
    );
  return withBrown(brown(values.length === 3 ? radial(values, label, warnings) : values));
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
