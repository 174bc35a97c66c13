// The losses of an 8-bit JPEG: sRGB, chroma at half the resolution, 8x8 cosine blocks in steps (Annex K of ITU-T T.81, scaled by quality
// as in the IJG's library). Entropy coding is lossless and therefore left out.

const BLOCK = 8;
const LUMA = [
  ...[
    16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17, 22, 29, 51,
    87, 80, 62,
  ],
  ...[18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101],
  ...[72, 92, 95, 98, 112, 100, 103, 99],
];
const CHROMA = [
  ...[
    17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99, 24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99,
    99, 99, 99,
  ],
  ...Array(32).fill(99),
];

const COSINES = Array.from({ length: BLOCK }, (_, k) =>
  Array.from(
    { length: BLOCK },
    (_, x) => Math.sqrt((k === 0 ? 1 : 2) / BLOCK) * Math.cos(((2 * x + 1) * k * Math.PI) / (2 * BLOCK)),
  ),
);

const scaled = (table, quality) => {
  const scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  return table.map((step) => Math.min(255, Math.max(1, Math.floor((step * scale + 50) / 100))));
};

/** The cosine transform of a block's rows, then of its columns; `inverse` reverses it. */
function transformed(block, inverse) {
  let values = block;
  for (let pass = 0; pass < 2; pass++) {
    const next = new Float64Array(BLOCK * BLOCK);
    for (let line = 0; line < BLOCK; line++) {
      for (let to = 0; to < BLOCK; to++) {
        let sum = 0;
        for (let from = 0; from < BLOCK; from++) {
          sum += values[line * BLOCK + from] * (inverse ? COSINES[from][to] : COSINES[to][from]);
        }
        // The result is transposed, so that the second pass transforms the columns.
        next[to * BLOCK + line] = sum;
      }
    }
    values = next;
  }
  return values;
}

/** A plane in blocks, each rounded to the steps of the table; the last pixel repeats at the frame's edge. */
function quantised({ width, height, data }, table) {
  const out = new Float64Array(data.length);
  for (let top = 0; top < height; top += BLOCK) {
    for (let left = 0; left < width; left += BLOCK) {
      const block = Float64Array.from({ length: BLOCK * BLOCK }, (_, index) => {
        const [row, column] = [top + Math.floor(index / BLOCK), left + (index % BLOCK)];
        return data[Math.min(row, height - 1) * width + Math.min(column, width - 1)] - 128;
      });
      const steps = transformed(block, false).map((value, index) => Math.round(value / table[index]) * table[index]);
      transformed(steps, true).forEach((value, index) => {
        const [row, column] = [top + Math.floor(index / BLOCK), left + (index % BLOCK)];
        if (row < height && column < width)
          out[row * width + column] = Math.round(Math.min(255, Math.max(0, value + 128)));
      });
    }
  }
  return { width, height, data: out };
}

/** Means of 2x2 pixels. */
function halved({ width, height, data }) {
  const [columns, rows] = [Math.ceil(width / 2), Math.ceil(height / 2)];
  const at = (column, row) => data[Math.min(row, height - 1) * width + Math.min(column, width - 1)];
  const means = Float64Array.from({ length: columns * rows }, (_, index) => {
    const [column, row] = [2 * (index % columns), 2 * Math.floor(index / columns)];
    return (at(column, row) + at(column + 1, row) + at(column, row + 1) + at(column + 1, row + 1)) / 4;
  });
  return { width: columns, height: rows, data: means };
}

/** Doubles the size by bilinear interpolation between pixel centres. */
function doubled({ width, height, data }, size) {
  const at = (column, row) =>
    data[Math.min(Math.max(row, 0), height - 1) * width + Math.min(Math.max(column, 0), width - 1)];
  return Float64Array.from({ length: size.width * size.height }, (_, index) => {
    const [x, y] = [((index % size.width) - 0.5) / 2, (Math.floor(index / size.width) - 0.5) / 2];
    const [column, row] = [Math.floor(x), Math.floor(y)];
    const [right, down] = [x - column, y - row];
    const upper = (1 - right) * at(column, row) + right * at(column + 1, row);
    return (1 - down) * upper + down * ((1 - right) * at(column, row + 1) + right * at(column + 1, row + 1));
  });
}

/** sRGB value of a linear level, 0 .. 1, in 255 steps. */
export const encoded = (linear) => 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);

/** Linear RGB, 0 .. 1, as the R, G, B, A of a decoded JPEG of this quality. */
export function throughJpeg({ width, height, data }, quality) {
  const length = width * height;
  const planes = [0, 1, 2].map(() => new Float64Array(length));
  for (let index = 0; index < length; index++) {
    const [r, g, b] = [0, 1, 2].map((channel) =>
      Math.round(encoded(Math.min(1, Math.max(0, data[3 * index + channel])))),
    );
    const luma = 0.299 * r + 0.587 * g + 0.114 * b;
    [luma, 128 + 0.564 * (b - luma), 128 + 0.713 * (r - luma)].forEach(
      (value, plane) => (planes[plane][index] = value),
    );
  }
  const size = { width, height };
  const [luma, ...chroma] = planes.map((plane) => ({ ...size, data: plane }));
  const y = quantised(luma, scaled(LUMA, quality)).data;
  const [cb, cr] = chroma.map((plane) => doubled(quantised(halved(plane), scaled(CHROMA, quality)), size));
  const out = new Uint8ClampedArray(4 * length);
  for (let index = 0; index < length; index++) {
    const [blue, red] = [cb[index] - 128, cr[index] - 128];
    out.set(
      [y[index] + 1.402 * red, y[index] - 0.344136 * blue - 0.714136 * red, y[index] + 1.772 * blue, 255],
      4 * index,
    );
  }
  return out;
}
