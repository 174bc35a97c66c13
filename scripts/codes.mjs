// node scripts/codes.mjs: writes docs/codes.md, the meaning and the remedy of every code, from src/codes.json, which the page and the
// command line also read. tests/contract/codes.test.mjs checks that both agree.
import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { inRoot, say } from "./shell.mjs";

export const DOCUMENT = "docs/codes.md";

const GROUPS = {
  runs: [
    "Ends of a run",
    '`report.reason.code` in JavaScript, `report.reason["code"]` in Python and in the command line\'s JSON, `Reason::code()` in Rust. A reason holds its numbers beside its code. The first four codes belong to runs that continue.',
  ],
  checks: [
    "Verdicts of a calibration check",
    "`code` of a check's report and of each of its candidates, `CheckReason::code()` in Rust.",
  ],
  warnings: [
    "Warnings of a calibration check",
    '`code` of each entry of `warnings`, beside its `message`, its `field` and its numbers; `WarningKind::code()` in Rust. Any of them keeps a verdict from being "consistent".',
  ],
  estimators: [
    "Warnings of an estimator",
    "`code` of each entry of `Estimator.warnings` in JavaScript, which the console shows once, too.",
  ],
  readers: [
    "Warnings of the readers of files",
    '`code` of each entry of `warnings` of `readRigFile` and `readRigFolder`, and of the command `check`. Those with `isDoubt` keep a verdict from being "consistent"; the others name what was left out.',
  ],
  errors: [
    "Errors",
    "`code` of a `BimodalError`, with a `message` and, where they help, `field`, `index` and `value`; `ErrorKind::code()` in Rust.",
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
