/** Which of the cameras that were read took which pictures: by their names, by the size of their images, and last by their order. */
import type { NamedCamera, RigFolder } from "./types.js";
import { warning } from "./warnings.js";

const COLOUR = /colou?r|rgb|\bhr\b/i;
const DEPTH = /depth|dpt|\bir\b|infra|tof|\blr\b/i;
const words = (name: string): string => name.replace(/[_.-]+/g, " ");

const fits = (camera: NamedCamera, { width, height }: { width: number; height: number }): boolean =>
  camera.width === width && camera.height === height;
const unsized = (camera: NamedCamera): boolean => camera.width === undefined;

/** Gives the frames of a folder their cameras, with a warning where that was a guess. */
export function addCameras({ frames, cameras, warnings }: RigFolder): void {
  const [first] = frames;
  if (first === undefined || cameras.length === 0) return;
  const { image, depth } = first;
  const byName = (pattern: RegExp, other: RegExp) =>
    cameras.find(({ name = "" }) => pattern.test(words(name)) && !other.test(words(name)));
  let colour = byName(COLOUR, DEPTH);
  let range = byName(DEPTH, COLOUR);
  const free = () => cameras.filter((each) => each !== colour && each !== range);
  if (colour === undefined && range === undefined && cameras.length === 1) {
    const [only] = cameras;
    const isShared = image.width === depth.width && image.height === depth.height;
    if (only !== undefined && isShared) {
      [colour, range] = [only, only];
      warnings.push(
        warning(
          "camera-shared",
          "Only one camera's intrinsics were found; they are used for both pictures, as if these were registered to each other.",
        ),
      );
    } else if (only !== undefined && fits(only, depth)) range = only;
    else colour = only;
  }
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
  for (const [camera, { width, height }, what] of [
    [colour, image, "colour images"],
    [range, depth, "depth maps"],
  ] as const) {
    if (camera?.width !== undefined && !fits(camera, { width, height })) {
      warnings.push(
        warning(
          "camera-size",
          `The intrinsics of the ${what} are for ${camera.width}x${camera.height} pixels, and these have ${width}x${height}: scale or crop them first.`,
          { camera: [camera.width, camera.height ?? 0], picture: [width, height] },
        ),
      );
    }
  }
  for (const [camera, { width, height }, what] of [
    [colour, image, "colour images"],
    [range, depth, "depth maps"],
  ] as const) {
    if (camera === undefined || !unsized(camera)) continue;
    const { cx, cy } = camera.camera;
    if (cx > width || cy > height)
      warnings.push(
        warning(
          "principal-point",
          `The intrinsics of the ${what} have their principal point outside these (${cx}, ${cy} of ${width}x${height}): they may be for another size.`,
          { cx, cy },
        ),
      );
  }
  for (const frame of frames) {
    if (colour) frame.image.camera = colour.camera;
    if (range) frame.depth.camera = range.camera;
  }
}
