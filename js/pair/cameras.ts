/** Assigns cameras to the two pictures of a run by the rules for folders of a rig, scaled to the size of these pictures. */
import { chosen, forSize } from "../rig/assign.js";
import { stem } from "../rig/names.js";
import type { NamedCamera } from "../rig/types.js";
import { type ReaderWarning, warning } from "../rig/warnings.js";

/** A camera that a file gave. */
export interface GivenCamera extends NamedCamera {
  /** The name of that file. */
  file: string;
}

/** Columns and rows of a picture; a depth map may be an organised cloud. */
export interface PictureSize {
  width: number;
  height: number;
  organised?: boolean;
}

/** The cameras of two pictures. */
export interface PairCameras {
  colour?: GivenCamera;
  depth?: GivenCamera;
  warnings: ReaderWarning[];
}

/** A single unnamed camera of a file gets the file's name. */
function named(cameras: readonly GivenCamera[]): GivenCamera[] {
  const isOnly = (file: string) => cameras.filter((each) => each.file === file).length === 1;
  return cameras.map((each) =>
    each.name === undefined && isOnly(each.file) ? { ...each, name: stem(each.file) } : each,
  );
}

/** A camera whose picture has another aspect ratio is left out, because it cannot be scaled. */
export function camerasFor(given: readonly GivenCamera[], colour: PictureSize, depth: PictureSize): PairCameras {
  const warnings: ReaderWarning[] = [];
  const frame = {
    image: { ...colour, data: new Uint8Array() },
    depth: { ...depth, ...(depth.organised === true && { points: new Float32Array() }) },
  };
  const [some, other] = chosen(named(given), frame, warnings);
  const sized = (camera: NamedCamera | undefined, size: PictureSize, what: string): GivenCamera | undefined => {
    const found = forSize(camera, size, what, warnings);
    if (found === undefined || found.width === undefined) return found as GivenCamera | undefined;
    if (found.width === size.width && found.height === size.height) return found as GivenCamera;
    const { file } = found as GivenCamera;
    warnings.push(
      warning("camera-left-out", `${file}: not used for the ${what}, because its image size has another aspect ratio.`),
    );
    return undefined;
  };
  const found = [sized(some, colour, "colour images"), sized(other, depth, "depth maps")] as const;
  return {
    ...(found[0] && { colour: found[0] }),
    ...(found[1] && { depth: found[1] }),
    warnings,
  };
}
