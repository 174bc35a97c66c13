/**
 * The content of a picture according to its file name and the folders around it, the innermost first.
 *
 * Limits: only English names and those of common tools are known; for other names the content decides.
 */

/** "rendering": a picture for people, such as colour-mapped depths. "view": the second of two cameras of the same kind. */
export type Role =
  | "colour"
  | "depth"
  | "cloud"
  | "mask"
  | "infrared"
  | "disparity"
  | "confidence"
  | "normals"
  | "labels"
  | "radar"
  | "rendering";

/** Only whole words count: "displayed" is not a disparity, and "undistorted" is not a distance. */
const whole = (words: string): RegExp => new RegExp(`(?<![a-z])(?:${words})(?![a-z])`);

/** Contents of pictures other than colours and depths; these words have priority over "depth" and "colour" in the same name. */
const SPECIAL: [Role, RegExp][] = [
  ["mask", /mask|segm/],
  ["confidence", whole("conf|confs|conf ?maps?|confidences?|confidence ?maps?|certainty|uncertainty|uncertainties")],
  ["labels", whole("semantics?|labels?|instances?|panoptic|seg|annotations?|annos?")],
  ["normals", whole("normals?|normal ?maps?")],
  [
    "rendering",
    whole(
      "vis|viz|visuals?|visuali[sz]ations?|colou?red|colou?ri[sz]ed|colou?r ?maps?|overlays?|previews?|thumbs?|thumbnails?|debug|heat ?maps?",
    ),
  ],
  ["radar", whole("radars?")],
  ["disparity", whole("disps?|disparity|disparities|disparity ?maps?|inv(?:erse)? ?depths?|idepths?")],
  [
    "infrared",
    whole(
      "ir|irs|nir|infra|infrared|infrareds|amplitudes?|intensity|intensities|reflectance|reflectivity|active ?brightness",
    ),
  ],
];
/** Colour images that were projected into the depth camera's view still have the word "depth" in their name. */
const COLOUR_IN_DEPTH =
  /(?:colou?r|rgb|image)[^a-z]*(?:aligned|registered|transformed|warped|mapped)?[^a-z]*(?:to|2|in|into)[^a-z]*depth/;
const DEPTH = /depth|dpt|(?<![a-z])(?:ranges?|distances?|tof|z ?maps?|z16)(?![a-z])/;
const CLOUD = whole("velodyne|velodyne ?points|lidars?|clouds?|point ?clouds?|points|pcds?|lasers?|scans?");
const COLOUR = whole("colou?rs?|rgbs?");
/** Words that, in names of folders, mean colour images, but in names of files mean any kind. */
const PICTURES = whole("images?|imgs?|photos?|pictures?|frames?");

/** The name in lower case, with spaces between words that only capitals separate. */
const plain = (segment: string): string =>
  segment
    .replace(/\.[a-z0-9]{1,5}$/i, "")
    .replace(/([a-z])([A-Z])/g, "$1 $2")
    .toLowerCase()
    .replace(/[_-]+/g, " ");

/** "depth_from_disparity" holds depths. */
const DEPTH_OF_DISPARITY = /depth[^a-z]*(?:from|of|by)|to[^a-z]*depth/;

const special = (segment: string): Role | undefined =>
  SPECIAL.find(
    ([role, pattern]) => pattern.test(segment) && !(role === "disparity" && DEPTH_OF_DISPARITY.test(segment)),
  )?.[0];

function common(segment: string): Role | undefined {
  if (COLOUR_IN_DEPTH.test(segment)) return "colour";
  if (DEPTH.test(segment)) return "depth";
  if (COLOUR.test(segment)) return "colour";
  return CLOUD.test(segment) ? "cloud" : undefined;
}

/** KITTI's depth maps are in folders that are named after those of its images. No file states their 256 units per metre. */
export const isKittiDepth = (name: string): boolean =>
  /(?<![a-z])(?:proj_depth|velodyne_raw|groundtruth_depth)(?![a-z])/i.test(name);

/** The content that a file's name states; undefined if it states none. */
export function roleOf(name: string): Role | undefined {
  if (isKittiDepth(name)) return "depth";
  const [own = "", folder = "", ...outer] = name.split("/").map(plain).reverse();
  const clear = special(own) ?? special(folder) ?? common(own);
  if (clear !== undefined) return clear;
  for (const segment of [folder, ...outer]) {
    const found = common(segment) ?? (PICTURES.test(segment) ? "colour" : undefined);
    if (found !== undefined) return found;
  }
  return PICTURES.test(own) ? "colour" : undefined;
}

/** Files that are neither colour images nor depth maps nor masks. */
export type Other = Exclude<Role, "colour" | "depth" | "cloud" | "mask">;

/** The message about such a file. */
export const CONTENTS: Record<Other, string> = {
  confidence: "confidences",
  labels: "labels of objects",
  normals: "normals",
  rendering: "a rendering for people",
  disparity: "disparities (or inverse depths)",
  radar: "a radar's points, which are too few and too coarse",
  infrared: "infrared or intensities",
};

export const isOther = (role: Role | undefined): role is Other => role !== undefined && Object.hasOwn(CONTENTS, role);

/** Whether a name says that distances were measured along the rays rather than along z. */
export const isAlongRays = (name: string): boolean =>
  /euclid|distances? to (?:the )?camera|(?<![a-z])(?:ray|radial) ?(?:depths?|distances?)/.test(
    name.split("/").slice(-2).map(plain).join(" "),
  );

const ALIGNED = /(?<![a-z])(?:aligned|registered|transformed)(?![a-z])/;
const DEPTH_IN_COLOUR = /depth[^a-z]*(?:to|2|in|into)[^a-z]*(?:colou?r|rgb)/;

/** Whether a depth map's name, or its folder's, says that it was projected into the colour camera's view. */
export function isAligned(name: string): boolean {
  const near = name.split("/").slice(-2).map(plain);
  const isOther = near.some((each) => /un ?(?:aligned|registered)/.test(each));
  return roleOf(name) === "depth" && !isOther && near.some((each) => ALIGNED.test(each) || DEPTH_IN_COLOUR.test(each));
}
