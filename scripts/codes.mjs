// node scripts/codes.mjs: writes docs/codes.md, the meaning and the remedy of every code, from src/codes.json, which the page and the
// command line also read. tests/contract/codes.test.mjs checks that both agree.
import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { inRoot, say } from "./shell.mjs";

export const DOCUMENT = "docs/codes.md";

const GROUPS = {
  runs: [
    "Ends of a run",
    'The code is `report.reason.code` in JavaScript, `report.reason["code"]` in Python and in the command line\'s JSON, and `Reason::code()` in Rust. A reason holds its numbers beside its code. The first four codes belong to runs that continue.',
  ],
  checks: [
    "Verdicts of a calibration check",
    "A check's report and each of its candidates have such a `code`. In Rust it is `CheckReason::code()`.",
  ],
  warnings: [
    "Warnings of a calibration check",
    'Each entry of `warnings` has such a `code` beside its `message`, its `field` and its numbers. In Rust it is `WarningKind::code()`. Any warning keeps a verdict from being "consistent".',
  ],
  estimators: [
    "Warnings of an estimator",
    "Each entry of `Estimator.warnings` in JavaScript has such a `code`. The console shows each warning once, too.",
  ],
  readers: [
    "Warnings of the readers of files",
    'Each entry of `warnings` has such a `code`, whether it comes from `readRigFile`, from `readRigFolder` or from the command `check`. Those with `isDoubt` keep a verdict from being "consistent"; the others name what was left out.',
  ],
  errors: [
    "Errors",
    "A `BimodalError` has such a `code`, a `message` and, where they help, `field`, `index` and `value`. In Rust the code is `ErrorKind::code()`.",
  ],
};

/** Rows of readers also state whether the code caps a check's verdict. */
const row = ([code, { cause, remedy, harmless }]) =>
  `| \`${code}\` | ${cause}${harmless ? " Caps no verdict." : ""} | ${remedy} |`;

/** The document for a table of codes. */
export function documentOf(table) {
  const sections = Object.entries(GROUPS).flatMap(([group, [title, words]]) => [
    `## ${title}`,
    "",
    words,
    "",
    "| code | cause | remedy |",
    "|---|---|---|",
    ...Object.entries(table[group]).map(row),
    "",
  ]);
  return [
    "# Codes",
    "",
    "Programs should use the codes, which are stable. The sentences are for people and may change.",
    "",
    ...sections,
  ].join("\n");
}

if (import.meta.filename === realpathSync(process.argv[1])) {
  writeFileSync(inRoot(DOCUMENT), documentOf(JSON.parse(readFileSync(inRoot("src/codes.json"), "utf8"))));
  say(`wrote ${DOCUMENT}`);
}
