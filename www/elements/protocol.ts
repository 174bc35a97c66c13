/** The messages between `<bimodal-stereo>` and its thread. Both sides import this file and no other file of the other side. */

import type { StereoPair } from "../../pkg/elements.js";
import type { Options, SampleRequest, StepReport, WasmSource } from "../../pkg/index.js";
import type { Fault } from "../engine/protocol";
import type { Panel } from "../learn/protocol";

/** Addresses are absolute, because a thread would resolve relative addresses by its own address. */
export interface Input {
  image: string;
  depth: string;
  mask: string;
  unit: number | undefined;
  sample: SampleRequest | undefined;
  pair: StereoPair | undefined;
}

export type Order =
  | { kind: "open"; input: Input; options: Options; wasm: WasmSource | undefined }
  | { kind: "step"; withCharts: boolean };

/** The contents of a drawing; the image is sent once, with the first answer. */
export const PICTURES = ["image", "surface", "light"] as const;
export type PictureName = (typeof PICTURES)[number];
export type Pictures = Partial<Record<PictureName, ImageBitmap>>;

export type Answer =
  | { kind: "opened"; pictures: Pictures }
  | { kind: "stepped"; report: StepReport; pictures: Pictures; panels: Panel[] | undefined }
  | { kind: "fault"; fault: Fault };
