/** Recognises the purpose of a file by its first bytes: depth maps are arrays or have one channel of 16 bits, masks have one of 8. */

const PNG = [0x89, 0x50, 0x4e, 0x47];
const NPY = [0x93, 0x4e, 0x55, 0x4d];
/** Where a PNG states its bits and its colour type, of which 0 is grey. */
const [BITS, COLOUR, END] = [24, 25, 26];

const begins = (bytes: Uint8Array, magic: readonly number[]): boolean => magic.every((byte, i) => bytes[i] === byte);

/** The first bytes of a saved run. */
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
