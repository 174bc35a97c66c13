/** Lays the words of a catalogue over the texts of lessons, exercises and figures, by the path of each text. */

import { filled, wordsAt } from "../words";
import type { Drawing, Panel, Said } from "./protocol";

/** Fields whose strings are read by people; a choice, a pair of strings, is read by its second one. */
export const READ = new Set([
  ...["title", "gist", "formulaWords", "text", "tasks", "label", "hint", "unit", "choices", "paper", "stages"],
  ...["can", "links", "question", "answer"],
]);
/** Units that are the same in all languages. */
export const SAME_UNITS: readonly string[] = ["°", "%", "px"];

type Plain = Readonly<Record<string, unknown>>;
const isPlain = (value: unknown): value is Plain =>
  typeof value === "object" && value !== null && !Array.isArray(value);
/** Fields with pairs: a value or an address with its words. */
const PAIRS = new Set(["choices", "links"]);
const isName = (text: unknown): text is string => typeof text === "string" && /^[\w-]+$/.test(text);

/** The name of an item of a list: its key if it has one, so that other items can be put before it. */
export function nameOf(item: unknown, index: number): string {
  const named = Array.isArray(item) ? item[0] : isPlain(item) ? (item.key ?? item.id) : undefined;
  return isName(named) ? named : String(index);
}

/** The same texts in the words of the catalogue in use, as far as it has them. */
export function translated<T>(texts: T, path: readonly string[]): T {
  return over(texts, wordsAt(path)) as T;
}

/** `field` is the name of the field that holds these texts. */
function over(texts: unknown, words: unknown, field = ""): unknown {
  if (words === undefined) return texts;
  if (typeof texts === "string") return typeof words === "string" ? words : texts;
  if (typeof texts === "function") return isPlain(words) && typeof words.by === "string" ? choosing(words) : texts;
  const named = words as Plain;
  if (Array.isArray(texts))
    return texts.map((item, index) => {
      const own = named[nameOf(item, index)];
      return PAIRS.has(field) && Array.isArray(item) ? [item[0], over(item[1], own)] : over(item, own);
    });
  if (!isPlain(texts)) return texts;
  return Object.fromEntries(Object.entries(texts).map(([key, text]) => [key, over(text, named[key], key)]));
}

/** Words that follow another control: `by` names it, and each of its choices has words. */
const choosing = (words: Plain) => (values: Plain) => String(words[String(values[String(words.by)])] ?? "");

/** A figure in the words of the catalogue in use, with its numbers in their places. */
export function drawingIn(lesson: string, drawing: Drawing): Drawing {
  const { words, said } = drawing;
  return {
    ...drawing,
    panels: drawing.panels.map((panel) => panelIn(lesson, panel)),
    ...(words ? { words: { ...words, ...saidIn(said) } } : {}),
  };
}

/** The path of a panel's words. */
export const placeOf = (lesson: string, { key, state }: Panel): string[] => [
  "figures",
  lesson,
  ...(state === undefined ? [key] : [key, state]),
];

function panelIn(lesson: string, panel: Panel): Panel {
  const words = translated(wordsOf(panel), placeOf(lesson, panel));
  const fill = (text: unknown) => (typeof text === "string" ? filled(text, panel.details ?? {}) : text);
  const { names = [], ...rest } = words;
  const texts = Object.fromEntries(Object.entries(rest).map(([key, text]) => [key, fill(text)]));
  const named = <T extends { name: string }>(all: T[]): T[] =>
    all.map((each, i) => ({ ...each, name: names[i] ?? each.name }));
  if (panel.kind === "plot") return { ...panel, ...texts, series: named(panel.series) };
  if (panel.kind === "cloud") return { ...panel, ...texts, sets: named(panel.sets) };
  return { ...panel, ...texts };
}

/** The texts of a panel, with the names of its curves or clouds. */
export function wordsOf(panel: Panel): { [key: string]: string | string[]; names?: string[] } {
  const { title, alt } = panel;
  if (panel.kind === "plot") {
    const { x, y, series } = panel;
    return { title, alt, x, y, names: series.map(({ name }) => name) };
  }
  if (panel.kind === "cloud") return { title, alt, names: panel.sets.map(({ name }) => name) };
  return { title, alt, ...(panel.legend ? { legend: panel.legend } : {}) };
}

/** Words of a figure's numbers, such as the status of a run, as far as the catalogue has all their parts. */
function saidIn(said: Drawing["said"] = {}): Record<string, string> {
  const all = Object.entries(said).map(([key, parts]) => [key, parts.map(partIn)] as const);
  return Object.fromEntries(
    all.flatMap(([key, parts]) => (parts.every((part) => part !== undefined) ? [[key, parts.join(": ")]] : [])),
  );
}

function partIn({ id, details }: Said): string | undefined {
  const words = wordsAt(id.split("."));
  if (typeof words !== "string") return undefined;
  const { weakest } = details;
  return filled(words, typeof weakest === "string" ? { ...details, weakest: directionIn(weakest) } : details);
}

/** A direction of a pose, which the module joins from one or two names. */
function directionIn(direction: string): string {
  const names = direction.split(" with ").map((name) => wordsAt(["directions", name]) ?? name);
  return names.join(` ${String(wordsAt(["directions", "with"]) ?? "with")} `);
}
