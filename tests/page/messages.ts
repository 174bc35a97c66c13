/**
 * The page's messages to its workers, in the test's hands: what the page does beside a slow or silent worker is then looked
 * at in a fixed order of events, however fast or busy the machine is.
 */

import type { Page } from "@playwright/test";

/** What a message asks for: of the Lab's worker and of the readers' by its kind, or a cell of the tables. Clouds to be drawn have no kind. */
type Kind = "catalogue" | "open" | "reset" | "advance" | "look" | "probe" | "read" | "pair" | "cell";

interface Box {
  counts: Partial<Record<Kind, number>>;
  /** Which messages are kept back, after how many more of them. */
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

  /** For every document that the page opens from now on; each message arrives so many milliseconds late. */
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

  /** How many of a kind this document has sent, those that were kept back included. */
  count(kind: Kind): Promise<number> {
    return this.#page.evaluate((kind) => window.messages.counts[kind] ?? 0, kind);
  }

  /** From now on messages, or those of one kind, are kept back; `after` of them still pass. */
  hold(kind?: Kind, after = 0): Promise<void> {
    return this.#page.evaluate(({ kind, after }) => void (window.messages.holding = { kind, after }), { kind, after });
  }

  /** What was kept back is sent, in its order, and so is what follows. */
  release(): Promise<void> {
    return this.#page.evaluate(() => {
      window.messages.holding = undefined;
      for (const pass of window.messages.held.splice(0)) pass();
    });
  }

  /** What was kept back never arrives, as at a worker whose step takes for ever; what follows does. */
  lose(): Promise<void> {
    return this.#page.evaluate(() => {
      window.messages.holding = undefined;
      window.messages.held = [];
    });
  }
}
