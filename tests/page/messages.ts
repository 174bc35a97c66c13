/**
 * Controls the page's messages to its workers, so that the page's behaviour next to a slow or silent worker is tested in a fixed order of
 * events, however fast or busy the machine is.
 */

import type { Page } from "@playwright/test";

/** Kinds of messages to the worker of the Lab or of the readers, or a cell of the tables. Messages with clouds to draw have no kind. */
type Kind = "catalogue" | "open" | "reset" | "advance" | "look" | "probe" | "read" | "pair" | "cell";

interface Box {
  counts: Partial<Record<Kind, number>>;
  /** The kind of messages that are held back, and how many of them pass before. */
  holding: { kind: Kind | undefined; after: number } | undefined;
  held: (() => void)[];
}
declare global {
  interface Window {
    messages: Box;
  }
}

export class Messages {
  readonly #page: Page;

  private constructor(page: Page) {
    this.#page = page;
  }

  /** Applies to every document that the page opens later; each message is delayed by `late` milliseconds. */
  static async of(page: Page, late = 0): Promise<Messages> {
    await page.addInitScript((late) => {
      const box: Box = { counts: {}, holding: undefined, held: [] };
      window.messages = box;
      const send = Worker.prototype.postMessage;
      Worker.prototype.postMessage = function (
        this: Worker,
        message: { kind?: Kind; cell?: object },
        options?: StructuredSerializeOptions | Transferable[],
      ) {
        const pass = () => send.call(this, message, options as StructuredSerializeOptions);
        const kind = message.cell ? "cell" : message.kind;
        if (kind === undefined) return pass();
        box.counts[kind] = (box.counts[kind] ?? 0) + 1;
        const concerned = box.holding && (box.holding.kind ?? kind) === kind;
        if (concerned && box.holding && box.holding.after-- <= 0) box.held.push(pass);
        else if (late > 0) setTimeout(pass, late);
        else pass();
      };
    }, late);
    return new Messages(page);
  }

  /** Number of messages of a kind that this document has sent, including held ones. */
  count(kind: Kind): Promise<number> {
    return this.#page.evaluate((kind) => window.messages.counts[kind] ?? 0, kind);
  }

  /** Holds back later messages, or those of one kind, after `after` of them have passed. */
  hold(kind?: Kind, after = 0): Promise<void> {
    return this.#page.evaluate(({ kind, after }) => void (window.messages.holding = { kind, after }), { kind, after });
  }

  /** Sends the held messages in order; later ones pass. */
  release(): Promise<void> {
    return this.#page.evaluate(() => {
      window.messages.holding = undefined;
      for (const pass of window.messages.held.splice(0)) pass();
    });
  }

  /** Drops the held messages, as for a worker whose step never ends; later ones pass. */
  lose(): Promise<void> {
    return this.#page.evaluate(() => {
      window.messages.holding = undefined;
      window.messages.held = [];
    });
  }
}
