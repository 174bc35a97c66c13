/**
 * Decides which camera took which pictures: by the file of the camera, by names, by image size, and finally by order.
 *
 * A file may hold a camera several times, once for each size of its pictures; the one of this size is used. If no camera has this size, one
 * of the same view is scaled, with a warning.
 */
import { isLidar, linked } from "./formats/frames.js";
import { poseOf } from "./formats/poses.js";
import { haveLikeAspects, scaledCamera } from "./scale.js";
import type { CheckFrame, NamedCamera, NamedPose, RigFolder } from "./types.js";
import { type ReaderWarning, digits, distinct, warning } from "./warnings.js";

const COLOUR = /colou?r|rgb|\bhr\b/i;
const DEPTH = /depth|dpt|\bir\b|infra|tof|\blr\b/i;
const words = (name: string): string => name.replace(/[_.-]+/g, " ");

type Side = "colour" | "depth";
interface Size {
  width: number;
  height: number;
}

const fits = (camera: NamedCamera, { width, height }: Size): boolean =>
  camera.width === width && camera.height === height;
const unsized = (camera: NamedCamera): boolean => camera.width === undefined;

/** The side, colour or depth, that a name gives a camera or an end of a pose. */
export function sideOf(name = ""): Side | undefined {
  const [colour, depth] = [COLOUR.test(words(name)), DEPTH.test(words(name))];
  return colour === depth ? undefined : colour ? "colour" : "depth";
}
const takes = (camera: NamedCamera, side: Side): boolean =>
  camera.takes === undefined ? sideOf(camera.name) === side : camera.takes === side || camera.takes === "both";
const isOpen = (camera: NamedCamera): boolean => camera.takes === undefined && sideOf(camera.name) === undefined;

const rank = ({ takes: said, name = "" }: NamedCamera): number =>
  said !== undefined ? 0 : /depth|dpt|colou?r|rgb/i.test(name) ? 1 : 2;

/**
 * The cameras of these pictures, found first by their file, then by their names; depth has priority over the infrared images that it is
 * computed from.
 */
function taking(cameras: NamedCamera[], side: Side): NamedCamera[] {
  return cameras.filter((each) => takes(each, side)).sort((a, b) => rank(a) - rank(b));
}

/** Chooses one camera of a side: one with this size, else one without a size, else one with the same view, else the first. */
const ofSize = (cameras: NamedCamera[], size: Size): NamedCamera | undefined =>
  cameras.find((each) => fits(each, size)) ??
  cameras.find(unsized) ??
  cameras.find(({ width = 1, height = 1 }) => haveLikeAspects([width, height], [size.width, size.height])) ??
  cameras[0];

/** Poses from a depth to a colour camera first, then the inverse ones; poses from a frame to itself carry no information. */
export function inOrder(poses: readonly NamedPose[]): NamedPose[] {
  const rank = ({ from, to }: NamedPose): number => {
    const [a, b] = [sideOf(from), sideOf(to)];
    return a === "depth" && b === "colour" ? 0 : a === "colour" && b === "depth" ? 1 : 2;
  };
  return poses.filter(({ from, to }) => from === undefined || from !== to).sort((a, b) => rank(a) - rank(b));
}

/** The camera with its numbers for another size of the same view. */
function scaled(camera: NamedCamera, { width, height }: Size): NamedCamera {
  const from: [number, number] = [camera.width ?? width, camera.height ?? height];
  return { ...camera, width, height, camera: scaledCamera(camera.camera, from, [width, height]) };
}

/** A single camera without a name belongs to both pictures if they show the same view, or else to the picture whose size it has. */
function shared(only: NamedCamera, image: Size, depth: Size, warnings: ReaderWarning[]): (NamedCamera | undefined)[] {
  const areAlike = haveLikeAspects([image.width, image.height], [depth.width, depth.height]);
  const isSame = image.width === depth.width && image.height === depth.height;
  const isOfDepth =
    fits(only, depth) || (unsized(only) && !isSame && isCentred(only, depth) && !isCentred(only, image));
  if (!areAlike || (isOfDepth && !isSame)) return isOfDepth ? [undefined, only] : [only, undefined];
  if (!isSame && !fits(only, image) && !(unsized(only) && isCentred(only, image))) return [only, undefined];
  const pair = [only, isSame ? only : scaled({ ...only, width: image.width, height: image.height }, depth)];
  if (only.takes === "both") return pair;
  const size = isSame
    ? ""
    : `, scaled from ${image.width}x${image.height} to ${depth.width}x${depth.height} for the depth maps`;
  warnings.push(
    warning(
      "camera-shared",
      `Only one camera's intrinsics were found; they are used for both pictures${size}, as if these were registered to each other.`,
    ),
  );
  return pair;
}

