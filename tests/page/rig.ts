/** For tests of "Check a rig": generated files, and a check whose answer the test determines. */

import { type Page, expect } from "@playwright/test";
import { encode } from "fast-png";
import type { CheckReport } from "../../pkg/index.js";

/** An 8-bit colour image of a box in front of a wall. */
export function colourPng(width = 160, height = 120): Buffer {
  const data = new Uint8Array(3 * width * height);
  for (let i = 0; i < width * height; i++) {
    const [column, row] = [i % width, Math.floor(i / width)];
    const inside = Math.abs(column - width / 2) < width / 5 && Math.abs(row - height / 2) < height / 5;
    data.fill(inside ? 200 - ((column + row) % 7) : 90, 3 * i, 3 * i + 3);
  }
  return Buffer.from(encode({ width, height, channels: 3, data }));
}

/** A 16-bit depth map of the same scene in millimetres. */
export function depthPng(width = 160, height = 120): Buffer {
  const data = Uint16Array.from({ length: width * height }, (_, i) => {
    const [column, row] = [i % width, Math.floor(i / width)];
    return Math.abs(column - width / 2) < width / 5 && Math.abs(row - height / 2) < height / 5 ? 1000 : 1300;
  });
  return Buffer.from(encode({ width, height, channels: 1, depth: 16, data }));
}

export const pair = (name = "0001") => [
  { name: `color_${name}.png`, mimeType: "image/png", buffer: colourPng() },
  { name: `depth_${name}.png`, mimeType: "image/png", buffer: depthPng() },
];

/** Adds files of this many frames, and the depth camera, which they do not name, by its field of view. */
export async function giveFiles(
  page: Page,
  files: readonly { name: string; mimeType: string; buffer: Buffer }[],
  frames = 1,
): Promise<void> {
  await page
    .locator("#rig input[type=file]:not([webkitdirectory])")
    .first()
    .setInputFiles([...files]);
  await expect(page.locator(".rig-frame")).toHaveCount(frames);
  const depth = page.getByRole("group", { name: "Depth camera" });
  await depth.getByLabel("Source of its parameters").selectOption("typed");
  await depth.getByLabel("Given as").selectOption("view");
  await depth.getByLabel("Horizontal field of view, °").fill("60");
}

export const matrixFile = (name: string, tx: number) => ({
  name,
  mimeType: "text/plain",
  buffer: Buffer.from(`1 0 0 ${tx}\n0 1 0 0\n0 0 1 0\n0 0 0 1\n`),
});

const AXES = ["rx", "ry", "rz", "tx", "ty", "tz"] as const;

/** A report in the form of the check's, about these candidates and frames. */
export function reportOf(
  verdict: CheckReport["verdict"],
  candidates: string[],
  frames: string[],
  overlap = 0.87,
): CheckReport {
  const offsets = Array.from({ length: 41 }, (_, i) => i - 20);
  const candidate = (i: number) => ({
    verdict: i === 0 ? verdict : ("off" as const),
    code: overlap < 0.15 ? ("little-overlap" as const) : ("off-target" as const),
    reason: `It is ${2 + i}.04 degrees off about y; the limit is 3.5 px.`,
    offDegrees: 2.04 + i,
    offMillimetres: 1.2,
    offAxes: [0, 2.04 + i, 0, 0, 0, 1.2] as [number, number, number, number, number, number],
    pixels: 10.7 + i,
    interval: [9.8 + i, 11.6 + i] as [number, number],
    probability: 0.0001,
  });
  const covariance = Array.from({ length: 36 }, (_, i) => (i % 7 === 0 ? (i < 18 ? 2e-6 : i === 35 ? 3e-5 : 1e-6) : 0));
  const codes = { consistent: "within-tolerance", off: "off-target", undecided: "unconstrained" } as const;
  return {
    verdict,
    code: codes[verdict],
    reason:
      verdict === "off"
        ? "It is 2.04 degrees off about y; the limit is 3.5 px."
        : verdict === "undecided"
          ? "All of the scene lies on one plane."
          : "It agrees with all frames.",
    warnings: [],
    estimate: {
      scale: 1,
      rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1],
      translation: [0.05, 0.002, -0.003],
      angles: { alpha: 0, beta: 0, gamma: 0 },
      matrix: [
        [1, 0, 0, 0.05],
        [0, 1, 0, 0.002],
        [0, 0, 1, -0.003],
        [0, 0, 0, 1],
      ],
    },
    overlap,
    middle: [0, 0, 1.1],
    covariance,
    health: { pixels: 0.42, interval: [0.21, 0.83] },
    tolerance: 3.5,
    candidates: Object.fromEntries(candidates.map((name, i) => [name, candidate(i)])),
    cues: {
      edges: { share: 0.55, sharpness: 1.9 },
      information: { share: 0.3, sharpness: 1.1 },
      shading: { share: 0.1, sharpness: 0.7 },
      silhouette: { share: 0.05, sharpness: 0.4 },
    },
    frames: frames.map((name, i) => ({ name, share: i === 0 ? 1 - 0.25 * (frames.length - 1) : 0.25 })),
    sensitivity: ["edges", "information", "shading"].flatMap((cue, k) =>
      AXES.map((axis, a) => ({
        cue,
        axis,
        offsets: offsets.map((x) => (a < 3 ? x / 4 : 2.5 * x)),
        // About y the optimum differs from the estimate by more than the covariance allows.
        values: offsets.map((x) => -((x - k + 1 - (a === 1 ? 3 : 0)) ** 2) / (4 + 3 * k + 4 * a)),
      })),
    ),
  };
}

/**
 * The check answers with this report after some progress; the worker handles everything else. `more` replaces members of the report. "never" keeps the check waiting, "unsent"
 * the frames before it; "dead" is a worker that ignores all messages from a check on.
 */
export async function answerChecks(
  page: Page,
  verdict: CheckReport["verdict"] | "never" | "unsent" | "dead",
  overlap?: number,
  more: Partial<CheckReport> = {},
): Promise<void> {
  const source = `${reportOf.toString()}`;
  await page.addInitScript(
    ({ source, verdict, axes, overlap, more }) => {
      const report = new Function("AXES", `return ${source}`)(axes) as (
        verdict: string,
        candidates: string[],
        frames: string[],
        overlap?: number,
      ) => object;
      const send = Worker.prototype.postMessage;
      let frames: string[] = [];
      let dead: Worker | undefined;
      Worker.prototype.postMessage = function (
        this: Worker,
        message: { kind?: string; id?: number; candidates?: object; frames?: { name: string }[] },
        options?: StructuredSerializeOptions | Transferable[],
      ) {
        if (this === dead || (message.kind === "frames" && verdict === "unsent")) return;
        if (message.kind === "check" && verdict === "dead") dead = this;
        if (message.kind === "frames" && message.frames) frames = message.frames.map(({ name }) => name);
        if (message.kind !== "check") return send.call(this, message, options as StructuredSerializeOptions);
        const say = (data: object) =>
          this.dispatchEvent(new MessageEvent("message", { data: { id: message.id, ...data } }));
        setTimeout(() => say({ share: 0.4, message: "aligning depth edges" }));
        if (verdict !== "never" && verdict !== "dead")
          setTimeout(
            () =>
              say({ answer: { ...report(verdict, Object.keys(message.candidates ?? {}), frames, overlap), ...more } }),
            20,
          );
      };
    },
    { source, verdict, axes: [...AXES], overlap, more },
  );
}
