// Height maps as NumPy saves them. The package's own reader refuses column order, which half of these files have.

/** A two-dimensional float32 .npy of either order, in row order. */
export function readHeights(bytes) {
  const [major] = bytes.subarray(6, 7);
  const [start, length] = major === 1 ? [10, bytes.readUInt16LE(8)] : [12, bytes.readUInt32LE(8)];
  const header = bytes.subarray(start, start + length).toString("latin1");
  const [, rows, columns] = /'shape': \((\d+), (\d+)\)/.exec(header) ?? [];
  if (!rows || !header.includes("'<f4'")) throw new Error(`not a float32 array of two dimensions: ${header.trim()}`);
  const [width, height] = [Number(columns), Number(rows)];
  const byColumn = header.includes("'fortran_order': True");
  const data = new Float32Array(width * height);
  for (let index = 0; index < data.length; index++) {
    const [column, row] = [index % width, Math.floor(index / width)];
    data[index] = bytes.readFloatLE(start + length + 4 * (byColumn ? column * height + row : index));
  }
  return { width, height, data };
}
