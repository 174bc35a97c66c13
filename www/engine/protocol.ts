/** Messages between the page and its worker. Both sides import this file and no other file of the other side. */

import type { ErrorDetails } from "../../pkg/index.js";
import type { ColorImage, DepthMap, Options, Pinhole, Pose, SampleRequest, StepReport } from "../../pkg/index.js";

/** A pair in the form of the library, read from the visitor's files. */
export interface Pair {
  image: ColorImage;
  depth: DepthMap;
  /** Guesses and changes during reading, in words, by field. */
  notes: Record<string, string>;
  /** The guessed unit of depth, if none was given. */
  unit?: number;
  /** The true pose, of a rendered pair. */
  truth?: Pose;
}

/** Files as dropped or picked, with the information that only their owner has. */
export interface OwnFiles {
  colour: File;
  depth: File;
  colourMask?: File;
  depthMask?: File;
  colourCamera?: Pinhole;
  depthCamera?: Pinhole;
  /** Metres (or pixels) per stored unit of depth. If it is absent and there is a camera, it is guessed. */
  unit?: number;
  /** Whether larger numbers of the depth map are nearer, with the factor if it is known. */
  inverse?: { numerator?: number };
  /** If absent, it is guessed from the bit depth. */
  transfer?: "srgb" | "linear";
  /** The true pose, of a rendered pair. */
  truth?: Pose;
}

/** Rotation of a sample's light about the colour view's x and y, degrees. */
export type SampleSource = { kind: "sample"; request: SampleRequest; turn: { alpha: number; beta: number } };
/** The input to show; a saved run continues where it stopped. */
export type Source = SampleSource | { kind: "files"; files: OwnFiles } | { kind: "saved"; file: File };
/** The input for the worker, after the files have been read. */
export type Input = Exclude<Source, { kind: "files" }> | { kind: "pair"; pair: Pair };

/**
 * Options whose light may also be "known" and whose start may be "truth". Only the worker holds the light and pose of the sample.
 */
export type LabOptions = Omit<Options, "light" | "start"> & {
  light: "known" | "estimate" | number[];
  start: NonNullable<Options["start"]> | "truth";
};

/**
 * Numbers of one view for drawing, for every `stride`-th pixel of the full grid. They start at the pixel `left`, `top`. With strides a
 * frame takes the same time for any size of input. Three channels are interleaved.
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

/** Colours with their white level, and whether they are already encoded for a screen. */
export interface Picture extends Raster {
  white: number;
  encoded: boolean;
}

/**
 * Points of one view for every `stride`-th pixel of the full grid, NaN where missing. They start at the pixel `left`, `top`. If the width
 * is 0, they are an unordered list.
 */
export interface Surface {
  left: number;
  top: number;
  width: number;
  height: number;
  stride: number;
  /** xyz interleaved, in the colour view's frame. */
  points: Float32Array;
  /** RGB of each point, if they have different colours. */
  colours: Uint8Array | null;
}

/** The pictures of the Lab, each with the view whose pixels it shows. */
export const VIEWS = {
  picture: "image",
  imageNormals: "image",
  imageDepth: "image",
  albedo: "image",
  shading: "image",
  residual: "image",
  given: "depth",
  refinedDepth: "depth",
  depthNormals: "depth",
  normalError: "image",
  depthError: "image",
  refinementError: "depth",
} as const;
export type ViewName = keyof typeof VIEWS;
export type Side = (typeof VIEWS)[ViewName];

/** Ranges of colours. The given depth has the range of the refined depth. */
export const SCALES = [
  "imageDepth",
  "refinedDepth",
  "residual",
  "normalError",
  "depthError",
  "refinementError",
] as const;
export type ScaleName = (typeof SCALES)[number];

export interface Range {
  min: number;
  max: number;
}

/** How the surfaces are coloured; a view without the chosen raster has a plain colour. */
export const TEXTURES = ["view", "picture", "normals", "residual"] as const;
export type Texture = (typeof TEXTURES)[number];

/** The visitor's choices for the display. */
export interface Look {
  /** Fixed ranges; the others follow the values. */
  ranges: Partial<Record<ScaleName, Range>>;
  texture: Texture;
}

