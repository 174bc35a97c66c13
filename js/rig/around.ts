/**
 * The cameras around a LiDAR, by the names of their pictures: nuScenes' samples/CAM_FRONT/, Argoverse's ring_front_center/, or one
 * picture of each camera beside the scan.
 */
import { base, folderOf, stem } from "./names.js";
import type { NamedCamera, NamedPose } from "./types.js";

/** Cameras that look to a side or back; the one ahead of a vehicle is taken first. */
const ASIDE = /left|right|back|rear|side/i;

/** Parts of a picture's path that may name its camera: folders, and the parts of its name between double underscores. */
export function partsOf(path: string): string[] {
  const folders = folderOf(path).split("/").slice(0, -1);
  return [...folders, ...stem(base(path)).split("__")].filter((part) => part !== "");
}

/** A picture's name without the numbers of its frame. */
const family = (path: string): string =>
  stem(path)
    .replace(/\d+/g, "")
    .replace(/^[\W_]+|[\W_]+$/g, "");

/**
 * The part that names the camera: the innermost part of the paths that differs between pictures and contains a word, or else the file's
 * name.
 */
function cameraIn(path: string): string {
  const parts = partsOf(path);
  const named = parts.filter((part) => /^(?:cam|ring|image)/i.test(part));
  const last = named.at(-1);
  // "cam0_000012" is frame 12 of cam0; folders are numbered by their cameras.
  if (last !== undefined) return last === parts.at(-1) ? last.replace(/[_-]\d+$/, "") : last;
  return family(path) === "" ? (parts.at(-2) ?? "") : family(path);
}

export interface CameraPictures {
  camera: string;
  pictures: string[];
}

/** The pictures of each camera, the camera that looks ahead first. */
export function byCamera(paths: string[]): CameraPictures[] {
  const groups = new Map<string, string[]>();
  for (const path of paths) groups.set(cameraIn(path), [...(groups.get(cameraIn(path)) ?? []), path]);
  return [...groups]
    .map(([camera, pictures]) => ({ camera, pictures }))
    .sort(
      (a, b) =>
        Number(ASIDE.test(a.camera)) - Number(ASIDE.test(b.camera)) ||
        a.camera.localeCompare(b.camera, "en", { numeric: true }),
    );
}

/**
 * Keeps those cameras around a LiDAR whose names occur in the names of the pictures or their folders. The other cameras did not take these
 * pictures. They are left out, and so are their poses relative to the same LiDAR.
 */
export function ofNamedPictures<T extends { cameras: NamedCamera[]; poses: NamedPose[] }>(all: T, paths: string[]): T {
  const parts = new Set(paths.flatMap(partsOf).map((part) => part.toLowerCase()));
  const isOurs = (name = "") => parts.has(name.toLowerCase());
  const ours = all.cameras.filter(({ name }) => isOurs(name));
  if (ours.length === 0) return all;
  const others = new Set(
    all.cameras.flatMap(({ name = "", takes }) => (isOurs(name) || takes === "depth" ? [] : [name])),
  );
  const isReplaced = ({ from = "", to = "" }: NamedPose) =>
    (others.has(to) && all.poses.some((each) => each.from === from && isOurs(each.to))) ||
    (others.has(from) && all.poses.some((each) => each.to === to && isOurs(each.from)));
  return {
    ...all,
    cameras: [
      ...ours.map((each) => ({ ...each, takes: each.takes ?? ("colour" as const) })),
      ...all.cameras.filter(({ name = "" }) => !isOurs(name) && !others.has(name)),
    ],
    poses: all.poses.filter((each) => !isReplaced(each)),
  };
}
