// The project uses the terms of the field. Coined words and phrases that a reader has to read twice are found in comments, docstrings,
// messages and visible texts. Each rule names what to say instead.
import assert from "node:assert/strict";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { extname, join } from "node:path";
import { test } from "node:test";
import { inRoot } from "../../scripts/shell.mjs";
import { DOCUMENT as THRESHOLDS, handWritten } from "../../scripts/thresholds.mjs";
import { ts } from "ts-morph";

/** A pattern, the words to use instead, and a sentence that breaks the rule. */
const RULES = [
  ["told", "given, initial (value, pose, light); reported", "A told start is kept."],
  ["tells? (?:\\w+ )?apart", "distinguish", "A property tells them apart."],
  [
    "(?:one|its|log|single) paints?|painted (?:objects?|scenes?|surfaces?|things?)",
    "albedo",
    "An object of one paint.",
  ],
  ["(?:regist\\w+|poses?) by (?:its |their |the )?colours", "photometric registration", "Registration by colours."],
  ["explains? the colours as well", "fits the image equally well", "Other poses explain the colours as well."],
  ["outlines?", "silhouette", "Outlines decide."],
  ["limbs?", "occluding contour", "The limbs face inward."],
  ["rims?", "depth discontinuity", "Edges along a rim."],
  ["hues?", "chromaticity", "Hue decides."],
  [
    "structure (?:of|in) (?:the |its )?residuals?",
    "spatial covariance of residuals",
    "The structure of residuals is large.",
  ],
  ["sure of it", "overconfident; confidently wrong", "The run is wrong and sure of it."],
  ["believed", "trusted", "The pose is believed up to a tolerance."],
  ["borne out|bears? (?:it |this )?out", "confirmed", "This is borne out by the tables."],
  ["asks? for", "requires; requests", "The noise asks for a window."],
  ["speaks? (?:for|against|of)", "supports; contradicts; refers to", "Nothing speaks against it."],
  ["doubt(?:s|ed|ful)?", "warning; low confidence", "A doubt caps the verdict."],
  ["(?:is|are) none(?! of)", "is not a rotation; is invalid; is missing", "Its rotation is none."],
  [
    "rooms|the house|floors|(?:this|each|every|other|which|whose) room",
    "module, crate, layer",
    "Each room looks below.",
  ],
  ["by and by", "gradually", "The scale falls by and by."],
  ["a word on", "a note about (or leave it out)", "Files come with a word on each."],
  ["of (?:its|their|his|one's) own", "separate (or leave it out)", "A thread of its own."],
].map(([pattern, say, example]) => ({
  pattern: new RegExp(`(?<![\\w-])(?:${pattern})(?![\\w-])`, "gi"),
  say,
  example,
}));

/** Areas whose comments, messages, visible texts and documents are checked. */
const COVERED = [
  "www",
  "js",
  "python/bimodal_stereo",
  "python/README.md",
  "README.md",
  "CHANGELOG.md",
  "CONTRIBUTING.md",
  "SECURITY.md",
  "examples/README.md",
  "docs/README.md",
  "docs/dev",
  "docs/accuracy.md",
  "docs/performance.md",
  "docs/robustness.md",
  "docs/check.md",
  "docs/hosting.md",
  "docs/guide",
  "docs/method",
  "docs/lab",
];

/**
 * Areas of code in which only comments and docstrings are checked. The string literals of tests and scripts (titles of tests, commands'
 * output) stay unchecked, and those of Rust are mostly checked by way of the packages that show them.
 */
const COMMENTS = [
  "src",
  "files",
  "cli",
  "python/src",
  "python/tests",
  "tests",
  "fuzz/bodies",
  "fuzz/targets",
  "scripts",
  "examples",
  "benches",
  "protocols",
];

/** Files that are not covered yet, because they still use words of the table above. */
const LATER = ["docs/codes.md"];

/** Phrases that stay as they are, each in one file, with the reason. */
const EXCEPTIONS = [
  // This text is in written files, of which tests/fixtures has copies.
  ["js/write/results.ts", "black is none"],
  // Titles of tests.
  ["docs/robustness.md", "is doubted by no other unit"],
  ["docs/robustness.md", "files of one's own"],
  ["docs/robustness.md", "speaks against nobody"],
  ["docs/robustness.md", "arrays that are none or lie about their length"],
  ["docs/robustness.md", "is told of, and the clouds are drawn again once it is back"],
  ["docs/robustness.md", "a link that asks for what can't be says which field is wrong"],
];

const KINDS = new Set([".ts", ".css", ".html", ".py", ".md"]);
const CODE = new Set([".ts", ".tsx", ".mts", ".js", ".mjs", ".html", ".py", ".rs"]);

const filesBelow = (path) =>
  statSync(inRoot(path)).isFile()
    ? [path]
    : readdirSync(inRoot(path), { withFileTypes: true })
        .filter(({ name }) => name !== "node_modules" && name !== "target")
        .flatMap((entry) => filesBelow(join(path, entry.name)));