/** Whether a principal point is as near to the middle of the picture as that of a usual lens: within a fifth of the sides. */
const isCentred = ({ camera: { cx, cy } }: NamedCamera, { width, height }: Size): boolean =>
  Math.abs(cx / width - 0.5) < 0.2 && Math.abs(cy / height - 0.5) < 0.2;

/** Focal lengths that differ by a smaller share belong to the same camera. */
const ALIKE = 1e-3;

/** Warns if another camera may have taken these pictures as well. */
function checkOnly(
  pool: NamedCamera[],
  camera: NamedCamera | undefined,
  what: string,
  warnings: ReaderWarning[],
): void {
  if (camera === undefined) return;
  const other = pool.find(
    (each) =>
      rank(each) === rank(camera) &&
      each.width === camera.width &&
      each.height === camera.height &&
      Math.abs(each.camera.fx / camera.camera.fx - 1) > ALIKE,
  );
  if (other === undefined) return;
  const called = [camera, other].map(({ name, camera: { fx } }) => `${name ?? "an unnamed one"} (fx ${fx.toFixed(1)})`);
  warnings.push(
    warning(
      "cameras-by-order",
      `Several cameras may have taken the ${what}; the first of ${called.join(" and ")} was used.`,
    ),
  );
}

/** Chooses both cameras by their names, then by size, then by order. */
export function chosen(
  cameras: NamedCamera[],
  { image, depth }: CheckFrame,
  warnings: ReaderWarning[],
): (NamedCamera | undefined)[] {
  const [colours, ranges] = [taking(cameras, "colour"), taking(cameras, "depth")];
  let [colour, range] = [ofSize(colours, image), ofSize(ranges, depth)];
  checkOnly(colours, colour, "colour images", warnings);
  if (depth.points === undefined) checkOnly(ranges, range, "depth maps", warnings);
  const open = () => cameras.filter((each) => isOpen(each) && each !== colour && each !== range);
  const [only, ...more] = open();
  if (colour === undefined && range === undefined && only !== undefined && more.length === 0 && cameras.length === 1)
    [colour, range] = shared(only, image, depth, warnings);
  colour ??= open().find((each) => fits(each, image) && !fits(each, depth));
  range ??= open().find((each) => fits(each, depth) && !fits(each, image));
  if (colour === undefined && range === undefined && open().length > 1) {
    warnings.push(
      warning(
        "cameras-by-order",
        "The names do not say which camera is which; the first was used for colour and the second for depth.",
      ),
    );
    [colour, range] = open();
  }
  if (cameras.length > 1) {
    colour ??= open().find((each) => unsized(each) || fits(each, image));
    range ??= open().find((each) => unsized(each) || fits(each, depth));
  }
  return [colour, range];
}

/** Largest distance of a principal point from the centre: a share of a side, or pixels in small pictures. */
const [OFF_MIDDLE, FEW_PIXELS] = [0.15, 8];

/** The camera for pictures of this size, with a warning if it is for another size. */
export function forSize(
  camera: NamedCamera | undefined,
  size: Size,
  what: string,
  warnings: ReaderWarning[],
): NamedCamera | undefined {
  if (camera === undefined) return undefined;
  const { width, height } = size;
  const { cx, cy } = camera.camera;
  if (unsized(camera)) {
    const off = Math.max(Math.abs((cx + 0.5) / width - 0.5), Math.abs((cy + 0.5) / height - 0.5));
    const where = cx > width || cy > height ? "outside the picture" : "far from the centre of the picture";
    if (off > Math.max(OFF_MIDDLE, FEW_PIXELS / Math.min(width, height)))
      warnings.push(
        warning(
          "principal-point",
          `The intrinsics of the ${what} have their principal point ${where} (${digits(cx)}, ${digits(cy)} of ${width}x${height}): they may be for another size, about ${Math.round(2 * cx + 1)}x${Math.round(2 * cy + 1)}.`,
          { cx, cy },
        ),
      );
    return camera;
  }
  if (fits(camera, size)) return camera;
  const own: [number, number] = [camera.width ?? 0, camera.height ?? 0];
  const canScale = haveLikeAspects(own, [width, height]);
  const how = canScale
    ? "the intrinsics were scaled, as if both sizes showed the same view"
    : "scale or crop the intrinsics first";
  warnings.push(
    warning(
      "camera-size",
      `The intrinsics of the ${what} are for ${own.join("x")} pixels, but these pictures have ${width}x${height}: ${how}.`,
      { camera: own, picture: [width, height] },
    ),
  );
  return canScale ? scaled(camera, size) : camera;
}

