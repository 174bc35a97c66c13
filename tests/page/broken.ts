/** Faults that tests inject into the page: workers that end, graphics that are lost, a page that is hidden. */

import type { Page } from "@playwright/test";

interface Breakable {
  /** Ends a worker without notice, as a browser does, after the n-th later message that contains all of `members`; `times` times. */
  endAt(members: Record<string, string>, nth?: number, times?: number): void;
  /** Number of workers that `endAt` has ended. */
  ended: number;
  /** Ends at once every worker whose script's address contains this name. */
  endAll(script: string): void;
  /** Number of workers that were made of such a script. */
  made(script: string): number;
  /** Hides the page: frames are not drawn, as while another tab is in front. */
  hide(isHidden: boolean): void;
}

/** Must be called before the page opens. */
export async function breakable(page: Page): Promise<void> {
  await page.addInitScript(() => {
    const workers: { worker: Worker; address: string }[] = [];
    let armed: { members: Record<string, string>; left: number; times: number } | undefined;
    const Real = Worker;
    window.Worker = class extends Real {
      constructor(address: string | URL, options?: WorkerOptions) {
        super(address, options);
        workers.push({ worker: this, address: String(address) });
      }
    };
    const send = Real.prototype.postMessage;
    Real.prototype.postMessage = function (
      this: Worker,
      message: Record<string, unknown>,
      rest?: StructuredSerializeOptions | Transferable[],
    ) {
      const isMeant =
        armed !== undefined &&
        Object.entries(armed.members).every(([key, value]) => String(message[key]) === value) &&
        --armed.left < 1;
      // Tests answer checks themselves, so a check's worker never receives the message at which it ends.
      if (!isMeant || message.kind !== "check") send.call(this, message, rest as StructuredSerializeOptions);
      if (!armed || !isMeant) return;
      this.terminate();
      (window as unknown as Breakable).ended++;
      armed.left = 1;
      if (--armed.times === 0) armed = undefined;
    };

    let isHidden = false;
    let waiting: FrameRequestCallback[] = [];
    const draw = requestAnimationFrame;
    window.requestAnimationFrame = (frame) => (isHidden ? waiting.push(frame) : draw(frame));
    Object.defineProperty(document, "visibilityState", { get: () => (isHidden ? "hidden" : "visible") });
    Object.defineProperty(document, "hidden", { get: () => isHidden });

    const mine: Breakable = {
      ended: 0,
      endAt: (members, nth = 1, times = 1) => (armed = { members, left: nth, times }),
      endAll: (script) => {
        for (const { worker, address } of workers) if (address.includes(script)) worker.terminate();
      },
      made: (script) => workers.filter(({ address }) => address.includes(script)).length,
      hide(hidden) {
        isHidden = hidden;
        document.dispatchEvent(new Event("visibilitychange"));
        const frames = waiting;
        waiting = [];
        if (!hidden) for (const frame of frames) draw(frame);
      },
    };
    Object.assign(window, mine);
  });
}

export const endAt = (page: Page, members: Record<string, string>, nth = 1, times = 1): Promise<void> =>
  page.evaluate(([members, nth, times]) => (window as unknown as Breakable).endAt(members, nth, times), [
    members,
    nth,
    times,
  ] as const);
export const ended = (page: Page): Promise<number> => page.evaluate(() => (window as unknown as Breakable).ended);
export const endAll = (page: Page, script: string): Promise<void> =>
  page.evaluate((script) => (window as unknown as Breakable).endAll(script), script);
export const made = (page: Page, script: string): Promise<number> =>
  page.evaluate((script) => (window as unknown as Breakable).made(script), script);
export const hide = (page: Page, isHidden: boolean): Promise<void> =>
  page.evaluate((isHidden) => (window as unknown as Breakable).hide(isHidden), isHidden);

/** Makes the n-th worker of this script ignore all messages and end as soon as it has reported to the page. Must be called before the page opens. */
export async function endSoon(page: Page, script: RegExp, nth: number): Promise<void> {
  const end =
    "addEventListener('message', (event) => event.stopImmediatePropagation()); const say = self.postMessage; self.postMessage = (message, ...rest) => { say.call(self, message, ...rest); if (message?.holds) self.close(); };";
  let count = 0;
  await page.route(script, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `${++count === nth ? `{${end}}` : ""}\n${await response.text()}` });
  });
}

/** WebGL that a test can take away and give back, on the page and in its threads. Must be called before the page opens. */
export async function fragileGraphics(page: Page): Promise<void> {
  const script = `{
    const made = [];
    for (const Canvas of [globalThis.HTMLCanvasElement, globalThis.OffscreenCanvas]) {
      if (!Canvas) continue;
      const get = Canvas.prototype.getContext;
      Canvas.prototype.getContext = function (kind, ...rest) {
        const context = get.call(this, kind, ...rest);
        if (/^webgl/.test(kind) && context && !made.some((each) => each.context === context)) made.push({ context, loss: context.getExtension("WEBGL_lose_context") });
        return context;
      };
    }
    new BroadcastChannel("graphics of tests").onmessage = ({ data }) => {
      for (const { loss } of made) data === "lose" ? loss.loseContext() : loss.restoreContext();
    };
  }`;
  await page.addInitScript(script);
  await page.route(/stage-thread[^/]*\.js$/, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `${script}\n${await response.text()}` });
  });
}

export const graphics = (page: Page, what: "lose" | "restore"): Promise<void> =>
  page.evaluate((what) => new BroadcastChannel("graphics of tests").postMessage(what), what);
