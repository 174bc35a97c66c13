// npm run thresholds: writes the columns "value" and "meaning" of docs/lab/thresholds.md from the constants of the code.
//
// A row is found by its first two cells, a name and a file; the last two cells, the data, are written by hand.
//   `NAME`         a constant of a Rust or TypeScript file
//   `Type::field`  a default: the field's value in `impl Default for Type`
// The value is the constant's expression, the meaning the first sentence of its comment.
// tests/contract/thresholds.test.mjs fails if the page and the code differ.
import { existsSync, readFileSync, readdirSync, realpathSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Failure, inRoot, say, script } from "./shell.mjs";

export const DOCUMENT = "docs/lab/thresholds.md";

/** Types of one number. */
const SCALAR = /^(?:[fiu](?:8|16|32|64)|[iu]size)$/;
const COMMENT = /(?:^[ \t]*\/\/\/.*\n)*/.source;
const ATTRIBUTES = /(?:^[ \t]*#\[.*\]\n)*/.source;
const RUST = new RegExp(
  `(${COMMENT})${ATTRIBUTES}^[ \\t]*(?:pub(?:\\([^)]*\\))? )?const (\\w+): ([^=]+?) =\\s+([^;[]*(?:\\[[^]*?\\])?[^;]*);$`,
  "gm",
);
const TYPESCRIPT = /(\/\*\*(?:(?!\*\/)[^])*\*\/\n)?^(?:export )?const (\w+)(: [^=]+)? = ([^;]*);/gm;
/** Tests of a Rust file stand at its end. */
const TESTS = /^#\[cfg\(test\)\]\nmod [^]*$/m;

/** The text of a comment, without links to items and to the page itself. */
const textOf = (comment = "") =>
  comment
    .replaceAll(/^[ \t]*(?:\/\/\/|\/\*\*|\*(?!\/))|\*\/\s*$/gm, "")
    .replaceAll(/\s+/g, " ")
    .replaceAll(/\[(`[^`]+`)\](?:\([^)]*\))?/g, "$1")
    .replaceAll(/[;,]? (?:both |all )?set (?:on|by) [^.;]*\(docs\/lab\/thresholds\.md\)/g, "")
    .replaceAll(/ \(docs\/lab\/thresholds\.md\)/g, "")
    .trim();

/** The first sentence: a full stop before a capital letter ends it. */
const firstSentence = (text) => /^.*?(?<!\bEq)\.(?= [A-Z`]|$)/.exec(text)?.[0] ?? text;

/** An expression in the form of the page: 20000 for 20_000_usize, 2 for 2.0, the numbers of an array. */
export function formatted(expression) {
  const plain = expression
    .replaceAll(/\s+/g, " ")
    .replaceAll(/(?<=\b\d[\d_.e-]*?)_?(?:[fiu](?:8|16|32|64)|[iu]size)\b/g, "")
    .replaceAll(/(?<=\d)_(?=\d)/g, "")
    .replaceAll(/\b(\d+)\.0?(?![\d.\w])/g, "$1")
    .replaceAll(/(?<=[[{(]) ?| ?,? ?(?=[\]})])/g, "")
    .replaceAll(/^\w+ ?\{(.*)\}$/g, "$1");
  if (/^-?[\d.]+(?:e-?\d+)?$/.test(plain)) return plain;
  return /^[[\],\d.e\- ]+$/.test(plain)
    ? plain.replaceAll("], [", "; ").replaceAll(/[[\]]/g, "")
    : `\`${plain.replaceAll("|", "\\|")}\``;
}

/** The constants of a source: name, type, value and the text of the comment. */
export const constants = (source, path) =>
  [...source.replace(TESTS, "").matchAll(path.endsWith(".ts") ? TYPESCRIPT : RUST)].map(
    ([, comment, name, type, value]) => ({ name, type, value, text: textOf(comment) }),
  );

/** A field's value in `impl Default for Type`, with the field's comment. */
function defaultOf(source, type, field) {
  const body = new RegExp(`^impl Default for ${type} \\{[^]*?^\\}`, "m").exec(source)?.[0].replaceAll(/\/\/.*$/gm, "");
  const value = body && new RegExp(`\\b${field}: ([^,}]+?) ?[,}]`).exec(body)?.[1];
  const struct = new RegExp(`^pub struct ${type} \\{[^]*?^\\}`, "m").exec(source)?.[0];
  const comment = struct && new RegExp(`(${COMMENT})${ATTRIBUTES}^[ \\t]*pub ${field}:`, "m").exec(struct)?.[1];
  return value === undefined ? [] : [{ name: `${type}::${field}`, value, text: textOf(comment) }];
}

/** The value and the meaning of a row's constant in the code. */
export function lookUp(name, path, read = (path) => existsSync(inRoot(path)) && readFileSync(inRoot(path), "utf8")) {
  const source = read(path);
  if (!source) throw new Failure(`${DOCUMENT}: "${path}" of \`${name}\` is not a file.`);
  const [type, field] = name.split("::");
  const found = field
    ? defaultOf(source, type, field)
    : constants(source, path).filter((constant) => constant.name === name);
  if (found.length !== 1) throw new Failure(`${DOCUMENT}: ${path} has ${found.length} constants \`${name}\`, not one.`);
  if (!found[0].text) throw new Failure(`${DOCUMENT}: \`${name}\` of ${path} has no comment.`);
  return { value: formatted(found[0].value), meaning: firstSentence(found[0].text).replaceAll("|", "\\|") };
}

export const HEAD = "| constant | file | value | meaning | set on | held out |";

/** The lines of the page's tables, each with its `row` if it has a constant. */
function linesOf(page) {
  let inTable = false;
  return page.split("\n").map((line) => {
    if (line === HEAD) inTable = true;
    else if (!line.startsWith("|")) inTable = false;
    if (!inTable || line === HEAD || line.startsWith("|---")) return { line };
    const cells = line.slice(2, -2).split(" | ");
    const [name, path] = cells.slice(0, 2).map((cell) => /^`([^`]+)`$/.exec(cell)?.[1]);
    if (cells.length !== 6 || !name || !path)
      throw new Failure(`${DOCUMENT}: a row has six cells, the first a name and the second a file: ${line}`);
    return { line, row: { name, path, data: cells.slice(4) } };
  });
}

/** The rows of the page: name and file of each. */
export const rowsOf = (page) => linesOf(page).flatMap(({ row }) => (row ? [row] : []));

/** The page with both columns filled in by `look`. */
export const filled = (page, look = lookUp) =>
  linesOf(page)
    .map(({ line, row }) => {
      if (!row) return line;
      const { value, meaning } = look(row.name, row.path);
      return `| \`${row.name}\` | \`${row.path}\` | ${value} | ${meaning} | ${row.data.join(" | ")} |`;
    })
    .join("\n");

/** The page without both columns, that is, the text that people wrote. */
export const handWritten = (page) => filled(page, () => ({ value: "", meaning: "" }));

const sourcesBelow = (folder) =>
  readdirSync(inRoot(folder), { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return sourcesBelow(path);
    return path.endsWith(".rs") ? [path] : [];
  });

/** The constants of `src` that are one number, as "file NAME". */
export const scalars = () =>
  sourcesBelow("src").flatMap((path) =>
    constants(readFileSync(inRoot(path), "utf8"), path)
      .filter(({ type }) => SCALAR.test(type))
      .map(({ name }) => `${path} ${name}`),
  );

if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(() => {
    const page = filled(readFileSync(inRoot(DOCUMENT), "utf8"));
    writeFileSync(inRoot(DOCUMENT), page);
    say(`wrote ${rowsOf(page).length} rows of ${DOCUMENT}`);
  });
}
