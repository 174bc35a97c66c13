/** Which of the two .wasm files this machine can run. */

/** The smallest module with 128-bit SIMD: a function that splats a zero over 16 bytes and counts their bits (i8x16.popcnt). */
const PROBE = Uint8Array.of(
  ...[0x00, 0x61, 0x73, 0x6d, 0x01, 0x00, 0x00, 0x00], // "\0asm", version 1
  ...[0x01, 0x05, 0x01, 0x60, 0x00, 0x01, 0x7b], // One type: [] -> [v128].
  ...[0x03, 0x02, 0x01, 0x00], // One function of this type.
  ...[0x0a, 0x0a, 0x01, 0x08, 0x00, 0x41, 0x00, 0xfd, 0x0f, 0xfd, 0x62, 0x0b], // The instructions i32.const 0, i8x16.splat, i8x16.popcnt.
);

/** Whether this machine has 128-bit SIMD. */
export const hasSimd = (): boolean => WebAssembly.validate(PROBE);

/** The address of the .wasm that `init()` loads: the one with 128-bit SIMD if this machine has it, else the scalar one. */
export function wasmUrl(): URL {
  // Each address is written as one expression, because bundlers look for exactly this form to include the files.
  return hasSimd()
    ? new URL("./bimodal_stereo_bg.wasm", import.meta.url)
    : new URL("./bimodal_stereo_scalar_bg.wasm", import.meta.url);
}
