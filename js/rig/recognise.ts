/** Recognises what a picture holds by its content, or by its name if the content is ambiguous. */
import { badFile } from "../errors.js";
import { looksLikeDepth, looksLikeLabels, looksLikeMask, looksLikeSoftMask } from "./colour.js";
import { isGrey } from "./depth.js";
import { isCoded } from "./formats/coded.js";
import type { Picture } from "./formats/picture.js";
import { CONTENTS, type Other, type Role, isAlongRays, isKittiDepth, isOther, roleOf } from "./roles.js";
import type { ReadOptions } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Kind = "colour" | "depth" | "mask";

const isColourful = (picture: Picture): boolean => picture.channels >= 3 && !isGrey(picture);
const isDepthRole = (role: Role | undefined): boolean => role === "depth" || role === "cloud";

/** Smallest shares of a cloud's points to the left of and above the optical axis, and largest share behind the camera. */
const [ASIDE, BEHIND] = [0.1, 0.02];

/** Whether channels of floats are the points of a cloud, with an intensity or without, rather than colours, which are never negative. */
function arePoints({ data, channels }: Picture): boolean {
  const below = [0, 0, 0];
  let count = 0;
  for (let at = 0; at < data.length; at += channels) {
    if (!Number.isFinite(data[at]) || !data[at + 2]) continue;
    count++;
    for (let axis = 0; axis < 3; axis++) if ((data[at + axis] ?? 0) < 0) below[axis] = (below[axis] ?? 0) + 1;
  }
  const [x = 0, y = 0, z = 0] = below;
  return x > ASIDE * count && y > ASIDE * count && z < BEHIND * count;
}

/** Three or four channels of floats are a cloud, a depth map that a renderer repeated in all channels, or colours. */
function kindOfFloats(picture: Picture, role: Role | undefined): Kind {
  const { data, format } = picture;
  if (role === "cloud" || arePoints(picture)) return "depth";
  const isBright = data.some((value) => value > 1 && Number.isFinite(value));
  if (picture.channels === 3 && /^np[yz]$/.test(format)) return isBright || role === "depth" ? "depth" : "colour";
  return picture.channels === 3 && isGrey(picture) && (isBright || role === "depth") ? "depth" : "colour";
}

/** Reports a file whose name or numbers suggest another kind. */
const ofOtherKind = (finding: string, remedy: string) =>
  badFile(`${finding}. ${remedy}`, undefined, { problem: "kind", finding });

const refusal = (role: Other) =>
  role === "disparity"
    ? badFile(
        "its name says that it holds disparities or inverse depths rather than depths: read it as such (the option `inverse`), or compute z = focal length * baseline / (disparity + doffs) and save that. Give the unit if it holds depths",
        undefined,
        { problem: "disparity" },
      )
    : ofOtherKind(
        `its name says that it holds ${CONTENTS[role]}: that is neither a colour image nor a depth map nor a mask`,
        "If it is one of these, state which one when you read it",
      );

/** The kind of a picture, by its content if that is clear, else by its name. */
export function kindOfPicture(name: string, picture: Picture): Kind {
  const role = roleOf(name);
  if (role !== "confidence" && looksLikeMask(picture)) return "mask";
  if (role === "mask" && picture.bits === 8 && isGrey(picture)) return "mask";
  // A mask that was drawn by hand may have soft edges.
  if ((role === undefined || role === "mask") && looksLikeSoftMask(picture, role === "mask")) return "mask";
  const isSeveral = picture.data instanceof Float32Array && picture.channels >= 3;
  if (isSeveral && role !== "normals") return kindOfFloats(picture, role);
  if (isColourful(picture)) return isDepthRole(role) && isCoded(picture) ? "depth" : "colour";
  if (isDepthRole(role)) return "depth";
  if (role === "colour" || role === "infrared" || role === "rendering") return "colour";
  if (isOther(role)) throw refusal(role);
  if (picture.format === "COLMAP" || picture.format === "table" || picture.format === "raw") return "depth";
  if (looksLikeLabels(picture))
    throw ofOtherKind(
      "its few small integers are labels of objects rather than depths",
      "If it is a depth map, state this when you read it",
    );
  return looksLikeDepth(picture) ? "depth" : "colour";
}

/** Warnings where a file's name contradicts the kind it is read as; a disparity map is refused as a depth map unless the unit is given. */
export function nameWarnings(
  name: string,
  picture: Picture,
  kind: string,
  { unit, inverse }: ReadOptions,
): ReaderWarning[] {
  const role = roleOf(name);
  if (kind === "depth" && isOther(role)) {
    if (role === "disparity" && inverse !== undefined) return [];
    if (role === "disparity" && unit === undefined) throw refusal(role);
    return [warning("files-swapped", `Its name says that it holds ${CONTENTS[role]}, but it was read as a depth map.`)];
  }
  if (kind === "depth" && isAlongRays(name))
    return [
      warning(
        "files-swapped",
        "Its name says that it holds distances along the rays, which exceed depths (along z) away from the middle of the picture: divide each by the length of its ray at z = 1.",
      ),
    ];
  if (kind === "colour" && role === "depth" && isColourful(picture))
    return [
      warning(
        "files-swapped",
        "Its name says depth, but it is a coloured picture: a rendering of the depth (a colour map), or depths in an unknown code? It was read as a colour image.",
      ),
    ];
  return [];
}

/** The unit of KITTI's depth maps, which are recognised by their names. */
export const unitOfName = (name: string, picture: Picture): { unit?: number; notes?: string[] } =>
  isKittiDepth(name) && picture.data instanceof Uint16Array && picture.unit === undefined
    ? { unit: 1 / 256, notes: [...picture.notes, "KITTI's by its name"] }
    : {};
