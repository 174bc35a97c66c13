// The English words of Learn by their paths in a catalogue of another language: what www/learn/languages/*.json have to translate.
import { readFileSync, readdirSync } from "node:fs";
import { inRoot } from "../../scripts/shell.mjs";
import { exercises, learn, lessons } from "./lesson-figures.mjs";

const { READ, SAME_UNITS, STATUSES, SYMBOLS, chapters, nameOf, placeOf, wordsOf } = learn;

/** The entries that have words, as an object; undefined if no entry has any. */
const full = (entries) => {
  const kept = entries.filter(([, words]) => words !== undefined);
  return kept.length > 0 ? Object.fromEntries(kept) : undefined;
};

/** The choice on which a label depends, and the label for each of its values. */
function labelsOf(label, { controls }) {
  for (const { key, choices = [] } of controls) {
    const labels = Object.fromEntries(choices.map(([value]) => [value, label({ [key]: value })]));
    if (new Set(Object.values(labels)).size > 1) return { by: key, ...labels };
  }
  throw new Error(`A label of lesson ${controls[0].key} depends on no choice`);
}

/** The texts within a part of a lesson; `field` is the nearest field's name. */
function textsOf(part, lesson, field) {
  if (typeof part === "string")
    return READ.has(field) && !(field === "unit" && SAME_UNITS.includes(part.trim())) ? part : undefined;
  if (typeof part === "function") return field === "label" ? labelsOf(part, lesson) : undefined;
  if (Array.isArray(part))
    return full(
      part.map((item, at) => {
        const isPair = Array.isArray(item) && READ.has(field);
        return [nameOf(item, at), textsOf(isPair ? item[1] : item, lesson, field)];
      }),
    );
  if (typeof part !== "object" || part === null) return undefined;
  return full(Object.entries(part).map(([name, each]) => [name, textsOf(each, lesson, name)]));
}

/** States of figures with further words, which no single choice produces. */
const OTHERS = { strips: [{ lx: 0.6, ly: 0.6, sx: 0.1, sy: 0.1 }] };

/** The first drawing of a figure for each value of its choices and boxes, and for the states above. Later drawings have the same words. */
function panelsOf(lesson) {
  const values = (control) =>
    control.kind === "choice" ? control.choices.map(([value]) => value) : control.kind === "box" ? [0, 1] : [];
  const states = lesson.controls.flatMap((control) => values(control).map((value) => ({ [control.key]: value })));
  return [{}, ...states, ...(OTHERS[lesson.id] ?? [])].flatMap((state) => {
    const asked = learn.computed(lesson, { ...learn.valuesFrom(lesson, new URLSearchParams()), ...state });
    const drawings = learn[lesson.id](asked);
    const { panels } = drawings.next().value;
    drawings.return();
    return panels;
  });
}

function figuresOf() {
  const all = {};
  const known = new Map();
  for (const lesson of lessons)
    for (const panel of panelsOf(lesson)) {
      const path = placeOf(lesson.id, panel).slice(1);
      const last = path.pop();
      const place = path.reduce((at, name) => (at[name] ??= {}), all);
      const words = Object.fromEntries(
        Object.entries(wordsOf(panel)).map(([key, text]) => [key, Array.isArray(text) ? { ...text } : text]),
      );
      for (const [field, text] of Object.entries(words)) {
        const name = [...path, last, field].join(".");
        const before = known.get(name);
        // Curves without points are left out.
        const isSame =
          typeof text === "string"
            ? before === text
            : Object.keys(text).every((at) => (before?.[at] ?? text[at]) === text[at]);
        if (before !== undefined && !isSame)
          throw new Error(`${name} has other words in another state: give the panel a "state"`);
        known.set(name, typeof text === "string" ? text : { ...before, ...text });
      }
      // A panel's words may contain those of one of its states.
      const { names, ...rest } = words;
      const there = Object.assign((place[last] ??= {}), rest);
      if (names) there.names = { ...there.names, ...names };
    }
  return all;
}

const PHRASE = /\bphrase\(\s*(["'`])(.+?)\1,\s*(?:"((?:[^"\\]|\\.)*)"|`([^`]*)`)/gs;
const SAID = /<(\w+)[^>]*\sdata-say="([^"]+)"[^>]*>([^<]*)</g;
const LABEL = /aria-label="([^"]+)" data-say-label="([^"]+)"/g;

/** Ids with their English words, once for each place. */
export function phrases() {
  const sources = readdirSync(inRoot("www"), { recursive: true })
    .filter((name) => name.endsWith(".ts"))
    .map((name) => readFileSync(inRoot("www", name), "utf8"));
  const page = readFileSync(inRoot("www/index.html"), "utf8");
  return [
    ...sources.flatMap((text) =>
      [...text.matchAll(PHRASE)].map(([, , id, plain, template]) => [id, plain ?? template]),
    ),
    ...[...page.matchAll(SAID)].map(([, , id, words]) => [id, words]),
    ...[...page.matchAll(LABEL)].map(([, words, id]) => [id, words]),
    ...Object.entries(SYMBOLS).map(([name, symbol]) => [`symbol.${name}`, symbol.name]),
  ].filter(([id]) => !id.includes("${"));
}

const AXES = ["x", "y", "z"];
const DIRECTIONS = [
  ...AXES.map((axis) => `rotation about ${axis}`),
  ...AXES.map((axis) => `translation along ${axis}`),
  ...["scale", "unknown", "with"],
];

export function english() {
  const { runs } = JSON.parse(readFileSync(inRoot("src/codes.json"), "utf8"));
  return {
    chapters: Object.fromEntries(chapters.map(({ id, title }) => [id, title])),
    lessons: Object.fromEntries(lessons.map((lesson) => [lesson.id, textsOf(lesson, lesson)])),
    exercises: textsOf(exercises),
    figures: figuresOf(),
    interface: Object.fromEntries(phrases()),
    statuses: STATUSES,
    runs: Object.fromEntries(Object.keys(runs).map((code) => [code, undefined])),
    directions: Object.fromEntries(DIRECTIONS.map((direction) => [direction, direction])),
  };
}
