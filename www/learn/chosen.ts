/** The slides of a show: all lessons in their order, or those that an address names, in the order of the address. */

import { lessonNamed, lessons } from "./lessons";
import type { LessonId } from "./protocol";

export type Chosen = readonly LessonId[];

const all = (): Chosen => lessons.map(({ id }) => id);

/** The slides of `slides=grey,strips`; names that are no lesson's are ignored, and no name at all means all lessons. */
export function chosenBy(names: string): Chosen {
  const found = names.split(",").flatMap((name) => lessonNamed(name)?.id ?? []);
  return found.length > 0 ? [...new Set(found)] : all();
}

/** The part of an address that brings these slides, which can begin with their questions. */
export const slidesInAddress = (chosen: Chosen, asksFirst: boolean): string =>
  (chosen.join() === all().join() ? "&slides" : `&slides=${chosen.join()}`) + (asksFirst ? "&ask" : "");

/** All lessons to choose from: in their own order, unless the chosen ones have another, which then come first. */
export function offered(chosen: Chosen): Chosen {
  const rest = all().filter((id) => !chosen.includes(id));
  const inOrder = all().filter((id) => chosen.includes(id));
  return chosen.join() === inOrder.join() ? all() : [...chosen, ...rest];
}
