/** The words of a text, one at a time, directly from its bytes, because a copy of a long text would take memory. */
const HASH = 35;
const NEWLINE = 10;

/** Longest word; longer ones are neither numbers nor names. */
const MOST = 64;

export class Words {
  /** Where the last word ended. */
  at = 0;
  readonly #bytes: Uint8Array;
  readonly #comments: boolean;

  /** `comments`: from "#" to the end of the line. */
  constructor(bytes: Uint8Array, comments = false) {
    this.#bytes = bytes;
    this.#comments = comments;
  }

  /** The next word; "" at the end. */
  next(): string {
    const bytes = this.#bytes;
    let at = this.at;
    for (;;) {
      while (at < bytes.length && (bytes[at] ?? 0) <= 32) at++;
      if (!this.#comments || bytes[at] !== HASH) break;
      while (at < bytes.length && bytes[at] !== NEWLINE) at++;
    }
    let word = "";
    while (at < bytes.length && (bytes[at] ?? 0) > 32 && word.length < MOST)
      word += String.fromCharCode(bytes[at++] ?? 0);
    this.at = at;
    return word;
  }

  /** The rest of this line, or the next one; undefined at the end. */
  line(): string | undefined {
    const bytes = this.#bytes;
    if (this.at >= bytes.length) return undefined;
    let end = bytes.indexOf(NEWLINE, this.at);
    if (end < 0) end = bytes.length;
    const text = String.fromCharCode(...bytes.subarray(this.at, Math.min(end, this.at + 1024)));
    this.at = end + 1;
    return text.replace(/\r$/, "");
  }
}
