/** Files of pixels and points by their first bytes. */

export type Kind = "png" | "jpeg" | "webp" | "tiff" | "exr" | "pfm" | "pnm" | "npy" | "npz" | "ply" | "pcd" | "las";

const FIRST: [Kind, RegExp][] = [
  ["png", /^\x89PNG\r\n\x1a\n/],
  ["jpeg", /^\xff\xd8\xff/],
  ["webp", /^RIFF.{4}WEBP/s],
  ["tiff", /^(?:II\*\0|MM\0\*|II\+\0|MM\0\+)/],
  ["exr", /^\x76\x2f\x31\x01/],
  ["pfm", /^P[Ff]\s/],
  ["pnm", /^P[1-7]\s/],
  ["npy", /^\x93NUMPY/],
  // The first entry of the archive is an array.
  ["npz", /^PK\x03\x04.{26}[^\0]{1,100}\.npy/s],
  ["ply", /^ply\s/],
  ["las", /^LASF/],
  ["pcd", /^(?:#[^\n]*\n|\s)*(?:VERSION|FIELDS)\s/],
];

/** Bytes that are examined; a PCD may begin with comments. */
const HEAD = 512;

export function kindOf(bytes: Uint8Array): Kind | undefined {
  let head = "";
  for (const byte of bytes.subarray(0, HEAD)) head += String.fromCharCode(byte);
  return FIRST.find(([, pattern]) => pattern.test(head))?.[0];
}
