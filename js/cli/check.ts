/** The command `check`: the calibration of a rig over a folder of frames, for a shell and for continuous integration. */
import { writeFileSync } from "node:fs";
import { reasonOf } from "../errors.js";
import { posesForClouds } from "../rig/turned.js";
import type { NamedFile, RigReading } from "../rig/types.js";
import type { CheckFrame, CheckReport } from "../types/index.js";
import { type Arguments, Mistake } from "./arguments.js";
import { candidatesOf } from "./candidates.js";
import { file, filesOf, inputsOf } from "./files.js";
import { pageOptions } from "./page.js";
import { progress } from "./progress.js";
import { type Judged, capped, ofReader, textOf } from "./report.js";

const CODES: Record<string, number> = { consistent: 0, off: 1, undecided: 2 };
export const BAD = 3;

/** The modules of the check, loaded only when needed: printing the manual loads none of them. */
async function modules() {
  const [main, rig, write] = await Promise.all([
    import("../index.js"),
    import("../rig/index.js"),
    import("../rig/write/index.js"),
  ]);
  return { ...main, ...rig, ...write };
}
type Modules = Awaited<ReturnType<typeof modules>>;

/** Runs the check with a progress bar; an interrupt ends it. */
async function checked(
  { checkCalibration }: Modules,
  frames: Parameters<Modules["checkCalibration"]>[0],
  candidates: Parameters<Modules["checkCalibration"]>[1],
  options: Arguments["checking"],
): Promise<CheckReport> {
  const stop = new AbortController();
  const interrupt = () => stop.abort();
  process.once("SIGINT", interrupt);
  const bar = progress(process.stderr);
  try {
    return await checkCalibration(frames, candidates, { ...options, signal: stop.signal, onProgress: bar.show });
  } finally {
    bar.end();
    process.removeListener("SIGINT", interrupt);
  }
}

/** An error as `--json` prints it. */
function errorJson(error: unknown): string {
  const { name, code, field } = error as { name?: unknown; code?: unknown; field?: unknown };
  let known: { code: unknown; field?: unknown } = { code: "internal" };
  if (error instanceof Mistake || name === "BimodalError") known = { code, field };
  // The error if the system does not open a file or a folder.
  else if (error instanceof Error && "syscall" in error) known = { code: "file", field: "file" };
  return `${JSON.stringify({ error: { ...known, message: reasonOf(error) } }, null, 2)}\n`;
}

/** The exit code. With `--json -` an error is printed as JSON as well. */
export async function check(args: Arguments): Promise<number> {
  try {
    return await checkFolder(args);
  } catch (error) {
    const isAbort = error instanceof Error && error.name === "AbortError";
    if (args.json === "-" && !isAbort) process.stdout.write(errorJson(error));
    throw error;
  }
}

/** Intrinsics given by an option must exist. */
async function checkCameras(cameras: NamedFile[], { readRigFile }: Modules): Promise<void> {
  for (const each of cameras) {
    const found = await readRigFile(each);
    if (found.kind !== "cameras" || found.cameras.length === 0)
      throw new Mistake(`${each.name}: it contains no intrinsics`, "file");
  }
}

/** Renames frames whose names are numbers alone, because "0: 48 % .." is hard to read. The number of the file stays in parentheses. */
const namedByNumber = (frames: CheckFrame[]): CheckFrame[] =>
  frames.map((frame, index) =>
    /^\d+$/.test(frame.name ?? "") ? { ...frame, name: `frame ${index + 1} (${frame.name})` } : frame,
  );

async function checkFolder(args: Arguments): Promise<number> {
  const loaded = await modules();
  const calibrations = args.calibrations.map((path) => file(path));
  const cameras = args.cameras.map((path) => file(path));
  await checkCameras(cameras, loaded);
  const found: RigReading[] = [];
  for (const each of calibrations) found.push(await loaded.readRigFile(each));
  const warnings: Judged[] = found.flatMap(({ name, warnings: own }) =>
    own.map((each) => ({ ...ofReader(each), message: `${name}: ${each.message}`, field: name })),
  );
  const candidates = candidatesOf(found, args.isInverted, warnings);
  // Intrinsics given by an option precede those in the folder.
  const named = [...cameras, ...calibrations.filter((_, index) => found[index]?.kind === "cameras")];
  const files = filesOf(args.folder, [...args.calibrations, ...args.cameras]);
  const read = await loaded.readRigFolder([...named, ...files], args.reading);
  if (read.frames.length === 0) {
    const first = read.warnings[0] ? `: ${read.warnings[0].message}` : "";
    throw new Mistake(`${args.folder}: it contains no readable pair of a colour image and a depth map${first}`, "file");
  }
  const frames = namedByNumber(read.frames);
  const given = Object.entries(candidates).map(([name, pose]) => ({ name, pose }));
  const poses = posesForClouds(given, frames, read.warnings);
  const judged = Object.fromEntries(poses.map(({ name = "", pose }) => [name, pose]));
  const report = await checked(loaded, frames, judged, args.checking);
  const whole = capped(report, [...report.warnings, ...warnings, ...read.warnings.map(ofReader)]);
  const inputs = inputsOf([...found, ...read.readings], [...calibrations, ...cameras, ...files] as NamedFile[]);
  await write(loaded, args, { whole, frames, poses, inputs });
  return CODES[whole.verdict] ?? BAD;
}

async function write(
  { reportHtml, projectFrame }: Modules,
  args: Arguments,
  outcome: Parameters<typeof pageOptions>[1],
): Promise<void> {
  const { whole } = outcome;
  const inputs = outcome.inputs.map(({ name, says, sha256 }) => ({ name, says, sha256 }));
  const json = () => `${JSON.stringify({ ...whole, inputs }, null, 2)}\n`;
  // The output files are opened before the check, so that a file that cannot be written is reported at once.
  (args.json === "-" ? process.stderr : process.stdout).write(textOf(whole));
  if (args.json !== undefined && args.json !== "-") writeFileSync(args.json, json());
  if (args.report !== undefined)
    writeFileSync(args.report, reportHtml(whole as CheckReport, [], await pageOptions(args, outcome, projectFrame)));
  if (args.json === "-") process.stdout.write(json());
}
