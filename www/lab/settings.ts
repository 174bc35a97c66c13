/**
 * Everything the Lab can be told, described once: the form, its errors, undo and the link are all made from this list.
 * An empty number stands for the library's own default, which is therefore written down nowhere else.
 */

import type { SampleRequest } from "../../pkg/index.js";
import type { LabOptions, OwnCamera } from "../engine/protocol";

/** Where the pair comes from: made by the crate, or the visitor's own. */
export type Origin = "sample" | "files";
export type Value = string | number | boolean | null;

interface Common {
  key: string;
  label: string;
  /** One sentence for whoever does not know the word. */
  hint?: string;
  /** What the present choice entails, always in sight. */
  remark?: (value: Value, source: Origin) => string;
  group: Group;
  /** Path in the library's errors that belongs to this field. */
  path: string;
  /** Shown only while this holds. */
  when?: (settings: Settings, source: Origin) => boolean;
}
export interface NumberField extends Common {
  kind: "number";
  initial: number | null;
  min?: number;
  max?: number;
  step?: number;
  unit?: string;
  /** What an empty field means. */
  empty?: string;
  slider?: true;
}
export interface ChoiceField extends Common {
  kind: "choice";
  initial: string;
  /** Without choices they come from the library's catalogue. */
  choices?: readonly (readonly [value: string, label: string])[];
}
export interface FlagField extends Common {
  kind: "flag";
  initial: boolean;
}
/** Numbers as one line of text, as they are copied from elsewhere. */
export interface ListField extends Common {
  kind: "list";
  initial: string;
  empty: string;
}
export type Field = NumberField | ChoiceField | FlagField | ListField;
export type Group = "sample" | "colour" | "depth" | "method" | "weights" | "loop";
export type Settings = Readonly<Record<string, Value>>;

const angle = (key: string, label: string, initial: number, group: Group, path: string): NumberField => ({
  kind: "number", key, label, initial, group, path, min: -90, max: 90, step: 1, unit: "deg",
});
const lens = (side: "colour" | "depth", key: "fx" | "fy" | "cx" | "cy"): NumberField => ({
  kind: "number", key: `${side}.${key}`, label: key, initial: null, empty: "none", group: side, unit: "px", step: 0.1,
  path: `${side === "colour" ? "image" : "depth"}.camera.${key}`,
});
const distortion = (side: "colour" | "depth"): ListField => ({
  kind: "list", key: `${side}.distortion`, label: "distortion", initial: "", empty: "none", group: side,
  hint: "Five numbers in OpenCV's order: k1 k2 p1 p2 k3.", path: `${side === "colour" ? "image" : "depth"}.camera.distortion`,
});
const ESTIMATED = "Estimated along with the pose.";
const near = (settings: Settings) => settings.start === "near";
/** The bare grid is taken as it is: its size follows from the surface, and nothing is rendered that noise could be added to. */
const rendered = (settings: Settings) => settings.protocol !== "grid";

