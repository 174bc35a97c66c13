/** The contents of the HTML report besides the numbers: the overlay, the files, the options, the versions, the command. */
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import type { NamedPose } from "../rig/types.js";
import { shellCheck } from "../rig/write/report/command.js";
import type { Overlay, ReportOptions } from "../rig/write/index.js";
import type { CheckFrame, CheckReport, FrameOverlay, Pose } from "../types/index.js";
import { writePng } from "../write/png.js";
import type { Arguments } from "./arguments.js";
import type { Input } from "./files.js";
import type { Whole } from "./report.js";
import { versionOf } from "./version.js";

/** Largest width of the report's pictures in pixels, and largest number of frames in the report. */
const [WIDEST, MOST_FRAMES] = [640, 3];

/** Integers of 8 or 16 bits, or linear floats, as bytes. */
function bytesOf({ data }: CheckFrame["image"]): (index: number) => number {
  if (data instanceof Float32Array) return (index) => 255 * Math.max(0, data[index] ?? 0) ** (1 / 2.2);
  const scale = data instanceof Uint16Array ? 1 / 257 : 1;
  return (index) => scale * (data[index] ?? 0);
}

/** The image for a report, subsampled: this is enough to show where its edges are. */
async function pictureOf(image: CheckFrame["image"]): Promise<string> {
  const step = Math.max(1, Math.ceil(image.width / WIDEST));
  const [width, height] = [Math.ceil(image.width / step), Math.ceil(image.height / step)];
  const channels = image.data.length / (image.width * image.height);
  const at = bytesOf(image);
  const data = new Uint8ClampedArray(3 * width * height);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const from = channels * step * (row * image.width + column);
      for (let c = 0; c < 3; c++) data[3 * (row * width + column) + c] = at(from + c);
    }
  }
  const png = await writePng({ width, height, channels: 3, data });
  return `data:image/png;base64,${Buffer.from(png).toString("base64")}`;
}

type Project = (frame: CheckFrame, pose: Pose) => Promise<FrameOverlay>;

/** The most informative frames, after the first one. */
async function overlaysOf(
  report: CheckReport,
  frames: CheckFrame[],
  poses: NamedPose[],
  project: Project,
): Promise<Overlay[]> {
  const order = [...report.frames.keys()].sort(
    (a, b) => (report.frames[b]?.share ?? 0) - (report.frames[a]?.share ?? 0),
  );
  const overlays: Overlay[] = [];
  for (const index of order.slice(0, MOST_FRAMES)) {
    const frame = frames[index];
    if (!frame) continue;
    const { width, height } = frame.image;
    const [given] = poses;
    const after = (await project(frame, report.estimate)).edges;
    const before = given && (await project(frame, given.pose)).edges;
    overlays.push({
      frame: report.frames[index]?.name ?? "",
      width,
      height,
      picture: await pictureOf(frame.image),
      before,
      after,
    });
  }
  return overlays;
}

/** The options of the check with their values, including defaults. */
const settingsOf = ({ checking, reading, isInverted }: Arguments): NonNullable<ReportOptions["settings"]> => [
  ["cues", checking.cues?.join(",") ?? "all"],
  ["frames", `at most ${reading.frames ?? 20}`],
  ["unit", reading.unit === undefined ? "as the files state it or as guessed" : `${reading.unit} m`],
  ["inverted", isInverted ? "yes" : "no"],
  ["threads", String(checking.workers ?? 1)],
];

const hash = (path: URL): string => createHash("sha256").update(readFileSync(path)).digest("hex");

export const versionsOf = (): NonNullable<ReportOptions["versions"]> => [
  ["bimodal-stereo", versionOf()],
  ["wasm", `SHA-256 ${hash(new URL("./bimodal_stereo_check_bg.wasm", import.meta.url)).slice(0, 16)}`],
  ["Node", `${process.version} on ${process.platform} ${process.arch}`],
];

const shellOf = ({ folder, calibrations, cameras, isInverted, reading, checking }: Arguments): string =>
  shellCheck({ folder, calibrations, cameras, isInverted, ...reading, ...checking });

interface Checked {
  whole: Whole;
  frames: CheckFrame[];
  /** The candidates in their order. */
  poses: NamedPose[];
  inputs: Input[];
}

/** The options of `reportHtml`. */
export async function pageOptions(
  args: Arguments,
  { whole, frames, poses, inputs }: Checked,
  project: Project,
): Promise<ReportOptions> {
  return {
    title: `Check of ${basename(args.calibrations[0] ?? "")}`,
    made: new Date(),
    inputs,
    calibrations: Object.fromEntries(poses.map(({ name = "", pose }) => [name, pose])),
    overlays: await overlaysOf(whole as CheckReport, frames, poses, project),
    shell: { command: shellOf(args), note: "Names of files and folders are relative to the folder in which it ran." },
    settings: settingsOf(args),
    versions: versionsOf(),
  };
}
