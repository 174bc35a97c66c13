/**
 * Finds the pictures of a folder that belong to one frame: by similar names, by file names that are time stamps, or by their order.
 *
 * The role of a picture follows from its name and those of its folders (roles.ts). Pictures that are neither colour images nor depth maps
 * nor masks (confidences, labels, normals, renderings) belong to no frame. Infrared images are used if there are no colour images.
 */
import { badFile } from "../errors.js";
import { rasterKind } from "./formats/headerless.js";
import { byCamera } from "./around.js";
import { APART, type Pair, type Pairs, byTime } from "./lists.js";
import { commonPath, folderOf, key, looseKey, stem, timeOf } from "./names.js";
import { CONTENTS, type Other, type Role, roleOf } from "./roles.js";
import { type Times, halfFrame, timesOf } from "./stamps.js";
import type { NamedFile } from "./types.js";
import { type ReaderWarning, ofFile, warning } from "./warnings.js";

interface Sorted {
  colours: NamedFile[];
  depths: NamedFile[];
  masks: NamedFile[];
}

const CLOUDS = new Set(["ply", "pcd", "points"]);
/** Files that are depth maps although their names do not say so. */
const MAPS = new Set(["colmap", "table"]);
const isCloud = ({ bytes }: NamedFile): boolean => CLOUDS.has(rasterKind(bytes) ?? "");

/** The folders that all pictures share, which distinguish none of them: "lidar_nuscenes/CAM_FRONT.jpg" is not a scan. */
function rootOf(pictures: NamedFile[]): string {
  const [first = "", ...others] = pictures.map(({ name }) => folderOf(name));
  if (others.length === 0) return "";
  const parts = first.split("/").slice(0, -1);
  const same = parts.findIndex(
    (_, at) => !others.every((path) => path.startsWith(`${parts.slice(0, at + 1).join("/")}/`)),
  );
  return parts
    .slice(0, same < 0 ? parts.length : same)
    .map((part) => `${part}/`)
    .join("");
}

function roleIn(file: NamedFile, root: string): Role | "unknown" {
  const role = roleOf(file.name.slice(root.length));
  if (role !== undefined && role !== "colour") return role;
  if (isCloud(file)) return "cloud";
  return MAPS.has(rasterKind(file.bytes) ?? "") ? "depth" : (role ?? "unknown");
}

/** Classifies pictures by content, with a warning for those that no frame needs. */
function sorted(pictures: NamedFile[], warnings: ReaderWarning[]): Sorted {
  const roles = new Map<Role | "unknown", NamedFile[]>();
  const root = rootOf(pictures);
  for (const file of pictures) {
    const role = roleIn(file, root);
    roles.set(role, [...(roles.get(role) ?? []), file]);
  }
  const of = (role: Role | "unknown") => roles.get(role) ?? [];
  const named = [...of("colour"), ...of("unknown")];
  const depths = [...of("depth"), ...of("cloud")];
  const colours = named.length > 0 ? named : of("infrared");
  for (const role of Object.keys(CONTENTS) as Other[]) {
    const [first, ...others] = role === "infrared" && named.length === 0 ? [] : of(role);
    if (first === undefined) continue;
    const more = others.length > 0 ? ` (and ${others.length} more like it)` : "";
    const advice =
      role === "disparity"
        ? ", which are not depths: compute z = focal length * baseline / (disparity + doffs) and save that"
        : "";
    const message = `its name says that it holds ${CONTENTS[role]}${advice}; it was left out.${more}`;
    warnings.push(ofFile(first.name, warning("file-left-out", message)));
  }
  return { colours, depths, masks: of("mask") };
}

function byKey(files: NamedFile[], keyOf: (name: string) => string): Map<string, NamedFile[]> {
  const groups = new Map<string, NamedFile[]>();
  for (const file of files) {
    const group = groups.get(keyOf(file.name));
    if (group) group.push(file);
    else groups.set(keyOf(file.name), [file]);
  }
  return groups;
}

/** The number at the end of a folder's name: cameras are numbered in their folders. */
const numberOfFolder = (name: string): string | undefined => /(\d+)\/$/.exec(folderOf(name))?.[1];
const isSecond = (name: string): boolean => /right|(?:^|[^a-z])r(?:[^a-z]|$)/i.test(name);
/** The number of folders that two names share. */
function shared(one: string, other: string): number {
  const [ours, theirs] = [one.split("/"), other.split("/")];
  const at = ours.findIndex((part, index) => part !== theirs[index]);
  return at < 0 ? ours.length : at;
}

