/** A cell as settings of the Lab, which then shows that run. */

import { SAMPLE } from "../../pkg/options.js";
import { defaults, toLink, type Settings, type Value } from "../lab/settings";
import { short } from "../draw/numbers";
import { sceneOf, type Cell } from "./protocol";

/** Why the Lab cannot show a cell, in words; undefined if it can. */
export function obstacle({ kind, exposure, alternations }: Cell): string | undefined {
  if (kind === "shading")
    return "This run uses true normals in a share of the pixels; the Lab has no setting for that.";
  if (exposure !== undefined)
    return "The colours of this run are multiplied by a factor; the Lab has no setting for that.";
  if (alternations !== undefined) return "This cell consists of many short runs; the Lab shows only one.";
  return undefined;
}

/** The scene and the given values, in one line. */
export function described(cell: Cell): string {
  const scene = sceneOf(cell);
  if (!scene) return "";
  const { surface, light, protocol, size, angles = {}, scale, overlap, noise, depthNoise, holes } = scene;
  const turns = (["alpha", "beta", "gamma"] as const)
    .filter((axis) => angles[axis])
    .map((axis) => `${axis} ${short(angles[axis] ?? 0).replace("-", "−")}°`);
  const { light: given, start } = cell.options;
  return [
    surface,
    `${light} light, ${given === "known" ? "given" : "estimated"}`,
    protocol === "grid" ? "bare grid" : `${size} px`,
    ...turns,
    ...(scale === undefined ? [] : [`scale ${short(scale)}`]),
    ...(overlap === undefined ? [] : [`overlap ${short(overlap)}`]),
    ...(noise === undefined ? [] : [`colour noise ${noise}`]),
    ...(depthNoise === undefined ? [] : [`depth noise ${depthNoise} px`]),
    ...(holes === undefined ? [] : [`holes ${100 * holes} %`]),
    `start: ${start}`,
  ].join(", ");
}

/** Settings that are not named here have the Lab's defaults, which are those of the library except for the size. */
export function settingsOf(cell: Cell): Settings | undefined {
  const scene = sceneOf(cell);
  if (!scene || obstacle(cell)) return undefined;
  const { surface, light, protocol, size, angles, scale, overlap, noise, depthNoise, holes, seed } = scene;
  const { options } = cell;
  const settings: Record<string, Value | undefined> = {
    surface,
    light,
    protocol,
    // The Lab's pictures are larger than the library's by default.
    size: String(size ?? SAMPLE.size.default),
    alpha: angles?.alpha ?? 0,
    beta: angles?.beta ?? 0,
    gamma: angles?.gamma ?? 0,
    trueScale: scale,
    overlap,
    noise,
    depthNoise,
    holes,
    draw: seed,
    lighting: options.light,
    start: options.start,
    registration: options.registration,
    shading: options.shading,
    scale: options.scale === "free" ? null : options.scale,
    prior: options.lambda?.prior,
    lightPrior: options.lambda?.light,
  };
  const named = Object.entries(settings).filter((entry): entry is [string, Value] => entry[1] !== undefined);
  return { ...defaults, ...Object.fromEntries(named) };
}

/** The address of that run, which begins when the Lab opens. */
export function watchLink(cell: Cell): string | undefined {
  const settings = settingsOf(cell);
  return settings && `#${[toLink(settings), "play"].filter(Boolean).join("&")}`;
}
