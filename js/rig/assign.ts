/**
 * Which of the cameras that were read took which pictures: by what their file says, by their names, by the size of their images, and last by
 * their order.
 *
 * A file may hold a camera many times, once for each size of its pictures: the one of this size is taken. Where there is none, one of the
 * same view is scaled, with a warning.
 */
import { poseOf } from "./formats/poses.js";
import { haveLikeAspects, scaledCamera } from "./scale.js";
import type { CheckFrame, NamedCamera, NamedPose, RigFolder } from "./types.js";
import { type ReaderWarning, distinct, warning } from "./warnings.js";

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

/** What a name says of a camera, or of an end of a pose. */
export function sideOf(name = ""): Side | undefined {
  const [colour, depth] = [COLOUR.test(words(name)), DEPTH.test(words(name))];
  return colour === depth ? undefined : colour ? "colour" : "depth";
}
const takes = (camera: NamedCamera, side: Side): boolean =>
  camera.takes === undefined ? sideOf(camera.name) === side : camera.takes === side || camera.takes === "both";
const isOpen = (camera: NamedCamera): boolean => camera.takes === undefined && sideOf(camera.name) === undefined;

/** Those that took these pictures: by their file's word before those by their names, and depth before the infrared it is made of. */
function taking(cameras: NamedCamera[], side: Side): NamedCamera[] {
  const rank = ({ takes: said, name = "" }: NamedCamera) =>
    said !== undefined ? 0 : /depth|dpt|colou?r|rgb/i.test(name) ? 1 : 2;
  return cameras.filter((each) => takes(each, side)).sort((a, b) => rank(a) - rank(b));
}

/** Of cameras of one side: one of this size, one without a size, one of the same view, or else the first. */
const ofSize = (cameras: NamedCamera[], size: Size): NamedCamera | undefined =>
  cameras.find((each) => fits(each, size)) ??
  cameras.find(unsized) ??
  cameras.find(({ width = 1, height = 1 }) => haveLikeAspects([width, height], [size.width, size.height])) ??
  cameras[0];

/** Poses that lead from a depth to a colour camera first, then those that lead back; those from a frame to itself say nothing. */
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

/** One camera without a name: for both pictures, where they show the same view, or for the one whose size it has. */
function shared(only: NamedCamera, image: Size, depth: Size, warnings: ReaderWarning[]): (NamedCamera | undefined)[] {
  const areAlike = haveLikeAspects([image.width, image.height], [depth.width, depth.height]);
  const isSame = image.width === depth.width && image.height === depth.height;
  const isOfDepth =
    fits(only, depth) || (unsized(only) && !isSame && isCentred(only, depth) && !isCentred(only, image));
  if (!areAlike || (isOfDepth && !isSame)) return isOfDepth ? [undefined, only] : [only, undefined];
  if (!isSame && !fits(only, image) && !(unsized(only) && isCentred(only, image))) return [only, undefined];
  const size = isSame
    ? ""
    : `, scaled from ${image.width}x${image.height} to ${depth.width}x${depth.height} for the depth maps`;
  warnings.push(
    warning(
      "camera-shared",
      `Only one camera's intrinsics were found; they are used for both pictures${size}, as if these were registered to each other.`,
    ),
  );
  return [only, isSame ? only : scaled({ ...only, width: image.width, height: image.height }, depth)];
}

/** Whether a principal point is as near to the middle of a picture as lenses are mounted: within a fifth of its sides. */
const isCentred = ({ camera: { cx, cy } }: NamedCamera, { width, height }: Size): boolean =>
  Math.abs(cx / width - 0.5) < 0.2 && Math.abs(cy / height - 0.5) < 0.2;

