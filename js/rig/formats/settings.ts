/**
 * Texts of settings: JSON with comments, TOML, and sections of "name = value" as in .ini files.
 *
 * Each library is loaded with the first such text. json5 (11 kB gzipped) reads comments, trailing commas, single quotes and numbers such as
 * "1.", which Python prints; jsonc-parser reads only comments. smol-toml (6 kB) is smaller and stricter than @iarna/toml.
 */
import { badFile } from "../../errors.js";
import type { Node } from "./numbers.js";

/** Largest number of characters of a text that is not plain JSON; calibrations have a few thousand. */
export const MOST_SETTINGS = 2 ** 18;

/** A text without the names that Python prints around the arrays of numpy and PyTorch. */
export const plainPython = (text: string): string =>
  text
    .replace(/\b(?:np|numpy|torch|jnp|cv2|cv)\.(?=\w)/g, "")
    .replace(/,\s*(?:dtype|device)\s*=\s*['"]?[\w.:]{1,40}['"]?/g, "")
    .replace(/\b(?:array|asarray|matrix|tensor|float32|float64|Matx\w*|Mat)\s*\(/g, "(")
    .replace(/\(\s*([[{][^()]*[\]}])\s*\)/g, "$1")
    .replace(/\((\s*[-+\d.][^()]*)\)/g, "[$1]");
const pythonWords = (text: string): string =>
  text
    .replace(/\bTrue\b/g, "true")
    .replace(/\bFalse\b/g, "false")
    .replace(/\b(?:None|nan)\b/g, "null");

/** The objects of a text that has one on each line. */
function objectsOf(text: string): unknown[] | undefined {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== "");
  if (!lines.every((line) => /^\s*\{.*\}\s*$/.test(line))) return undefined;
  try {
    return lines.map((line) => JSON.parse(line) as unknown);
  } catch {
    return undefined;
  }
}

const isJson = (text: string): boolean => /^[{[]/.test(text);

/** JSON, possibly with comments or as printed by Python. */
export async function readJson(text: string): Promise<unknown> {
  try {
    // Python writes these three values, which JSON lacks; values of a calibration are finite.
    return JSON.parse(text.replace(/\b(?:NaN|-?Infinity)\b/g, "null"));
  } catch (error) {
    const damaged = badFile(
      `this JSON is damaged or cut off (${error instanceof Error ? error.message : String(error)})`,
      error,
    );
    if (text.length > MOST_SETTINGS) throw damaged;
    const lines = objectsOf(text);
    if (lines !== undefined) return lines;
    const { default: json5 } = await import("json5");
    try {
      return json5.parse(pythonWords(plainPython(text)));
    } catch {
      throw damaged;
    }
  }
}

const SECTION = /^[ \t]*\[{1,2}[ \t]*["']?[A-Za-z_][^\]\n]{0,80}\]{1,2}[ \t]*(?:[#;].*)?$/m;
const SETTING = /^[ \t]*["']?[A-Za-z_][\w.\- ]{0,80}["']?[ \t]*[=:][ \t]*\S/m;

/** Whether a text has sections with settings, as TOML and .ini files have. */
export const isSectioned = (text: string): boolean =>
  SECTION.test(text) && SETTING.test(text) && !isJson(text.replace(SECTION, ""));

/** The sections of an .ini file. Its names and texts have no quotes, so TOML's parser refuses it. */
export function readIni(text: string): Node {
  const root: Node = {};
  let section = root;
  for (const line of text.split(/\r?\n/)) {
    const bare = line.replace(/(?:^|[ \t])[#;].*$/, "").trim();
    const [, name] = /^\[([^\]]{1,80})\]$/.exec(bare) ?? [];
    const [, key, value] = /^([^=:]{1,80}?)[ \t]*[=:][ \t]*(.*)$/.exec(bare) ?? [];
    if (name !== undefined && name !== "__proto__") {
      section = {};
      root[name.trim()] = section;
    } else if (key !== undefined && key !== "__proto__") section[key.trim()] = value;
  }
  return root;
}

/** TOML, or else an .ini file. */
export async function readSections(text: string): Promise<{ value: unknown; format: string }> {
  if (text.length > MOST_SETTINGS) throw badFile(`it is text of ${text.length} characters, too long for settings`);
  const { parse } = await import("smol-toml");
  try {
    return { value: parse(text, { maxDepth: 32 }), format: "TOML" };
  } catch {
    return { value: readIni(text), format: "settings in sections" };
  }
}