/** Selects the colour images that belong to the depth map from a frame's images in several folders, by role, number and side. */
function nearest(depth: NamedFile, colours: NamedFile[]): NamedFile[] {
  const lowest = Math.min(...colours.map(({ name }) => Number(numberOfFolder(name) ?? Infinity)));
  const rules = [
    (file: NamedFile) => commonPath(file.name) === commonPath(depth.name),
    (file: NamedFile) => roleOf(file.name) === "colour",
    (file: NamedFile) => numberOfFolder(file.name) === numberOfFolder(depth.name),
    (file: NamedFile) => !isSecond(file.name),
    (file: NamedFile) => Number(numberOfFolder(file.name) ?? Infinity) === lowest,
  ];
  // In one folder, names that differ only in punctuation are equivalent.
  const folders = new Set(colours.map(({ name }) => folderOf(name)));
  return rules.slice(0, folders.size > 1 ? rules.length : 1).reduce((left, rule) => {
    const kept = left.filter(rule);
    return left.length > 1 && kept.length > 0 ? kept : left;
  }, colours);
}

/** Selects the colour images of this depth map, by folder, if several depth maps have the same name. */
function ownOf(depth: NamedFile, others: NamedFile[], colours: NamedFile[]): NamedFile[] {
  if (others.length === 0) return colours;
  const like = colours.filter(({ name }) => commonPath(name) === commonPath(depth.name));
  if (like.length > 0) return like;
  const near = colours.filter(({ name }) =>
    others.every((other) => shared(name, depth.name) > shared(name, other.name)),
  );
  if (near.length > 0) return near;
  // cam0, cam1 and depth0, depth1.
  const own = numberOfFolder(depth.name);
  const isOwn = own !== undefined && others.every(({ name }) => numberOfFolder(name) !== own);
  return isOwn ? colours.filter(({ name }) => numberOfFolder(name) === own) : [];
}

/** Words in names of depth maps that were computed from others, or are poorer than others. */
const SECONDARY =
  /(?<![a-z])(?:raw|velodyne|sparse|noisy|aligned|registered|transformed|filtered|filled|inpainted|completed?|pred|predicted|estimated|mono)(?![a-z])/i;

/** Of several depth maps of a frame in sibling folders, keeps only the plain one, if there is one. */
function plainOf(groups: NamedFile[][], warnings: ReaderWarning[]): NamedFile[][] {
  const parents = new Set(groups.map(([file]) => folderOf(folderOf(file?.name ?? "").slice(0, -1))));
  const length = ([file]: NamedFile[]) => file?.name.length ?? 0;
  const plain = groups.filter(([file]) => !SECONDARY.test((file?.name ?? "").replaceAll("_", " ")));
  const shortest = Math.min(...plain.map(length));
  // "depth" beside "depth_bfx".
  const [only, ...more] = plain.filter((group) => length(group) === shortest);
  if (groups.length === 1 || parents.size > 1 || only === undefined || more.length > 0) return groups;
  for (const [file] of groups)
    if (file && file !== only[0])
      warnings.push(
        ofFile(
          file.name,
          warning("names-ambiguous", `another depth map, ${only[0]?.name}, has the same name; it was left out.`),
        ),
      );
  return [only];
}

/** A depth map that was saved in several formats counts once; depth maps come before clouds. */
function alternatives(depths: NamedFile[]): NamedFile[][] {
  const groups = new Map<string, NamedFile[]>();
  const maps = depths.filter((file) => !isCloud(file));
  for (const file of maps.length > 0 ? maps : depths) {
    const path = folderOf(file.name) + stem(file.name);
    groups.set(path, [...(groups.get(path) ?? []), file]);
  }
  return [...groups.values()];
}

/** Depth maps that belong to other groups. */
const firstsOf = (groups: NamedFile[][], own: NamedFile): NamedFile[] =>
  groups.flatMap(([first]) => (first && first !== own ? [first] : []));