export const fields: readonly Field[] = [
  { kind: "choice", key: "surface", label: "Surface", initial: "bust", group: "sample", path: "sample.surface" },
  { kind: "choice", key: "light", label: "Light", initial: "colourful", group: "sample", path: "sample.light" },
  { kind: "choice", key: "size", label: "Size", hint: "Of both views: a side, or a camera's whole frame.", initial: "64", group: "sample", path: "sample.size", when: rendered,
    choices: [["32", "32 px"], ["64", "64 px"], ["96", "96 px"], ["128", "128 px"], ["256", "256 px"], ["640x480", "640×480"]] },
  { kind: "choice", key: "protocol", label: "Protocol", initial: "rendered", group: "sample", path: "sample.protocol",
    hint: "Rendered: as cameras see the surface. Bare grid: every eighth sample of it, the same points in both views, as the paper may have done.",
    choices: [["rendered", "rendered"], ["grid", "bare grid"]] },
  { ...angle("beta", "Rotation β", 20, "sample", "sample.angles.beta"), slider: true, hint: "About the vertical axis: the angle to find." },
  angle("alpha", "Rotation α", 0, "sample", "sample.angles.alpha"),
  angle("gamma", "Rotation γ", 0, "sample", "sample.angles.gamma"),
  { kind: "number", key: "trueScale", label: "True scale", hint: "Of the pose to find: the depth view is smaller by it.", initial: 1, step: 0.05, group: "sample", path: "sample.scale", when: rendered },
  { kind: "number", key: "noise", label: "Colour noise", hint: "Gaussian, on the logarithm of the intensity.", initial: 0, min: 0, max: 0.2, step: 0.005, slider: true, group: "sample", path: "sample.noise", when: rendered },
  { kind: "number", key: "overlap", label: "Overlap", hint: "Share of the depth map's columns that is kept.", initial: 1, min: 0.1, max: 1, step: 0.05, slider: true, group: "sample", path: "sample.overlap" },
  { kind: "number", key: "depthNoise", label: "Depth noise", initial: 0, min: 0, max: 5, step: 0.1, unit: "px", group: "sample", path: "sample.depthNoise", when: rendered },
  { kind: "number", key: "holes", label: "Holes", hint: "Share of the depth pixels that is lost.", initial: 0, min: 0, max: 0.5, step: 0.05, group: "sample", path: "sample.holes", when: rendered },
  { kind: "number", key: "draw", label: "Noise seed", hint: "Another number draws other noise and other holes.", initial: null, min: 0, step: 1, group: "sample", path: "sample.seed", when: rendered },

  { kind: "choice", key: "transfer", label: "Encoding", hint: "How the file's numbers stand for intensity.", initial: "guess", group: "colour", path: "image.transfer",
    choices: [["guess", "guess"], ["srgb", "sRGB"], ["linear", "linear"]] },
  lens("colour", "fx"), lens("colour", "fy"), lens("colour", "cx"), lens("colour", "cy"), distortion("colour"),
  { kind: "number", key: "unit", label: "Unit", hint: "Metres per stored number; pixels without a camera.", initial: null, step: 0.0001, group: "depth", path: "depth.unit" },
  lens("depth", "fx"), lens("depth", "fy"), lens("depth", "cx"), lens("depth", "cy"), distortion("depth"),

  { kind: "choice", key: "lighting", label: "Light", initial: "estimate", group: "method", path: "options.light",
    when: (_, source) => source === "sample",
    remark: (value) => (value === "known" ? "The method is told the sample's own light, up to its exposure." : ESTIMATED),
    choices: [["known", "known"], ["estimate", "estimate"]] },
  { kind: "list", key: "coefficients", label: "Light", hint: "27 numbers where the light is known: nine for red, for green, for blue.", initial: "", empty: "estimated", group: "method", path: "options.light",
    when: (_, source) => source === "files", remark: (value) => (value === "" ? ESTIMATED : "") },
  { kind: "choice", key: "start", label: "Start", initial: "search", group: "method", path: "options.start",
    hint: "Search: everywhere. Identity: both views coincide. Near: the angles below. True pose: a sample's own.",
    choices: [["search", "search"], ["identity", "identity"], ["near", "near"], ["truth", "true pose"]] },
  { ...angle("start.alpha", "Start α", 0, "method", "options.start.angles.alpha"), when: near },
  { ...angle("start.beta", "Start β", 12, "method", "options.start.angles.beta"), when: near },
  { ...angle("start.gamma", "Start γ", 0, "method", "options.start.angles.gamma"), when: near },
  { kind: "choice", key: "registration", label: "Registration", initial: "joint", group: "method", path: "options.registration",
    hint: "Joint: pose and light straight from the colours. ICP and RANSAC: as in the paper. Or keep the start.", choices: [["joint", "joint"], ["icp", "ICP"], ["fixed", "keep start"]] },
  { kind: "choice", key: "shading", label: "Shading", initial: "surface", group: "method", path: "options.shading",
    hint: "The surface as a whole, or each pixel on its own as in the paper.", choices: [["surface", "surface"], ["pixel", "pixel"]] },
  { kind: "number", key: "scale", label: "Scale", hint: "A number holds it.", empty: "free", initial: null, step: 0.01, group: "method", path: "options.scale" },
  { kind: "flag", key: "trim", label: "Trim", hint: "Leave out flying pixels and background inside the mask.", initial: true, group: "method", path: "options.trim" },

  { kind: "number", key: "prior", label: "λ shape prior", hint: "How strongly a normal follows the other view's.", initial: null, min: 0, step: 0.01, group: "weights", path: "options.lambda.prior" },
  { kind: "number", key: "unitLength", label: "λ unit length", initial: null, min: 0, step: 0.1, group: "weights", path: "options.lambda.unit" },
  { kind: "number", key: "lightPrior", label: "λ light", hint: "How strongly the light follows natural lights.", initial: null, min: 0, step: 0.001, group: "weights", path: "options.lambda.light" },
  { kind: "number", key: "refinement", label: "λ refinement", initial: null, min: 0, step: 0.01, group: "weights", path: "options.lambda.refinement" },

  { kind: "number", key: "stop", label: "Stop below", hint: "Change of the rotation that counts as settled.", initial: null, min: 0, step: 0.005, unit: "deg", group: "loop", path: "options.stopDegrees" },
  { kind: "number", key: "iterations", label: "At most", initial: null, min: 1, step: 1, unit: "iterations", group: "loop", path: "options.maxIterations" },
  { kind: "number", key: "distance", label: "Match within", hint: "Accepted distance of a correspondence.", empty: "automatic", initial: null, min: 0, step: 0.25, unit: "px", group: "loop", path: "options.correspondenceDistance" },
  { kind: "number", key: "seed", label: "Seed", initial: null, min: 0, step: 1, group: "loop", path: "options.seed" },
];

export const inputGroups: readonly Group[] = ["sample", "colour", "depth"];

export const defaults: Settings = Object.fromEntries(fields.map(({ key, initial }) => [key, initial]));

const number = (settings: Settings, key: string): number | undefined => {
  const value = settings[key];
  return typeof value === "number" ? value : undefined;
};
const text = (settings: Settings, key: string): string => String(settings[key]);

