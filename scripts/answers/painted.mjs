// Scenes with varying albedo, in which local contrast, silhouettes or surfaces replace photometric registration.
import { LENS, OTHER_LENS, PAPER, metric, near, pinhole, sample } from "./requests.mjs";

const PATCHES = { seed: 1 };
const OTHER_PATCHES = { seed: 6 };
const STRIPES = { seed: 3, stripes: true };
const OTHER_STRIPES = { seed: 8, stripes: true };
/** Noise of the depth, metres. */
const NOISY = 0.001;

const ORTHOGRAPHIC = [
  {
    name: "patches, searched: bust, window, 96x96",
    sample: sample("bust", "window", 96, { angles: { beta: 25 } }),
    albedo: PATCHES,
  },
  {
    name: "stripes, searched: ripples, overcast, 80x80, scale 1.1",
    sample: sample("ripples", "overcast", 80, { angles: { alpha: 10, beta: -20 }, scale: 1.1 }),
    albedo: STRIPES,
  },
  {
    name: "patches, searched, scale held: hills and a light of our own, 72x72",
    sample: sample("hills", "own", 72, { angles: { beta: 15 } }),
    albedo: OTHER_PATCHES,
    options: { scale: 1 },
  },
  {
    name: "stripes, JPEG of quality 85, searched: bust, overcast, 96x96",
    sample: sample("bust", "overcast", 96),
    albedo: OTHER_STRIPES,
    colours: "JPEG of quality 85",
    options: { scale: 1 },
  },
  {
    name: "patches, noisy depths in steps, searched: bust, colourful, 80x80",
    sample: sample("bust", "colourful", 80, { depthNoise: 0.5 }),
    albedo: PATCHES,
    depths: ["16 bit, quarter pixels"],
    options: { scale: 1 },
  },
  {
    name: "patches, started near: bust, window, 96x96",
    sample: sample("bust", "window", 96, { angles: { beta: 30 } }),
    albedo: OTHER_PATCHES,
    options: { start: near(6), scale: 1 },
  },
  {
    name: "stripes, JPEG of quality 60, started near: vase, colourful, 80x80",
    sample: sample("vase", "colourful", 80),
    albedo: STRIPES,
    colours: "JPEG of quality 60",
    options: { start: near(8), scale: 1 },
  },
  {
    name: "patches, noisy depths, started near: ripples, window, 80x80",
    sample: sample("ripples", "window", 80, { depthNoise: 0.8, holes: 0.1 }),
    albedo: PATCHES,
    options: { start: near(4), scale: 1 },
  },
  {
    name: "stripes, rotation alone given: bust, overcast, 72x72",
    sample: sample("bust", "overcast", 72),
    albedo: OTHER_STRIPES,
    options: { start: near(5, "rotation"), scale: 1 },
  },
  {
    name: "patches, the paper's loop: bust, window, 64x64",
    sample: sample("bust", "window", 64, { angles: { beta: 8 } }),
    albedo: PATCHES,
    options: PAPER,
  },
];

const PINHOLES = [
  {
    name: "two pinholes, patches, searched: 96x72",
    metric: metric("window", pinhole(96, 72), pinhole(96, 72)),
    albedo: PATCHES,
  },
  {
    name: "two distorted pinholes, stripes, JPEG of quality 85, searched: 96x72",
    metric: metric("overcast", pinhole(96, 72, LENS), pinhole(96, 72, OTHER_LENS)),
    albedo: STRIPES,
    colours: "JPEG of quality 85",
  },
  {
    name: "two pinholes, patches, started near: 96x72",
    metric: metric("overcast", pinhole(96, 72), pinhole(96, 72)),
    albedo: OTHER_PATCHES,
    options: { start: near(4) },
  },
  {
    name: "two pinholes, stripes, noisy millimetres, started near: 96x72",
    metric: metric("colourful", pinhole(96, 72), pinhole(96, 72), { depthNoise: NOISY }),
    albedo: STRIPES,
    colours: "8 bit, sRGB",
    depths: ["16 bit, millimetres"],
    options: { start: near(4), scale: 1 },
  },
  {
    name: "two pinholes, patches, rotation alone given: 96x72",
    metric: metric("window", pinhole(96, 72), pinhole(96, 72)),
    albedo: PATCHES,
    options: { start: near(3, "rotation") },
  },
  {
    name: "two pinholes, stripes, JPEG of quality 60, rotation alone given: 80x64",
    metric: metric("overcast", pinhole(80, 64), pinhole(80, 64)),
    albedo: OTHER_STRIPES,
    colours: "JPEG of quality 60",
    options: { start: near(5, "rotation"), scale: 1 },
  },
];

export const PAINTED = [...ORTHOGRAPHIC, ...PINHOLES];
