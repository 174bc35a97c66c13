/** The intrinsics and the size of a camera among the members of an object, by the names and shapes that programs write. */
import { badFile } from "../../errors.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { intrinsicsOf4x4 } from "./blocks.js";
import { type RawCamera, ofMatrix } from "./cameras.js";
import { member } from "./names.js";
import { type Matrix, type Node, type Numbers, matrixOf, numberOf, textOf, transposed } from "./numbers.js";

/** Names of focal lengths and of principal points in the files of different programs. */
const FX = ["fx", "flx", "focalx", "focallengthx"];
const FY = ["fy", "fly", "focaly", "focallengthy"];
const CX = ["cx", "ppx", "u0", "centerx", "principalpointx"];
const CY = ["cy", "ppy", "v0", "centery", "principalpointy"];
/** Four intrinsics in a list are fx fy cx cy if the first two differ by less than this share. */
const SQUARE = 0.2;
/** Shortest focal length in pixels; shorter ones are normalised by the image's size, or are not focal lengths. */
const SHORTEST = 10;
const isLike = (value: number | undefined, to: number): boolean => value !== undefined && Math.abs(value - to) < 1e-6;

/** Nine numbers as a matrix of intrinsics, row by row; they may be stored by rows or by columns. */
function intrinsics(matrix: Matrix | undefined): Numbers | undefined {
  const values = (matrix && intrinsicsOf4x4(matrix.values)) ?? matrix?.values;
  if (values?.length !== 9 || !isLike(values[8], 1)) return undefined;
  const isTriangle = (m: Numbers) => isLike(m[3], 0) && isLike(m[6], 0) && isLike(m[7], 0) && !isLike(m[0], 0);
  if (isTriangle(values))
    return isLike(values[2], 0) && isLike(values[5], 0) && isLike(values[0], 1) ? undefined : values;
  const turned = transposed(values, 3);
  return isTriangle(turned) ? turned : undefined;
}

type Intrinsics = Pick<RawCamera, "focal" | "centre" | "model" | "distortion" | "isByName" | "skew">;

const cameraNamed = (name: string | undefined): string =>
  name === undefined || name === "" ? "its camera" : `its camera "${name}"`;

/** The members fx, fy, cx and cy, by any of their names. */
export function membersOf(node: Node, name: string | undefined): Pick<RawCamera, "focal" | "centre"> | undefined {
  const single = numberOf(member(node, "f", "focal", "focallength", "focallengthpx", "focalpx"));
  const [fx, cx] = [numberOf(member(node, ...FX)), numberOf(member(node, ...CX))];
  if (fx === undefined && single !== undefined && single > SHORTEST && cx !== undefined) {
    const cy = numberOf(member(node, ...CY));
    return cy === undefined ? undefined : { focal: [single, single], centre: [cx, cy] };
  }
  if (fx === undefined || cx === undefined) return undefined;
  const [fy, cy] = [numberOf(member(node, ...FY)), numberOf(member(node, ...CY))];
  if (fy === undefined || cy === undefined) throw badFile(`${cameraNamed(name)} has fx and cx, but not fy and cy`);
  return { focal: [fx, fy], centre: [cx, cy] };
}

/** camodocal's Kannala-Brandt cameras: mu, mv, u0, v0, and k2 to k5, which are OpenCV's k1 to k4. */
export function kannala(node: Node): Intrinsics | undefined {
  const numbers = (names: string[]) => names.map((each) => numberOf(member(node, each)) ?? NaN);
  const [mu = NaN, mv = NaN, u0 = NaN, v0 = NaN] = numbers(["mu", "mv", "u0", "v0"]);
  const lens = numbers(["k2", "k3", "k4", "k5"]);
  if ([mu, mv, u0, v0, ...lens].some(Number.isNaN)) return undefined;
  return { focal: [mu, mv], centre: [u0, v0], model: "fisheye", distortion: lens, isByName: false };
}

