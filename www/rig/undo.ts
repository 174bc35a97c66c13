/** Undo: the state before something was removed or changed with one click. */

import type { RigState } from "./state";

/** Largest number of undo steps; their contents stay in memory. */
const MOST_STEPS = 20;

/** An object with its earlier state. The object itself stays in its list, because rows of the page refer to it. */
interface Kept {
  thing: object;
  copy: object;
}

/** The step of the page on which the removed item was visible. */
export type Where = "files" | "calibration";

interface Step {
  words: string;
  where: Where;
  /** Whether the removed item has been restored in another way. */
  isMoot(): boolean;
  /** Number of an item; later items have higher numbers. */
  last: number;
  /** Whether everything was removed. Later items then belong to another rig. */
  isWhole: boolean;
  lists: Pick<RigState, "items" | "frames" | "candidates">;
  rest: Pick<RigState, "notes" | "history" | "run">;
  kept: Kept[];
}

export class Undo {
  readonly #rig: RigState;
  #steps: Step[] = [];
  /** Ids of the files that the worker holds, as far as this page has seen them. */
  #known = new Set<number>();

  constructor(rig: RigState) {
    this.#rig = rig;
  }

  /** A description of what the next undo takes back; undefined if there is no step, or if its effect would not be visible. */
  wordsAt(where: string): string | undefined {
    if (this.#steps.at(-1)?.isMoot()) {
      this.#steps = this.#steps.slice(0, this.#steps.findLastIndex((step) => !step.isMoot()) + 1);
      this.#forget();
    }
    const last = this.#steps.at(-1);
    return last?.where === where ? last.words : undefined;
  }

  /** Must be called before the change. */
  keep(
    words: string,
    {
      where = "files",
      isWhole = false,
      isMoot = () => false,
    }: Partial<Pick<Step, "where" | "isWhole" | "isMoot">> = {},
  ): void {
    const { items, frames, candidates, notes, history, cameras, run } = this.#rig;
    const things = [
      ...items,
      ...frames,
      ...candidates,
      cameras.colour,
      cameras.depth,
      cameras.colour.typed,
      cameras.depth.typed,
    ];
    this.#steps.push({
      words,
      where,
      isMoot,
      last: this.#rig.freshId(),
      isWhole,
      lists: { items: [...items], frames: [...frames], candidates: [...candidates] },
      rest: { notes, history, run },
      kept: things.map((thing) => ({ thing, copy: { ...thing } })),
    });
    if (this.#steps.length > MOST_STEPS) this.#steps.shift();
    this.#forget();
  }

  back(): void {
    const step = this.#steps.pop();
    if (!step) return;
    for (const { thing, copy } of step.kept) {
      for (const key of Object.keys(thing)) if (!(key in copy)) Reflect.deleteProperty(thing, key);
      Object.assign(thing, copy);
    }
    const { items, frames, candidates } = this.#rig;
    const later = <T extends { id: number }>(list: T[]): T[] =>
      step.isWhole ? [] : list.filter(({ id }) => id > step.last);
    Object.assign(this.#rig, {
      items: [...step.lists.items, ...later(items)],
      frames: [...step.lists.frames, ...later(frames)],
      candidates: [...step.lists.candidates, ...later(candidates)],
      ...(step.isWhole ? step.rest : {}),
    });
    for (const { id } of items) this.#known.add(id);
    this.#forget();
    this.#rig.changed();
  }

  /** Releases the files to which neither the rig nor an undo step refers. */
  #forget(): void {
    const needed = new Set(
      [...this.#rig.items, ...this.#steps.flatMap(({ lists }) => lists.items)].map(({ id }) => id),
    );
    for (const id of this.#known)
      if (!needed.has(id)) void this.#rig.session.call("forget", { file: id }).catch(() => {});
    this.#known = needed;
  }
}
