/** What a picture is where nobody said: by its content, and where that would do for several, by its name. */
import { badFile } from "../errors.js";
import { looksLikeDepth, looksLikeLabels, looksLikeMask } from "./colour.js";
import { isGrey } from "./depth.js";
import { decoded } from "./formats/coded.js";
import type { Picture } from "./formats/picture.js";
import { CONTENTS, type Role, isAlongRays, isKittiDepth, roleOf } from "./roles.js";
import type { ReadOptions } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Kind = "colour" | "depth" | "mask";

const isColourful = (picture: Picture): boolean => picture.channels >= 3 && !isGrey(picture);
const isDepthRole = (role: Role | undefined): boolean => role === "depth" || role === "cloud";
type Other = keyof typeof CONTENTS;
const isOther = (role: Role | undefined): role is Other => role !== undefined && Object.hasOwn(CONTENTS, role);

/** Shares of the pixels of a cloud: half of a view lies left of its middle and half above it, and nothing behind. */
const [ASIDE, BEHIND] = [0.1, 0.02];

/** Whether three channels of floats, or four with an intensity, are the points of a cloud rather than colours, which are not below zero. */
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

/** Three or four channels of floats: a cloud, a depth map that a renderer repeated as grey, or colours. */
function kindOfFloats(picture: Picture, role: Role | undefined): Kind {
  const { data, format } = picture;
  if (role === "cloud" || arePoints(picture)) return "depth";
  const isBright = data.some((value) => value > 1 && Number.isFinite(value));
  if (picture.channels === 3 && /^np[yz]$/.test(format)) return isBright || role === "depth" ? "depth" : "colour";
  return picture.channels === 3 && isGrey(picture) && (isBright || role === "depth") ? "depth" : "colour";
}

const refusal = (role: Other) =>
  badFile(
    role === "disparity"
      ? "its name says that it holds disparities or inverse depths, which are no depths: compute z = focal length * baseline / (disparity + doffs) and save that. Give the unit if it holds depths"
      : `its name says that it holds ${CONTENTS[role]}: that is neither a colour image nor a depth map nor a mask. Say what to read it as if it is`,
  );

/** By the content where that is clear, else by the name. */
export function kindOfPicture(name: string, picture: Picture): Kind {
  const role = roleOf(name);
  // A drawn mask may have soft edges.
  if (role !== "confidence" && looksLikeMask(picture)) return "mask";
  if (role === "mask" && picture.bits === 8 && isGrey(picture)) return "mask";
  const isSeveral = picture.data instanceof Float32Array && picture.channels >= 3;
  if (isSeveral && role !== "normals") return kindOfFloats(picture, role);
  if (isColourful(picture)) return isDepthRole(role) && decoded(picture) !== undefined ? "depth" : "colour";
  if (isDepthRole(role)) return "depth";
  if (role === "colour" || role === "infrared" || role === "rendering") return "colour";
  if (isOther(role)) throw refusal(role);
  if (picture.format === "COLMAP" || picture.format === "table" || picture.format === "raw") return "depth";
  if (looksLikeLabels(picture))
    throw badFile(
      "its few, small whole numbers are labels of objects rather than depths. Say what to read it as if it is a depth map",
    );
  return looksLikeDepth(picture) ? "depth" : "colour";
}

/** What a name says against what the file is read as; a disparity map is never taken for depths unless the unit is given. */
export function nameWarnings(name: string, picture: Picture, kind: string, { unit }: ReadOptions): ReaderWarning[] {
  const role = roleOf(name);
  if (kind === "depth" && isOther(role)) {
    if (role === "disparity" && unit === undefined) throw refusal(role);
    return [warning("files-swapped", `Its name says that it holds ${CONTENTS[role]}, and it is read as a depth map.`)];
  }
  if (kind === "depth" && isAlongRays(name))
    return [
      warning(
        "files-swapped",
        "Its name says that it holds distances along the rays, which are longer than depths (along z) beside the middle of the picture: divide each by the length of its ray at z = 1.",
      ),
    ];
  if (kind === "colour" && role === "depth" && isColourful(picture))
    return [
      warning(
        "files-swapped",
        "Its name says depth, but it is a coloured picture: a rendering of the depth (a colour map), or depths coded in a way that is not known here? It is read as a colour image.",
      ),
    ];
  return [];
}

/** The unit that a file's name gives away. */
export const unitOfName = (name: string, picture: Picture): { unit?: number; notes?: string[] } =>
  isKittiDepth(name) && picture.data instanceof Uint16Array && picture.unit === undefined
    ? { unit: 1 / 256, notes: [...picture.notes, "by its name KITTI's"] }
    : {};
