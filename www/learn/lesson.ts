/** The parts of a lesson. */

import { decimals, withUnit } from "./digits";
import type { SymbolName } from "./maths";
import type { Ink, LessonId, Values } from "./protocol";
import type { References } from "./references";

interface CommonControl {
  key: string;
  label: string | ((values: Values) => string);
  hint?: string;
  /** The condition under which the control is shown. */
  when?: (values: Values) => boolean;
}
export interface SliderControl extends CommonControl {
  kind: "slider";
  min: number;
  max: number;
  step: number;
  initial: number;
  unit?: string;
  /** Whether the slider runs over the logarithm, from 10^min to 10^max. */
  logarithmic?: boolean;
  /** The value as people read it, if it depends on the other controls. */
  reads?: (value: number, values: Values) => string;
}
export interface ChoiceControl extends CommonControl {
  kind: "choice";
  choices: readonly (readonly [value: string, label: string])[];
  initial: string;
}
export interface BoxControl extends CommonControl {
  kind: "box";
  initial: 0 | 1;
}
export type Control = SliderControl | ChoiceControl | BoxControl;

export interface Readout {
  key: string;
  label: string;
  unit?: string;
  digits?: number;
  ink?: Ink;
  /** One sentence that explains the number. */
  hint?: string;
}

/** The effect of a button. It sets controls at once and then moves one slider slowly, so that the change can be watched. */
export interface Try {
  set?: Values;
  /** A slider that each press moves on by one of its steps, up to its end. */
  step?: string;
  sweep?: { key: string; to: number };
}

/** A question before a surprise, which is answered by a choice or a number and then compared with the figure. */
export interface Guess {
  question: string;
  /** The paragraph that answers it: the question stands before this one. */
  before: number;
  /** The state of the figure that the question is about. */
  at: Values;
  choices?: readonly string[];
  /** Which of the choices is right. */
  right?: number;
  /** The number of the figure that is asked for, and how near counts as right. */
  number?: { key: string; unit?: string; digits: number; within: number };
  /** The change of the figure that reveals the answer. */
  reveal: Try;
  /** The panel from which the answer could be read, which a slide hides until the guess is made. */
  covers?: string;
  answer: string;
}

export interface Lesson {
  id: LessonId;
  title: string;
  /** The lesson in one sentence, which the slides show. */
  gist: string;
  formula(): Element;
  /** The formula in words. */
  formulaWords: string;
  /** Symbols of the text that the formula does not have. */
  symbols?: readonly SymbolName[];
  text: readonly string[];
  /** The stages of a loop, drawn in a row that leads back to its beginning. */
  stages?: readonly string[];
  /** Things to try with the figure: the first sentence says what its button does, the rest what to look for. */
  tasks: readonly string[];
  /** The effects of the tasks' buttons, in the same order. */
  tries: readonly Try[];
  /** Questions whose answers the figure reveals afterwards. */
  guesses: readonly Guess[];
  /** One sentence about what the reader can do after the lesson. */
  can: string;
  controls: readonly Control[];
  readouts: readonly Readout[];
  /** Panels on which a drag sets two sliders. With `follows`, a mouse sets them without a pressed button. */
  drags: Readonly<Record<string, { x: string; y: string; follows?: boolean }>>;
  /** Sections of the method's documents and publications on the subject. */
  more: References;
}

export const LIGHTS = [
  ["colourful", "coloured lamps"],
  ["window", "window"],
  ["overcast", "cloudy yard"],
] as const;

/** The panels that follow a mouse that only hovers over them. */
export const followedIn = ({ drags }: Lesson): ReadonlySet<string> =>
  new Set(Object.keys(drags).filter((key) => drags[key]?.follows));

export const initialValues = ({ controls }: Lesson): Values =>
  Object.fromEntries(controls.map(({ key, initial }) => [key, initial]));

/** The values for computation: a logarithmic slider gives powers of ten, and zero at its lower end. */
export function computed({ controls }: Lesson, values: Values): Values {
  return Object.fromEntries(
    controls.map((control) => {
      const value = values[control.key] ?? control.initial;
      return [control.key, control.kind === "slider" && control.logarithmic ? amount(control, Number(value)) : value];
    }),
  );
}

export const amount = ({ logarithmic, min }: SliderControl, value: number): number =>
  !logarithmic ? value : value <= min ? 0 : 10 ** value;

export const labelOf = ({ label }: Control, values: Values): string =>
  typeof label === "string" ? label : label(values);

/** The value of a control as displayed. */
export function shown(control: SliderControl, value: number, values: Values): string {
  if (control.reads) return control.reads(value, values);
  const number = amount(control, value);
  const digits = control.logarithmic ? digitsOf(number) : Math.max(0, -Math.floor(Math.log10(control.step) + 1e-9));
  return withUnit(decimals(number, digits), control.unit);
}

/** Decimals of a number that is rounded to two significant digits, without trailing zeros. */
function digitsOf(number: number): number {
  const plain = String(Number(number.toPrecision(2)));
  return plain.split(".")[1]?.length ?? 0;
}

/** Takes the values from an address that are valid for their controls. */
export function valuesFrom(lesson: Lesson, asked: URLSearchParams): Values {
  const values: Record<string, number | string> = { ...initialValues(lesson) };
  for (const control of lesson.controls) {
    const given = asked.get(control.key);
    if (given === null) continue;
    if (control.kind === "choice") {
      if (control.choices.some(([value]) => value === given)) values[control.key] = given;
    } else if (control.kind === "box") {
      values[control.key] = given === "1" ? 1 : 0;
    } else if (given.trim() !== "" && Number.isFinite(Number(given))) {
      values[control.key] = Math.min(control.max, Math.max(control.min, Number(given)));
    }
  }
  return values;
}
