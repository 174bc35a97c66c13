/** Text files: the format is recognised from the text, and the result is cameras and poses. */
import { BimodalError, badFile } from "../../errors.js";
import { once } from "../once.js";
import { asFisheye } from "./cameras.js";
import { readColmap, isColmap } from "./colmap.js";
import { isColmapImages, readColmapImages } from "./colmap-images.js";
import { readColumns } from "./columns.js";
import { withPoints } from "./commas.js";
import { withEnds } from "./filename.js";
import { readNotes } from "./notes.js";
import type { Node } from "./numbers.js";
import { readNumbers } from "./plain.js";
import { isEcho, isPublisher, readEcho, readPublishers } from "./ros.js";
import { MOST_SETTINGS, isSectioned, plainPython, readJson, readSections } from "./settings.js";
import { type Calibration, searchTree } from "./tree.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Element, plainXml, readXml } from "./xml.js";

/** Aliases are bounded so that a small file cannot become a large value. */
const YAML_LIMITS = { maxDepth: 32, maxAliases: 64 };

/** YAML without the directive "%YAML:1.0" and the non-standard tags of OpenCV and Python, and with spaces in place of tabs. */
const plainYaml = (text: string): string =>
  text
    .replace(/^%YAML.*$/m, "")
    .replace(/!!(?:opencv-[\w-]+|python\/[\w:./]+)/g, "")
    .replace(/^\t+/gm, (tabs) => "  ".repeat(tabs.length));

/** Largest number of characters of a list that is put into one line. */
const LONGEST_LIST = 20_000;

