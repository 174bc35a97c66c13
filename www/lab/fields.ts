/**
 * All settings of the Lab. The form, its errors, undo and the link are made from this list. Members of the library's options come from the
 * library's rows, with their defaults and words; this file adds settings that combine several members or depend on files. An empty number
 * is absent, so that the library's default applies.
 */

import { OPTIONS, RENDERED_ALONE, SAMPLE, paths, type PageField, type Rows, type ShownRow } from "../../pkg/options.js";

/** Source of the pair: rendered by the crate, or the visitor's files. */
export type Origin = "sample" | "files";
export type Value = string | number | boolean | null;

interface Common {
  key: string;
  label: string;
  /** One sentence that explains the label. */
  hint?: string;
  /** A remark on the present choice, always visible. */
  remark?: (value: Value, source: Origin) => string;
  group: Group;
  /** Path in the library's errors that belongs to this field. */
  path: string;
  /** The condition under which the field is shown. */
  when?: (settings: Settings, source: Origin) => boolean;
}
export interface NumberField extends Common {
  kind: "number";
  initial: number | null;
  unit?: string | undefined;
  /** The meaning of an empty field. */
  empty: string;
  slider?: PageField["slider"];
}
export interface ChoiceField extends Common {
  kind: "choice";
  initial: string;
  /** The choices; if absent, they come from the library's catalogue. */
  choices?: readonly (readonly [value: string, label: string])[];
  /** Choices that apply only to one origin; the other origin has the initial choice. */
  only?: Readonly<Record<string, Origin>>;
}
export interface FlagField extends Common {
  kind: "flag";
  initial: boolean;
}
/** Numbers as one line of text, so that they can be pasted. */
export interface ListField extends Common {
  kind: "list";
  initial: string;
  empty: string;
}
export type Field = NumberField | ChoiceField | FlagField | ListField;
export type Group = PageField["group"] | "colour" | "depth";
export type Settings = Readonly<Record<string, Value>>;

export const near = (settings: Settings) => settings.start === "near";
/** A bare grid has no rendering options, because its surface determines its size and it has no noise. */
export const rendered = (settings: Settings) => settings.protocol !== "grid";

/** The field of a row. */
function fieldOf(path: string, row: ShownRow, { group, label, hint, link, initial, empty, slider }: PageField): Field {
  const [, ...names] = path.split(".");
  const common = {
    ...{ key: link ?? String(names.at(-1)), label, group, path },
    ...(hint === undefined ? {} : { hint }),
    ...(group === "sample" && RENDERED_ALONE.includes(String(names[0])) ? { when: rendered } : {}),
  };
  const value = row.default;
  switch (row.kind) {
    case "word":
      return { ...common, kind: "choice", initial: String(value), choices: Object.entries(row.words) };
    case "flag":
      return { ...common, kind: "flag", initial: value === true };
    default: {
      const start = initial ?? (typeof value === "number" ? value : null);
      return {
        ...common,
        kind: "number",
        initial: start,
        unit: row.unit,
        empty: empty ?? row.words?.[String(value)] ?? String(value),
        slider,
      };
    }
  }
}

const fieldsOf = (rows: Rows, root: string): Field[] =>
  [...paths(rows, root)].flatMap(([path, row]) => ("page" in row ? [fieldOf(path, row, row.page)] : []));
export const sampleFields = fieldsOf(SAMPLE, "sample");
export const optionFields = fieldsOf(OPTIONS, "options");

const startAngle = (name: "alpha" | "beta" | "gamma", label: string, initial: number): NumberField => ({
  ...{
    kind: "number",
    key: `start.${name}`,
    label,
    initial,
    empty: "0",
    group: "method",
    path: `options.start.angles.${name}`,
  },
  ...{ unit: SAMPLE.angles.members[name].unit, when: near },
});
const lens = (side: "colour" | "depth", key: "fx" | "fy" | "cx" | "cy"): NumberField => ({
  kind: "number",
  key: `${side}.${key}`,
  label: key,
  initial: null,
  empty: "none",
  group: side,
  unit: "px",
  path: `${side === "colour" ? "image" : "depth"}.camera.${key}`,
});
const distortion = (side: "colour" | "depth"): ListField => ({
  kind: "list",
  key: `${side}.distortion`,
  label: "distortion",
  initial: "",
  empty: "none",
  group: side,
  hint: "In OpenCV's order: k1 k2 p1 p2, then k3, then k4 k5 k6.",
  path: `${side === "colour" ? "image" : "depth"}.camera.distortion`,
});
const lensModel = (side: "colour" | "depth"): ChoiceField => ({
  kind: "choice",
  key: `${side}.model`,
  label: "lens model",
  initial: "brown",
  group: side,
  path: `${side === "colour" ? "image" : "depth"}.camera.model`,
  when: (settings) => settings[`${side}.distortion`] !== "",
  choices: [
    ["brown", "Brown: k1 k2 p1 p2 k3 k4 k5 k6"],
    ["fisheye", "fisheye: k1 k2 k3 k4"],
  ],
});
/** Turns of a sample's light about the colour view's axes. */
const lightTurn = (
  key: "lightTilt" | "lightTurn",
  angle: "alpha" | "beta",
  label: string,
  hint: string,
): NumberField => ({
  ...{
    kind: "number",
    key,
    label,
    hint,
    initial: 0,
    empty: "0",
    unit: "deg",
    group: "sample",
    path: `angles.${angle}`,
  },
  slider: { min: -180, max: 180, step: 5 },
});
const ESTIMATED = "Estimated along with the pose.";

