/** The imports of files, from their syntax: for the declarations that the package ships, and for the tests of layers. */
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { parseAst } from "rolldown/parseAst";

const isNode = (value) => typeof value === "object" && value !== null;

/** Every node of a syntax tree. */
function* nodes(tree) {
  yield tree;
  for (const child of Object.values(tree).flat()) if (isNode(child)) yield* nodes(child);
}

/** The addresses that a source imports, as written: in statements, and in `import("x")` in code and types. */
export function imports(text, lang) {
  const sources = [...nodes(parseAst(text, { lang }))].map(({ source }) => source?.value);
  return [...new Set(sources.filter((source) => typeof source === "string"))];
}

/** The declarations below a folder that the entries reach by relative imports. A missing file is an error. */
export function reachable(folder, entries) {
  const found = new Set();
  const waiting = [...entries];
  for (let name = waiting.pop(); name !== undefined; name = waiting.pop()) {
    if (found.has(name)) continue;
    found.add(name);
    const path = join(folder, name);
    if (!existsSync(path)) throw new Error(`${name} is imported by a declaration and is not there`);
    for (const source of imports(readFileSync(path, "utf8"), "dts"))
      if (source.startsWith(".")) waiting.push(join(dirname(name), source.replace(/\.js$/, ".d.ts")));
  }
  return found;
}
