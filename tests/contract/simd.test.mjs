// A build can lose SIMD without any visible change, so these tests count its instructions.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, test } from "node:test";
import binaryen from "binaryen";

const FILES = { simd: "bimodal_stereo_bg.wasm", scalar: "bimodal_stereo_scalar_bg.wasm" };
/** Vectorised loops have thousands of vector instructions; any library may have a few for copies of 16 bytes. */
const MANY = 1000;

const bytesOf = (file) => readFileSync(new URL(`../../pkg/${file}`, import.meta.url));

/** The decoded module as text, in which every instruction follows a bracket and nothing else looks like one. */
function decoded(file) {
  const module = binaryen.readBinary(bytesOf(file));
  const text = module.emitText();
  module.dispose();
  return text;
}

/** Names of all vector instructions, with repetitions. */
const vectorInstructions = (text) => [...text.matchAll(/\(((?:v128|[if]\d+x\d+)\.\w+)/g)].map((match) => match[1]);

describe("instructions", () => {
  test("the default build computes with 128-bit SIMD", (t) => {
    const found = vectorInstructions(decoded(FILES.simd));
    const sums = found.filter((name) => /^f32x4\.(add|sub|mul|div)$/.test(name));
    t.diagnostic(`${found.length} vector instructions, ${sums.length} of them f32x4 arithmetic`);
    assert.ok(
      found.length > MANY,
      `${found.length} vector instructions; RUSTFLAGS, where set, replaces the flags of .cargo/config.toml`,
    );
    for (const name of ["f32x4.add", "f32x4.sub", "f32x4.mul"]) assert.ok(sums.includes(name), `no ${name}`);
  });

  test("the scalar build has neither vectors nor instructions on them", () => {
    const text = decoded(FILES.scalar);
    assert.deepEqual(vectorInstructions(text), []);
    assert.doesNotMatch(text, /\bv128\b/);
  });

  /** Node 20 aborts when it discards optimised code that is inside such a call: see scripts/numerics.mjs. */
  test("no function takes or returns a reference", () => {
    for (const file of Object.values(FILES)) assert.doesNotMatch(decoded(file), /externref/, file);
  });

  test("both files ask for the same and offer the same", () => {
    const [simd, scalar] = Object.values(FILES).map((file) => {
      const module = new WebAssembly.Module(bytesOf(file));
      const sorted = (entries) => entries.map((entry) => JSON.stringify(entry)).sort();
      return {
        imports: sorted(WebAssembly.Module.imports(module)),
        exports: sorted(WebAssembly.Module.exports(module)),
      };
    });
    assert.deepEqual(scalar, simd);
  });
});
