/**
 * Which of the cameras that were read took which pictures: by their names, by the size of their images, and last by their order.
 *
 * Intrinsics for another size of the same shape are scaled, which is said; a depth map whose name says that it was carried into the colour
 * camera's view has that camera's.
 */
import type { Pair } from "./lists.js";
import { isAligned, isInDepth } from "./roles.js";
import type { CheckFrame, NamedCamera, RigFolder } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

const COLOUR = /colou?r|rgb|\bhr\b/i;
const DEPTH = /depth|dpt|\bir\b|infra|tof|\blr\b/i;
const words = (name: string): string => name.replace(/[_.-]+/g, " ");
/** Shapes that differ by less are the same; sizes are rounded. */
const SAME_SHAPE = 0.015;
/** Principal points lie nearer to the middle, in shares of a side. */
const OFF_MIDDLE = 0.15;
/** .. or in pixels, of small pictures. */
const FEW_PIXELS = 8;
const NEAR_MIDDLE = 0.1;

interface Size {
  width: number;
  height: number;
}
interface Both {
  colour: NamedCamera | undefined;
  range: NamedCamera | undefined;
}

const fits = (camera: NamedCamera, { width, height }: Size): boolean =>
  camera.width === width && camera.height === height;
const unsized = (camera: NamedCamera): boolean => camera.width === undefined;
const isAlike = (one: Size, other: Size): boolean =>
  Math.abs((one.width * other.height) / (one.height * other.width) - 1) < SAME_SHAPE;
const isSame = (one: Size, other: Size): boolean => one.width === other.width && one.height === other.height;
const sizeOf = ({ width, height }: NamedCamera): Size | undefined =>
  width === undefined || height === undefined ? undefined : { width, height };

/** How far the principal point is off the middle of such a picture, in shares of its sides. */
const offMiddle = ({ camera: { cx, cy } }: NamedCamera, { width, height }: Size): number =>
  Math.max(Math.abs((cx + 0.5) / width - 0.5), Math.abs((cy + 0.5) / height - 0.5));

/** The camera of the same view in another size; pixel centres are whole numbers. */
function scaled({ name, camera }: NamedCamera, from: Size, to: Size): NamedCamera {
  const [across, down] = [to.width / from.width, to.height / from.height];
  const { fx, fy, cx, cy } = camera;
  const place = (at: number, by: number) => (at + 0.5) * by - 0.5;
  const own = { ...camera, fx: fx * across, fy: fy * down, cx: place(cx, across), cy: place(cy, down) };
  return { ...(name !== undefined && { name }), camera: own, ...to };
}

/** Of several cameras that would do, the one of this size. */
const best = (cameras: NamedCamera[], picture: Size): NamedCamera | undefined =>
  cameras.find((each) => fits(each, picture)) ?? cameras.find(unsized) ?? cameras[0];

const SHARED = "used for both pictures, as if these were registered to each other";

/** A single camera without a name: of both pictures where these show the same view, else of the one whose size is its own. */
function ofOne(only: NamedCamera, { image, depth }: CheckFrame, warnings: ReaderWarning[]): Both {
  const size = sizeOf(only);
  const isImages = size ? isSame(size, image) : offMiddle(only, image) < NEAR_MIDDLE;
  if (isSame(image, depth)) {
    warnings.push(warning("camera-shared", `Only one camera's intrinsics were found; they are ${SHARED}.`));
    return { colour: only, range: only };
  }
  if (fits(only, depth)) return { colour: undefined, range: only };
  if (!isImages || !isAlike(image, depth) || depth.points !== undefined) return { colour: only, range: undefined };
  warnings.push(
    warning(
      "camera-shared",
      `Only one camera's intrinsics were found; they are ${SHARED}, scaled from ${image.width}x${image.height} to the depth maps' ${depth.width}x${depth.height}.`,
    ),
  );
  return { colour: only, range: scaled(only, image, depth) };
}

/** By names, sizes and order, of the cameras that go for all frames. */
function chosen(cameras: NamedCamera[], frame: CheckFrame, warnings: ReaderWarning[]): Both {
  const { image, depth } = frame;
  const byName = (pattern: RegExp, other: RegExp, picture: Size) =>
    best(
      cameras.filter(({ name = "" }) => pattern.test(words(name)) && !other.test(words(name))),
      picture,
    );
  let colour = byName(COLOUR, DEPTH, image);
  let range = byName(DEPTH, COLOUR, depth);
  const free = () => cameras.filter((each) => each !== colour && each !== range);
  const [only] = cameras;
  if (colour === undefined && range === undefined && only && cameras.length === 1) return ofOne(only, frame, warnings);
  colour ??= free().find((each) => fits(each, image) && !fits(each, depth));
  range ??= free().find((each) => fits(each, depth) && !fits(each, image));
  if (colour === undefined && range === undefined && cameras.length > 1) {
    warnings.push(
      warning(
        "cameras-by-order",
        "No name says which camera is which; the first was used for colour and the second for depth.",
      ),
    );
    [colour, range] = cameras;
  }
  if (cameras.length > 1) {
    colour ??= free().find((each) => unsized(each) || fits(each, image));
    range ??= free().find((each) => unsized(each) || fits(each, depth));
  }
  return { colour, range };
}

