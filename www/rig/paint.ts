/** Drawing a mask: pixels that are used are 255, others 0. */

const [BACKGROUND, OBJECT, PROBABLY_BACKGROUND, PROBABLY_OBJECT] = [0, 1, 2, 3];

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

export class Paint {
  readonly width: number;
  readonly height: number;
  /** Absent as long as the whole image is used. */
  data: Uint8Array | undefined;
  /** The label of each pixel since the last suggestion: 0 background, 1 object, 2 probably background, 3 probably object. */
  marks: Uint8Array | undefined;

  constructor(width: number, height: number, data?: Uint8Array) {
    this.width = width;
    this.height = height;
    this.data = data?.slice();
  }

  /**
   * The first stroke decides the other pixels: if it marks used pixels, no others are used; if it marks excluded pixels, all others are
   * used.
   */
  #start(use: boolean): Uint8Array {
    this.data ??= new Uint8Array(this.width * this.height).fill(use ? 0 : 255);
    return this.data;
  }

  rectangle(box: Box, use: boolean): Box {
    const data = this.#start(use);
    const inside = this.#within(box);
    // A rectangle means that the object lies inside it. The first rectangle also excludes everything outside.
    this.marks ??= new Uint8Array(this.width * this.height).fill(use ? BACKGROUND : PROBABLY_OBJECT);
    for (let row = inside.top; row < inside.top + inside.height; row++) {
      const from = row * this.width + inside.left;
      data.fill(use ? 255 : 0, from, from + inside.width);
      this.marks.fill(use ? PROBABLY_OBJECT : BACKGROUND, from, from + inside.width);
    }
    return inside;
  }

  disc(column: number, row: number, radius: number, use: boolean): Box {
    const data = this.#start(use);
    this.marks ??= Uint8Array.from(data, (value) => (value && !use ? PROBABLY_OBJECT : PROBABLY_BACKGROUND));
    const box = this.#within({
      left: Math.floor(column - radius),
      top: Math.floor(row - radius),
      width: 2 * radius + 2,
      height: 2 * radius + 2,
    });
    for (let y = box.top; y < box.top + box.height; y++) {
      for (let x = box.left; x < box.left + box.width; x++) {
        if ((x - column) ** 2 + (y - row) ** 2 > radius ** 2) continue;
        data[y * this.width + x] = use ? 255 : 0;
        this.marks[y * this.width + x] = use ? OBJECT : BACKGROUND;
      }
    }
    return box;
  }

  /** Grows the used part by this many pixels on all sides; a negative number shrinks it. */
  grow(pixels: number): void {
    if (!this.data || pixels === 0) return;
    const value = pixels > 0 ? 255 : 0;
    this.#spread(value, Math.abs(pixels), this.height, this.width, this.width, 1);
    this.#spread(value, Math.abs(pixels), this.width, this.height, 1, this.width);
  }

  /** Spreads a value along each line in both directions, by this many pixels. */
  #spread(value: number, pixels: number, lines: number, length: number, line: number, step: number): void {
    const data = this.data;
    if (!data) return;
    const before = data.slice();
    for (let i = 0; i < lines; i++) {
      for (const forward of [true, false]) {
        let since = pixels + 1;
        for (let k = 0; k < length; k++) {
          const at = i * line + (forward ? k : length - 1 - k) * step;
          since = before[at] === value ? 0 : since + 1;
          if (since <= pixels) data[at] = value;
        }
      }
    }
  }

  get share(): number {
    return this.data ? this.data.reduce((sum, value) => sum + (value ? 1 : 0), 0) / this.data.length : 1;
  }

  #within({ left, top, width, height }: Box): Box {
    const [l, t] = [Math.max(0, Math.round(left)), Math.max(0, Math.round(top))];
    const [r, b] = [Math.min(this.width, Math.round(left + width)), Math.min(this.height, Math.round(top + height))];
    return { left: l, top: t, width: Math.max(0, r - l), height: Math.max(0, b - t) };
  }
}
