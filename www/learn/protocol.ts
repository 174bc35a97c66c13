/** The messages between the lessons and their worker. Both sides import this file and nothing else of each other. */

import type { WasmSource } from "../../pkg/index.js";
import type { Fault } from "../engine/protocol";
import type { Details } from "../words";

/** The controls of a lesson by name; a box that is ticked is 1. */
export type Values = Readonly<Record<string, number | string>>;

export const LESSONS = [
  "normal",
  "lambert",
  "relief",
  "strips",
  "orders",
  "pixel",
  "grey",
  "colours",
  "surface",
  "prior",
  "pose",
  "loop",
  "sensor",
  "paint",
  "failure",
] as const;
export type LessonId = (typeof LESSONS)[number];

/** Ends of the slider of the last lesson: the narrowest depth map as a share of its width, and the largest rotation in degrees. */
export const [LEAST_OVERLAP, LARGEST_TURN] = [0.05, 90];
/** The largest constant that lesson 5 moves between its orders. */
export const LARGEST_CONSTANT = 0.6;

/** Marks on a picture; the style sheet gives each its colour, the same as that of its symbol in the text. */
export type Ink =
  | "normal"
  | "light"
  | "intensity"
  | "albedo"
  | "prior"
  | "colour"
  | "pose"
  | "sensor"
  | "minimum"
  | "path"
  | "truth"
  | "error"
  | "red"
  | "green"
  | "blue"
  | "pixel"
  | "isophote";

/** Points of a picture, x and y in turn, from 0 at the left and the top to 1; NaN leaves a gap in a line. */
export interface Mark {
  ink: Ink;
  shape: "dot" | "ring" | "cross" | "line";
  points: number[];
  /** Radius of dots and rings in hundredths of the picture. */
  size?: number;
  /** Whether lines are thin and have a thin light edge instead of a dark one, because they lie close to each other. */
  isFine?: boolean;
}

interface Common {
  /** The key of a panel, which stays the same while values change. */
  key: string;
  title: string;
  /** A description for screen readers. */
  alt: string;
  /** Values that replace {names} in the panel's words. */
  details?: Details;
  /** Distinguishes the words of a panel whose words depend on the controls. */
  state?: string;
}

export interface ImagePanel extends Common {
  kind: "image";
  width: number;
  height: number;
  pixels: Uint8ClampedArray;
  marks?: Mark[];
  /** The meaning of the colours, in one line. */
  legend?: string;
}

export interface Series {
  name: string;
  ink: Ink;
  /** x and y in turn; NaN leaves a gap. */
  points: number[];
  dots?: boolean;
}

export interface PlotPanel extends Common {
  kind: "plot";
  x: string;
  y: string;
  series: Series[];
  /** The present value of the control on the x axis. */
  at?: number;
  /** Smallest range of x, so that the axis does not move while the curve grows. */
  domain?: readonly [number, number];
  /** Smallest range of y, so that noise does not fill the picture. */
  range?: [number, number];
  /** Whether x is an angle in degrees, whose axis is divided by 30, 60 or 90. */
  hasAngles?: boolean;
}

export interface CloudPanel extends Common {
  kind: "cloud";
  sets: { name: string; ink: Ink; points: Float32Array }[];
}

export type Panel = ImagePanel | PlotPanel | CloudPanel;

/** Everything that a figure shows for one set of values. */
export interface Drawing {
  panels: Panel[];
  numbers: Record<string, number>;
  /** Numbers that are words, such as the status of a run. */
  words?: Record<string, string>;
  /** The same for other languages: the parts of these words, to be joined by colons. */
  said?: Record<string, Said[]>;
}

/** Words by their path in a catalogue, with the numbers in them. */
export interface Said {
  id: string;
  details: Details;
}

/** The first message to a thread that finds the .wasm elsewhere than beside itself. */
export interface Loading {
  wasm: WasmSource;
}

export interface Request {
  id: number;
  lesson: LessonId;
  values: Values;
}

/** A lesson may draw several times on its way to the last drawing. */
export type Answer = { id: number; drawing: Drawing; done: boolean } | { id: number; fault: Fault };