export const startField: ChoiceField = {
  kind: "choice",
  key: "start",
  label: "Start",
  initial: "search",
  group: "method",
  path: "options.start",
  hint: "Search: all rotations. Identity: the views coincide. Near: the angles below. True pose: that of the sample.",
  choices: [...Object.entries(OPTIONS.start.words), ["near", "near"], ["truth", "true pose"]],
  only: { truth: "sample" },
};

export const fields: readonly Field[] = [
  { kind: "choice", key: "surface", label: "Surface", initial: "bust", group: "sample", path: "sample.surface" },
  { kind: "choice", key: "light", label: "Light", initial: "colourful", group: "sample", path: "sample.light" },
  lightTurn("lightTurn", "beta", "Light turned", "About the vertical axis; dragging the light ball does the same."),
  lightTurn("lightTilt", "alpha", "Light tilted", "About the horizontal axis."),
  {
    kind: "choice",
    key: "size",
    label: "Size",
    hint: "Side length of both views, or a full camera frame.",
    initial: "128",
    group: "sample",
    path: "sample.size",
    when: rendered,
    choices: [
      ["32", "32 px"],
      ["64", "64 px"],
      ["96", "96 px"],
      ["128", "128 px"],
      ["256", "256 px"],
      ["640x480", "640×480"],
    ],
  },
  ...sampleFields,

  {
    kind: "choice",
    key: "transfer",
    label: "Encoding",
    hint: "How the file encodes intensity.",
    initial: "guess",
    group: "colour",
    path: "image.transfer",
    choices: [
      ["guess", "guess"],
      ["srgb", "sRGB"],
      ["linear", "linear"],
    ],
  },
  lens("colour", "fx"),
  lens("colour", "fy"),
  lens("colour", "cx"),
  lens("colour", "cy"),
  distortion("colour"),
  lensModel("colour"),
  {
    kind: "number",
    key: "unit",
    label: "Unit",
    hint: "Metres per stored number; in pixels if there is no camera.",
    initial: null,
    empty: "default",
    group: "depth",
    path: "depth.unit",
  },
  {
    kind: "choice",
    key: "meaning",
    label: "Numbers",
    hint: "Depths are larger where a surface is farther; disparities, inverse depths and the estimates of networks are larger where it is nearer.",
    initial: "depth",
    group: "depth",
    path: "depth.inverse",
    choices: [
      ["depth", "larger is farther"],
      ["inverse", "larger is nearer"],
    ],
  },
  {
    kind: "number",
    key: "numerator",
    label: "Focal × baseline",
    hint: "A depth in metres is this number divided by the stored one. For disparities in pixels enter the focal length (px) times the baseline (m); for inverse metres enter 1. Not used without a camera.",
    initial: null,
    empty: "unknown",
    group: "depth",
    path: "depth.inverse.numerator",
    when: ({ meaning }) => meaning === "inverse",
  },
  lens("depth", "fx"),
  lens("depth", "fy"),
  lens("depth", "cx"),
  lens("depth", "cy"),
  distortion("depth"),
  lensModel("depth"),

  {
    kind: "choice",
    key: "lighting",
    label: "Light",
    initial: "estimate",
    group: "method",
    path: "options.light",
    when: (_, source) => source === "sample",
    remark: (value) => (value === "known" ? "The sample's light is given, up to its exposure." : ESTIMATED),
    choices: [["known", "known"], ...Object.entries(OPTIONS.light.words)],
  },
  {
    kind: "list",
    key: "coefficients",
    label: "Light",
    hint: "27 numbers if the light is known: nine each for red, green and blue.",
    initial: "",
    empty: "estimated",
    group: "method",
    path: "options.light",
    when: (_, source) => source === "files",
    remark: (value) => (value === "" ? ESTIMATED : ""),
  },
  startField,
  startAngle("alpha", "Start α", 0),
  startAngle("beta", "Start β", 12),
  startAngle("gamma", "Start γ", 0),
  ...optionFields,
];

export const inputGroups: readonly Group[] = ["sample", "colour", "depth"];

/** Whether one of these fields belongs to the input. */
export const areOfInput = (keys: readonly string[]): boolean =>
  fields.some(({ key, group }) => inputGroups.includes(group) && keys.includes(key));

export const defaults: Settings = Object.fromEntries(fields.map(({ key, initial }) => [key, initial]));
if (Object.keys(defaults).length < fields.length)
  throw new Error("Two fields share a name: give one of their rows a `link`.");

/** Whether a choice is unavailable for this source. */
export const isOff = ({ only }: ChoiceField, value: Value, source: Origin): boolean =>
  (only?.[String(value)] ?? source) !== source;

/** The effective value of a field: own files have no true pose to start from. */
export const valueOf = (field: Field, settings: Settings, source: Origin): Value =>
  field.kind === "choice" && isOff(field, settings[field.key] ?? null, source)
    ? field.initial
    : (settings[field.key] ?? null);
