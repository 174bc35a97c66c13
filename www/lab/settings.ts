/**
 * Everything the Lab can be told: the form, its errors, undo and the link are all made from this list. What is a member of
 * the library's options comes from the library's own rows, with its default and its words; here is what the Lab makes of
 * several, or of files. An empty number is absent, and so the library's default.
 */

import type { Options, Pinhole, SampleRequest } from "../../pkg/index.js";
import { OPTIONS, RENDERED_ALONE, SAMPLE, paths, type PageField, type Rows, type ShownRow } from "../../pkg/options.js";
import type { LabOptions } from "../engine/protocol";
import type { Method } from "./explain";

/** Where the pair comes from: made by the crate, or the visitor's own. */
export type Origin = "sample" | "files";
export type Value = string | number | boolean | null;

interface Common {
  key: string;
  label: string;
  /** One sentence that explains the label. */
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
  unit?: string | undefined;
  /** What an empty field means. */
  empty: string;
  slider?: PageField["slider"];
}
export interface ChoiceField extends Common {
  kind: "choice";
  initial: string;
  /** Without choices they come from the library's catalogue. */
  choices?: readonly (readonly [value: string, label: string])[];
  /** Those that mean something for one origin alone; of the other they are the initial one. */
  only?: Readonly<Record<string, Origin>>;
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
export type Group = PageField["group"] | "colour" | "depth";
export type Settings = Readonly<Record<string, Value>>;

const near = (settings: Settings) => settings.start === "near";
/** The bare grid is taken as it is: its size follows from the surface, and nothing is rendered that noise could be added to. */
const rendered = (settings: Settings) => settings.protocol !== "grid";

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
const sampleFields = fieldsOf(SAMPLE, "sample");
const optionFields = fieldsOf(OPTIONS, "options");

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
  hint: "Five numbers in OpenCV's order: k1 k2 p1 p2 k3.",
  path: `${side === "colour" ? "image" : "depth"}.camera.distortion`,
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

const startField: ChoiceField = {
  kind: "choice",
  key: "start",
  label: "Start",
  initial: "search",
  group: "method",
  path: "options.start",
  hint: "Search: everywhere. Identity: both views coincide. Near: the angles below. True pose: a sample's own.",
  choices: [...Object.entries(OPTIONS.start.words), ["near", "near"], ["truth", "true pose"]],
  only: { truth: "sample" },
};

export const fields: readonly Field[] = [
  { kind: "choice", key: "surface", label: "Surface", initial: "bust", group: "sample", path: "sample.surface" },
  { kind: "choice", key: "light", label: "Light", initial: "colourful", group: "sample", path: "sample.light" },
  lightTurn("lightTurn", "beta", "Light turned", "About the vertical axis, as dragging the ball under the light does."),
  lightTurn("lightTilt", "alpha", "Light tilted", "About the horizontal axis."),
  {
    kind: "choice",
    key: "size",
    label: "Size",
    hint: "Of both views: a side, or a camera's whole frame.",
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
    hint: "How the file's numbers stand for intensity.",
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
  {
    kind: "number",
    key: "unit",
    label: "Unit",
    hint: "Metres per stored number; pixels without a camera.",
    initial: null,
    empty: "default",
    group: "depth",
    path: "depth.unit",
  },
  lens("depth", "fx"),
  lens("depth", "fy"),
  lens("depth", "cx"),
  lens("depth", "cy"),
  distortion("depth"),

  {
    kind: "choice",
    key: "lighting",
    label: "Light",
    initial: "estimate",
    group: "method",
    path: "options.light",
    when: (_, source) => source === "sample",
    remark: (value) =>
      value === "known" ? "The method is told the sample's own light, up to its exposure." : ESTIMATED,
    choices: [["known", "known"], ...Object.entries(OPTIONS.light.words)],
  },
  {
    kind: "list",
    key: "coefficients",
    label: "Light",
    hint: "27 numbers where the light is known: nine for red, for green, for blue.",
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

export const defaults: Settings = Object.fromEntries(fields.map(({ key, initial }) => [key, initial]));
if (Object.keys(defaults).length < fields.length)
  throw new Error("Two fields share a name: give one of their rows a `link`.");

const number = (settings: Settings, key: string): number | undefined => {
  const value = settings[key];
  return typeof value === "number" ? value : undefined;
};
const text = (settings: Settings, key: string): string => String(settings[key]);

/** Puts a value where its path says, below what its first name stands for. */
function place(root: Record<string, unknown>, path: string, value: unknown): void {
  const names = path.split(".").slice(1);
  const last = String(names.pop());
  let inner = root;
  for (const name of names) inner = (inner[name] ??= {}) as Record<string, unknown>;
  inner[last] = value;
}

/** What the fields of some rows say; an empty one is left to the library, as is what it would refuse beside the others. */
function told<T extends object>(given: readonly Field[], settings: Settings, source: Origin): Partial<T> {
  const object: Record<string, unknown> = {};
  for (const { key, path, when } of given) {
    const value = settings[key];
    if (value !== null && value !== undefined && (when?.(settings, source) ?? true)) place(object, path, value);
  }
  return object as Partial<T>;
}

export function sampleRequest(settings: Settings): SampleRequest {
  const request = told<SampleRequest>(sampleFields, settings, "sample");
  return {
    surface: text(settings, "surface"),
    light: lightOf(text(settings, "light")),
    ...request,
    // Each empty angle is zero; the library takes its own where it is told of none at all.
    angles: { ...request.angles },
    ...(rendered(settings) ? size(settings) : {}),
  };
}

/** A light's name, or its 27 numbers as `lightText` writes them. */
export const lightOf = (text: string): string | number[] => (isLightText(text) ? text.split(" ").map(Number) : text);
export const isLightText = (text: string): boolean => text.includes(" ");

/** Coefficients for an address: four digits are finer than any eye, and than the sliders. */
export const lightText = (coefficients: readonly number[]): string =>
  coefficients.map((value) => String(Number(value.toPrecision(4)))).join(" ");

/** By how much the sample's light is turned. */
export const turnOf = (settings: Settings): { alpha: number; beta: number } => ({
  alpha: number(settings, "lightTilt") ?? 0,
  beta: number(settings, "lightTurn") ?? 0,
});

/** "64" is a square. */
function size(settings: Settings): Pick<SampleRequest, "size" | "height"> {
  const [width = 0, height = width] = text(settings, "size").split("x").map(Number);
  return { size: width, height };
}

/** The numbers in a line of text, however they are set apart. */
const listed = (settings: Settings, key: string): number[] =>
  text(settings, key)
    .split(/[\s,;[\]]+/)
    .filter((word) => word !== "")
    .map(Number);

function lightOption(settings: Settings, source: Origin): LabOptions["light"] {
  if (source === "sample") return settings.lighting === "known" ? "known" : "estimate";
  const coefficients = listed(settings, "coefficients");
  return coefficients.length > 0 ? coefficients : "estimate";
}

/** Whether a choice can't be made of this origin. */
export const isOff = ({ only }: ChoiceField, value: Value, source: Origin): boolean =>
  (only?.[String(value)] ?? source) !== source;

/** What a field comes to: of own files there is no true pose to start from. */
export const valueOf = (field: Field, settings: Settings, source: Origin): Value =>
  field.kind === "choice" && isOff(field, settings[field.key] ?? null, source)
    ? field.initial
    : (settings[field.key] ?? null);

function startOption(settings: Settings, source: Origin): LabOptions["start"] {
  if (!near(settings))
    return (["identity", "truth"] as const).find((word) => word === valueOf(startField, settings, source)) ?? "search";
  const angle = (name: string) => number(settings, `start.${name}`) ?? 0;
  return { angles: { alpha: angle("alpha"), beta: angle("beta"), gamma: angle("gamma") } };
}

export function runOptions(settings: Settings, source: Origin): LabOptions {
  return {
    ...told<LabOptions>(optionFields, settings, source),
    light: lightOption(settings, source),
    start: startOption(settings, source),
  };
}

/** A run that starts near these angles; tenths of a degree are finer than a start has to be. */
export function startNear({ alpha, beta, gamma }: Record<"alpha" | "beta" | "gamma", number>): Settings {
  const rounded = (degrees: number) => Math.round(10 * degrees) / 10;
  return { start: "near", "start.alpha": rounded(alpha), "start.beta": rounded(beta), "start.gamma": rounded(gamma) };
}

/** The value at a path below what its first name stands for. */
const valueAt = (root: unknown, path: string): unknown =>
  path
    .split(".")
    .slice(1)
    .reduce<unknown>((inner, name) => (inner as Record<string, unknown> | undefined)?.[name], root);

/** The fields as a saved run had been told them; of a start the angles alone, which is all that fields have. */
export function settingsOf(options: Options): Settings {
  const own = optionFields.map((field): [string, Value] => {
    const value = valueAt(options, field.path);
    if (field.kind === "number") return [field.key, typeof value === "number" ? value : null];
    return [field.key, typeof value === "string" || typeof value === "boolean" ? value : field.initial];
  });
  const { light, start = "search" } = options;
  const angles = typeof start === "object" && "angles" in start ? start.angles : undefined;
  const near = angles && Object.entries(angles).map(([name, value]): [string, Value] => [`start.${name}`, value]);
  return {
    ...Object.fromEntries(own),
    coefficients: typeof light === "string" || light === undefined ? "" : Array.from(light).join(" "),
    start: typeof start === "string" ? start : "near",
    ...Object.fromEntries(near ?? []),
  };
}

/** What the explanations have to know of a run. */
export function methodOf(settings: Settings, source: Origin): Method {
  const { light, start, registration = "joint", shading = "surface" } = runOptions(settings, source);
  return { lightIsKnown: light !== "estimate", searches: start === "search", registration, shading };
}

const valueInWords = (field: Field, value: Value): string => {
  if (field.kind === "flag") return value === true ? "yes" : "no";
  if (field.kind === "choice") return field.choices?.find(([word]) => word === value)?.[1] ?? String(value);
  if (value === null || value === "") return field.empty;
  return field.kind === "number" && field.unit ? `${value} ${field.unit}` : String(value);
};

/** All that a run was told, as the form shows it. */
export function optionsInWords(settings: Settings, source: Origin): [name: string, value: string][] {
  const groups: Partial<Record<Group, string>> =
    source === "sample" ? { sample: "Sample: " } : { colour: "Colour camera: ", depth: "Depth camera: " };
  const asked = fields.filter(
    ({ group, when }) =>
      (groups[group] !== undefined || !inputGroups.includes(group)) && (when?.(settings, source) ?? true),
  );
  const isTold = ({ key, group }: Field) =>
    (group !== "colour" && group !== "depth") || (settings[key] !== null && settings[key] !== "");
  return asked
    .filter(isTold)
    .map((field) => [
      `${groups[field.group] ?? ""}${field.label}`,
      valueInWords(field, valueOf(field, settings, source)),
    ]);
}

const lensKeys = ["fx", "fy", "cx", "cy"] as const;

/** A camera once all of its four numbers are given; none where none is; the name of what is missing in between. */
export function camera(settings: Settings, side: "colour" | "depth"): Pinhole | undefined | string {
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
