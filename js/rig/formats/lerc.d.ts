/** Declares the package, which contains no types. */
declare module "lerc" {
  const lerc: {
    decode(
      blob: ArrayBuffer,
      options: { returnPixelInterleavedDims: boolean },
    ): { pixels: (Uint8Array | Uint16Array | Uint32Array | Float32Array | Float64Array)[] };
  };
  export default lerc;
}
