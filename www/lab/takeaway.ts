/** Results as files of common formats. Loaded when the first is asked for. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { byId } from "../dom";
import type { Taken } from "../engine/protocol";
import { sha256 } from "../hash";
import type { Kind } from "./kinds";
import { dataUrlOf, pngOf, shownIn } from "./pictures";
import { numbersOf } from "./posetable";
import { optionsInWords, type Origin, type Settings } from "./settings";
import type { Verdict } from "./verdict";
import { depthPng, lightCsv, matrixText, normalsPng, poseJson, runReportHtml, writeClouds, writeNpy } from "./write";

/** A run as the page knows it. */
export interface Run {
  taken: Taken;
  report: StepReport;
  /** Nothing while it is not over. */
  end: Verdict | undefined;
  truth: Pose | null;
  origin: Origin;
  settings: Settings;
  /** The visitor's own, with what they were read as. */
  files: readonly { file: File; says: string }[];
  link: string;
}

export interface Made {
  name: string;
  blob: Blob;
  /** What one has to know to read it, such as the unit. */
  says?: string;
}

const made = (name: string, type: string, part: BlobPart, says?: string): Made => ({ name, blob: new Blob([part], { type }), ...(says === undefined ? {} : { says }) });

/** The clouds' inks on the page. */
const [ORANGE, BLUE] = [[199, 100, 26], [11, 98, 184]];

/** Both clouds in the colour view's frame. */
function ply({ imagePoints, depthPoints, unit }: Taken): Uint8Array<ArrayBuffer> {
  const tinted = (name: string, points: Float32Array, ink: readonly number[]) => ({ name, points, colours: Uint8Array.from(points, (_, i) => ink[i % 3] ?? 0) });
  const clouds = [tinted("shape from the picture", imagePoints, ORANGE), tinted("depth map, moved by the pose", depthPoints, BLUE)];
  return writeClouds(clouds, unit === "m" ? "metres" : "pixels");
}

/** Normals are found by the first iteration: before it there are none to save. */
async function normals(name: string, given: { width: number; height: number; normals: Float32Array }): Promise<Made> {
  if (!given.normals.some((value) => Number.isFinite(value) && value !== 0)) throw new Error("there are no normals yet; press Step or Play first.");
  return made(name, "image/png", await normalsPng({ ...given, data: given.normals }), "(n + 1) / 2 of white, x right, y up, z near");
}

/** A file's name of a title. */
const slug = (title: string): string => title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "picture";

/** The picture that is chosen beside the button. */
async function picture(): Promise<Made> {
  const wanted = byId("take-picture", HTMLSelectElement).value;
  const shown = shownIn(byId("lab", HTMLElement)).find(({ title }) => title === wanted);
  if (!shown) throw new Error(`"${wanted}" is not shown at the moment.`);
  return { name: `${slug(shown.title)}.png`, blob: await pngOf(shown.canvas) };
}

async function report(run: Run): Promise<Made> {
  const { taken, report, end, truth, origin, settings, files, link } = run;
  const inputs = await Promise.all(files.map(async ({ file, says }) => ({ name: file.name, says, sha256: await sha256(file) })));
  const words = [end?.words ?? report.message ?? "", end?.next ?? ""].filter(Boolean);
  const html = runReportHtml({
    ...{ tone: end?.tone ?? "open", status: end?.status ?? `not over: iteration ${report.iteration}`, words },
    ...{ pose: taken.pose, truth, unit: taken.unit, light: taken.light },
    numbers: [["Iterations", String(report.iteration)], ...numbersOf(report, taken.unit)],
    options: optionsInWords(settings, origin),
    pictures: shownIn(byId("lab", HTMLElement)).map(({ title, words, canvas }) => ({ title: words ?? title, dataUrl: dataUrlOf(canvas) })),
    ...{ inputs, link, made: new Date() },
  });
  return made("bimodal-stereo-report.html", "text/html", html);
}

export async function fileOfKind(kind: Kind, run: Run): Promise<Made> {
  const { pose, unit, depthUnit, light, depth, image } = run.taken;
  const length = (of: "m" | "px") => (of === "m" ? "metres" : "pixels");
  switch (kind) {
    case "pose":
      return made("pose.json", "application/json", poseJson(pose, unit));
    case "matrix":
      return made("depth_to_colour.txt", "text/plain", matrixText(pose), `lengths in ${length(unit)}`);
    case "clouds":
      return made("clouds.ply", "application/octet-stream", ply(run.taken), length(unit));
    case "depthPng": {
      const { bytes, says } = await depthPng({ ...depth, data: depth.refined }, depthUnit);
      return made("refined-depth.png", "image/png", bytes, `${says} per stored number, 0 is no depth`);
    }
    case "depth":
      return made("refined-depth.npy", "application/octet-stream", writeNpy({ width: depth.width, height: depth.height, channels: 1, data: depth.refined }), length(depthUnit));
    case "normals":
      return normals("normals.png", image);
    case "depthNormals":
      return normals("refined-normals.png", depth);
    case "light":
      return made("light.csv", "text/csv", lightCsv(light));
    case "picture":
      return picture();
    case "report":
      return report(run);
  }
}
