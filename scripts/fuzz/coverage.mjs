// The part of the package that has run so far, by V8's precise coverage; it guides the fuzzer.
import { Session } from "node:inspector/promises";

/** V8 lists the ranges of a function that did not run. The rest of the function has run. */
export class Coverage {
  #session = new Session();
  /** For each function, the characters of its text that have run. */
  #ran = new Map();
  /** The characters that ran for the first time in the last call: arrays and indices in them. */
  #last = [];
  /** Number of characters of all functions that have run. */
  count = 0;

  async start() {
    this.#session.connect();
    await this.#session.post("Profiler.enable");
    await this.#session.post("Profiler.startPreciseCoverage", { callCount: true, detailed: true });
    await this.grown();
  }

  /** Growth of the covered text since the last call, characters. */
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

  /** Takes back the last growth, so that it can be measured again file by file. */
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
    // Ranges follow the order of the text; none lies within another idle range.
    for (const { startOffset, endOffset } of idle) {
      mark(startOffset);
      at = Math.max(at, endOffset);
    }
    mark(to);
  }
}
