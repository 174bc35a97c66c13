/**
 * Which topics are the colour camera's and the depth camera's: by their encodings, their names, and by whether intrinsics are beside them.
 *
 * A depth image in its own pixels is taken before one that was registered to the colour image: registering used the calibration in question.
 */
import { isCompressedDepth } from "./compressed.js";
import { baseOf } from "./infos.js";
import { isColoured, mayBeDepth } from "./pixels.js";
import type { Shot } from "./source.js";

export interface Roles {
  colour?: string;
  depth?: string;
}

const DEPTH_NAME = /depth|dpt|range(?![a-z])|stereo\/image/i;
const OTHER_NAME =
  /infra|(?:^|[/_])ir(?:[/_\d]|$)|confidence|amplitude|disparity|intensity|mask|segment|fisheye|thermal|label/i;
const COLOUR_NAME = /colou?r|rgb/i;
const REGISTERED = /aligned|registered|_to_colou?r|_to_rgb|hw_registered|sw_registered/i;

/** Clouds with rows and columns, and scans without. */
const isCloud = ({ encoding }: Pick<Shot, "encoding">): boolean => encoding === "points" || encoding === "scan";

/** Whether a shot's pixels can be depths. */
export function isDepth({ track, encoding }: Shot): boolean {
  if (isCloud({ encoding })) return true;
  if (isCompressedDepth(encoding)) return true;
  if (OTHER_NAME.test(track) || !mayBeDepth(encoding)) return encoding === "png" && DEPTH_NAME.test(track);
  // 16 bits of grey alone may be an infrared picture.
  return encoding.toLowerCase() !== "mono16" || DEPTH_NAME.test(track);
}

export const isColour = (shot: Shot): boolean => !isDepth(shot) && !mayBeDepth(shot.encoding);

/** How much two names have in common from their beginning, in steps. */
function shared(a: string, b: string): number {
  const [x, y] = [baseOf(a).split("/"), baseOf(b).split("/")];
  let count = 0;
  while (count < Math.min(x.length, y.length) && x[count] === y[count]) count++;
  return count;
}

const colourScore = (shot: Shot): number =>
  (isColoured(shot.encoding) || /^(?:jpe?g|png|webp)$/.test(shot.encoding) ? 4 : 0) +
  (COLOUR_NAME.test(shot.track) ? 4 : 0) -
  (OTHER_NAME.test(shot.track) || DEPTH_NAME.test(shot.track) ? 8 : 0) -
  // What was compressed has lost edges.
  (isColoured(shot.encoding) ? 0 : 0.5);

const depthScore = (shot: Shot): number =>
  (isCloud(shot) ? 0 : 4) +
  (DEPTH_NAME.test(shot.track) ? 2 : 0) -
  (REGISTERED.test(shot.track) ? 3 : 0) -
  (isCompressedDepth(shot.encoding) ? 0.5 : 0);

/** The best pair among one shot of each topic; `known` says whether intrinsics are there for a topic. */
export function rolesOf(shots: readonly Shot[], known: (track: string) => boolean): Roles {
  const colours = shots.filter(isColour);
  const depths = shots.filter(isDepth);
  const pairs = colours.flatMap((colour) =>
    depths.map((depth) => ({
      colour,
      depth,
      score:
        colourScore(colour) +
        depthScore(depth) +
        shared(colour.track, depth.track) +
        (known(colour.track) ? 2 : 0) +
        (isCloud(depth) || known(depth.track) ? 2 : 0),
    })),
  );
  const [best] = pairs.sort((a, b) => b.score - a.score);
  if (best) return { colour: best.colour.track, depth: best.depth.track };
  const [colour] = [...colours].sort((a, b) => colourScore(b) - colourScore(a));
  const [depth] = [...depths].sort((a, b) => depthScore(b) - depthScore(a));
  return { ...(colour && { colour: colour.track }), ...(depth && { depth: depth.track }) };
}
