/**
 * ZIP archives for .npz: the central directory, and stored or deflated entries up to the largest size of a file.
 *
 * fflate's unzipSync is not used, because it neither checks the checksum of an entry nor notices a wrong length.
 */
import { crc32 } from "../../crc.js";
import { badFile } from "../../errors.js";
import { inflateRaw } from "../../inflate.js";
import { MOST_BYTES } from "./limits.js";

export interface Entry {
  name: string;
  method: number;
  packed: number;
  length: number;
  checksum: number;
  /** The place where the local header of the entry begins. */
  at: number;
}

const END = 0x06054b50;
const CENTRAL = 0x02014b50;
const LOCAL = 0x04034b50;
/** Bytes of the end record and of the longest comment after it. */
const [END_BYTES, COMMENT] = [22, 65_535];
const MOST_ENTRIES = 1000;
const [STORED, DEFLATED] = [0, 8];
/** Bit of an entry's flags. */
const ENCRYPTED = 1;

const damaged = () => badFile("this ZIP archive is damaged or cut off; unpack it and use its files");

export function entriesOf(bytes: Uint8Array): Entry[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let end = bytes.length - END_BYTES;
  const first = Math.max(0, end - COMMENT);
  while (end >= first && view.getUint32(end, true) !== END) end--;
  if (end < first) throw damaged();
  const count = view.getUint16(end + 10, true);
  if (count > MOST_ENTRIES) throw badFile(`it is a ZIP archive of ${count} files; unpack it first`);
  const found: Entry[] = [];
  for (let each = 0, at = view.getUint32(end + 16, true); each < count; each++) {
    if (view.getUint32(at, true) !== CENTRAL) throw damaged();
    const [name, extra, comment] = [28, 30, 32].map((offset) => view.getUint16(at + offset, true)) as [
      number,
      number,
      number,
    ];
    found.push({
      name: String.fromCharCode(...bytes.subarray(at + 46, at + 46 + Math.min(name, 256))),
      method: view.getUint16(at + 10, true),
      packed: view.getUint32(at + 20, true),
      length: view.getUint32(at + 24, true),
      checksum: view.getUint32(at + 16, true),
      at: view.getUint32(at + 42, true),
    });
    at += 46 + name + extra + comment;
  }
  return found;
}

function content(body: Uint8Array, { method, length }: Entry): Uint8Array {
  if (method === STORED) return body;
  if (method === DEFLATED) return inflateRaw(body, length, "this ZIP archive");
  throw badFile(`this ZIP archive is compressed with method ${method}, which is not supported; unpack it first`);
}

/** The content of an entry. */
export function unpacked(bytes: Uint8Array, entry: Entry): Uint8Array {
  const { packed, length, checksum, at } = entry;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (view.getUint32(at, true) !== LOCAL) throw damaged();
  if (view.getUint16(at + 6, true) & ENCRYPTED) throw badFile("this ZIP archive is encrypted; unpack it first");
  const from = at + 30 + view.getUint16(at + 26, true) + view.getUint16(at + 28, true);
  if (from + packed > bytes.length) throw damaged();
  if (length > MOST_BYTES)
    throw badFile(`this ZIP archive contains a file of ${length} bytes; up to ${MOST_BYTES} are supported`);
  const found = content(bytes.subarray(from, from + packed), entry);
  if (crc32(found) !== checksum) throw badFile("this ZIP archive is damaged: the checksum of a file in it is wrong");
  return found;
}
