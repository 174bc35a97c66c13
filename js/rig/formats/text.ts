/** Text files: what they are is told from their words, and what they hold comes out as cameras and poses. */
import { badFile } from "../../errors.js";
import { readColmap, isColmap } from "./colmap.js";
import { MOST_TEXT } from "./limits.js";
import { isMetadata, readMetadata } from "./metadata.js";
import { isMiddlebury, readMiddlebury } from "./middlebury.js";
import { readNumbers } from "./plain.js";
import { isEnumeration, readEnumeration } from "./realsense.js";
import { isEcho, isPublisher, readEcho, readPublishers } from "./ros.js";
import { type Calibration, searchTree } from "./tree.js";
import { plainXml, readXml } from "./xml.js";

/** Characters of YAML: calibrations have a few thousand. */
const MOST_YAML = 2 ** 18;
/** So that a small file cannot become a large value. */
const YAML_LIMITS = { maxDepth: 32, maxAliases: 64 };

/** The text of a file, or nothing where its bytes are none. */
export function textOf(bytes: Uint8Array): string | undefined {
  if (bytes.length > MOST_TEXT) return undefined;
  const [first, second] = bytes;
  const encoding =
    first === 0xff && second === 0xfe ? "utf-16le" : first === 0xfe && second === 0xff ? "utf-16be" : "utf-8";
  try {
    const text = new TextDecoder(encoding, { fatal: true }).decode(bytes);
    // Control characters tell bytes from text.
    return /[\0-\x08\x0e-\x1f]/.test(text) ? undefined : text;
  } catch {
    return undefined;
  }
}

function readJson(text: string): unknown {
  try {
    // Python writes these three, which JSON does not have; nothing of a calibration may be one of them.
    return JSON.parse(text.replace(/\b(?:NaN|-?Infinity)\b/g, "null"));
  } catch (error) {
    throw badFile(`this JSON is damaged or cut off (${error instanceof Error ? error.message : String(error)})`, error);
  }
}

/** OpenCV's YAML says "%YAML:1.0", which YAML does not have, and marks its matrices by a tag of its own, as Python does its tuples. */
const plainYaml = (text: string): string =>
  text
    .replace(/^%YAML.*$/m, "")
    .replace(/!!(?:opencv-[\w-]+|python\/[\w:./]+)/g, "")
    .replace(/^\t+/gm, (tabs) => "  ".repeat(tabs.length));

/** Settings as "fx = 500", line by line, are YAML but for the sign. */
const withColons = (text: string): string =>
  /^[ \t]*[\w.]{1,80}[ \t]*:/m.test(text) ? text : text.replace(/^([ \t]*[\w.]{1,80})[ \t]*=[ \t]*/gm, "$1: ");

/** By js-yaml, which is loaded when such a text comes. */
async function readYaml(text: string): Promise<unknown> {
  if (text.length > MOST_YAML)
    throw badFile(`it is text of ${text.length} characters, in none of the forms that are read here`);
  const { CORE_SCHEMA, loadAll, mergeTag } = await import("js-yaml");
  try {
    return loadAll(withColons(plainYaml(text)), { ...YAML_LIMITS, schema: CORE_SCHEMA.withTags(mergeTag) });
  } catch (error) {
    const reason = error instanceof Error ? (error.message.split("\n")[0] ?? "") : String(error);
    throw badFile(`it is a text in none of the forms that are read here, or damaged (as YAML: ${reason})`, error);
  }
}

const NEITHER =
  "neither a camera (camera_matrix, K, fx fy cx cy, intrinsics) nor a motion (R and T, T_.., rotation and translation, a 4x4 matrix)";

function searched(value: unknown, format: string): Calibration & { format: string } {
  const isText = (each: unknown) => typeof each !== "object" || each === null;
  if (isText(value) || (Array.isArray(value) && value.every(isText)))
    throw badFile("it is a text in none of the forms that are read here");
  const found = searchTree(value);
  if (found.cameras.length === 0 && found.poses.length === 0)
    throw badFile(`it is ${format}, but holds ${NEITHER} that is known here`);
  return { ...found, format };
}

/** What a text holds, with a word on what kind of text it is. */
export async function readText(text: string): Promise<Calibration & { format: string }> {
  const trimmed = text.replace(/^\ufeff/, "").trim();
  if (trimmed === "") throw badFile("it is empty: there is nothing in it but spaces");
  if (isPublisher(trimmed)) return { ...readPublishers(trimmed), format: "a static transform of ROS" };
  if (isEcho(trimmed)) return { ...readEcho(trimmed), format: "a transform of ROS" };
  if (isEnumeration(trimmed)) return { ...readEnumeration(trimmed), format: "RealSense's streams" };
  if (isMetadata(trimmed)) return { ...readMetadata(trimmed), format: "metadata of realsense-viewer" };
  if (isMiddlebury(trimmed)) return { ...readMiddlebury(trimmed), format: "Middlebury's calibration of a stereo pair" };
  if (trimmed.startsWith("<")) return searched(plainXml(readXml(trimmed)), "XML");
  if (isColmap(trimmed)) return { ...readColmap(trimmed), format: "COLMAP's cameras" };
  const numbers = readNumbers(trimmed);
  if (numbers !== undefined) return numbers;
  if (/^[{[]/.test(trimmed)) return searched(readJson(trimmed), "JSON");
  return searched(await readYaml(trimmed), "YAML");
}