/** The members focal_length and principal_point of two numbers each, as in OKVIS. */
export function listsOf(node: Node): Intrinsics | undefined {
  const single = numberOf(node.focal_length);
  const focal = single === undefined ? matrixOf(node.focal_length)?.values : [single, single];
  const centre = matrixOf(node.principal_point)?.values;
  const isPixels = focal?.length === 2 && (focal[0] ?? 0) > SHORTEST;
  return isPixels && centre?.length === 2 ? { focal, centre } : undefined;
}

/** Focal length and sensor width in millimetres with the size of the images, as in Blender. */
export function bySensor(node: Node, warnings: ReaderWarning[]): Intrinsics | undefined {
  const focal = numberOf(member(node, "focallengthmm", "focalmm", "focallength", "lens", "f"));
  const sensor = numberOf(member(node, "sensorwidthmm", "sensorwidth"));
  const { width, height } = sizeOf(node, "");
  if (focal === undefined || sensor === undefined || width === undefined || height === undefined) return undefined;
  const f = (focal / sensor) * Math.max(width, height);
  warnings.push(
    warning(
      "camera-computed",
      `The focal length was computed from ${focal} mm on a sensor of ${sensor} mm, and the principal point was set to the centre of the image. Give fx, fy, cx and cy in pixels if they are known.`,
      { focal, sensor },
    ),
  );
  return { focal: [f, f], centre: [(width - 1) / 2, (height - 1) / 2] };
}

/** Four intrinsics in a list, of Kalibr or of a file without a camera model. */
export function fourOf(node: Node, name: string | undefined): Intrinsics | undefined {
  const kalibr = textOf(member(node, "cameramodel"));
  // DSEC has fu fv pu pv as "camera_matrix".
  const four = matrixOf(member(node, "intrinsics", "cameramatrix"))?.values;
  if (four === undefined) return undefined;
  if (kalibr !== undefined && four.length !== 9 && four.length !== 12) {
    // Other models have other parameters, which are not read here.
    if (kalibr !== "pinhole") return undefined;
    if (four.length !== 4) throw badFile(`${cameraNamed(name)} has ${four.length} intrinsics; fu fv pu pv are needed`);
  } else {
    const [fx = 0, fy = 0] = four;
    const isSquare = fx > SHORTEST && fy > SHORTEST && Math.abs(fx / fy - 1) < SQUARE;
    if (four.length !== 4 || !isSquare) return undefined;
  }
  return { focal: four.slice(0, 2), centre: four.slice(2) };
}

export function cameraOfMatrix(node: Node, key: string, label: string): Intrinsics | undefined {
  const matrix = matrixOf(node[key]);
  const k = intrinsics(matrix);
  if (k === undefined) {
    if (matrix?.values.length === 9 && label === "" && !/^(?:m|matrix)$/i.test(key))
      throw badFile(`its ${key} is not a matrix of intrinsics (fx 0 cx / 0 fy cy / 0 0 1)`);
    return undefined;
  }
  return ofMatrix(k);
}

/** The size among the members of the camera itself; leftovers.ts finds those around it. */
export function sizeOf(node: Node, label: string): { width?: number; height?: number } {
  const both = matrixOf(member(node, "resolution", "imagesize", "size"))?.values;
  if (both?.length === 2) return { width: both[0] ?? 0, height: both[1] ?? 0 };
  const side = (...names: string[]) =>
    numberOf(member(node, ...names.flatMap((name) => (label === "" ? [name] : [`${name}${label}`, name]))));
  const width = side("imagewidth", "width", "resolutionx", "imgdistw");
  const height = side("imageheight", "height", "resolutiony", "imgdisth");
  const [w, h] = [side("w"), side("h")];
  if (width === undefined && height === undefined && w !== undefined && h !== undefined) return { width: w, height: h };
  return { ...(width !== undefined && { width }), ...(height !== undefined && { height }) };
}
