// Checks the calibration of a rig over a folder of frames, for a shell or for continuous integration.
//
// npm run build && node examples/check-folder.mjs --help
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { basename, join, relative, resolve } from "node:path";
import { parseArgs } from "node:util";
import { progress } from "./progress.mjs";

const HELP = `Usage: node examples/check-folder.mjs FOLDER --calibration FILE [options]

Says whether the extrinsics in FILE agree with the frames in FOLDER. FOLDER holds pairs of a colour image and a depth map, with like
names or in the way of TUM RGB-D or Redwood, and the cameras' intrinsics where FILE does not. FILE is a 4x4 matrix in text, YAML or
XML of OpenCV, Kalibr's camchain, a static transform of ROS, or JSON of Open3D or RealSense: P_colour = R P_depth + t.

  --calibration FILE  the extrinsics in question; given again, others to compare with them
  --inverted          FILE carries colour to depth and its names do not say so
  --cameras FILE      intrinsics that lie elsewhere; may be given again
  --unit METRES       metres for each stored unit of the depth maps, 0.001 for millimetres
  --frames N          at most so many pairs, spread over the folder; default 20
  --cues LIST         of shading,edges,information,silhouette; default all
  --workers N         threads, 1 to 16; default 1
  --json OUT          writes the report as JSON; - is the standard output
  --report OUT.html   writes the report as a page that can be read and printed anywhere
  --help

Exit code: 0 consistent, 1 off, 2 undecided or settled with a warning, 3 the input is bad or the check could not run, 130 interrupted.
`;

const CODES = { consistent: 0, off: 1, undecided: 2 };
const BAD = 3;
const INTERRUPTED = 130;

/** Bytes that a folder may hold, since all of it is read: some hundreds of pairs. */
const MOST_BYTES = 2 ** 31;
/** The example runs from the folder that npm run build leaves. */
const PACKAGE = new URL("../pkg/", import.meta.url);

/** What the user can mend: its message says it all. */
class Mistake extends Error {}

function parsed(args) {
  const text = { type: "string" };
  const many = { type: "string", multiple: true };
  const options = {
    ...{
      calibration: many,
      cameras: many,
      cues: text,
      frames: text,
      json: text,
      report: text,
      unit: text,
      workers: text,
    },
    ...{ inverted: { type: "boolean" }, help: { type: "boolean", short: "h" } },
  };
  try {
    return parseArgs({ args, options, allowPositionals: true });
  } catch (error) {
    throw new Mistake(error.message);
  }
}

function number(values, name) {
  if (values[name] === undefined) return {};
  const value = Number(values[name]);
  if (values[name].trim() === "" || !Number.isFinite(value))
    throw new Mistake(`--${name} needs a number, not "${values[name]}"`);
  return { [name]: value };
}

async function modules() {
  const load = (name) => import(new URL(name, PACKAGE).href);
  try {
    return { ...(await load("rig.js")), ...(await load("rig-write.js")), ...(await load("index.js")) };
  } catch (error) {
    if (error.code !== "ERR_MODULE_NOT_FOUND") throw error;
    throw new Mistake(
      `this build of the package cannot check a rig: type npm run build (${error.message.split("\n")[0]})`,
    );
  }
}

const file = (path, name = path) => ({ name: name.replaceAll("\\", "/"), bytes: new Uint8Array(readFileSync(path)) });

/** The files below a folder by name, hidden ones left out; those of `except` as well. */
function filesOf(folder, except) {
  const paths = readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name))
    .filter(
      (path) =>
        !relative(folder, path)
          .split(/[\\/]/)
          .some((part) => part.startsWith(".")) && !except.has(resolve(path)),
    )
    .sort();
  const bytes = paths.reduce((sum, path) => sum + statSync(path).size, 0);
  if (bytes > MOST_BYTES) {
    throw new Mistake(
      `${folder} holds ${(bytes / 2 ** 30).toFixed(1)} GB, and at most ${MOST_BYTES / 2 ** 30} are read: copy some of its pairs into a folder of their own`,
    );
  }
  return paths.map((path) => file(path, relative(folder, path)));
}

