/** ROS's static transforms on a command line, in a launch file or in a script. */
import { badFile } from "../../errors.js";
import type { NamedPose } from "../types.js";
import { type Numbers, numberOf } from "./numbers.js";
import { motion, ofQuaternion, ofYawPitchRoll } from "./poses.js";
import type { Calibration } from "./tree.js";
import { type ReaderWarning, warning } from "../warnings.js";

const NAME = "static_transform_publisher";
/** Characters after the name that may contain its arguments. */
const REACH = 2000;
const MOST = 1000;

export const isPublisher = (text: string): boolean => text.includes(NAME);

/** A text without the comments of XML, and of shells, Python and YAML. */
function withoutComments(text: string): string {
  if (text.trimStart().startsWith("<")) return text.replace(/<!--[^]*?(?:-->|$)/g, "");
  return text.replace(/^[ \t]*#.*$/gm, "").replace(/[ \t]#[^"'\n]*$/gm, "");
}

/** The arguments behind each mention, up to the end of its element or the next mention. */
function mentions(text: string): string[] {
  const pieces = text.split(NAME).slice(1);
  if (pieces.length > MOST) throw badFile(`it holds more than ${MOST} static transforms`);
  return pieces.map((piece) => {
    const inside =
      piece
        .slice(0, REACH)
        .replace(/\\\r?\n/g, " ")
        .split(/\/>|<\/node>|<node|\bNode\s*\(/)[0] ?? "";
    return (
      /\bargs\s*=\s*"([^"]*)"/.exec(inside)?.[1] ??
      /\barguments\s*=\s*\[([^\]]*)\]/.exec(inside)?.[1] ??
      /\barguments\s*=\s*(["'])([^"']*)\1\s*\.split\b/.exec(inside)?.[2] ??
      // The rest of the list that contains the name, such as ExecuteProcess's cmd.
      /^["']\s*,([^\]]*)\]/.exec(inside)?.[1] ??
      inside.split(/\r?\n/).find((line) => /\d/.test(line)) ??
      ""
    );
  });
}

/** Conditions of nodes and groups, in XML and in launch files in Python. */
const CONDITION = /<(?:node|group|include)\b[^<>]*?\s(?:if|unless)\s*=|\b(?:IfCondition|UnlessCondition)\s*\(/;
/** Arguments that ROS computes when it starts the file. */
const COMPUTED = /\$\([^)]{0,80}\)?|\$\{?\w{1,40}\}?|\b(?:LaunchConfiguration|math\.\w+|str|float)\b/;
/** A flag that takes a number, followed by a computed argument. */
const COMPUTED_FLAG = new RegExp(`--(?:x|y|z|roll|pitch|yaw|q[xyzw])[\\s'",=]+(${COMPUTED.source})`);
const words = (text: string): string[] => text.split(/[\s,'"[\]()=]+/).filter((part) => part !== "");

/** The words of an argument list whose numbers are literal. In names of frames, "$(arg robot)" is kept as it is. */
function written(args: string): string[] {
  const all = words(args);
  const isFlags = all.some((word) => word.startsWith("--"));
  const numbers = all.findIndex((word) => numberOf(word) === undefined);
  const computed = isFlags
    ? COMPUTED_FLAG.exec(args)?.[1]
    : numbers < 6 && numbers >= 0
      ? COMPUTED.exec(args)?.[0]
      : undefined;
  if (computed !== undefined)
    throw badFile(
      `its static transform has the argument ${computed}, which ROS computes when it starts the file: write the numbers there, or save the output of "rosrun tf tf_echo PARENT CHILD" (ROS 2: "ros2 run tf2_ros tf2_echo") and give that`,
    );
  return words(args.replace(/\$\((?:arg|var)\s+(\w{1,40})\)/g, "$1"));
}

/** ROS 2: `--x 1 --qw 1 --frame-id a --child-frame-id b`. */
function ofFlags(words: string[], warnings: ReaderWarning[]): NamedPose {
  const values = new Map<string, string>();
  words.forEach((word, index) => word.startsWith("--") && values.set(word.slice(2), words[index + 1] ?? ""));
  const number = (name: string, missing: number): number => {
    const text = values.get(name);
    const value = text === undefined ? missing : numberOf(text);
    if (value === undefined) throw badFile(`its static transform has --${name} ${text}, which is not a number`);
    return value;
  };
  const isQuaternion = ["qx", "qy", "qz", "qw"].some((name) => values.has(name));
  const rotation = isQuaternion
    ? ofQuaternion([number("qx", 0), number("qy", 0), number("qz", 0), number("qw", 1)], warnings)
    : ofYawPitchRoll([number("yaw", 0), number("pitch", 0), number("roll", 0)]);
  const [to, from] = [values.get("frame-id"), values.get("child-frame-id")];
  return motion(
    rotation,
    [number("x", 0), number("y", 0), number("z", 0)],
    { ...(from !== undefined && { from }), ...(to !== undefined && { to }) },
    warnings,
  );
}

/** ROS 1: `x y z yaw pitch roll parent child [ms]` or `x y z qx qy qz qw parent child [ms]`. */
function ofPlaces(words: string[], warnings: ReaderWarning[]): NamedPose {
  const numbers: Numbers = [];
  for (const word of words) {
    const value = numberOf(word);
    if (value === undefined) break;
    numbers.push(value);
  }
  if (numbers.length !== 6 && numbers.length !== 7)
    throw badFile(
      `its static transform has ${numbers.length} numbers; x y z and yaw pitch roll, or qx qy qz qw, are needed`,
    );
  const [to, from] = words.slice(numbers.length);
  const turn = numbers.slice(3);
  const rotation = turn.length === 4 ? ofQuaternion(turn, warnings) : ofYawPitchRoll(turn);
  return motion(
    rotation,
    numbers.slice(0, 3),
    { ...(from !== undefined && { from }), ...(to !== undefined && { to }) },
    warnings,
  );
}

/** The transforms, which carry points of the child frame into the parent. */
export function readPublishers(whole: string): Calibration {
  const warnings: ReaderWarning[] = [];
  const text = withoutComments(whole);
  if (!isPublisher(text))
    throw badFile(`it names ${NAME} only in comments: remove the comment signs if that line is the right one`);
  const found = mentions(text)
    .filter((args) => COMPUTED.test(args) || words(args).some((word) => numberOf(word) !== undefined))
    .map(written);
  if (found.length === 0) throw badFile(`it names ${NAME}, but no numbers follow`);
  const poses = found.map((all) => (all.some((word) => word.startsWith("--")) ? ofFlags : ofPlaces)(all, warnings));
  warnings.push(...doubtsOf(poses, text));
  return { cameras: [], poses, warnings };
}

/**
 * Warns of several transforms between the same frames, and of one with a condition, because the file does not show which of them ROS
 * publishes.
 */
function doubtsOf(poses: NamedPose[], text: string): ReaderWarning[] {
  const isConditional = CONDITION.test(text);
  const twice = poses.find((pose, index) =>
    poses.some((other, at) => at < index && other.from === pose.from && other.to === pose.to),
  );
  if (twice === undefined && !isConditional) return [];
  const which = isConditional
    ? "It publishes its transforms under conditions (if, unless), which were not evaluated: all transforms were read"
    : `It has several transforms from ${twice?.from} to ${twice?.to}: all were read, in their order`;
  return [warning("pose-assumed", `${which}. Remove those that do not apply.`)];
}

const TRIPLE = /Translation:\s*\[([^\]\n]{1,200})\]/;
const QUATERNION = /Quaternion\s*(?:\(xyzw\)\s*)?\[([^\]\n]{1,200})\]/;

export const isEcho = (text: string): boolean =>
  TRIPLE.test(text.slice(0, REACH)) && QUATERNION.test(text.slice(0, REACH));

/** While tf2_echo waits for the pose of its second frame in its first one, it prints both names. */
const WAITS = /Waiting for transform (\S{1,80}) -> +(\S{1,80}?):? /;

/** The first transform in the output of tf_echo, which names the frames only while it waits. */
export function readEcho(text: string): Calibration {
  const warnings: ReaderWarning[] = [];
  const numbers = (pattern: RegExp, count: number): Numbers => {
    const found = (pattern.exec(text.slice(0, REACH))?.[1] ?? "").split(",").map((part) => numberOf(part) ?? NaN);
    if (found.length !== count || found.some(Number.isNaN))
      throw badFile(`its transform does not have ${count} numbers where they are needed`);
    return found;
  };
  const [, to, from] = WAITS.exec(text.slice(0, REACH)) ?? [];
  const names = from !== undefined && to !== undefined ? { from, to } : {};
  return {
    cameras: [],
    poses: [motion(ofQuaternion(numbers(QUATERNION, 4), warnings), numbers(TRIPLE, 3), names, warnings)],
    warnings,
  };
}