/** For depth maps that are aligned with the colour images: both use the colour camera, and the pose is the identity. */
function align(folder: RigFolder, colour: NamedCamera, why: string): void {
  folder.warnings.push(
    warning(
      "camera-shared",
      `${why}: one camera's intrinsics are used for both, and the pose between them is the identity.`,
    ),
  );
  const pose = poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]);
  folder.poses.unshift({ name: "aligned (identity)", from: "depth", to: colour.name ?? "color", pose });
}

/**
 * If no pose leads from the depth camera or the LiDAR to the colour camera, puts the chain of poses through shared frames first.
 */
function relate({ poses }: RigFolder, colour: string | undefined, depth: string | undefined): void {
  const isDirect = poses.some(({ from, to }) => {
    const [a, b] = [from ?? "", to ?? ""];
    const sides = [sideOf(a), sideOf(b)];
    const isNamed = [depth, colour].every((name) => name !== undefined && (name === a || name === b));
    return isNamed || (sides.includes("colour") && sides.includes("depth")) || from === undefined || to === undefined;
  });
  if (colour === undefined || isDirect) return;
  const ends =
    depth !== undefined && depth !== colour
      ? [depth]
      : poses.flatMap(({ from = "", to = "" }) => [from, to].filter(isLidar));
  for (const from of ends) {
    const way = linked(poses, from, colour);
    if (way === undefined) continue;
    const isThere = poses.findIndex((pose) => pose.from === from && pose.to === colour);
    if (isThere >= 0) poses.splice(isThere, 1);
    poses.unshift(way);
    return;
  }
}

/** Names that differ only in their number: image_2 and image_3. */
const family = (name: string): string => name.replace(/\d+/g, "#");

/**
 * If cameras are named after folders of pictures, such as KITTI's image_2, keeps only the cameras of the folders that these pictures are
 * in. A pose to a removed camera is left out as well, if the same frame also has a pose to a kept camera.
 */
export function ofPictures<T extends { cameras: NamedCamera[]; poses: NamedPose[] }>(all: T, paths: string[]): T {
  const segments = new Set(paths.flatMap((path) => path.split("/").slice(0, -1)));
  const isOurs = (name = "") => /\d/.test(name) && segments.has(name);
  const families = new Set(all.cameras.flatMap(({ name = "" }) => (isOurs(name) ? [family(name)] : [])));
  const isOther = (name = "") => families.has(family(name)) && !segments.has(name);
  const tookColours = ({ takes: said }: NamedCamera) => said === "colour" || said === "both";
  const cameras = all.cameras.filter((each) => !(isOther(each.name) && tookColours(each)));
  const isWhole = all.cameras.some((each) => each.takes === "both" && (isOther(each.name) || isOurs(each.name)));
  return {
    ...all,
    cameras: cameras.map((each) =>
      isOurs(each.name) ? { ...each, takes: isWhole ? "both" : (each.takes ?? "colour") } : each,
    ),
    poses: all.poses.filter(
      ({ from, to }) => !isOther(to) || !all.poses.some((other) => other.from === from && isOurs(other.to)),
    ),
  };
}

