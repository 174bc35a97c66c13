/** Text files: what they are is told from their words, and what they hold comes out as cameras and poses. */
import { BimodalError, badFile } from "../../errors.js";
import { readColmap, isColmap } from "./colmap.js";
import { isColmapImages, readColmapImages } from "./colmap-others.js";
import { readColumns } from "./columns.js";
import { withPoints } from "./commas.js";
import { MOST_TEXT } from "./limits.js";
import { readNotes } from "./notes.js";
import type { Node } from "./numbers.js";
import { readNumbers } from "./plain.js";
import { isEcho, isPublisher, readEcho, readPublishers } from "./ros.js";
import { MOST_SETTINGS, isSectioned, plainPython, readJson, readSections } from "./settings.js";
import { type Calibration, searchTree } from "./tree.js";
import { type Element, plainXml, readXml } from "./xml.js";

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
  if (text.length > MOST_SETTINGS)
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

type Read = Calibration & { format: string };

/** Readers of products, which are loaded when the first text comes. */
const products = () => import("./products.js");

async function searched(value: unknown, format: string, text: string): Promise<Read> {
  const isText = (each: unknown) => typeof each !== "object" || each === null;
  if (isText(value) || (Array.isArray(value) && value.every(isText)))
    throw badFile("it is a text in none of the forms that are read here");
  const product = (await products()).productOfTree(value);
  if (product !== undefined) return product;
  const found = searchTree(value, text);
  if (found.cameras.length === 0 && found.poses.length === 0)
    throw badFile(`it is ${format}, but holds ${NEITHER} that is known here`);
  return { ...found, format };
}

/** Each row of a table by its number; rows with times or pictures are where the camera stood. */
async function ofTable({ rows, isSeries }: { rows: Node[]; isSeries: boolean }, text: string): Promise<Read> {
  const named = Object.fromEntries(rows.map((row, at) => [isSeries ? `pose ${at + 1}` : `row ${at + 1}`, row]));
  const found = await searched(named, isSeries ? "a table of poses" : "a table", text);
  // What is guessed of one row is guessed of all.
  return { ...found, warnings: [...new Map([...found.warnings].reverse().map((each) => [each.code, each])).values()] };
}

/** Numbers with labels, where there are any. */
function ofNotes(text: string): Read | undefined {
  const notes = text.length > MOST_SETTINGS ? undefined : readNotes(text);
  const found = notes === undefined ? undefined : searchTree(notes, text);
  if (found === undefined || found.cameras.length + found.poses.length === 0) return undefined;
  return { ...found, format: "numbers with labels" };
}

/** YAML, or where that is none or holds nothing, numbers with labels. */
async function ofYaml(text: string): Promise<Read> {
  try {
    const value = await readYaml(text);
    const product = (await products()).productOfTree(value);
    if (product !== undefined) return product;
    const found = searchTree(value, text);
    if (found.cameras.length + found.poses.length > 0) return { ...found, format: "YAML" };
    return ofNotes(text) ?? searched(value, "YAML", text);
  } catch (error) {
    const isYaml = error instanceof BimodalError && error.cause === undefined;
    const found = isYaml ? undefined : ofNotes(text);
    if (found === undefined) throw error;
    return found;
  }
}

/** XML, or what Python prints of an object: it begins with "<", too. */
async function ofXml(text: string): Promise<Read> {
  let root: Element;
  try {
    root = readXml(text);
  } catch (error) {
    const found = /^<[\w.]+(?::|\s+object|\s*<)/.test(text) ? ofNotes(text.replace(/[<>]/g, " ")) : undefined;
    if (found === undefined) throw error;
    return found;
  }
  return (await products()).productOfXml(root) ?? searched(plainXml(root), "XML", text);
}

/** What a text holds, with a word on what kind of text it is. */
export async function readText(text: string): Promise<Read> {
  const trimmed = text.replace(/^\ufeff/, "").trim();
  if (trimmed === "") throw badFile("it is empty: there is nothing in it but spaces");
  if (isPublisher(trimmed)) return { ...readPublishers(trimmed), format: "a static transform of ROS" };
  if (isEcho(trimmed)) return { ...readEcho(trimmed), format: "a transform of ROS" };
  const { isPythonTree, productOfText } = await products();
  const product = productOfText(trimmed);
  if (product !== undefined) return product;
  if (isPythonTree(trimmed)) return searched(await readYaml(trimmed), "YAML", trimmed);
  if (trimmed.startsWith("<")) return ofXml(trimmed);
  if (isColmap(trimmed)) return { ...readColmap(trimmed), format: "COLMAP's cameras" };
  if (isColmapImages(trimmed)) return { ...readColmapImages(trimmed), format: "COLMAP's images" };
  const pointed = withPoints(trimmed);
  if (pointed !== undefined) {
    const found = await ofWords(pointed);
    return { ...found, format: `${found.format} (decimal commas)` };
  }
  return ofWords(trimmed);
}

/** Numbers alone, tables, and the languages of settings. */
async function ofWords(text: string): Promise<Read> {
  const numbers = readNumbers(text) ?? (text.length < MOST_SETTINGS ? readNumbers(plainPython(text)) : undefined);
  if (numbers !== undefined) return numbers;
  const table = readColumns(text);
  if (table !== undefined) return ofTable(table, text);
  if (isSectioned(text)) {
    const { value, format } = await readSections(text);
    return searched(value, format, text);
  }
  if (/^[{[]/.test(text)) return searched(await readJson(text), "JSON", text);
  return ofYaml(text);
}
