/** SHA-256 of a file in hexadecimal; undefined in browsers without it, for example on pages that were not served over https. */
export async function sha256(blob: Blob): Promise<string | undefined> {
  // The type claims that it always exists.
  const subtle = (crypto as { subtle?: SubtleCrypto }).subtle;
  if (!subtle) return undefined;
  const bytes = new Uint8Array(await subtle.digest("SHA-256", await blob.arrayBuffer()));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
