/**
 * EBML, the elements of Matroska: an id, a size, and bytes or further elements. Only the parts that are needed are read, since a recording may
 * be larger than memory.
 *
 * The packages on npm read a whole file, as a stream in Node.
 */
import { badFile } from "../../errors.js";
import type { Bytes } from "./source.js";

export interface Element {
  id: number;
  /** Positions at which the element's content begins and ends. */
  from: number;
  until: number;
}

/** Bytes of the longest head: four of an id, eight of a size. */
const HEAD = 12;
/** Bytes that are read at once if elements are small. */
const WINDOW = 2048;
/** Bytes of the largest content that is read whole: a calibration has some thousand, a list of tracks fewer. */
const MOST_CONTENT = 2 ** 24;

/** The elements of a file. The part that was read last is kept. */
export class Elements {
  readonly bytes: Bytes;
  #window = new Uint8Array();
  #at = 0;

  constructor(bytes: Bytes) {
    this.bytes = bytes;
  }

  /** This many bytes from a place, or fewer at the end of the file. */
  async peek(from: number, length: number): Promise<Uint8Array> {
    if (from < this.#at || from + length > this.#at + this.#window.length) {
      this.#window = (await this.bytes.read(from, Math.max(WINDOW, length))) as Uint8Array<ArrayBuffer>;
      this.#at = from;
    }
    return this.#window.subarray(from - this.#at, from - this.#at + length);
  }

  async content({ from, until }: Element): Promise<Uint8Array> {
    if (until - from > MOST_CONTENT)
      throw badFile(`one of its elements declares ${until - from} bytes, which is too large`);
    return this.bytes.read(from, until - from);
  }

  /** The element at a place, cut off at the end of its parent; undefined after the last one. */
  async at(from: number, end: number): Promise<Element | undefined> {
    const head = await this.peek(from, Math.min(HEAD, end - from));
    const found = headOf(head);
    if (found === undefined) return undefined;
    const start = from + found.length;
    return { id: found.id, from: start, until: found.size === undefined ? end : Math.min(end, start + found.size) };
  }

  async *children(parent: Element): AsyncGenerator<Element> {
    let at = parent.from;
    while (at < parent.until) {
      const element = await this.at(at, parent.until);
      if (element === undefined) return;
      yield element;
      at = element.until;
    }
  }
}

/** An id and a size; a size whose bits are all set is unknown. */
function headOf(bytes: Uint8Array): { id: number; size: number | undefined; length: number } | undefined {
  const width = Math.clz32(bytes[0] ?? 0) - 23;
  if (width > 4 || bytes.length < width + 1) return undefined;
  let id = 0;
  for (let i = 0; i < width; i++) id = id * 256 + (bytes[i] ?? 0);
  const first = bytes[width] ?? 0;
  const count = Math.clz32(first) - 23;
  if (count > 8 || bytes.length < width + count) return undefined;
  let size = first & (0xff >> count);
  let isOpen = size === 0xff >> count;
  for (let i = 1; i < count; i++) {
    const byte = bytes[width + i] ?? 0;
    isOpen &&= byte === 0xff;
    size = size * 256 + byte;
  }
  return { id, size: isOpen ? undefined : size, length: width + count };
}

/** The elements in bytes that have been read. */
export function* elementsIn(bytes: Uint8Array): Generator<{ id: number; bytes: Uint8Array }> {
  for (let at = 0; at < bytes.length; ) {
    const head = headOf(bytes.subarray(at, at + HEAD));
    if (head === undefined) return;
    const from = at + head.length;
    const until = head.size === undefined ? bytes.length : Math.min(bytes.length, from + head.size);
    yield { id: head.id, bytes: bytes.subarray(from, until) };
    at = until;
  }
}

export const unsigned = (bytes: Uint8Array): number => bytes.reduce((sum, byte) => sum * 256 + byte, 0);
export const text = (bytes: Uint8Array): string => new TextDecoder().decode(bytes).replace(/\0+$/, "");