/** Converts YAML as OpenCV and PyYAML accept it for js-yaml: "data:[" without a space, and lists that are indented as far as their name. */
function strictYaml(text: string): string {
  const lines: string[] = [];
  let depth = 0;
  for (const line of text.replace(/^([ \t-]*[A-Za-z_][\w.]{0,80}):(?=[[{"'\d+-])/gm, "$1: ").split(/\r?\n/)) {
    const bare = line.replace(/(?:^|[ \t])#.*$/, "");
    const isInside = depth > 0 && (lines.at(-1)?.length ?? 0) < LONGEST_LIST;
    if (isInside) lines.push(`${lines.pop() ?? ""} ${bare.trim()}`);
    else lines.push(line);
    const opens = bare.replace(/"[^"]*"|'[^']*'/g, "");
    depth = Math.max(0, (isInside ? depth : 0) + count(opens, /[[{]/g) - count(opens, /[\]}]/g));
  }
  return lines.join("\n");
}
const count = (text: string, pattern: RegExp): number => text.match(pattern)?.length ?? 0;

/** Settings such as "fx = 500" on each line, with the colons of YAML. */
const withColons = (text: string): string =>
  /^[ \t]*[\w.]{1,80}[ \t]*:/m.test(text) ? text : text.replace(/^([ \t]*[\w.]{1,80})[ \t]*=[ \t]*/gm, "$1: ");

/** The first line of a parser's message. */
const reasonOf = (error: unknown): string =>
  error instanceof Error ? (error.message.split("\n")[0] ?? "") : String(error);

/** The documents of a YAML text. js-yaml is loaded with the first such text. */
async function readYaml(text: string): Promise<unknown> {
  if (text.length > MOST_SETTINGS) throw badFile(`it is text of ${text.length} characters in an unknown format`);
  const { CORE_SCHEMA, loadAll, mergeTag } = await import("js-yaml");
  const parsed = (yaml: string) => loadAll(yaml, { ...YAML_LIMITS, schema: CORE_SCHEMA.withTags(mergeTag) });
  const plain = withColons(plainYaml(text));
  try {
    return parsed(plain);
  } catch (error) {
    try {
      return parsed(strictYaml(plain));
    } catch {
      // The error about the unchanged file is more informative.
    }
    throw badFile(`it is text in an unknown format, or damaged (as YAML: ${reasonOf(error)})`, error);
  }
}

const NEITHER =
  "neither a camera (camera_matrix, K, fx fy cx cy, intrinsics) nor a transform (R and T, T_.., rotation and translation, a 4x4 matrix)";

/** With `isBare` the file holds only numbers. */
type Read = Calibration & { format: string; isBare?: boolean };

/** The readers of products, which are loaded with the first text. */
const products = once(() => import("./products.js"));

/** The findings of a product's reader or of the search by names; undefined where there is neither a camera nor a pose. */
async function search(value: unknown, format: string, text: string): Promise<Read | undefined> {
  const product = (await products()).productOfTree(value);
  if (product !== undefined) return product;
  const found = searchTree(value, text);
  return found.cameras.length + found.poses.length > 0 ? { ...found, format } : undefined;
}

/** Fewest numbers of a camera: a focal length and a centre. */
const FEWEST_NUMBERS = 3;
const isText = (value: unknown): boolean => typeof value !== "object" || value === null;
const numbersIn = (value: unknown): number =>
  String(value)
    .split(/[\s,;]+/)
    .filter((word) => word !== "" && Number.isFinite(Number(word))).length;

/** Whether documents of YAML are notes: lines of text, which may have colons or dashes. */
function areNotes(documents: readonly unknown[]): boolean {
  const lines = documents.flatMap((each) => (isText(each) ? [each] : Object.values(each as object)));
  return lines.every(isText) && lines.reduce((sum: number, line) => sum + numbersIn(line), 0) < FEWEST_NUMBERS;
}

function nothingIn(value: unknown, format: string): BimodalError {
  const all = Array.isArray(value) ? value : [value];
  if (all.every(isText) || (format === "YAML" && areNotes(all))) return badFile("it is text in an unknown format");
  return badFile(`it is ${format}, but holds ${NEITHER} by a known name`);
}

async function searched(value: unknown, format: string, text: string): Promise<Read> {
  const found = await search(value, format, text);
  if (found === undefined) throw nothingIn(value, format);
  return found;
}

/** The rows of a table, by their numbers. Rows with times or images are poses of the camera in the world. */
async function ofTable({ rows, isSeries }: { rows: Node[]; isSeries: boolean }, text: string): Promise<Read> {
  const named = Object.fromEntries(rows.map((row, at) => [isSeries ? `pose ${at + 1}` : `row ${at + 1}`, row]));
  const found = await searched(named, isSeries ? "a table of poses" : "a table", text);
  // All rows have the same columns, so one warning for each code is enough.
  return { ...found, warnings: [...new Map([...found.warnings].reverse().map((each) => [each.code, each])).values()] };
}

/** MVSNet's "extrinsic" beside "intrinsic" is the pose of the world in that camera. */
function ofViews({ extrinsic, ...notes }: Node): Node {
  if (extrinsic === undefined) return notes;
  return notes.intrinsic === undefined ? { ...notes, extrinsic } : { ...notes, world_to_camera: extrinsic };
}

/** Numbers with labels; undefined where there is neither a camera nor a pose among them. */
function ofNotes(text: string): Read | undefined {
  const notes = text.length > MOST_SETTINGS ? undefined : readNotes(text);
  const found = notes === undefined ? undefined : searchTree(ofViews(notes), text);
  if (found === undefined || found.cameras.length + found.poses.length === 0) return undefined;
  return { ...found, format: "numbers with labels" };
}

/** Properties that show YAML: its directive, the matrices of OpenCV, and lists of members. */
const IS_YAML = /^%YAML|!!opencv-matrix|^\s*- \w+:\s*$/m;
/** YAML, or else numbers with labels. */
async function ofYaml(text: string): Promise<Read> {
  let value: unknown;
  try {
    value = await readYaml(text);
  } catch (error) {
    const found = error instanceof BimodalError ? ofNotes(text) : undefined;
    if (found === undefined) throw error;
    if (IS_YAML.test(text))
      found.warnings.push(
        warning(
          "read-by-lines",
          `It is damaged YAML (${reasonOf(error instanceof BimodalError ? error.cause : error)}) and was read line by line, which may miss lenses, cameras and poses. Repair that line.`,
        ),
      );
    return found;
  }
  const found = (await search(value, "YAML", text)) ?? ofNotes(text);
  if (found === undefined) throw nothingIn(value, "YAML");
  return found;
}

/** XML, or an object printed by Python, which also begins with "<". */
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

/** The cameras and poses of a text, with the name of its format; the file's name supplies frames that the text leaves open. */
export async function readText(text: string, file: string): Promise<Read> {
  const { isBare = false, ...found } = await ofContent(text);
  asFisheye(found.cameras, found.warnings, `${file.replace(/^.*[/\\]/, "")}\n${text}`);
  const { poses, isPlace = false, isOneEnd = false } = withEnds(found.poses, file, isBare);
  const isEchoed = found.format === ECHO && found.poses[0]?.from === undefined && poses[0]?.from !== undefined;
  const said = [
    ...(isPlace ? [placeOfName()] : []),
    ...(isOneEnd ? [oneEndNamed()] : []),
    ...(isEchoed ? [echoNamed()] : []),
  ];
  return { ...found, poses, warnings: [...found.warnings, ...said] };
}

const ECHO = "a transform of ROS";
const echoNamed = (): ReaderWarning =>
  warning(
    "pose-assumed",
    'tf2_echo does not print the frames of its transform, and "tf2_echo A B" prints the pose from B to A. The direction was taken from the file\'s name, as in depth_to_color.txt; check that the name states the direction and not the order of the command.',
  );

const oneEndNamed = (): ReaderWarning =>
  warning(
    "pose-assumed",
    "Its name says which camera the pose belongs to, but neither its direction nor the other frame. It was taken to lead from the depth camera to the colour camera; if it does, name the file depth_to_color.txt.",
  );

const placeOfName = (): ReaderWarning =>
  warning(
    "camera-to-world",
    "Its name says that it is the pose of a camera in the world (camera to world), which was not used as extrinsics between two cameras. If it does relate two cameras, name the file depth_to_color.txt or the like.",
    { poses: 1 },
  );

async function ofContent(text: string): Promise<Read> {
  const trimmed = text.replace(/^\ufeff/, "").trim();
  if (trimmed === "") throw badFile("it is empty or has only spaces");
  if (isPublisher(trimmed)) return { ...readPublishers(trimmed), format: "a static transform of ROS" };
  if (isEcho(trimmed)) return { ...readEcho(trimmed), format: ECHO };
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

/** Plain numbers, tables, and the languages of settings. */
async function ofWords(text: string): Promise<Read> {
  const numbers = readNumbers(text) ?? (text.length < MOST_SETTINGS ? readNumbers(plainPython(text)) : undefined);
  if (numbers !== undefined) return { ...numbers, isBare: true };
  const table = readColumns(text);
  if (table !== undefined) return ofTable(table, text);
  if (isSectioned(text)) {
    const { value, format } = await readSections(text);
    return searched(value, format, text);
  }
  if (/^[{[]/.test(text)) return searched(await readJson(text), "JSON", text);
  return ofYaml(text);
}
