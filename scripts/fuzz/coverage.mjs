// How much of the package ran so far, by V8's precise coverage: what a fuzzer is guided by.
import { Session } from "node:inspector/promises";

/** V8 lists the ranges of a function that did not run; what is left of the function did. */
export class Coverage {
  #session = new Session();
  /** For each function the characters of its text that have run. */
  #ran = new Map();
  /** What grew last: arrays and indices. */
  #last = [];
  /** Characters that have run, of all functions. */
  count = 0;

  async start() {
    this.#session.connect();
    await this.#session.post("Profiler.enable");
    await this.#session.post("Profiler.startPreciseCoverage", { callCount: true, detailed: true });
    await this.grown();
  }

  /** By how many characters the covered text has grown since it was last asked. */
  async grown() {
    const { result } = await this.#session.post("Profiler.takePreciseCoverage");
    const before = this.count;
    this.#last = [];
    for (const { url, functions } of result) {
      const file = /\/pkg\/([^/]+)$/.exec(url)?.[1];
      if (file === undefined) continue;
      for (const { ranges } of functions) if (ranges[0].count > 0) this.#add(file, ranges);
    }
    return this.count - before;
  }

  /** Takes back what grew last, so that it can be asked again file by file. */
  forget() {
    for (const [ran, at] of this.#last) ran[at] = 0;
    this.count -= this.#last.length;
    this.#last = [];
  }

  #add(file, [whole, ...parts]) {
    const { startOffset: from, endOffset: to } = whole;
    const key = `${file}:${from}-${to}`;
    const ran = this.#ran.get(key) ?? new Uint8Array(to - from);
    this.#ran.set(key, ran);
    const idle = parts.filter(({ count }) => count === 0);
    let at = from;
    const mark = (until) => {
      for (; at < until; at++) {
        if (ran[at - from] === 1) continue;
        ran[at - from] = 1;
        this.count++;
        this.#last.push([ran, at - from]);
      }
    };
    // In the order of the text; none lies within another that did not run either.
    for (const { startOffset, endOffset } of idle) {
      mark(startOffset);
      at = Math.max(at, endOffset);
    }
    mark(to);
  }
}