/** Files that match by their names; `others` match none or several. */
function byNames({ colours, depths, masks }: Sorted, warnings: ReaderWarning[], keyOf = key): Pair[] {
  const maskOf = (name: string, { name: path }: NamedFile) => {
    const like = masks.filter((mask) => keyOf(mask.name) === name);
    const near = (mask: NamedFile) => shared(mask.name, path);
    const [first] = like.sort((a, b) => near(b) - near(a));
    return first ?? (masks.length === 1 && key(masks[0]?.name ?? "") === "" ? masks[0] : undefined);
  };
  const likeColours = byKey(colours, keyOf);
  /** Files that already have a warning. */
  const said = new Set<string>();
  const pairs = [...byKey(depths, keyOf)].flatMap(([name, likeDepths]) => {
    const theirs = likeColours.get(name) ?? [];
    const all = alternatives(likeDepths);
    const isOwn = ([depth]: NamedFile[]) => depth && ownOf(depth, firstsOf(all, depth), theirs).length > 0;
    const groups = theirs.length === 0 || all.every(isOwn) ? all : plainOf(all, warnings);
    for (const each of likeDepths) if (!groups.flat().includes(each)) said.add(each.name);
    return groups.flatMap(([depth, ...more]): Pair[] => {
      if (depth === undefined) return [];
      const [colour, ...others] = nearest(depth, ownOf(depth, firstsOf(groups, depth), theirs));
      if (colour && others.length === 0) {
        for (const { name } of [depth, ...more, colour]) said.add(name);
        const mask = maskOf(name, colour);
        return [{ name, colour, depths: [depth, ...more], ...(mask && { mask }) }];
      }
      if (theirs.length > 0) {
        warnings.push(
          ofFile(depth.name, warning("names-ambiguous", "several files have names like this one; it was left out.")),
        );
        for (const { name } of [depth, ...theirs]) said.add(name);
      }
      return [];
    });
  });
  if (pairs.length > 0)
    for (const { name } of [...depths, ...colours])
      if (!said.has(name))
        warnings.push(
          ofFile(name, warning("file-alone", "its name matches no other file or more than one; it was left out.")),
        );
  return pairs;
}

/** Factor by which the frames of a pair must be nearer in time to each other than to other frames. */
const CLEARLY = 4;

/** Largest difference in time between the two frames of a pair. */
function apartOf({ colours, depths }: Times): number {
  const order = [...depths].sort((a, b) => a - b);
  const gaps = order.slice(1).map((time, at) => time - (order[at] ?? NaN));
  const apart = Math.max(APART, Math.min(...gaps.filter((gap) => gap > 0)) / CLEARLY);
  return Math.min(Number.isFinite(apart) ? apart : APART, halfFrame(colours, depths));
}

/** Pairs files by time stamps in their names, which are seldom equal for two cameras; returns nothing for names without a time. */
function byStamps({ colours, depths }: Sorted, warnings: ReaderWarning[]): Pairs | undefined {
  const fewer = Math.min(colours.length, depths.length);
  // A single image and a single depth map belong together, whatever their names.
  if (fewer === 0 || colours.length + depths.length === 2) return undefined;
  const namesOf = (files: NamedFile[]) => files.map(({ name }) => name);
  const times = timesOf(namesOf(colours), namesOf(depths));
  if (times === undefined) return undefined;
  const stamps = (files: NamedFile[], of: number[]) =>
    files.map(({ name }, at) => ({ time: of[at] ?? NaN, path: name }));
  const [ours, theirs] = [stamps(colours, times.colours), stamps(depths, times.depths)];
  const apart = apartOf(times);
  const found = byTime(ours, theirs, apart);
  // If the names also have a counter, stamps are used only if most of them agree.
  if (!times.isAlone && 2 * found.length <= fewer) return undefined;
  if (found.length === 0)
    throw badFile(
      `no pair of a colour image and a depth map was found: the time stamps of their names are more than ${(1000 * apart).toFixed(0)} ms apart`,
    );
  const file = new Map([...colours, ...depths].map((each) => [each.name, each]));
  const timeAt = new Map(theirs.map(({ path, time }) => [path, time]));
  const most = Math.max(...found.map(([, depth, time]) => Math.abs((timeAt.get(depth) ?? time) - time)));
  if (most > APART)
    warnings.push(
      warning(
        "pairs-by-order",
        `The frames were paired by the time stamps of their names, which are up to ${(1000 * most).toFixed(0)} ms apart: nothing may have moved in that time.`,
        { pairs: found.length },
      ),
    );
  const used = new Set(found.flat());
  for (const { name } of [...depths, ...colours])
    if (!used.has(name))
      warnings.push(
        ofFile(name, warning("file-alone", "no other file has a time stamp near this one; it was left out.")),
      );
  const pairs = found.flatMap(([one, other]): Pair[] => {
    const [colour, depth] = [file.get(one), file.get(other)];
    return colour && depth ? [{ name: key(one), colour, depths: [depth] }] : [];
  });
  return { pairs, says: `${pairs.length} pairs by their time stamps` };
}

const inOrder = (files: NamedFile[]): NamedFile[] =>
  [...files].sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));

/** If all names differ, files are paired by their order. */
function byOrder({ colours, depths }: Sorted, warnings: ReaderWarning[]): Pairs {
  if (depths.length === 0 || depths.length !== colours.length) return { pairs: [], says: "" };
  if (depths.length > 1)
    warnings.push(
      warning(
        "pairs-by-order",
        `No depth map has a name like a colour image's. The ${depths.length} images and depth maps were paired in the order of their names.`,
        { pairs: depths.length },
      ),
    );
  const ordered = inOrder(colours);
  const pairs = inOrder(depths).flatMap((depth, index): Pair[] =>
    ordered[index] ? [{ name: key(depth.name), colour: ordered[index], depths: [depth] }] : [],
  );
  return { pairs, says: `${depths.length} pairs in their order` };
}

