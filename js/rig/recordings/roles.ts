/**
 * Which topics hold the images of the colour camera and of the depth camera, judged by encoding, name, and whether there are intrinsics.
 *
 * A depth image in its own pixels is preferred to one that was registered to the colour image, because the registration used the
 * calibration to be checked.
 */
import { isCompressedDepth } from "./compressed.js";
import { baseOf } from "./infos.js";
import { isColoured, mayBeDepth } from "./pixels.js";
import type { Shot } from "./source.js";

/** The topics of the two cameras. */
export interface Choice {
  /** The topic of the colour images. */
  colour?: string;
  /** The topic of the depth maps or clouds. */
  depth?: string;
}

const DEPTH_NAME = /depth|dpt|range(?![a-z])|stereo\/image/i;
const OTHER_NAME =
  /infra|(?:^|[/_])ir(?:[/_\d]|$)|confidence|amplitude|disparity|intensity|mask|segment|fisheye|thermal|label/i;
const COLOUR_NAME = /colou?r|rgb/i;
const REGISTERED = /aligned|registered|_to_colou?r|_to_rgb|hw_registered|sw_registered/i;

/** Organised clouds and scans. */
const isCloud = ({ encoding }: Pick<Shot, "encoding">): boolean => encoding === "points" || encoding === "scan";

/** Whether a shot's pixels can be depths. */
export function isDepth({ track, encoding }: Shot): boolean {
  if (isCloud({ encoding })) return true;
  if (isCompressedDepth(encoding)) return true;
  if (OTHER_NAME.test(track) || !mayBeDepth(encoding)) return encoding === "png" && DEPTH_NAME.test(track);
  // 16-bit grey may also be an infrared picture.
  return encoding.toLowerCase() !== "mono16" || DEPTH_NAME.test(track);
}

export const isColour = (shot: Shot): boolean => !isDepth(shot) && !mayBeDepth(shot.encoding);

/** The number of leading path segments that two topics share. */
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
  // Images without lossy compression are preferred, because it softens edges.
  (isColoured(shot.encoding) ? 0 : 0.5);

const depthScore = (shot: Shot): number =>
  (isCloud(shot) ? 0 : 4) +
  (DEPTH_NAME.test(shot.track) ? 2 : 0) -
  (REGISTERED.test(shot.track) ? 3 : 0) -
  (isCompressedDepth(shot.encoding) ? 0.5 : 0);

/** The best pair, given one shot of each topic; `known` tells whether there are intrinsics for a topic. */
export function rolesOf(shots: readonly Shot[], known: (track: string) => boolean): Choice {
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