const COLOUR = /colou?r|rgb/i;
const DEPTH = /depth|infra|\bir\b|tof/i;
const isBackwards = ({ from = "", to = "" }) =>
  COLOUR.test(from) && !DEPTH.test(from) && DEPTH.test(to) && !COLOUR.test(to);

/** The motion back; angles of R = Rx Ry Rz in degrees. */
function inverse({ scale, rotation: r, translation: t }) {
  const rotation = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((k) => r[k]);
  const translation = [0, 1, 2].map(
    (i) => -(rotation[3 * i] * t[0] + rotation[3 * i + 1] * t[1] + rotation[3 * i + 2] * t[2]),
  );
  const degrees = (y, x) => (Math.atan2(y, x) * 180) / Math.PI;
  const angles = {
    alpha: degrees(-rotation[5], rotation[8]),
    beta: degrees(rotation[2], Math.hypot(rotation[0], rotation[1])),
    gamma: degrees(-rotation[1], rotation[0]),
  };
  return { scale, rotation, translation, angles };
}

/** The poses of all calibrations by name, that in question first. */
function candidatesOf(readings, isInverted, warnings) {
  const candidates = {};
  for (const { name, poses = [] } of readings) {
    if (poses.length === 0) throw new Mistake(`${name}: it holds no extrinsics`);
    poses.forEach((pose, index) => {
      const own = pose.name ?? (pose.from && pose.to ? `${pose.from} to ${pose.to}` : `pose ${index + 1}`);
      const title = poses.length === 1 ? basename(name) : `${basename(name)}, ${own}`;
      const turns = isInverted || isBackwards(pose);
      if (turns && !isInverted)
        warnings.push(`${name}: it carries ${pose.from} to ${pose.to}; its inverse was checked.`);
      // Two files may have one name; a number as a name would come first.
      let unique = /^\d+$/.test(title) ? `"${title}"` : title;
      while (Object.hasOwn(candidates, unique)) unique += "'";
      candidates[unique] = turns ? inverse(pose.pose) : pose.pose;
    });
  }
  return candidates;
}

const short = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(3))) : "?");
const percent = (share) => `${(100 * share).toFixed(0)} %`;
const pixels = ({ pixels: value, interval }) => `${short(value)} (${short(interval[0])} to ${short(interval[1])})`;

/** Columns as wide as their widest cell. */
function table(rows) {
  const widths = rows[0].map((_, column) => Math.max(...rows.map((row) => row[column].length)));
  return rows.map((row) =>
    row
      .map((cell, column) => cell.padEnd(widths[column]))
      .join("  ")
      .trimEnd(),
  );
}

/** The report with what the readers guessed, which keeps its verdict from green as the check's own warnings do. */
function capped(report, warnings) {
  if (report.verdict !== "consistent" || warnings.length === 0) return { ...report, warnings };
  return { ...report, warnings, verdict: "undecided", reason: `Settled, but check: ${warnings[0]} ${report.reason}` };
}

/** The verdict, whose reason may open with the same word. */
const headline = ({ verdict, reason }) => `${verdict.toUpperCase()}: ${reason.replace(/^consistent: /i, "")}`;

/** The report for a terminal. */
function text(report) {
  const {
    estimate: { rotation: r, translation: t },
  } = report;
  const candidates = Object.entries(report.candidates).map(([name, found]) => [
    ...[name, found.verdict, `${short(found.offDegrees)} deg`, `${short(found.offMillimetres)} mm`],
    ...[pixels(found), short(found.probability)],
  ]);
  return [
    headline(report),
    "",
    ...table([
      ["calibration", "verdict", "turned by", "shifted by", "error, pixels (95 %)", "probability"],
      ...candidates,
      ["best fit", "", "", "", pixels(report.health), ""],
    ]),
    "",
    "best fit, P_colour = R P_depth + t, metres:",
    ...[0, 1, 2].map((i) => `  ${[...r.slice(3 * i, 3 * i + 3), t[i]].join(" ")}`),
    "  0 0 0 1",
    "",
    `cues: ${Object.entries(report.cues)
      .map(([name, { share }]) => `${name} ${percent(share)}`)
      .join(", ")}`,
    `frames: ${report.frames.map(({ name, share, note }) => `${name} ${percent(share)}${note ? ` (${note})` : ""}`).join(", ")}`,
    ...report.warnings.map((warning) => `warning: ${warning}`),
    "",
  ].join("\n");
}

