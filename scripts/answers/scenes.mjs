// The scenes: each has a name in words, its pair (see pairs.mjs), its options, and a way of driving the loop.
//   sample, metric   the pair, from the package's `sample` or in metres (metric.mjs)
//   albedo           { seed, stripes }: patches or stripes of another albedo
//   colours, depths  changes to its views; `maskless` leaves out the image's mask
//   options          the estimator's; light "known" is the pair's; start { off: degrees, about, members } is near the pair's pose
//   drive            "run" (the default), "step", "stage", "time": the method that takes the steps;
//                    { stop: n } leaves the loop running after n steps; { reset: options } first takes some steps, then resets
//   rig              instead of all these: frames of a rendered rig whose calibration is checked (rigs.mjs)
import { MISSTATED } from "./misstated.mjs";
import { PAINTED } from "./painted.mjs";
import { GIVEN, LENS, OTHER_LENS, PAPER, grid, metric, near, pinhole, sample } from "./requests.mjs";
import { RIGS } from "./rigs.mjs";

const ANYWHERE = [
  {
    name: "bust, window light, 32x32, 70 % of the columns: a rival",
    sample: sample("bust", "window", 32, { angles: { beta: 30 }, overlap: 0.7 }),
  },
  {
    name: "bust, window light, 64x64, beta 50",
    sample: sample("bust", "window", 64, { angles: { beta: 50 }, seed: 3 }),
  },
  {
    name: "bust, overcast light, 96x96, turned about all axes",
    sample: sample("bust", "overcast", 96, { angles: { alpha: 10, beta: -30, gamma: 8 } }),
  },
  {
    name: "vase, overcast light, 48x48, 8-bit image, half the columns",
    sample: sample("vase", "overcast", 48, { overlap: 0.5 }),
    colours: "8 bit clamped, sRGB",
  },
  {
    name: "ripples, window light, 80x80, 60 % of the columns",
    sample: sample("ripples", "window", 80, { angles: { alpha: -12, beta: 35 }, overlap: 0.6 }),
  },
  {
    name: "ripples, colourful light, 64x64, 16-bit linear image, scale 1.2",
    sample: sample("ripples", "colourful", 64, { angles: { beta: 15, gamma: 25 }, scale: 1.2, seed: 5 }),
    colours: "16 bit, linear",
  },
  {
    name: "ripples, overcast light, 112x112, scale 0.85",
    sample: sample("ripples", "overcast", 112, { scale: 0.85 }),
    options: { stopDegrees: 0.001 },
    drive: "step",
  },
  {
    name: "bust, window light, 128x96, 8-bit image, holes, noisy depths",
    sample: sample("bust", "window", 128, { height: 96, holes: 0.1, depthNoise: 0.2 }),
    colours: "8 bit, sRGB",
  },
  {
    name: "bust, colourful light, 160x160, beta 30",
    sample: sample("bust", "colourful", 160, { angles: { beta: 30 } }),
    options: { tolerance: 0.01 },
    drive: "step",
  },
  {
    name: "two workers: vase, window light, 160 columns, 112 rows",
    sample: sample("vase", "window", 160, { height: 112, angles: { beta: -25 } }),
    options: { workers: 2 },
  },
  {
    name: "hills and a light of our own, 72 columns, 56 rows",
    sample: sample("hills", "own", 72, { height: 56, angles: { alpha: 15, beta: 10 }, seed: 2 }),
    options: { tolerance: 4 },
  },
];

const WORKERS = [
  {
    name: "two workers: bust, window light, 96x96",
    sample: sample("bust", "window", 96, { angles: { beta: 25 } }),
    options: { workers: 2 },
  },
  {
    name: "two workers share iterations: vase, overcast light, 128x128",
    sample: sample("vase", "overcast", 128, { depthNoise: 0.3 }),
    options: { workers: 2, start: near(5), maxIterations: 12 },
  },
];

const LIGHT_KNOWN = [
  {
    name: "light known: bust, colourful, 64x64, beta 80, 3/8 of the columns",
    sample: sample("bust", "colourful", 64, { angles: { beta: 80 }, overlap: 0.375 }),
    options: { light: "known", scale: 1 },
  },
  {
    name: "light known: vase, overcast, 64x64, beta -60, stage by stage",
    sample: sample("vase", "overcast", 64, { angles: { beta: -60 } }),
    options: { light: "known", tolerance: 0.3 },
    drive: "stage",
  },
  {
    name: "light known, four numeric options at once: bust, a light of our own, 80x80",
    sample: sample("bust", "own", 80),
    options: { light: "known", stopDegrees: 0.1, correspondenceDistance: 2, seed: 9, maxIterations: 2 },
  },
  {
    name: "bare grid: bust, colourful, beta 20, free scale",
    sample: grid("bust", "colourful", { beta: 20 }),
    options: { light: "known" },
  },
  {
    name: "bare grid: bust, colourful, beta 90",
    sample: grid("bust", "colourful", { beta: 90 }),
    options: { light: "known", scale: 1 },
  },
  {
    name: "bare grid: ripples, overcast, light unknown",
    sample: grid("ripples", "overcast", { alpha: 12, beta: -15, gamma: 5 }),
  },
  {
    name: "bare grid without its normals: bust, colourful",
    sample: grid("bust", "colourful", { beta: -20 }),
    depths: ["without normals"],
    options: { light: "known", start: near(6, "angles") },
  },
];

