/**
 * Keeps a rig over a reload. It stores the requests that read the files, together with the files, and one record of the visitor's choices
 * and the last verdict. A reload restores it in its own tab; other tabs offer it. Frames of a robot exist only in the worker and are not
 * kept.
 */

import { change, reasonOf, records } from "../database";
import type { Rig } from "./rig";
import type { Read } from "./session";

/** The record beside the requests. */
const STATE = "state";
/** Milliseconds without a change after which the rig is stored. */
const REST = 300;
/** Key in the storage of this tab; its value names the tab's own rig. */
const MINE = "kept-rig";
/** The name of this file contains a hash of its content. Another version of the page may store other records. */
const VERSION = import.meta.url;

type Lists = Pick<Rig, "items" | "frames" | "candidates" | "cues" | "notes" | "arranged" | "run" | "history">;

interface State {
  /** Identifies the tab that stored it. */
  owner: string;
  version: string;
  /** The largest number in use. */
  last: number;
  /** The keys of the requests, in their order. */
  order: string[];
  cameras: Rig["cameras"];
  lists: Lists;
}

/** If the browser forbids storage, nothing is kept. */
function ownerHere(): string | null {
  try {
    return sessionStorage.getItem(MINE);
  } catch {
    return null;
  }
}

function own(owner: string): void {
  try {
    sessionStorage.setItem(MINE, owner);
  } catch {
    // The rig is offered after a reload, not restored.
  }
}

async function found(): Promise<{ state: State; reads: Map<string, Read> } | undefined> {
  const all = await records("rig").catch(() => new Map<string, unknown>());
  const state = all.get(STATE) as State | undefined;
  return state && { state, reads: new Map(state.order.map((key) => [key, all.get(key) as Read])) };
}

export class Kept {
  readonly #rig: Rig;
  /** Called with a sentence about how the files are kept. */
  readonly #onWords: (words: string) => void;
  /** The records of this rig in the database. */
  #stored = new Map<string, Read>();
  #owner = crypto.randomUUID() as string;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Whether the records in the database are those of this rig. */
  #isStored = false;
  #work: Promise<void> = Promise.resolve();

  constructor(rig: Rig, onWords: (words: string) => void) {
    this.#rig = rig;
    this.#onWords = onWords;
    rig.listen(() => {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => (this.#work = this.#work.then(() => this.#keep())), REST);
    });
  }

  /** Restores the rig that this tab had before a reload; returns the number of files that another visit has left. */
  async open(): Promise<number> {
    const last = await found();
    if (!last || this.#isUsed) return 0;
    if (last.state.owner !== ownerHere()) return last.state.lists.items.length;
    await this.restore();
    return 0;
  }

  /** Restores the stored rig, unless another one has been begun. */
  async restore(): Promise<void> {
    const last = await found();
    if (!last || this.#isUsed) return;
    const { state, reads } = last;
    const rig = this.#rig;
    if (state.version !== VERSION) return this.#readAgain(reads.values());
    for (const [key, read] of reads) rig.session.known.set(key, read);
    this.#stored = reads;
    this.#isStored = true;
    this.#owner = state.owner;
    own(state.owner);
    rig.reserve(state.last);
    Object.assign(rig, state.lists);
    for (const { kind, ask } of reads.values()) {
      if (kind !== "read") continue;
      const item = rig.item(ask.file);
      if (item) item.blob = ask.blob;
    }
    for (const side of ["colour", "depth"] as const) Object.assign(rig.cameras[side], state.cameras[side]);
    rig.session.onReplaced();
    rig.changed();
  }

  get #isUsed(): boolean {
    const { items, candidates, busy } = this.#rig;
    return items.length + candidates.length > 0 || busy !== "";
  }

  /** Restores only the files; the visitor chooses their roles again. */
  async #readAgain(reads: Iterable<Read>): Promise<void> {
    for (const { kind, ask } of reads) {
      if (kind === "read") await this.#rig.add([{ name: ask.name, blob: ask.blob }]);
      if (kind === "folder") await this.#rig.addFolder(ask.files);
    }
  }

  async #keep(): Promise<void> {
    const { items, busy, live } = this.#rig;
    // The rig is stored after these activities, because each ends with another change.
    if (busy || live.isRunning || items.some(({ state }) => state === "reading")) return;
    if (!this.#isUsed) return this.#forget();
    try {
      await this.#write();
      this.#onWords("Files and choices stay in this browser, also after a reload, until you start over.");
    } catch (error) {
      await this.#forget();
      this.#onWords(
        `This browser could not store the files (${reasonOf(error)}). They work, but a reload removes them.`,
      );
    }
  }

  async #write(): Promise<void> {
    const rig = this.#rig;
    const { frames, candidates, cues, notes, arranged, run, history, cameras } = rig;
    const items = rig.items.map(({ blob: _, ...rest }) => rest);
    const lists: Lists = { items, frames, candidates, cues, notes, arranged, run, history };
    const reads = new Map(rig.session.known);
    const owner = this.#owner;
    const state: State = { owner, version: VERSION, last: rig.freshId(), order: [...reads.keys()], cameras, lists };
    await change("rig", (store) => {
      if (!this.#isStored) store.clear();
      for (const key of this.#stored.keys()) if (!reads.has(key)) store.delete(key);
      // Files are large: each is written once.
      for (const [key, read] of reads) if (this.#stored.get(key) !== read) store.put(read, key);
      store.put(state, STATE);
    });
    this.#stored = reads;
    this.#isStored = true;
    own(owner);
  }

  /** Deletes the stored files, so that a reload does not restore them. */
  async #forget(): Promise<void> {
    if (this.#isStored) await change("rig", (store) => store.clear()).catch(() => {});
    this.#stored = new Map();
    this.#isStored = false;
    this.#onWords("");
  }
}