/** An object without the keys that are not set: absent means default. */
function present<T extends object>(entries: { [K in keyof T]: T[K] | undefined }): Partial<T> {
  const kept: Partial<T> = {};
  for (const key in entries) {
    const value = entries[key];
    if (value !== undefined) kept[key] = value;
  }
  return kept;
}

/** The word that is set; the first where it is none of them. */
const one = <T extends string>(value: unknown, words: readonly [T, ...T[]]): T => words.find((word) => word === value) ?? words[0];

const angles = (settings: Settings, prefix: string) => ({
  alpha: number(settings, `${prefix}alpha`) ?? 0,
  beta: number(settings, `${prefix}beta`) ?? 0,
  gamma: number(settings, `${prefix}gamma`) ?? 0,
});

export function sampleRequest(settings: Settings): SampleRequest {
  const surface = { surface: text(settings, "surface"), light: text(settings, "light"), angles: angles(settings, "") };
  const kept = present<Pick<SampleRequest, "overlap">>({ overlap: number(settings, "overlap") });
  // The library refuses what the bare grid has no use for.
  if (!rendered(settings)) return { ...surface, ...kept, protocol: "grid" };
  return {
    ...surface,
    ...kept,
    ...size(settings),
    ...present<Pick<SampleRequest, "scale" | "noise" | "depthNoise" | "holes" | "seed">>({
      scale: number(settings, "trueScale"),
      noise: number(settings, "noise"),
      depthNoise: number(settings, "depthNoise"),
      holes: number(settings, "holes"),
      seed: number(settings, "draw"),
    }),
  };
}

/** "64" is a square. */
function size(settings: Settings): Pick<SampleRequest, "size" | "height"> {
  const [width = 0, height = width] = text(settings, "size").split("x").map(Number);
  return { size: width, height };
}

/** The numbers in a line of text, however they are set apart. */
const listed = (settings: Settings, key: string): number[] =>
  text(settings, key).split(/[\s,;[\]]+/).filter((word) => word !== "").map(Number);

function lightOption(settings: Settings, source: Origin): LabOptions["light"] {
  if (source === "sample") return settings.lighting === "known" ? "known" : "estimate";
  const coefficients = listed(settings, "coefficients");
  return coefficients.length > 0 ? coefficients : "estimate";
}

export function runOptions(settings: Settings, source: Origin): LabOptions {
  const lambda = present<NonNullable<LabOptions["lambda"]>>({
    prior: number(settings, "prior"),
    unit: number(settings, "unitLength"),
    light: number(settings, "lightPrior"),
    refinement: number(settings, "refinement"),
  });
  return {
    light: lightOption(settings, source),
    start: near(settings) ? { angles: angles(settings, "start.") } : one<"search" | "identity" | "truth">(settings.start, ["search", "identity", "truth"]),
    registration: one(settings.registration, ["joint", "icp", "fixed"]),
    shading: one(settings.shading, ["surface", "pixel"]),
    scale: number(settings, "scale") ?? "free",
    trim: settings.trim === true,
    lambda,
    ...present<Pick<LabOptions, "stopDegrees" | "maxIterations" | "correspondenceDistance" | "seed">>({
      stopDegrees: number(settings, "stop"),
      maxIterations: number(settings, "iterations"),
      correspondenceDistance: number(settings, "distance"),
      seed: number(settings, "seed"),
    }),
  };
}

const lensKeys = ["fx", "fy", "cx", "cy"] as const;

/** A camera once all of its four numbers are given; none where none is; the name of what is missing in between. */
export function camera(settings: Settings, side: "colour" | "depth"): OwnCamera | undefined | string {
  const [fx, fy, cx, cy] = lensKeys.map((key) => number(settings, `${side}.${key}`));
  const distortion = listed(settings, `${side}.distortion`);
  if (fx !== undefined && fy !== undefined && cx !== undefined && cy !== undefined) {
    return { fx, fy, cx, cy, ...(distortion.length > 0 ? { distortion } : {}) };
  }
  const missing = lensKeys.filter((key) => settings[`${side}.${key}`] === null);
  return missing.length === lensKeys.length && distortion.length === 0 ? undefined : missing.join(", ");
}

/** What differs from the defaults, as the part of the address after #. */
export function toLink(settings: Settings): string {
  const changed = fields.filter(({ key }) => settings[key] !== defaults[key]);
  return new URLSearchParams(changed.map(({ key }) => [key, String(settings[key] ?? "")])).toString();
}

/** Reads such an address; what it does not understand stays at its default. */
export function fromLink(hash: string): Settings {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const read = fields.map((field): [string, Value] => {
    const text = given.get(field.key);
    if (text === null) return [field.key, field.initial];
    if (field.kind === "list") return [field.key, text];
    if (field.kind === "flag") return [field.key, text === "true"];
    if (field.kind === "choice") {
      const known = field.choices?.some(([value]) => value === text) ?? true;
      return [field.key, known ? text : field.initial];
    }
    const value = Number(text);
    if (text === "") return [field.key, null];
    return [field.key, Number.isFinite(value) ? value : field.initial];
  });
  return Object.fromEntries(read);
}