/** Where names say that one picture was carried into the other's view, both have that one's camera. */
function registered(
  { colour, range }: Both,
  { image, depth }: CheckFrame,
  pair: Pair,
  warnings: ReaderWarning[],
): Both {
  const [first] = pair.depths;
  const isDepth = isAligned(first.name) && colour !== undefined && isAlike(image, depth);
  const isImage = !isDepth && isInDepth(pair.colour.name) && range !== undefined && isAlike(image, depth);
  if (!isDepth && !isImage) return { colour, range };
  warnings.push(
    warning(
      "camera-shared",
      isDepth
        ? "The names of the depth maps say that they were aligned to the colour camera: its intrinsics are used for both, and the motion between such pictures is the identity, whatever the files' extrinsics say."
        : "The names of the colour images say that they were aligned to the depth camera: its intrinsics are used for both, and the motion between such pictures is the identity, whatever the files' extrinsics say.",
    ),
  );
  if (isDepth && colour)
    return { colour, range: isSame(image, depth) ? colour : scaled(colour, sizeOf(colour) ?? image, depth) };
  return { colour: range && (isSame(image, depth) ? range : scaled(range, sizeOf(range) ?? depth, image)), range };
}

/** The camera as it fits these pictures, with a word where it was made for others. */
function fitted(camera: NamedCamera | undefined, picture: Size, what: string, warnings: ReaderWarning[]) {
  if (camera === undefined) return undefined;
  const { width, height } = picture;
  const size = sizeOf(camera);
  if (size !== undefined && !isSame(size, picture)) {
    const isScaled = isAlike(size, picture);
    const advice = isScaled
      ? `they were scaled by ${Number((width / size.width).toPrecision(4))}, as if these were not cropped`
      : "scale or crop them first";
    warnings.push(
      warning(
        "camera-size",
        `The intrinsics of the ${what} are for ${size.width}x${size.height} pixels, and these have ${width}x${height}: ${advice}.`,
        { camera: [size.width, size.height], picture: [width, height] },
      ),
    );
    return isScaled ? scaled(camera, size, picture) : camera;
  }
  const { cx, cy } = camera.camera;
  const most = Math.max(OFF_MIDDLE, FEW_PIXELS / Math.min(width, height));
  if (size !== undefined || offMiddle(camera, picture) < most) return camera;
  const where = cx > width || cy > height ? "outside these" : "far from the middle of these";
  warnings.push(
    warning(
      "principal-point",
      `The intrinsics of the ${what} have their principal point ${where} (${cx}, ${cy} of ${width}x${height}): they may be for another size, ${Math.round(2 * cx)}x${Math.round(2 * cy)} or so.`,
      { cx, cy },
    ),
  );
  return camera;
}

const MISSING = {
  colour: "The colour camera's intrinsics are missing; its focal length has to be estimated.",
  depth: "The depth camera's intrinsics are missing; without them depths cannot be turned into points.",
};

interface Known {
  /** The camera that is called as the frame, of each. */
  own?: (NamedCamera | undefined)[];
  /** The files of the first frame. */
  pair?: Pair | undefined;
}

/** Gives the frames of a folder their cameras, with a warning where that was a guess. */
export function addCameras({ frames, cameras, warnings }: RigFolder, { own = [], pair }: Known = {}): void {
  const [first] = frames;
  const isOwn = own.some((each) => each !== undefined);
  if (first === undefined || (cameras.length === 0 && !isOwn)) return;
  const said: ReaderWarning[] = [];
  const all = frames.map((frame, index) => {
    const single = own[index];
    // What goes for all frames is said once.
    const words = index === 0 || single !== undefined ? said : [];
    const found = single ? ofOne(single, frame, words) : chosen(cameras, frame, words);
    return pair ? registered(found, frame, pair, words) : found;
  });
  const [{ colour, range } = { colour: undefined, range: undefined }] = all;
  if (colour === undefined) said.push(warning("colour-camera-missing", MISSING.colour));
  if (range === undefined && first.depth.points === undefined)
    said.push(warning("depth-camera-missing", MISSING.depth));
  for (const [index, frame] of frames.entries()) {
    const both = all[index];
    const image = fitted(both?.colour, frame.image, "colour images", said);
    const depth = fitted(both?.range, frame.depth, "depth maps", said);
    if (image) frame.image.camera = image.camera;
    if (depth) frame.depth.camera = depth.camera;
  }
  warnings.push(...new Map(said.map((each) => [each.message, each])).values());
}