/** Every `stride`-th pixel of a view's full grid, starting at `left`, `top`. */
export interface Painted extends Pick<Raster, "left" | "top" | "width" | "height" | "stride"> {
  full: { width: number; height: number };
  bitmap: ImageBitmap;
}

/** Everything that is drawn and changes with a step. */
export interface Drawings {
  views: Partial<Record<ViewName, Painted>>;
  ranges: Record<ScaleName, Range>;
  surfaces: Record<Side, Surface>;
  /** `points` is the pose under which the depth map's points are given, during a search the initial pose. `seen` is the pose to show. */
  poses: { points: Pose; seen: Pose };
}

/** Everything that changes with a step. */
export interface Frame extends Drawings {
  /** The reports of all steps since the last frame; the newest is the last. */
  reports: StepReport[];
  /** Alpha, beta, gamma and score of each rotation that the search has tried. */
  scores: Float32Array;
  /** A ball under the light that was found, and the factors by which it differs from the true light. */
  light: { found: ImageBitmap; difference: ImageBitmap | null };
}

/** A light whose numbers are known. */
export interface KnownLight {
  ball: ImageBitmap;
  /** All 27 coefficients of the light. */
  coefficients: Float64Array;
}

/** Everything that changes with the input. */
export interface Opened {
  /** Units of the depth of both views. */
  units: { image: "px" | "m"; depth: "px" | "m" };
  /** Guesses and changes during reading, in words, by field. */
  notes: Record<string, string>;
  /** The true pose, if the input is a sample. */
  truth: Pose | null;
  /** The light under which it was rendered. */
  trueLight: KnownLight | null;
  /** Whether true shapes are available for comparison. */
  measured: boolean;
  /** The options of a saved run. */
  options: Options | null;
  frame: Frame;
}

/** A preview of a sample that is not open yet. */
export interface Preview {
  picture: Painted;
  trueLight: KnownLight;
}

/** A pixel of a view, in its full grid. */
export interface Pixel {
  column: number;
  row: number;
}

/** What is known about a pixel and about the pixel in the other view that sees the same point. */
export interface Probed {
  pixels: Record<Side, Pixel | null>;
  /** The positions of their points, in the colour view's frame. */
  points: Record<Side, number[] | null>;
  /** The value of each picture there; absent if it has none. */
  values: Partial<Record<ViewName, number[]>>;
  /** Natural logarithms of the linear colours, measured and as albedo and shading predict them. */
  log: number[] | null;
  predicted: number[] | null;
  /** The depth map's normal there, turned into the colour view. */
  prior: number[] | null;
}

export interface Catalogue {
  surfaces: string[];
  lights: string[];
}

/** The downloads at full resolution. */
export interface Taken {
  pose: Pose;
  /** The unit of the colour view; `depthUnit` is that of the depth view. */
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
  open: { request: { source: Input; options: LabOptions; look: Look }; reply: Opened };
  take: { request: Record<never, never>; reply: Taken };
  /** The run as bytes that `open` takes as a saved one. */
  save: { request: Record<never, never>; reply: Uint8Array };
  preview: { request: { source: SampleSource }; reply: Preview };
  reset: { request: { options: LabOptions; look: Look }; reply: Frame };
  look: { request: { look: Look }; reply: Drawings };
  probe: { request: { side: Side; pixel: Pixel }; reply: Probed };
  /** Runs at least one step, and more until the time is up. A stage is run without any other. */
  advance: { request: { by: "step" | "stage"; milliseconds: number; look: Look }; reply: Frame };
}

export type Kind = keyof Calls;
export type Request = { [K in Kind]: { id: number; kind: K } & Calls[K]["request"] }[Kind];

/** An error in a form that can be sent between threads. */
export interface Fault {
  code: string;
  message: string;
  field?: string;
  details?: ErrorDetails;
  /** Whether the worker has to be replaced: after a panic its instance cannot be trusted, and without its module it cannot work. */
  fatal: boolean;
}

export type Answer =
  | { id: number; ok: true; reply: Calls[Kind]["reply"] }
  | { id: number; ok: false; fault: Fault }
  | { id: null; loaded: number };
