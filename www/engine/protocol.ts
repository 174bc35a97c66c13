/** What the page and its worker say to each other. Both sides import this file and nothing else of one another. */

import type { Options, Pinhole, Pose, SampleRequest, StepReport } from "../../pkg/index.js";

/** A camera as it was typed in: how many numbers there are the library judges. */
export type OwnCamera = Omit<Pinhole, "distortion"> & { distortion?: number[] };

/** Files as dropped or picked, with what only their owner knows about them. */
export interface OwnFiles {
  colour: File;
  depth: File;
  colourMask?: File;
  depthMask?: File;
  colourCamera?: OwnCamera;
  depthCamera?: OwnCamera;
  /** Metres (or pixels) per stored unit of depth; the library's default without it. */
  unit?: number;
  /** Guessed from the bit depth without it. */
  transfer?: "srgb" | "linear";
}

/** A sample's light may be turned, degrees about the colour view's x and y. */
export type SampleSource = { kind: "sample"; request: SampleRequest; turn: { alpha: number; beta: number } };
export type Source = SampleSource | { kind: "files"; files: OwnFiles };

/** Options whose light may also be "known" and whose start "truth": those of the sample, which only the worker holds. */
export type LabOptions = Omit<Options, "light" | "start"> & {
  light: "known" | "estimate" | number[];
  start: NonNullable<Options["start"]> | "truth";
};

/**
 * Numbers of one view as they are drawn: from the pixel at `left`, `top` on, every `stride`-th of the full grid, so that
 * a frame costs the same for any size of input. Three channels are interleaved.
 */
export interface Raster {
  left: number;
  top: number;
  width: number;
  height: number;
  stride: number;
  channels: 1 | 3;
  data: Float32Array;
}

/** Colours, with what is needed to show them: their white level and whether they are already encoded for a screen. */
export interface Picture extends Raster {
  white: number;
  encoded: boolean;
}

/** Points of one view where its pixels are: every `step`-th of a drawn raster in both directions, NaN where there is none. Without a width they are a mere list. */
export interface Surface {
  width: number;
  height: number;
  step: number;
  /** xyz interleaved, in the colour view's frame. */
  points: Float32Array;
}

/** How far normals (degrees) and depths (their view's unit) are from the truth. */
export interface ErrorMaps {
  imageNormals: Raster;
  imageDepth: Raster;
  refinedDepth: Raster;
}

/** Everything that changes with a step. */
export interface Frame {
  /** One for each step since the last frame, the newest last. */
  reports: StepReport[];
  imageNormals: Raster;
  imageDepth: Raster;
  albedo: Picture;
  shading: Picture;
  residual: Raster;
  refinedDepth: Raster;
  depthNormals: Raster;
  imageSurface: Surface;
  depthSurface: Surface;
  /** The pose that the depth map's points stand under: while the search looks at others, that of the start. */
  depthPose: Pose;
  /** A ball under the light that was found, and by what factors it differs from the true one. */
  light: { found: Picture; difference: Picture | null };
  /** Of a sample, whose truth is known. */
  errors: ErrorMaps | null;
}

/** Everything that changes with the input. */
export interface Opened {
  picture: Picture;
  given: Raster;
  /** Unit of the image's depth and of the depth view's. */
  units: { image: "px" | "m"; depth: "px" | "m" };
  /** What was guessed or changed on the way in, in words, keyed by the field it belongs to. */
  notes: Record<string, string>;
  /** The pose to find, where the input is a sample. */
  truth: Pose | null;
  /** A ball under its light. */
  trueLight: Picture | null;
  frame: Frame;
}

/** What a sample would look like, before it is opened. */
export interface Preview {
  picture: Picture;
  trueLight: Picture;
}

export interface Catalogue {
  surfaces: string[];
  lights: string[];
}

/** What can be taken away, in full. */
export interface Taken {
  pose: Pose;
  /** Of the colour view and of the depth view. */
  unit: "px" | "m";
  depthUnit: "px" | "m";
  light: Float64Array;
  imagePoints: Float32Array;
  depthPoints: Float32Array;
  image: { width: number; height: number; normals: Float32Array };
  depth: { width: number; height: number; refined: Float32Array; normals: Float32Array };
}

/** Each request with its reply. */
export interface Calls {
  catalogue: { request: Record<never, never>; reply: Catalogue };
  open: { request: { source: Source; options: LabOptions }; reply: Opened };
  take: { request: Record<never, never>; reply: Taken };
  preview: { request: { source: SampleSource }; reply: Preview };
  reset: { request: { options: LabOptions }; reply: Frame };
  /** Steps until the time is up, at least one; a stage is always a single one. */
  advance: { request: { by: "step" | "stage"; milliseconds: number }; reply: Frame };
}

export type Kind = keyof Calls;
export type Request = { [K in Kind]: { id: number; kind: K } & Calls[K]["request"] }[Kind];

/** An error in a form that survives the way between threads. */
export interface Fault {
  code: string;
  message: string;
  field?: string;
  /** After a panic the instance is suspect, and without its module it is none: the worker has to be replaced. */
  fatal: boolean;
}

export type Answer =
  | { id: number; ok: true; reply: Calls[Kind]["reply"] }
  | { id: number; ok: false; fault: Fault }
  | { id: null; loaded: number };
