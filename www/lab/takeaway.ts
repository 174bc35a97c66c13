/** Results as files in common formats. Loaded with the first download. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { byId } from "../dom";
import { GONE, onGone } from "../engine/alive";
import type { Taken } from "../engine/protocol";
import { sha256 } from "../hash";
import type { Kind } from "./kinds";
import type { FileAnswer, FileRequest, LargeKind } from "./files-thread";
import { dataUrlOf, pngOf, shownIn } from "./pictures";
import { numbersOf } from "./posetable";
import { optionsInWords, type Origin, type Settings } from "./settings";
import type { Verdict } from "./verdict";
import { lightCsv, matrixText, poseJson, runReportHtml } from "./write";

/** A run with the information that the page has about it. */
export interface Run {
  taken: Taken;
  report: StepReport;
  /** Undefined until the run has ended. */
  end: Verdict | undefined;
  truth: Pose | null;
  origin: Origin;
  settings: Settings;
  /** The visitor's files, with descriptions of how they were read. */
  files: readonly { file: File; says: string }[];
  link: string;
}

export interface Made {
  name: string;
  blob: Blob;
  /** Information for the reader of the file, such as the unit. */
  says?: string;
}

const made = (name: string, type: string, part: BlobPart, says?: string): Made => ({
  name,
  blob: new Blob([part], { type }),
  ...(says === undefined ? {} : { says }),
});

/** Kinds that are made in a separate thread. */
function madeApart(kind: LargeKind, taken: Taken): Promise<Extract<FileAnswer, { bytes: Uint8Array }>> {
  const worker = new Worker(new URL("./files-thread.ts", import.meta.url), { type: "module" });
  const answer = new Promise<Extract<FileAnswer, { bytes: Uint8Array }>>((resolve, reject) => {
    onGone(worker, () => reject(new Error(GONE)));
    worker.onmessage = ({ data }: MessageEvent<FileAnswer>) =>
      "fault" in data ? reject(new Error(data.fault.message)) : resolve(data);
    worker.onerror = (event) => {
      event.preventDefault();
      reject(new Error(event.message || "the code that writes the file could not be loaded."));
    };
  });
  const { imagePoints, depthPoints, image, depth } = taken;
  const arrays = [imagePoints, depthPoints, image.normals, depth.refined, depth.normals];
  worker.postMessage({ kind, taken } satisfies FileRequest, [
    ...new Set(arrays.map(({ buffer }) => buffer as ArrayBuffer)),
  ]);
  return answer.finally(() => worker.terminate());
}

const hasNormals = (normals: Float32Array): boolean => normals.some((value) => Number.isFinite(value) && value !== 0);

const FILES: Readonly<Record<LargeKind, { name: string; type: string }>> = {
  clouds: { name: "clouds.ply", type: "application/octet-stream" },
  depth: { name: "refined-depth.npy", type: "application/octet-stream" },
  depthPng: { name: "refined-depth.png", type: "image/png" },
  normals: { name: "normals.png", type: "image/png" },
  depthNormals: { name: "refined-normals.png", type: "image/png" },
};

/** The file name for a title. */
const slug = (title: string): string =>
  title
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-|-$/g, "") || "picture";

/** The picture that is chosen beside the button. */
async function picture(): Promise<Made> {
  const wanted = byId("take-picture", HTMLSelectElement).value;
  const shown = shownIn(byId("lab", HTMLElement)).find(({ title }) => title === wanted);
  if (!shown) throw new Error(`"${wanted}" is not shown at the moment.`);
  return { name: `${slug(shown.title)}.png`, blob: await pngOf(shown.canvas) };
}

async function report(run: Run): Promise<Made> {
  const { taken, report, end, truth, origin, settings, files, link } = run;
  const inputs = await Promise.all(
    files.map(async ({ file, says }) => ({ name: file.name, says, sha256: await sha256(file) })),
  );
  const shown = shownIn(byId("lab", HTMLElement));
  const pictures = await Promise.all(
    shown.map(async ({ title, words, canvas }) => ({ title: words ?? title, dataUrl: await dataUrlOf(canvas) })),
  );
  // After a good end the advice is about the page's controls, which the report does not have.
  const advice = end?.tone === "good" ? "" : (end?.next ?? "");
  const words = [end?.words ?? report.message ?? "", advice].filter(Boolean);
  const html = runReportHtml({
    ...{ tone: end?.tone ?? "open", status: end?.status ?? `not finished: iteration ${report.iteration}`, words },
    ...{ pose: taken.pose, truth, unit: taken.unit, light: taken.light },
    numbers: [["Iterations", String(report.iteration)], ...numbersOf(report, taken.unit)],
    options: optionsInWords(settings, origin),
    pictures,
    ...{ inputs, link, made: new Date() },
  });
  return made("bimodal-stereo-report.html", "text/html", html);
}

/** The run itself, to resume later. */
export const fileOfRun = (bytes: Uint8Array): Made =>
  made(
    "run.bimodal",
    "",
    bytes as Uint8Array<ArrayBuffer>,
    "drop it on this page to resume from here; it holds both views and the options",
  );

export async function fileOfKind(kind: Exclude<Kind, "run">, run: Run): Promise<Made> {
  const { pose, unit, light, depth, image } = run.taken;
  switch (kind) {
    case "pose":
      return made("pose.json", "application/json", poseJson(pose, unit, run.report));
    case "matrix":
      return made(
        "depth_to_colour.txt",
        "text/plain",
        matrixText(pose),
        `lengths in ${unit === "m" ? "metres" : "pixels"}`,
      );
    case "light":
      return made("light.csv", "text/csv", lightCsv(light));
    case "picture":
      return picture();
    case "report":
      return report(run);
    default: {
      // Only the first iteration computes these results.
      const normals = {
        normals: image.normals,
        depthNormals: depth.normals,
        clouds: undefined,
        depth: undefined,
        depthPng: undefined,
      }[kind];
      if (normals && !hasNormals(normals)) throw new Error("there are no normals yet; press Step or Play first.");
      const { bytes, says } = await madeApart(kind, run.taken);
      return made(FILES[kind].name, FILES[kind].type, bytes, says);
    }
  }
}