const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** What was read, with the hashes by which it can be told later. */
function inputsOf(readings, files) {
  const bytes = new Map(files.map((each) => [each.name, each.bytes]));
  const seen = new Map(
    readings
      .filter(({ name }) => bytes.has(name))
      .map(({ name, says }) => [name, { name, says, sha256: sha256(bytes.get(name)) }]),
  );
  return [...seen.values()];
}

async function run(args) {
  const { values, positionals } = parsed(args);
  if (values.help) return void process.stdout.write(HELP);
  const [folder, ...rest] = positionals;
  if (folder === undefined || rest.length > 0)
    throw new Mistake(`one folder is needed, not ${positionals.length}; --help says more`);
  if (!values.calibration) throw new Mistake("--calibration FILE is needed; --help says more");
  const options = {
    ...number(values, "workers"),
    ...(values.cues !== undefined && { cues: values.cues.split(",").map((cue) => cue.trim()) }),
  };
  const reading = { ...number(values, "frames"), ...number(values, "unit") };
  const { default: init, checkCalibration, readRigFile, readRigFolder, reportHtml } = await modules();

  const calibrations = values.calibration.map((path) => file(path));
  const cameras = (values.cameras ?? []).map((path) => file(path));
  const found = [];
  for (const each of calibrations) found.push(await readRigFile(each));
  const warnings = found.flatMap((each) => each.warnings.map((warning) => `${each.name}: ${warning}`));
  const candidates = candidatesOf(found, values.inverted === true, warnings);
  // Intrinsics that were named go before those that lie in the folder.
  const named = [...cameras, ...calibrations.filter((_, index) => found[index].kind === "cameras")];
  const files = filesOf(
    folder,
    new Set([...values.calibration, ...(values.cameras ?? [])].map((path) => resolve(path))),
  );
  const read = await readRigFolder([...named, ...files], reading);
  if (read.frames.length === 0)
    throw new Mistake(
      `${folder} holds no pair of a colour image and a depth map that could be read${read.warnings[0] ? `: ${read.warnings[0]}` : ""}`,
    );

  await init();
  const stop = new AbortController();
  const interrupt = () => stop.abort();
  process.once("SIGINT", interrupt);
  const bar = progress(process.stderr);
  let report;
  try {
    report = await checkCalibration(read.frames, candidates, { ...options, signal: stop.signal, onProgress: bar.show });
  } finally {
    bar.end();
    process.removeListener("SIGINT", interrupt);
  }

  const whole = capped(report, [
    ...new Set([...report.warnings.map(({ message }) => message), ...warnings, ...read.warnings]),
  ]);
  const inputs = inputsOf([...found, ...(read.readings ?? [])], [...calibrations, ...cameras, ...files]);
  const json = () => `${JSON.stringify({ ...whole, inputs }, null, 2)}\n`;
  if (values.json !== undefined && values.json !== "-") writeFileSync(values.json, json());
  if (values.report !== undefined) {
    writeFileSync(
      values.report,
      reportHtml(whole, [], { title: `Check of ${basename(values.calibration[0])}`, made: new Date(), inputs }),
    );
  }
  (values.json === "-" ? process.stderr : process.stdout).write(text(whole));
  if (values.json === "-") process.stdout.write(json());
  process.exitCode = CODES[whole.verdict] ?? BAD;
}

try {
  await run(process.argv.slice(2));
} catch (error) {
  // Node's own code for what goes wrong is 1, which means "off" here.
  const isAbort = error?.name === "AbortError";
  const isForeseen = error instanceof Mistake || error?.name === "BimodalError" || error?.syscall !== undefined;
  process.stderr.write(`${isAbort ? "interrupted" : isForeseen ? error.message : (error?.stack ?? error)}\n`);
  process.exitCode = isAbort ? INTERRUPTED : BAD;
}