const PAPERS_LOOP = [
  {
    name: "paper's loop: bust, colourful, 32x32, light known",
    sample: sample("bust", "colourful", 32),
    options: { ...PAPER, light: "known" },
  },
  {
    name: "paper's loop: bust, window, 64x64, light unknown",
    sample: sample("bust", "window", 64, { angles: { beta: 8 } }),
    options: { ...PAPER, seed: 3 },
  },
  {
    name: "paper's loop: vase, overcast, 48x48, 1 pixel",
    sample: sample("vase", "overcast", 48, { angles: { beta: 10 } }),
    options: { ...PAPER, light: "known", correspondenceDistance: 1 },
  },
  {
    name: "paper's loop: ripples, colourful, 96x96, 2.5 pixels",
    sample: sample("ripples", "colourful", 96, { holes: 0.1 }),
    options: { ...PAPER, correspondenceDistance: 2.5, stopDegrees: 0.5 },
  },
  {
    name: "paper's loop: bare grid, bust, colourful",
    sample: grid("bust", "colourful", { beta: 20 }),
    options: { ...PAPER, light: "known", scale: 1 },
  },
  {
    name: "ICP after a search: bust, overcast, 64x64",
    sample: sample("bust", "overcast", 64),
    options: { registration: "icp", maxIterations: 15 },
  },
  {
    name: "registration by colours with pixels: vase, colourful, 64x64",
    sample: sample("vase", "colourful", 64),
    options: { start: "identity", shading: "pixel" },
  },
];

const STARTS = [
  {
    name: "told angles and translation, 8 degrees off: bust, window, 144x144",
    sample: sample("bust", "window", 144),
    options: { start: near(8, "angles", "translation") },
  },
  {
    name: "told angles alone: ripples, overcast, 64x64",
    sample: sample("ripples", "overcast", 64),
    options: { start: near(4, "angles") },
  },
  {
    name: "told rotation and translation, scale 1.1 held: hills, window, 80x80",
    sample: sample("hills", "window", 80, { scale: 1.1 }),
    options: { start: near(3, "rotation", "translation"), scale: 1.1 },
  },
  {
    name: "from identity: bust, overcast, 112x112, given normals",
    sample: sample("bust", "overcast", 112, { angles: { beta: 6 } }),
    depths: ["with given normals"],
    options: { start: "identity" },
  },
  { name: "left while it searches: vase, window, 64x64", sample: sample("vase", "window", 64), drive: { stop: 40 } },
  {
    name: "left after two iterations: ripples, colourful, 96x96",
    sample: sample("ripples", "colourful", 96),
    options: { start: near(6) },
    drive: { stop: 2 },
  },
  {
    name: "reset in the middle of a search: bust, colourful, 40x40",
    sample: sample("bust", "colourful", 40),
    options: { start: near(6) },
    drive: { reset: {} },
  },
  {
    name: "reset from the paper's loop: ripples, window, 56x56",
    sample: sample("ripples", "window", 56),
    options: { light: "known" },
    drive: { reset: PAPER },
  },
];

const FIXED = [
  {
    name: "pose held: bust, window, 64x64, pixels without prior",
    sample: sample("bust", "window", 64, { noise: 0.02 }),
    options: { ...GIVEN, registration: "fixed", shading: "pixel", lambda: { prior: 0 } },
  },
  {
    name: "pose held: vase, overcast, 64x64, heights with a strong prior",
    sample: sample("vase", "overcast", 64, { noise: 0.02 }),
    options: { ...GIVEN, registration: "fixed", lambda: { prior: 0.5 } },
  },
  {
    name: "pose held: bust, colourful, 64x64, refinement",
    sample: sample("bust", "colourful", 64, { angles: { beta: 0 }, noise: 0.02, depthNoise: 0.5, holes: 0.1 }),
    options: { light: "known", start: "identity", registration: "fixed", scale: 1 },
    drive: "time",
  },
  {
    name: "pose held, light unknown: ripples, overcast, 160x160",
    sample: sample("ripples", "overcast", 160, { depthNoise: 0.3 }),
    options: { start: near(0), registration: "fixed", maxIterations: 10 },
  },
];

