/** Converts the fields to requests and options of the library, to words and to a link, and the options of a saved run to fields. */

import type { Options, Pinhole, SampleRequest } from "../../pkg/index.js";
import type { LabOptions } from "../engine/protocol";
import type { Method } from "./explain";
import {
  defaults,
  fields,
  inputGroups,
  near,
  optionFields,
  rendered,
  sampleFields,
  startField,
  valueOf,
  type Field,
  type Group,
  type Origin,
  type Settings,
  type Value,
} from "./fields";

export { defaults, type Origin, type Settings, type Value } from "./fields";

const number = (settings: Settings, key: string): number | undefined => {
  const value = settings[key];
  return typeof value === "number" ? value : undefined;
};
const text = (settings: Settings, key: string): string => String(settings[key]);

/** Values that the page has put into fields by itself, until the visitor changes them. */
const GUESSED = { unit: "guessedUnit", meaning: "guessedMeaning" } as const;

/** Whether the field still holds the value that the page filled in. */
export const isGuessed = (settings: Settings, key: keyof typeof GUESSED): boolean =>
  settings[key] !== null && settings[key] === settings[GUESSED[key]];

/** Fills a field for the visitor; `undefined` empties it. */
export const guess = (key: keyof typeof GUESSED, value: Value | undefined): Settings => ({
  [key]: value ?? null,
  [GUESSED[key]]: value ?? null,
});

/** Sets a value at a path below the object of its first name. */
function place(root: Record<string, unknown>, path: string, value: unknown): void {
  const names = path.split(".").slice(1);
  const last = String(names.pop());
  let inner = root;
  for (const name of names) inner = (inner[name] ??= {}) as Record<string, unknown>;
  inner[last] = value;
}

/** The values of these rows' fields. Empty fields are left to the library, and so are values that it would refuse in combination. */
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
    // Each empty angle is zero; the library's defaults apply only if no angle is given.
    angles: { ...request.angles },
    ...(rendered(settings) ? size(settings) : {}),
  };
}

/** A light's name, or its 27 numbers as `lightText` writes them. */
export const lightOf = (text: string): string | number[] => (isLightText(text) ? text.split(" ").map(Number) : text);
export const isLightText = (text: string): boolean => text.includes(" ");

/** Coefficients for an address: four digits are finer than the eye and the sliders can resolve. */
export const lightText = (coefficients: readonly number[]): string =>
  coefficients.map((value) => String(Number(value.toPrecision(4)))).join(" ");

/** The angles by which the sample's light is rotated. */
export const turnOf = (settings: Settings): { alpha: number; beta: number } => ({
  alpha: number(settings, "lightTilt") ?? 0,
  beta: number(settings, "lightTurn") ?? 0,
});

/** "64" is a square. */
function size(settings: Settings): Pick<SampleRequest, "size" | "height"> {
  const [width = 0, height = width] = text(settings, "size").split("x").map(Number);
  return { size: width, height };
}

/** The numbers in a line of text, whatever separates them. */
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

/** The address of a run that starts near these angles; tenths of a degree are precise enough. */
export function startNear({ alpha, beta, gamma }: Record<"alpha" | "beta" | "gamma", number>): Settings {
  const rounded = (degrees: number) => Math.round(10 * degrees) / 10;
  return { start: "near", "start.alpha": rounded(alpha), "start.beta": rounded(beta), "start.gamma": rounded(gamma) };
}

/** The value at a path below the object of its first name. */
const valueAt = (root: unknown, path: string): unknown =>
  path
    .split(".")
    .slice(1)
    .reduce<unknown>((inner, name) => (inner as Record<string, unknown> | undefined)?.[name], root);

/** The fields for the options of a saved run. An initial pose gives only its angles, which alone have fields. */
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

/** The facts about a run on which explanations depend. */
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

/** All settings of a run, as the form shows them. */
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

/** A camera if all four numbers are given, undefined if none is, otherwise the names of the missing ones. */
export function camera(settings: Settings, side: "colour" | "depth"): Pinhole | undefined | string {
  const [fx, fy, cx, cy] = lensKeys.map((key) => number(settings, `${side}.${key}`));
  const distortion = listed(settings, `${side}.distortion`);
  if (fx !== undefined && fy !== undefined && cx !== undefined && cy !== undefined) {
    const model = settings[`${side}.model`] === "fisheye" ? "fisheye" : "brown";
    return { fx, fy, cx, cy, ...(distortion.length > 0 ? { model, distortion } : {}) };
  }
  const missing = lensKeys.filter((key) => settings[`${side}.${key}`] === null);
  return missing.length === lensKeys.length && distortion.length === 0 ? undefined : missing.join(", ");
}

/** What differs from the defaults, as the part of the address after #. */
export function toLink(settings: Settings): string {
  const changed = fields.filter(({ key }) => settings[key] !== defaults[key]);
  return new URLSearchParams(changed.map(({ key }) => [key, String(settings[key] ?? "")])).toString();
}

/** Reads such an address; unknown parts stay at their defaults. */
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
