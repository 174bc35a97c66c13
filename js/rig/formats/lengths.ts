/**
 * Units of translations: the unit that a file's comments state, and a warning if a translation is longer than the usual distance of a
 * rig's cameras.
 *
 * Limit: rigs whose cameras are farther apart have to state the unit.
 */
import type { NamedPose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { isLidar } from "./frames.js";
import { lengthOf } from "./names.js";
import { degreesOf } from "./poses.js";

/** Longest translations without a warning, metres: between cameras, and between a LiDAR and a camera. */
const [CAMERAS, LIDARS] = [1, 3];
/** Cameras of a rig look in nearly the same direction; axes of a LiDAR are rotated against a camera's by 120 degrees. */
const PARALLEL = 60;
/** Frames of vehicles, robots and boards, in which sensors may be far away. */
const FAR = /imu|body|base|vehicle|ego|car\b|robot|world|map|odom|hand|gripper|flange|tool|board|target|reference|gps/i;
/** Largest number of comments that are examined. */
const MOST = 200;

const COMMENT = /(?:^|[\s,;{])(?:#|\/\/|%|;|\/\*)([^\n]{1,200})/gm;
const SUBJECT = /\b(?:translations?|units?|t|tvec|positions?|lengths?|baselines?|distances?|extrinsics?|poses?|all)\b/i;
/** Comments about lengths other than translations. */
const OTHERS = /depth|focal|pixel|sensor|board|square|tag|marker|pattern|rotation only/i;
const UNIT =
  /(?:\b(?:in|are|is|unit|units|as)|[:=([])\s*\[?\(?\s*(mm|cm|dm|m|inch(?:es)?|(?:milli|centi|deci)?met(?:er|re)s?)\b/i;

/** Metres per unit of the translations, where the comments of a text state one unit. */
export function unitInComments(text: string): number | undefined {
  const units = new Set<number>();
  let count = 0;
  for (const [, comment = ""] of text.matchAll(COMMENT)) {
    if (++count > MOST) break;
    const unit = SUBJECT.test(comment) && !OTHERS.test(comment) ? lengthOf(UNIT.exec(comment)?.[1] ?? "") : undefined;
    if (unit !== undefined) units.add(unit);
  }
  const [only, ...more] = units;
  return more.length === 0 ? only : undefined;
}

const says = (length: number, unit: number): string => `${Number((1000 * length * unit).toPrecision(3))} mm`;

/** Adds a warning if a translation without a unit is longer than the usual distance of a rig's sensors. */
export function checkLength({ name, from = "", to = "", pose }: NamedPose, warnings: ReaderWarning[]): void {
  const frames = `${from} ${to} ${name ?? ""}`;
  if (FAR.test(frames)) return;
  const length = Math.hypot(...pose.translation);
  const ofLidar = [from, to, name ?? ""].some(isLidar) || /lidar|velo|livox|radar/i.test(frames);
  if (!(length > (ofLidar || degreesOf(pose.rotation) > PARALLEL ? LIDARS : CAMERAS))) return;
  warnings.push(
    warning(
      "translation-unit-guessed",
      `The translation${name === undefined || name === "" ? "" : ` of "${name}"`} was read in metres, as the file does not state its unit; its length of ${length.toPrecision(4)} m is long for a rig. It would be ${says(length, 0.001)} if the numbers are millimetres, and ${says(length, 0.01)} if they are centimetres. Write the unit into the file, as "unit": "cm".`,
      { length },
    ),
  );
}
