/** Clouds as a binary PLY with a colour for each point. */
import { fault } from "./built.js";

/** Points with colours. */
export interface Cloud {
  /** 3 numbers for each point, interleaved, metres; points that are not finite are left out. */
  points: Float32Array;
  /** Red, green and blue of each point, 0 .. 255; grey without it. */
  colours?: Uint8Array | Uint8ClampedArray | undefined;
  /** The name of the cloud in the file. */
  name?: string | undefined;
}

const GREY = 128;
/** Bytes of x, y and z, of red, green and blue, and of the label. */
const [PLACE, COLOUR, LABEL] = [12, 3, 1];
const MOST_CLOUDS = 256;

const isThere = (points: Float32Array, at: number): boolean =>
  Number.isFinite(points[at]) && Number.isFinite(points[at + 1]) && Number.isFinite(points[at + 2]);

function check(cloud: Cloud, index: number): void {
  const field = `clouds[${index}]`;
  const { points, colours } = Object(cloud) as Cloud;
  if (!(points instanceof Float32Array)) throw fault("type", `${field}.points`, "must be a Float32Array");
  if (points.length % 3 !== 0)
    throw fault("size", `${field}.points`, `needs 3 numbers for each point, not ${points.length}`);
  // Numbers that do not fit a byte would be truncated.
  if (colours !== undefined && Object(colours).byteLength !== points.length)
    throw fault("size", `${field}.colours`, `needs ${points.length} bytes`);
}

/** A comment is one line of ASCII. */
const comment = (words: string): string => String(words).replace(/[^\x20-\x7e]/g, "?");

function header(clouds: readonly Cloud[], count: number, unit: string): string {
  const labels = clouds.length > 1;
  return [
    "ply",
    "format binary_little_endian 1.0",
    `comment ${comment(unit)}; x right, y down, z forward`,
    ...clouds.map(
      ({ name }, index) => `comment ${labels ? `label ${index}: ` : ""}${comment(name ?? `cloud ${index + 1}`)}`,
    ),
    `element vertex ${count}`,
    ...["x", "y", "z"].map((axis) => `property float ${axis}`),
    ...["red", "green", "blue"].map((colour) => `property uchar ${colour}`),
    ...(labels ? ["property uchar label"] : []),
    "end_header",
    "",
  ].join("\n");
}

/**
 * One file that holds all clouds, which are in one frame; if there are several, the property `label` distinguishes them, 0 for the first. A
 * comment states the unit.
 */
export function writeClouds(clouds: readonly Cloud[], unit: "metres" | "pixels" = "metres"): Uint8Array<ArrayBuffer> {
  if (!Array.isArray(clouds)) throw fault("type", "clouds", "must be a list of clouds");
  if (clouds.length === 0 || clouds.length > MOST_CLOUDS)
    throw fault("size", "clouds", `needs 1 to ${MOST_CLOUDS} of them, not ${clouds.length}`);
  // `forEach` would skip the holes of a list.
  [...clouds].forEach(check);
  let count = 0;
  for (const { points } of clouds) for (let at = 0; at < points.length; at += 3) if (isThere(points, at)) count++;
  const head = new TextEncoder().encode(header(clouds, count, unit));
  const stride = PLACE + COLOUR + (clouds.length > 1 ? LABEL : 0);
  const file = new Uint8Array(head.length + count * stride);
  file.set(head);
  const view = new DataView(file.buffer);
  let to = head.length;
  clouds.forEach(({ points, colours }, label) => {
    for (let at = 0; at < points.length; at += 3) {
      if (!isThere(points, at)) continue;
      for (let k = 0; k < 3; k++) {
        view.setFloat32(to + 4 * k, points[at + k] ?? NaN, true);
        file[to + PLACE + k] = colours?.[at + k] ?? GREY;
      }
      if (clouds.length > 1) file[to + PLACE + COLOUR] = label;
      to += stride;
    }
  });
  return file;
}