/** Both cameras by what is said of them, then by size, then by order. */
function chosen(
  cameras: NamedCamera[],
  image: Size,
  depth: Size,
  warnings: ReaderWarning[],
): (NamedCamera | undefined)[] {
  let colour = ofSize(taking(cameras, "colour"), image);
  let range = ofSize(taking(cameras, "depth"), depth);
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
        "No name says which camera is which; the first was used for colour and the second for depth.",
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

/** The camera for pictures of this size, with a warning where it is of another. */
function forSize(camera: NamedCamera | undefined, size: Size, what: string, warnings: ReaderWarning[]) {
  if (camera === undefined) return undefined;
  const { width, height } = size;
  const { cx, cy } = camera.camera;
  if (unsized(camera)) {
    if (cx > width || cy > height)
      warnings.push(
        warning(
          "principal-point",
          `The intrinsics of the ${what} have their principal point outside these (${cx}, ${cy} of ${width}x${height}): they may be for another size.`,
          { cx, cy },
        ),
      );
    return camera;
  }
  if (fits(camera, size)) return camera;
  const own: [number, number] = [camera.width ?? 0, camera.height ?? 0];
  const canScale = haveLikeAspects(own, [width, height]);
  const how = canScale ? "they were scaled to that, as if these showed the same view" : "scale or crop them first";
  warnings.push(
    warning(
      "camera-size",
      `The intrinsics of the ${what} are for ${own.join("x")} pixels, and these have ${width}x${height}: ${how}.`,
      { camera: own, picture: [width, height] },
    ),
  );
  return canScale ? scaled(camera, size) : camera;
}

/** Depth maps that were carried into the colour images: both have the colour camera, and nothing lies between them. */
function align(folder: RigFolder, colour: NamedCamera): void {
  folder.warnings.push(
    warning(
      "camera-shared",
      "The names of the depth maps say that they are aligned with the colour images: the colour camera's intrinsics are used for both, and the pose between them is the identity.",
    ),
  );
  const pose = poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]);
  folder.poses.unshift({ name: "aligned (identity)", from: "depth", to: colour.name ?? "color", pose });
}

/** Names that differ in their number alone: image_2 and image_3. */
const family = (name: string): string => name.replace(/\d+/g, "#");

/**
 * Of cameras that are called as folders of pictures, as KITTI's image_2, those whose pictures these are, and the poses that do not lead to
 * others of them.
 */
export function ofPictures<T extends { cameras: NamedCamera[]; poses: NamedPose[] }>(all: T, paths: string[]): T {
  const segments = new Set(paths.flatMap((path) => path.split("/").slice(0, -1)));
  const mine = all.cameras.filter(({ name }) => name !== undefined && /\d/.test(name) && segments.has(name));
  const families = new Set(mine.map(({ name = "" }) => family(name)));
  const isOther = (name: string | undefined) => name !== undefined && families.has(family(name)) && !segments.has(name);
  return {
    ...all,
    cameras: all.cameras
      .filter(({ name }) => !isOther(name))
      .map((each) => (mine.includes(each) ? { ...each, takes: each.takes ?? "colour" } : each)),
    poses: all.poses.filter(({ from, to }) => !isOther(from) && !isOther(to)),
  };
}

/** What the names of a folder's files say. */
export interface Hints {
  /** The depth maps were carried into the colour images. */
  isAligned?: boolean;
  /** Cameras that are called as a frame are its own. */
  cameraOf?: (frame: CheckFrame) => NamedCamera | undefined;
}

/** Phones give each picture a camera of its own, as their lens focuses; depth maps are registered to it. */
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

/** Gives the frames of a folder their cameras, with a warning where that was a guess. */
export function addCameras(folder: RigFolder, { isAligned = false, cameraOf }: Hints = {}): void {
  const { frames, cameras, warnings } = folder;
  const [first] = frames;
  if (first === undefined || cameras.length === 0) return;
  if (cameraOf !== undefined && addOwn(folder, cameraOf)) return;
  const { image, depth } = first;
  const isSame = image.width === depth.width && image.height === depth.height;
  const [some, other] = chosen(cameras, image, depth, warnings);
  const colour = forSize(some, image, "colour images", warnings);
  const isCarried = isAligned && isSame && colour !== undefined && colour !== other;
  const range = isCarried ? colour : forSize(other, depth, "depth maps", warnings);
  if (isCarried) align(folder, colour);
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
    if (range) frame.depth.camera = range.camera;
  }
}