/** The first and last of files numbered one by one; undefined for other names. */
function numbered(files: readonly NamedFile[]): { first: number; last: number } | undefined {
  const numbers = [...new Set(files.map(({ name }) => key(name)))];
  if (!numbers.every((each) => /^\d{1,9}$/.test(each))) return undefined;
  const [first, last] = [Math.min(...numbers.map(Number)), Math.max(...numbers.map(Number))];
  return last - first === files.length - 1 ? { first, last } : undefined;
}

/** As many images as depth maps, numbered from different starts, may belong together in their order. */
function doubtNumbers({ colours, depths }: Sorted, warnings: ReaderWarning[]): void {
  const [ours, theirs] = [numbered(colours), numbered(depths)];
  if (colours.length !== depths.length || ours === undefined || theirs === undefined) return;
  if (ours.first !== theirs.first)
    warnings.push(
      warning(
        "pairs-shifted",
        `The colour images are numbered from ${ours.first} to ${ours.last} and as many depth maps from ${theirs.first} to ${theirs.last}. Those of one number were paired, but they may belong together in their order; number both from the same start.`,
        { colour: ours.first, depth: theirs.first },
      ),
    );
}

function attempt(found: Sorted, warnings: ReaderWarning[]): Pairs {
  const same = new Set(found.colours.map(({ name }) => key(name)));
  const isSame = found.depths.length > 0 && found.depths.every(({ name }) => same.has(key(name)));
  const stamped = isSame ? undefined : byStamps(found, warnings);
  if (stamped !== undefined) return stamped;
  const own: ReaderWarning[] = [];
  const strict = byNames(found, own);
  // The looser comparison ignores some words, so it cannot help if the names are ambiguous already.
  const pairs = strict.length > 0 || own.length > 0 ? strict : byNames(found, own, looseKey);
  warnings.push(...own);
  if (pairs.length > 0) doubtNumbers(found, warnings);
  return pairs.length > 0 ? { pairs, says: `${pairs.length} pairs by their names` } : byOrder(found, warnings);
}

/** The pairs of one of several cameras around a LiDAR, because a pose cannot be checked with the pictures of other cameras. */
function ofOneCamera(found: Sorted, warnings: ReaderWarning[]): Pairs | undefined {
  if (found.depths.length === 0 || !found.depths.every(isCloud)) return undefined;
  const cameras = byCamera(found.colours.map(({ name }) => name));
  const [ours] = cameras;
  if (cameras.length < 2 || ours === undefined) return undefined;
  const names = new Set(ours.pictures);
  const own: ReaderWarning[] = [];
  const pairs = attempt({ ...found, colours: found.colours.filter(({ name }) => names.has(name)) }, own);
  if (pairs.pairs.length === 0) return undefined;
  const message = `it shows another camera's view and was left out: only one camera can be checked against the LiDAR at a time, and ${ours.camera} was chosen. To check this one, give its pictures and the scans, without the pictures of ${ours.camera}.`;
  const others = found.colours.filter(({ name }) => !names.has(name));
  warnings.push(...own, ...others.map(({ name }) => ofFile(name, warning("file-left-out", message))));
  return pairs;
}

/** For a folder in which no picture has a partner: adds a warning with the reason to each picture that has none yet. */
export function sayUnpaired(pictures: NamedFile[], warnings: ReaderWarning[]): void {
  const { colours, depths } = sorted(pictures, []);
  if (colours.length + depths.length < 2) return;
  const said = new Set(warnings.map(({ file }) => file));
  const count = (files: NamedFile[], one: string, more: string) => `${files.length} ${files.length === 1 ? one : more}`;
  const message = `it was left out, because ${count(colours, "colour image", "colour images")} and ${count(depths, "depth map or scan", "depth maps or scans")} have no names or time stamps in common. Give both files of a frame the same name.`;
  for (const { name } of [...colours, ...depths])
    if (!said.has(name)) warnings.push(ofFile(name, warning("file-alone", message)));
}

export function pairsOf(pictures: NamedFile[], warnings: ReaderWarning[]): Pairs {
  const found = sorted(pictures, warnings);
  // Sorted only by time, pictures of different cameras would alternate.
  const areStamped = [...found.colours, ...found.depths].every(({ name }) => timeOf(name) !== undefined);
  const single = areStamped ? ofOneCamera(found, warnings) : undefined;
  if (single !== undefined) return single;
  const own: ReaderWarning[] = [];
  const pairs = attempt(found, own);
  const later = pairs.pairs.length === 0 ? ofOneCamera(found, warnings) : undefined;
  if (later !== undefined) return later;
  warnings.push(...own);
  return pairs;
}
