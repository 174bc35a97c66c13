declare module "@openpgp/seek-bzip" {
  export function decode(bytes: Uint8Array, output?: Uint8Array | number): Uint8Array;
}