const matches = (text, pattern) => [...text.matchAll(pattern)].map(({ 0: found, index }) => [index, found]);

/** Comments, and string literals of more than one word: a literal without a space is a key or a code. */
function partsOfScript(name, text, onlyComments) {
  const source = ts.createSourceFile(name, text, ts.ScriptTarget.Latest, true);
  const parts = new Map();
  const visit = (node) => {
    const isText = ts.isStringLiteral(node) || ts.isTemplateLiteralToken(node);
    if (!onlyComments && isText && /\s/.test(node.text)) parts.set(node.getStart(), node.text);
    for (const ranges of [
      ts.getLeadingCommentRanges(text, node.getFullStart()),
      ts.getTrailingCommentRanges(text, node.getEnd()),
    ])
      if (ranges) parts.set(ranges[0].pos, ranges.map(({ pos, end }) => text.slice(pos, end)).join("\n"));
    node.getChildren().forEach(visit);
  };
  visit(source);
  return [...parts];
}

/** Strings, characters and lifetimes of Rust are matched so that what looks like a comment within them is skipped. */
const RUST =
  /(?:\/\/.*(?:\n[ \t]*(?=\/\/))?)+|\/\*[^]*?\*\/|b?r(#*)"[^]*?"\1|"(?:\\[^]|[^"\\])*"|'(?:\\.[^']*|[^'\\])'|'\w+/g;
const PYTHON = /"""[^]*?"""|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|#.*(?:\n[ \t]*#.*)*/g;
const HTML = /<!--[^]*?-->|\/\*[^]*?\*\/|^[ \t]*\/\/.*/gm;

/** The comments and docstrings of a file, each with its position. */
function commentsOf(name, text) {
  switch (extname(name)) {
    case ".rs":
      return matches(text, RUST).filter(([, part]) => /^\/[/*]/.test(part));
    case ".py":
      return matches(text.replaceAll(/\bNone\b/g, "null"), PYTHON).filter(([, part]) => /^(?:"""|#)/.test(part));
    case ".html":
      return matches(text, HTML);
    default:
      return partsOfScript(name, text, true);
  }
}

const ATTRIBUTES = /(?:title|alt|content|placeholder|aria-label|aria-description)="([^"]*)"/g;
const UNRELEASED = /^## \[?Unreleased\]?[^]*?(?=^## |$(?![^]))/gm;

/** Paragraphs, items of lists and rows of tables, without blocks of code and without generated regions. */
const paragraphs = (text) => matches(withoutRegions(withoutCode(text)), /^.+(?:\n(?![-|#\n]).+)*/gm);

/** The texts that people read in a file, each with its position. */
function partsOf(name, text) {
  switch (extname(name)) {
    case ".ts":
      return partsOfScript(name, text, false);
    case ".css":
      return matches(text, /\/\*[^]*?\*\//g);
    case ".html":
      return [...matches(text, /(?<=>)[^<]+/g), ...matches(text, ATTRIBUTES)];
    case ".py":
      // `is None` is code, also between the quotes of two strings.
      return matches(text.replaceAll(/\bNone\b/g, "null"), /"""[^]*?"""|#.*|"[^"\n]* [^"\n]*"/g);
    default:
      return name === "CHANGELOG.md"
        ? matches(text, UNRELEASED).flatMap(([start, section]) =>
            paragraphs(section).map(([at, part]) => [start + at, part]),
          )
        : // The other columns of that page are comments of `src`.
          paragraphs(name === THRESHOLDS ? handWritten(text) : text);
  }
}

const blank = (part) => part.replaceAll(/[^\n]/g, " ");

/** Blanks names of code between backticks and blocks of code, which are not checked. */
const withoutCode = (text) => text.replaceAll(/```[^]*?```|``[^`]*``|`[^`]*`/g, blank);

/** The regions that scripts/docs.mjs fills. */
const withoutRegions = (text) => text.replaceAll(/<!-- begin: [^]*?<!-- end: \w+ -->/g, blank);

function found(name, text, parts = partsOf) {
  const excepted = EXCEPTIONS.filter(([file]) => file === name).map(([, phrase]) => phrase);
  return parts(name, text).flatMap(([start, part]) => {
    // A phrase may continue on the next line of a comment.
    const joined = withoutCode(part).replaceAll(/\s*\n[ \t]*(?:\*|\/\/[/!]?|#)?\s*/g, " ");
    const words = excepted.reduce((rest, phrase) => rest.replaceAll(phrase, ""), joined);
    return RULES.flatMap(({ pattern, say }) =>
      [...words.matchAll(pattern)].map(({ 0: phrase, index }) => {
        const around = words.slice(Math.max(0, index - 30), index + phrase.length + 30);
        return `${name}, from line ${text.slice(0, start).split("\n").length}: "..${around}.."; say ${say}`;
      }),
    );
  });
}

test("visible texts and comments use the terms of the field", () => {
  const names = COVERED.flatMap(filesBelow).filter((name) => KINDS.has(extname(name)));
  assert.ok(names.length > 300, `${names.length} files`);
  const wrong = names.flatMap((name) => found(name, readFileSync(inRoot(name), "utf8")));
  assert.deepEqual(wrong, []);
});

test("comments of the library, tests and scripts use the terms of the field", () => {
  const isCovered = (name) => CODE.has(extname(name)) && !LATER.some((path) => name.startsWith(`${path}/`));
  const names = COMMENTS.flatMap(filesBelow).filter(isCovered);
  assert.ok(names.length > 650, `${names.length} files`);
  const wrong = names.flatMap((name) => found(name, readFileSync(inRoot(name), "utf8"), commentsOf));
  assert.deepEqual(wrong, []);
});

test("areas that are not covered yet, and exceptions, are there", () => {
  for (const path of LATER) assert.ok(statSync(inRoot(path)), path);
  for (const [name, phrase] of EXCEPTIONS)
    assert.ok(readFileSync(inRoot(name), "utf8").includes(phrase), `${name} no longer has "${phrase}"`);
});

test("a sentence that breaks a rule is found wherever people read it", async (t) => {
  const places = [
    ["a.ts", (words) => `/** ${words} */\nexport const a = 1;\n`],
    ["a.ts", (words) => `export const a = (\n  // ${words}\n  1\n);\n`],
    ["a.ts", (words) => `export const a = { b: "${words}" };\n`],
    ["a.ts", (words) => `export const a = (b: number) => \`\${b} of ${words} \${b}\`;\n`],
    ["a.css", (words) => `/* ${words} */\na { color: red; }\n`],
    ["a.html", (words) => `<p>${words}</p>\n`],
    ["a.html", (words) => `<button title="${words}">a</button>\n`],
    ["a.py", (words) => `def a():\n    """${words}"""\n`],
    ["a.py", (words) => `a = 1  # ${words}\n`],
    ["a.md", (words) => `# A\n\n${words}\n`],
    ["CHANGELOG.md", (words) => `# Changelog\n\n## [Unreleased]\n\n- ${words}\n\n## [0.1.0]\n`],
  ];
  for (const { say, example } of RULES)
    await t.test(example, () => {
      for (const [name, write] of places) {
        const wrong = found(name, write(example));
        assert.equal(wrong.length, 1, `${name}: ${write(example)}`);
        assert.ok(wrong[0].endsWith(`say ${say}`), wrong[0]);
      }
    });
});

test("only comments and docstrings of tests, scripts and Rust are checked", () => {
  const words = "A told start is kept.";
  for (const [name, text] of [
    ["a.rs", `//! ${words}\n`],
    ["a.rs", `pub fn a<'a>(b: &'a str) -> char { '"' } // ${words}\n`],
    ["a.rs", `/* ${words} */\nconst A: &str = r#"a "b" // c"#;\n`],
    ["a.mjs", `/** ${words} */\nexport const a = 1;\n`],
    ["a.tsx", `export const a = <b title="c" />; // ${words}\n`],
    ["a.py", `a = "#"  # ${words}\n`],
    ["a.py", `def a():\n    """${words}"""\n`],
    ["a.html", `<!-- ${words} -->\n`],
  ])
    assert.equal(found(name, text, commentsOf).length, 1, text);
  for (const [name, text] of [
    ["a.rs", `const A: [&str; 2] = ["// ${words}", r#"/* ${words} */"#];\n`],
    ["a.mjs", `test("${words}", () => "// ${words}");\n`],
    ["a.py", `a = "# ${words}"\n`],
    ["a.html", `<p>${words}</p>\n`],
  ])
    assert.deepEqual(found(name, text, commentsOf), [], text);
});

test("a phrase over two lines of a comment is found", () => {
  assert.equal(found("a.ts", "/**\n * A thread of\n * its own.\n */\nexport {};\n").length, 1);
  assert.equal(found("a.ts", "// A thread of its\n// own.\nexport {};\n").length, 1);
  assert.equal(found("a.rs", "fn a() {\n    /// A thread of its\n    /// own.\n}\n", commentsOf).length, 1);
  assert.equal(found("a.py", "# A thread of its\n# own.\n", commentsOf).length, 1);
});

test("names of code, other senses of a word and what was released are left alone", () => {
  for (const [name, text] of [
    ["a.ts", "/** `told` and `rim` are names. */\nexport const told = 'rim';\n"],
    ["a.ts", "/** None of these is none of the others. */\nexport const a = 1;\n"],
    ["a.ts", "/** A room with one wall; floor-plan; outlined. */\nexport const floor = Math.floor(1);\n"],
    ["a.md", "A block:\n\n```sh\ntold rim\n```\n"],
    ["a.md", "<!-- begin: tables (written by a command) -->\n\n| told | rim |\n\n<!-- end: tables -->\n"],
    ["CHANGELOG.md", "# Changelog\n\n## [Unreleased]\n\n- Nothing.\n\n## [0.1.0]\n\n- A told start.\n"],
  ])
    assert.deepEqual(found(name, text), [], text);
});
