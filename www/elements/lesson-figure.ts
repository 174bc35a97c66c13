/** The figure of a lesson in a shadow root, made of the parts of the page's lessons. */

import type { ElementError, FigureResult } from "../../pkg/elements.js";
import { dipInto, make } from "../dom";
import { Controls } from "../learn/controls";
import { Figure } from "../learn/figure";
import { type Lesson, computed, followedIn, initialValues, valuesFrom } from "../learn/lesson";
import { lessonNamed, lessons } from "../learn/lessons";
import type { Values } from "../learn/protocol";
import { Readouts } from "../learn/readouts";
import { Session } from "../learn/session";
import { styled } from "./styled";

interface Hooks {
  onResult(result: FigureResult, done: boolean): void;
  onState(state: string): void;
  onError(error: ElementError): void;
}

export interface Shown {
  set(state: string): void;
  end(): void;
}

/** The values that differ from the lesson's own, as in the page's addresses. */
function stateOf(lesson: Lesson, values: Values): string {
  const start = initialValues(lesson);
  const changed = Object.entries(values).filter(([key, value]) => value !== start[key]);
  return new URLSearchParams(changed.map(([key, value]) => [key, String(value)])).toString();
}

export function show(root: ShadowRoot, name: string, state: string, hooks: Hooks): Shown {
  styled(root);
  const alert = make("p", { class: "alert", role: "alert", hidden: true });
  root.replaceChildren(alert);
  const complain = (error: ElementError) => {
    alert.textContent = error.message;
    alert.hidden = false;
    hooks.onError(error);
  };
  const lesson = lessonNamed(name);
  if (!lesson) {
    const known = lessons.map(({ id }) => id).join(", ");
    complain({ code: "option", field: "lesson", message: `lesson: "${name}" is none of ${known}` });
    return { set: () => {}, end: () => {} };
  }
  return live(root, lesson, valuesFrom(lesson, new URLSearchParams(state)), alert, { ...hooks, onError: complain });
}

function live(root: ShadowRoot, lesson: Lesson, values: Values, alert: HTMLElement, hooks: Hooks): Shown {
  const session = new Session({
    onDrawing: (drawing, done) => {
      dipInto(root);
      alert.hidden = true;
      figure.show(drawing);
      readouts.show(drawing);
      box.setAttribute("aria-busy", String(!done));
      hooks.onResult({ numbers: drawing.numbers, words: drawing.words ?? {} }, done);
    },
    onFault: ({ code, field, message, details }) => {
      box.setAttribute("aria-busy", "false");
      hooks.onError({ code, message, ...(field === undefined ? {} : { field }), ...(details && { details }) });
    },
  });
  const ask = () => {
    box.setAttribute("aria-busy", "true");
    figure.wait();
    readouts.wait();
    session.ask(lesson.id, computed(lesson, controls.values));
  };
  const changed = () => {
    hooks.onState(stateOf(lesson, controls.values));
    ask();
  };
  const figure = new Figure(new Set(Object.keys(lesson.drags)), followedIn(lesson), (key, x, y) =>
    controls.set(dragged(lesson, key, x, y)),
  );
  const controls = new Controls(lesson, values, changed);
  const readouts = new Readouts(lesson.readouts);
  const box = make(
    "section",
    { class: "learn-figure", "aria-label": lesson.title, "aria-busy": "true", part: "figure" },
    controls.element,
    readouts.element,
    figure.element,
  );
  root.append(box);
  ask();
  return {
    set: (state) => {
      controls.show(valuesFrom(lesson, new URLSearchParams(state)));
      changed();
    },
    end: () => session.end(),
  };
}

/** The values of the two sliders that a place on a panel selects. The place is given as shares of the panel's sides. */
function dragged(lesson: Lesson, key: string, x: number, y: number): Values {
  const axes = lesson.drags[key];
  if (!axes) return {};
  const along = (name: string, share: number): [string, number][] => {
    const control = lesson.controls.find((each) => each.key === name);
    if (control?.kind !== "slider") return [];
    const value = control.min + share * (control.max - control.min);
    return [[name, Number((Math.round(value / control.step) * control.step).toFixed(6))]];
  };
  return Object.fromEntries([...along(axes.x, x), ...along(axes.y, y)]);
}