/** The common camera of both pictures, if one of them was transformed into the other's view. */
function carriedInto(
  { frames, cameras, poses }: RigFolder,
  [colour, range]: (NamedCamera | undefined)[],
  isAligned: boolean,
) {
  const [{ image, depth } = {}] = frames;
  if (image === undefined || depth === undefined || depth.points !== undefined) return undefined;
  if (image.width !== depth.width || image.height !== depth.height) return undefined;
  /** Whether there are cameras of this side, but none with pictures of this size. */
  const isNoneOf = (side: Side) => {
    const own = taking(cameras, side);
    return own.length > 0 && own.every((each) => !unsized(each) && !fits(each, image));
  };
  const size = `${image.width}x${image.height}`;
  if (colour !== undefined && colour !== range) {
    if (isAligned)
      return { camera: colour, why: "The names of the depth maps say that they are aligned with the colour images" };
    if (fits(colour, image) && isNoneOf("depth"))
      return {
        camera: colour,
        why: `The depth maps have the size of the colour images (${size}), which no depth camera in the files has, so they were treated as aligned with the colour images`,
      };
  }
  // A colour camera with the aspect ratio of the pictures took them binned or scaled; its intrinsics are scaled, with a warning.
  const isOfView = ({ width = 1, height = 1 }: NamedCamera) =>
    haveLikeAspects([width, height], [image.width, image.height]);
  const isOther = isNoneOf("colour") && !taking(cameras, "colour").some(isOfView);
  if (range !== undefined && colour !== undefined && colour !== range && fits(range, depth) && isOther)
    return {
      camera: range,
      why: `The colour images have the size of the depth maps (${size}), which no colour camera in the files has, so they were treated as transformed into the depth camera's view`,
    };
  if (colour !== undefined && colour === range && colour.takes === "both" && poses.length > 0)
    return {
      camera: colour,
      why: "The depth maps were treated as registered to the colour images, as is usual for this product",
    };
  return undefined;
}

/** Facts that the names of a folder's files state. */
export interface Hints {
  /** Whether the depth maps are aligned with the colour images. */
  isAligned?: boolean;
  /** Cameras named after a frame are the cameras of that frame. */
  cameraOf?: (frame: CheckFrame) => NamedCamera | undefined;
}

/** Phones give each picture a separate camera, because the lens focuses; depth maps are registered to it. */
function addOwn(folder: RigFolder, cameraOf: NonNullable<Hints["cameraOf"]>): boolean {
  const { frames, warnings } = folder;
  const own = frames.map(cameraOf);
  if (frames.length < 1 || own.some((each) => each === undefined)) return false;
  const said: ReaderWarning[] = [];
  frames.forEach(({ image, depth }, index) => {
    const camera = own[index] as NamedCamera;
    const sized = forSize(camera, image, "colour images", said) ?? camera;
    const [colour, range] = shared({ ...sized, width: image.width, height: image.height }, image, depth, said);
    if (colour) image.camera = colour.camera;
    if (range) depth.camera = range.camera;
  });
  warnings.push(...distinct(said));
  return true;
}

/** Assigns cameras to the frames of a folder, with a warning if this was a guess. */
export function addCameras(folder: RigFolder, { isAligned = false, cameraOf }: Hints = {}): void {
  const { frames, cameras, warnings } = folder;
  const [first] = frames;
  if (first === undefined || cameras.length === 0) return;
  if (cameraOf !== undefined && addOwn(folder, cameraOf)) return;
  const { image, depth } = first;
  const [some, other] = chosen(cameras, first, warnings);
  const carried = carriedInto(folder, [some, other], isAligned);
  const colour = forSize(carried?.camera ?? some, image, "colour images", warnings);
  // A cloud needs no camera. If it was sorted from a scan, its size is that of no camera.
  const own = () => (depth.points ? other : forSize(other, depth, "depth maps", warnings));
  const range = carried && colour ? colour : own();
  if (carried && colour) align(folder, colour, carried.why);
  else relate(folder, colour?.name, range === colour ? undefined : range?.name);
  if (colour === undefined)
    warnings.push(
      warning(
        "colour-camera-missing",
        "The colour camera's intrinsics are missing; its focal length has to be estimated.",
      ),
    );
  if (range === undefined && depth.points === undefined)
    warnings.push(
      warning(
        "depth-camera-missing",
        "The depth camera's intrinsics are missing; without them depths cannot be turned into points.",
      ),
    );
  for (const frame of frames) {
    if (colour) frame.image.camera = colour.camera;
    // A cloud's points are not a picture of the colour camera.
    if (range && !(frame.depth.points && range.takes === "both")) frame.depth.camera = range.camera;
  }
}
