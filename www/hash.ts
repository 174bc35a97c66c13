/** SHA-256 of a file in hexadecimal; nothing where the browser has none, as on pages that came without encryption. */
export async function sha256(blob: Blob): Promise<string | undefined> {
  // The type says that it is always there.
  const subtle = (crypto as { subtle?: SubtleCrypto }).subtle;
  if (!subtle) return undefined;
  const bytes = new Uint8Array(await subtle.digest("SHA-256", await blob.arrayBuffer()));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
