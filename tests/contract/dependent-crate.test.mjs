// Crates that depend on this one: their dependencies, and the exports of their modules.
import assert from "node:assert/strict";
import { copyFileSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { WASM, tool } from "../../scripts/setup.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { run, write } from "./fresh.mjs";
import { LONG } from "./long.mjs";

/** The crate's features, except those for this project's own package. */
function features() {
  const metadata = JSON.parse(run("cargo", ["metadata", "--no-deps", "--format-version", "1"], inRoot()));
  const { features } = metadata.packages.find(({ name }) => name === "bimodal-stereo");
  assert.deepEqual(features.default ?? [], [], "nothing is on by default");
  return Object.keys(features).filter((name) => name !== "default" && !name.startsWith("bindings"));
}

/**
 * A separate crate below target/, where a second build is fast. It uses this project's lock file, so that new releases of dependencies
 * change nothing.
 */
function dependent(name, manifest, files) {
  const path = inRoot(`target/dependent/${name}`);
  mkdirSync(path, { recursive: true });
  copyFileSync(inRoot("Cargo.lock"), `${path}/Cargo.lock`);
  const head = `[package]\nname = "dependent"\nversion = "0.0.0"\nedition = "2024"\n\n[workspace]\n`;
  // The build is not optimised, because speed does not matter here.
  const profile = `[profile.dev]\nopt-level = 0\ndebug = false\n`;
  write(path, { "Cargo.toml": `${head}\n${manifest}\n${profile}`, ...files });
  return path;
}

const root = JSON.stringify(inRoot());

test("a module for JavaScript that uses the crate exports its own functions alone", LONG, () => {
  const path = dependent(
    "wasm",
    `[lib]
crate-type = ["cdylib"]

[dependencies]
bimodal-stereo = { path = ${root} }
thiserror = "2.0.18"
wasm-bindgen = "0.2"
`,
    {
      // The glue is a CommonJS module, unlike this project's modules.
      "bound/package.json": "{}",
      "src/lib.rs": `use bimodal_stereo::{Estimator, Options, scenes};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

#[derive(Debug, thiserror::Error)]
#[error("no start: {0}")]
struct NoStart(#[from] bimodal_stereo::Error);

fn start(surface: &str) -> Result<f64, NoStart> {
    let sample = scenes::Scene::new(&scenes::surface(surface)?)?.sample(&scenes::SampleRequest::default())?;
    let estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), Options::default())?;
    Ok(estimator.report().pose.scale)
}

#[wasm_bindgen]
pub fn scale_at_the_start(surface: &str) -> Result<f64, JsError> {
    Ok(start(surface)?)
}
`,
    },
  );
  run("cargo", ["build", "--quiet", "--target", WASM, "--target-dir", "target"], path);
  const linked = `${path}/target/${WASM}/debug/dependent.wasm`;
  const exported = (file) =>
    WebAssembly.Module.exports(new WebAssembly.Module(readFileSync(file))).map(({ name }) => name);
  // Before binding, a function's name ends in a hash; names of wasm-bindgen and of the linker begin with underscores.
  const described = exported(linked)
    .filter((name) => !name.startsWith("__") && name !== "memory")
    .map((name) => name.replace(/_[0-9a-f]{16}$/, ""));
  assert.deepEqual(described, ["scale_at_the_start"]);

  run(tool("wasm-bindgen"), ["--target", "nodejs", "--out-dir", "bound", linked], path);
  const named = exported(`${path}/bound/dependent_bg.wasm`).filter((name) => !name.startsWith("__"));
  assert.deepEqual(named.sort(), ["memory", "scale_at_the_start"]);
  const bound = createRequire(import.meta.url)(`${path}/bound/dependent.js`);
  assert.deepEqual(Object.keys(bound), ["scale_at_the_start"]);
  assert.equal(bound.scale_at_the_start("bust"), 1);
  assert.throws(() => bound.scale_at_the_start("teapot"), /^Error: no start: /);
});

test("a native crate uses every feature beside releases of its own choice", LONG, () => {
  const path = dependent(
    "native",
    `[dependencies]
bimodal-stereo = { path = ${root}, features = ${JSON.stringify(features())} }
image = { version = "0.25", default-features = false }
nalgebra = "0.35"
thiserror = "2.0.18"
`,
    {
      "src/main.rs": `use bimodal_stereo::{ColourImage, DepthMap, Estimator, Options, Similarity};

#[derive(Debug, thiserror::Error)]
#[error(transparent)]
struct Failure(#[from] bimodal_stereo::Error);

/// The types are the crate's own: one release of nalgebra and of image for both.
fn estimator(colours: &image::DynamicImage, depths: &image::DynamicImage) -> Result<Estimator, Failure> {
    let (image, depth) = (ColourImage::try_from(colours)?, DepthMap::try_from(depths)?);
    Ok(Estimator::new(image, &depth, Options::default())?.with_threads(2))
}

fn main() -> Result<(), Failure> {
    let pose = Similarity::from(nalgebra::Isometry3::translation(1.0, 2.0, 3.0));
    let matrix: nalgebra::Matrix4<f64> = pose.into();
    println!("{matrix} {}", estimator(&image::DynamicImage::new_rgb8(64, 64), &image::DynamicImage::new_luma16(64, 64)).is_ok());
    Ok(())
}
`,
    },
  );
  run("cargo", ["check", "--quiet", "--target-dir", "target"], path);
});
