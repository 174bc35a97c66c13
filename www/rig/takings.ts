/** Frames from recordings, which are taken again when other topics are chosen. */

import { type Item, type Taking, messageOf } from "./state";
import type { Assembly } from "./protocol";
import type { Session } from "./session";
import type { RigState } from "./state";

/** Number of frames taken from a recording; more frames of one rig add little. */
const FRAMES = 10;

interface Taker extends RigState {
  readonly session: Session;
  reserve(count: number): number;
  join(assembly: Assembly, recording?: Item): void;
  leave(items: readonly Item[]): void;
}

export class Takings {
  readonly #rig: Taker;

  constructor(rig: Taker) {
    this.#rig = rig;
  }

  /** Takes frames from a recording. Those that were taken from it earlier are removed. */
  async take(item: Item, changes: Partial<Pick<Taking, "colour" | "depth" | "frames">> = {}): Promise<void> {
    const { chosen = {} } = item.summary ?? {};
    const before = item.taking;
    const { colour = "", depth = "", frames = FRAMES } = { ...chosen, ...before, ...changes };
    const taking: Taking = { colour, depth, frames, state: "reading", share: 0, notes: [] };
    item.taking = taking;
    this.#forget(item, before);
    this.#rig.changed();
    try {
      const first = this.#rig.reserve(3 * frames);
      const topics = { ...(colour && { colour }), ...(depth && { depth }) };
      const onProgress = (share: number) => {
        taking.share = share;
        this.#rig.changed();
      };
      const assembly = await this.#rig.session.call("take", { file: item.id, first, ...topics, frames }, onProgress);
      // A later choice is already under way.
      if (item.taking !== taking || !this.#rig.items.includes(item)) return;
      Object.assign(taking, { state: "read", notes: assembly.warnings });
      this.#rig.join(assembly, item);
    } catch (error) {
      Object.assign(taking, { state: "failed", error: messageOf(error) });
    }
    this.#rig.changed();
  }

  #forget(item: Item, before: Taking | undefined): void {
    this.#rig.leave(this.#rig.items.filter(({ recording }) => recording === item.id));
    this.#rig.candidates = this.#rig.candidates.filter(({ file }) => file !== item.id);
    if (before) this.#rig.notes = this.#rig.notes.filter((note) => !before.notes.includes(note));
  }
}
