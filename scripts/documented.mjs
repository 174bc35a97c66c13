/**
 * The comments of the package's types: finds members without one, and the lines of comments that follow from the rows of js/options.ts.
 * `node scripts/documented.mjs` writes these lines into js/types/, from pkg/ as it is built; the contract tests check that they are there.
 */
import { readFileSync, readdirSync, realpathSync, writeFileSync } from "node:fs";
import { inRoot } from "./shell.mjs";
import { ts } from "ts-morph";

const MEMBERS = [
  ts.SyntaxKind.PropertySignature,
  ts.SyntaxKind.MethodSignature,
  ts.SyntaxKind.PropertyDeclaration,
  ts.SyntaxKind.MethodDeclaration,
  ts.SyntaxKind.GetAccessor,
];
const DECLARATIONS = [
  ts.SyntaxKind.InterfaceDeclaration,
  ts.SyntaxKind.ClassDeclaration,
  ts.SyntaxKind.TypeAliasDeclaration,
  ts.SyntaxKind.FunctionDeclaration,
  ts.SyntaxKind.VariableDeclaration,
];

const isCommented = (node) => {
  // A constant has its comment at its statement.
  const carrier = ts.isVariableDeclaration(node) ? node.parent.parent : node;
  return ts.getJSDocCommentsAndTags(carrier).length > 0;
};

/** Every member of a declaration, including those of nested types, with its path. */
function* membersOf(node, path) {
  for (const child of childrenOf(node)) {
    const isMember = MEMBERS.includes(child.kind) && child.name && !ts.isPrivateIdentifier(child.name);
    const own = isMember ? `${path}.${child.name.getText()}` : path;
    if (isMember) yield [own, child];
    yield* membersOf(child, own);
  }
}

function childrenOf(node) {
  const children = [];
  ts.forEachChild(node, (child) => void children.push(child));
  return children;
}

/** Everything that some modules export, by name and member, and whether it has a comment. */
export function comments(files) {
  const program = ts.createProgram(files, {
    module: ts.ModuleKind.NodeNext,
    moduleResolution: ts.ModuleResolutionKind.NodeNext,
    target: ts.ScriptTarget.ES2022,
    types: [],
  });
  const checker = program.getTypeChecker();
  const found = new Map();
  for (const file of files) {
    const exported = checker.getExportsOfModule(checker.getSymbolAtLocation(program.getSourceFile(file)));
    for (const symbol of exported) {
      const target = symbol.flags & ts.SymbolFlags.Alias ? checker.getAliasedSymbol(symbol) : symbol;
      for (const declaration of target.declarations ?? []) {
        if (!DECLARATIONS.includes(declaration.kind)) continue;
        found.set(symbol.name, isCommented(declaration));
        for (const [path, member] of membersOf(declaration, symbol.name)) found.set(path, isCommented(member));
      }
    }
  }
  return found;
}

const UNITS = { deg: "degrees", px: "pixels" };
const named = (limit) => (limit === 0 ? "zero" : limit.toLocaleString("en-GB"));

/** A row's range in words. */
function range({ kind, min, above, max, below, unit, length }) {
  if (kind === "list") return `${length} numbers`;
  if (!["number", "whole", "side"].includes(kind)) return undefined;
  const from = above !== undefined ? `above ${named(above)}` : min !== undefined ? `from ${named(min)}` : "";
  const to =
    max !== undefined
      ? `${min === undefined ? "up " : ""}to ${named(max)}`
      : below !== undefined
        ? `below ${named(below)}`
        : "";
  const what = kind === "number" ? "a number" : "a whole number";
  return `${what} ${from} ${to}${unit === undefined ? "" : `, in ${UNITS[unit]}`}`
    .replace(/ +(?=,|$)/g, "")
    .replace(/ {2,}/g, " ");
}

/** The lines of a member's comment that follow from its row. */
export function linesOf(row) {
  const words = range(row);
  return [
    ...(words === undefined ? [] : [`Range: ${words}.`]),
    ...(row.default === undefined ? [] : [`@default ${JSON.stringify(row.default)}`]),
  ];
}

const isOurs = (line) => /^(Range: |@default )/.test(line);

/** The text of a comment without its delimiters. */
const unframed = (comment) =>
  comment
    .slice(3, -2)
    .split("\n")
    .map((line) => line.replace(/^\s*\* ?/, "").trim())
    .filter((line, index, all) => line !== "" || (index > 0 && index < all.length - 1));

/** The source of types with the comments of its members updated from their rows; `rows` are by interface and path. */
export function documented(text, rows) {
  const source = ts.createSourceFile("types.ts", text, ts.ScriptTarget.ES2022, true);
  const edits = [];
  for (const declaration of source.statements.filter(ts.isInterfaceDeclaration)) {
    for (const [path, member] of membersOf(declaration, declaration.name.text)) {
      const row = rows.get(path);
      const [comment] = ts.getJSDocCommentsAndTags(member);
      if (row === undefined || comment === undefined) continue;
      const indent = " ".repeat(source.getLineAndCharacterOfPosition(member.getStart()).character);
      const lines = [...unframed(comment.getText()).filter((line) => !isOurs(line)), ...linesOf(row)];
      const framed =
        lines.length === 1
          ? `/** ${lines[0]} */`
          : ["/**", ...lines.map((line) => `${indent} * ${line}`), `${indent} */`].join("\n");
      edits.push([comment.getStart(), comment.getEnd(), framed]);
    }
  }
  return edits
    .sort(([a], [b]) => b - a)
    .reduce((whole, [from, to, comment]) => whole.slice(0, from) + comment + whole.slice(to), text);
}

/** The rows of the options and of sample requests, by interface and path. */
export async function rowsOfTypes() {
  const { OPTIONS, SAMPLE, paths } = await import("../pkg/options.js");
  return new Map([...paths(OPTIONS, "Options"), ...paths(SAMPLE, "SampleRequest")]);
}

/** The sources of the public types. */
export const TYPES = readdirSync(inRoot("js/types")).map((name) => inRoot("js/types", name));

// `import.meta` has the real path, the command line the path that was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  const rows = await rowsOfTypes();
  for (const path of TYPES) writeFileSync(path, documented(readFileSync(path, "utf8"), rows));
}