const WEIGHTS = [
  {
    name: "no light prior: bust, colourful, 72x72",
    sample: sample("bust", "colourful", 72),
    options: { seed: 4, lambda: { light: 0 } },
  },
  {
    name: "other weights: ripples, window, 64x64",
    sample: sample("ripples", "window", 64),
    options: { start: near(4), shading: "pixel", lambda: { prior: 0.2, unit: 10, light: 1e-4, refinement: 0.3 } },
  },
  {
    name: "weak weights: vase, overcast, 80x80",
    sample: sample("vase", "overcast", 80, { depthNoise: 0.3 }),
    options: { start: near(4), lambda: { unit: 0.1, light: 1e-8, refinement: 0 } },
  },
  {
    name: "paper's loop, other weights, left after three iterations: bust, window, 48x48",
    sample: sample("bust", "window", 48),
    options: { ...PAPER, light: "known", lambda: { unit: 3, refinement: 0.05 } },
    drive: { stop: 3 },
  },
  {
    name: "without annealing: bust, a light of our own, 64x64",
    sample: sample("bust", "own", 64),
    options: { annealing: false },
  },
  {
    name: "without annealing, told 10 degrees off: ripples, colourful, 96x96",
    sample: sample("ripples", "colourful", 96),
    options: { annealing: false, start: near(10) },
  },
  {
    name: "flying pixels trimmed: bust, colourful, 96x96",
    sample: sample("bust", "colourful", 96),
    depths: ["flying pixels"],
    options: { trim: true, start: near(5) },
    drive: "time",
  },
  {
    name: "flying pixels kept, without annealing: bust, overcast, 64x64",
    sample: sample("bust", "overcast", 64),
    depths: ["flying pixels"],
    options: { trim: false, annealing: false, start: near(5) },
    drive: "stage",
  },
];

const TYPES = [
  {
    name: "8-bit sRGB image without a mask: bust, window, 96x96",
    sample: sample("bust", "window", 96),
    colours: "8 bit, sRGB",
    maskless: true,
    options: { start: near(5) },
    drive: "step",
  },
  {
    name: "8-bit linear image, 16-bit depths: vase, colourful, 64x64",
    sample: sample("vase", "colourful", 64),
    colours: "8 bit, linear",
    depths: ["16 bit, 1/200 pixel"],
    options: { trim: false },
  },
  {
    name: "16-bit image, its transfer guessed: ripples, window, 72x72",
    sample: sample("ripples", "window", 72),
    colours: "16 bit, guessed",
    depths: ["float, half pixels", "without mask"],
    options: { start: near(5), trim: false },
    drive: "time",
  },
  {
    name: "16-bit linear image, depths as a cloud: bust, overcast, 64x64",
    sample: sample("bust", "overcast", 64),
    colours: "16 bit, linear",
    depths: ["as a cloud", "without mask"],
    options: { start: near(5) },
    drive: "stage",
  },
  {
    name: "16-bit sRGB image, a cloud with given normals: bust, window, 80x80",
    sample: sample("bust", "window", 80),
    colours: "16 bit, sRGB",
    depths: ["with given normals", "as a cloud"],
    options: { light: "known", start: near(3) },
    maskless: true,
  },
];

const PINHOLES = [
  {
    name: "two pinholes, metres, distorted 8-bit image: 96x72, reset from a pose held",
    metric: metric("window", pinhole(96, 72, LENS), pinhole(96, 72)),
    colours: "8 bit, sRGB",
    options: { start: near(3), scale: 1 },
    drive: { reset: { registration: "fixed", start: near(3) } },
  },
  {
    name: "two distorted pinholes: 128x96 and 112x84, light known",
    metric: metric("colourful", pinhole(128, 96, LENS), pinhole(112, 84, OTHER_LENS)),
    options: { light: "known", start: near(3) },
  },
  {
    name: "two pinholes, distorted millimetres, 8-bit image: 80x64, search",
    metric: metric("overcast", pinhole(80, 64), pinhole(80, 64, OTHER_LENS), { depthNoise: 0.0005 }),
    colours: "8 bit clamped, sRGB",
    depths: ["16 bit, millimetres"],
  },
  {
    name: "distorted depths of 0.2 mm, image without camera: 96x96, search",
    metric: metric("colourful", { width: 96, height: 96, metresPerPixel: 0.004 }, pinhole(96, 72, LENS)),
    depths: ["16 bit, 0.2 mm", "without mask"],
  },
  {
    name: "paper's loop in metres: 72x72, distorted image",
    metric: metric("colourful", pinhole(72, 72, LENS), pinhole(72, 72), { degrees: 5 }),
    maskless: true,
    options: { ...PAPER, light: "known" },
  },
];

const UNKNOWABLE = [
  {
    name: "told a pose beside the object: two pinholes, metres, 96x72",
    metric: metric("window", pinhole(96, 72), pinhole(96, 72)),
    options: { start: { off: 4, about: "camera" } },
  },
  { name: "a ball, window light, 72x72", sample: sample("ball", "window", 72, { angles: { beta: 12 } }) },
  { name: "one grey for all pixels: bust, 64x64", sample: sample("bust", "window", 64), colours: "grey" },
];

export const SCENES = [
  ...ANYWHERE,
  ...WORKERS,
  ...LIGHT_KNOWN,
  ...PAPERS_LOOP,
  ...STARTS,
  ...FIXED,
  ...WEIGHTS,
  ...TYPES,
  ...PINHOLES,
  ...UNKNOWABLE,
  ...PAINTED,
  ...MISSTATED,
  ...RIGS,
];
