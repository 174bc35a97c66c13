/** What a file is for, recognised by its first bytes alone: depth maps have one channel of 16 bits or are arrays, masks one of 8. */

const PNG = [0x89, 0x50, 0x4e, 0x47];
const NPY = [0x93, 0x4e, 0x55, 0x4d];
/** Where a PNG says its bits and its kind of colour, of which 0 is grey. */
const [BITS, COLOUR, END] = [24, 25, 26];

const begins = (bytes: Uint8Array, magic: readonly number[]): boolean => magic.every((byte, i) => bytes[i] === byte);

/** Pictures that neither the library's own decoders nor browsers know, and clouds: TIFF, EXR, PFM, PGM and PPM, PLY and PCD. */
const FURTHER = /^(?:II[*+]\0|MM\0[*+]|\x76\x2f\x31\x01|P[Ff1-7]\s|ply\s|(?:#[^\n]*\n|\s)*(?:VERSION|FIELDS)\s)/;
/** Enough for a PCD's comments. */
const HEAD = 512;

/** Whether the package's readers of rig files are needed: for colour formats that browsers do not decode, and for all other depth maps and masks. */
export async function isFurther(file: File, isColour: boolean): Promise<boolean> {
  // A file that has vanished is reported where it is read.
  const bytes = new Uint8Array(
    await file
      .slice(0, HEAD)
      .arrayBuffer()
      .catch(() => Uint8Array.from(PNG).buffer),
  );
  return isColour ? FURTHER.test(String.fromCharCode(...bytes)) : !begins(bytes, PNG) && !begins(bytes, NPY);
}

/** How a saved run begins. */
const RUN = new TextEncoder().encode("bimodal-stereo\n");

export async function runAmong(files: readonly File[]): Promise<File | undefined> {
  for (const file of files)
    if (begins(new Uint8Array(await file.slice(0, RUN.length).arrayBuffer()), [...RUN])) return file;
  return undefined;
}

export async function sniffed(file: File): Promise<"colour" | "depth" | "mask"> {
  const bytes = new Uint8Array(await file.slice(0, END).arrayBuffer());
  if (begins(bytes, NPY)) return "depth";
  if (!begins(bytes, PNG) || bytes[COLOUR] !== 0) return "colour";
  return bytes[BITS] === 16 ? "depth" : "mask";
}
