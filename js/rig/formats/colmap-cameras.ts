/** COLMAP's cameras.bin, the binary form of cameras.txt. */

/** Models by their number, with their counts of parameters. */
const MODELS: [name: string, parameters: number][] = [
  ["SIMPLE_PINHOLE", 3],
  ["PINHOLE", 4],
  ["SIMPLE_RADIAL", 4],
  ["RADIAL", 5],
  ["OPENCV", 8],
  ["OPENCV_FISHEYE", 8],
  ["FULL_OPENCV", 12],
  ["FOV", 5],
  ["SIMPLE_RADIAL_FISHEYE", 4],
  ["RADIAL_FISHEYE", 5],
  ["THIN_PRISM_FISHEYE", 12],
];
/** Bytes before the cameras, and of a camera without its parameters. */
const HEAD = 8;
const CAMERA = 24;
const MOST_CAMERAS = 5000;

/** The text of cameras.txt for a cameras.bin; undefined where the bytes are not exactly those of one. */
export function colmapText(bytes: Uint8Array): string | undefined {
  if (bytes.length < HEAD + CAMERA) return undefined;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const count = view.getUint32(0, true);
  if (view.getUint32(4, true) !== 0 || count === 0 || count > MOST_CAMERAS) return undefined;
  const lines: string[] = [];
  let at = HEAD;
  for (let index = 0; index < count; index++) {
    if (at + CAMERA > bytes.length) return undefined;
    const [id, model] = [view.getUint32(at, true), view.getInt32(at + 4, true)];
    const [width, height] = [Number(view.getBigUint64(at + 8, true)), Number(view.getBigUint64(at + 16, true))];
    const [name, parameters] = MODELS[model] ?? [];
    if (name === undefined || parameters === undefined) return undefined;
    at += CAMERA;
    if (at + 8 * parameters > bytes.length) return undefined;
    const values = Array.from({ length: parameters }, (_, each) => view.getFloat64(at + 8 * each, true));
    at += 8 * parameters;
    if (!values.every(Number.isFinite)) return undefined;
    lines.push(`${id} ${name} ${width} ${height} ${values.join(" ")}`);
  }
  return at === bytes.length ? lines.join("\n") : undefined;
}
