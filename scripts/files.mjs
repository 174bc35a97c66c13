// node scripts/files.mjs: writes docs/guide/files.md, the list of supported files, and its short form on the page from the table beside the
// readers (js/rig/formats/catalogue). tests/contract/files-page.test.mjs checks that both agree and that the readers do what the table says.
import { mkdirSync, realpathSync, writeFileSync } from "node:fs";
import { dirname } from "node:path";
import { inRoot, say } from "./shell.mjs";

export const DOCUMENT = "docs/guide/files.md";
/** The list on the page, which loads it when somebody opens it. */
export const LIST = "www/rig/supported.ts";

/** The exports of some sources that Node cannot load as they are. */
export async function loaded(source) {
  // Imported late, because before the set-up there are no node_modules.
  const { build } = await import("esbuild");
  const stdin = { contents: source, resolveDir: inRoot("js"), loader: "ts" };
  const { outputFiles } = await build({ stdin, bundle: true, format: "esm", write: false, logLevel: "error" });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

/** The groups of the table. */
export const catalogue = async () =>
  (await loaded('export { CATALOGUE } from "./rig/formats/catalogue/index.js";')).CATALOGUE;

const INTRODUCTION = `The readers recognise files by their content, and names decide what the content leaves open. Every guess has a warning with a code. A
warning caps the verdict of a check at "undecided", unless its row in [codes](../codes.md#warnings-of-the-readers-of-files) says otherwise.
A file that is not read is refused with an error that names its format and what to do. The option \`as\` gives the kind, and \`unit\` the
metres per stored unit.

\`node scripts/files.mjs\` makes this page from \`js/rig/formats/catalogue/\`. A test reads a file of each row and compares the kind and the
warnings. [check.md](../check.md#what-is-read) says what the Rust command line and the Python package read of these.`;

const HEAD = ["| product | file | what is taken | what is guessed | how to export it |", "|---|---|---|---|---|"];

/** A cell of a Markdown table. */
const cell = (words) => words.replaceAll("|", "\\|");

/** The document for a table. */
export function documentOf(groups) {
  const sections = groups.flatMap(({ title, rows }) => [
    `## ${title}`,
    "",
    ...HEAD,
    ...rows.map(
      ({ product, file, taken, guessed, exported }) =>
        `| ${[product, file, taken, guessed, exported].map(cell).join(" | ")} |`,
    ),
    "",
  ]);
  return ["# Files that are read", "", INTRODUCTION, "", ...sections].join("\n");
}

/** The source of the page's list of what is read. A group of pictures or scans lists formats; any other group lists products. */
export function listOf(groups) {
  const areFormats = (title) => /maps|images|Masks|scans/.test(title);
  const brief = (file) =>
    file
      .replaceAll("`", "")
      .replace(/(?:[:;(]| in three| without| with or| of every| below).*$/, "")
      .trim();
  const entry = ({ title, rows }) => {
    const read = rows.filter(({ file }) => !/not read/.test(file));
    const products = read.flatMap(({ product }) => product.split(/[,;] (?![^(]*\))/));
    const formats = areFormats(title) ? read.map(({ file }) => brief(file)) : [];
    return `  [${JSON.stringify(title)}, ${JSON.stringify([...new Set([...formats, ...products])].join(", "))}],`;
  };
  return [
    "/** Products and formats that are read, made by `node scripts/files.mjs` from the readers' table. */",
    "",
    "// biome-ignore format: one group on each line",
    "export const SUPPORTED: readonly [group: string, products: string][] = [",
    ...groups.map(entry),
    "];",
    "",
  ].join("\n");
}

if (import.meta.filename === realpathSync(process.argv[1])) {
  mkdirSync(dirname(inRoot(DOCUMENT)), { recursive: true });
  const groups = await catalogue();
  writeFileSync(inRoot(DOCUMENT), documentOf(groups));
  writeFileSync(inRoot(LIST), listOf(groups));
  say(`wrote ${DOCUMENT} and ${LIST}`);
}
