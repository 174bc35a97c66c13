// Scenes whose input is described incorrectly: a wrong unit, inverted relief, a missing mask, an initial pose that is trusted too
// much.
import { LENS, OTHER_LENS, metric, near, pinhole, sample } from "./requests.mjs";

const UNITS = [
  {
    name: "unit ten times too long, searched: bust, window, 80x80",
    sample: sample("bust", "window", 80),
    depths: ["unit ten times too long"],
  },
  {
    name: "unit half as long, searched: ripples, colourful, 80x80",
    sample: sample("ripples", "colourful", 80, { angles: { beta: 15 } }),
    depths: ["unit half as long"],
  },
  {
    name: "unit twice too long, started near: bust, overcast, 72x72",
    sample: sample("bust", "overcast", 72),
    depths: ["unit twice too long"],
    options: { start: near(3), scale: 1 },
  },
  {
    name: "unit ten times too long, started near: two pinholes, 80x64",
    metric: metric("window", pinhole(80, 64), pinhole(80, 64)),
    depths: ["unit ten times too long"],
    options: { start: near(3), scale: 1 },
  },
  {
    name: "unit half as long, searched: two pinholes, 80x64",
    metric: metric("colourful", pinhole(80, 64), pinhole(80, 64)),
    depths: ["unit half as long"],
  },
];

const HOLLOW = [
  {
    name: "hollow, searched: bust, window, 80x80",
    sample: sample("bust", "window", 80),
    depths: ["hollow"],
  },
  {
    name: "hollow with patches, searched: ripples, overcast, 72x72",
    sample: sample("ripples", "overcast", 72),
    albedo: { seed: 4 },
    depths: ["hollow"],
    options: { scale: 1 },
  },
  {
    name: "hollow, started near: vase, colourful, 64x64",
    sample: sample("vase", "colourful", 64),
    depths: ["hollow"],
    options: { start: near(5) },
  },
];

const WITHOUT_MASKS = [
  {
    name: "flying pixels trimmed without a mask, searched: bust, overcast, 80x80",
    sample: sample("bust", "overcast", 80),
    depths: ["flying pixels", "without mask"],
  },
  {
    name: "a wall behind the object, trimmed without a mask: bust, window, 80x80",
    sample: sample("bust", "window", 80),
    depths: ["before a wall, without mask"],
    options: { start: near(4) },
  },
  {
    name: "a wall behind the object, trimmed without a mask, searched: two pinholes, 80x64",
    metric: metric("window", pinhole(80, 64), pinhole(80, 64)),
    depths: ["before a wall, without mask"],
  },
  {
    name: "whole frames, searched: two pinholes, 80x64",
    metric: metric("colourful", pinhole(80, 64), pinhole(80, 64)),
    colours: "before a wall",
    depths: ["before a wall, without mask"],
    maskless: true,
  },
  {
    name: "whole frames with patches, started near: two distorted pinholes, 96x72",
    metric: metric("overcast", pinhole(96, 72, LENS), pinhole(96, 72, OTHER_LENS)),
    albedo: { seed: 2 },
    colours: "before a wall",
    depths: ["before a wall, without mask"],
    maskless: true,
    options: { start: near(4), scale: 1 },
  },
  {
    name: "a whole frame, the object's depths: two pinholes, 80x64, 8-bit JPEG, searched",
    metric: metric("overcast", pinhole(80, 64), pinhole(80, 64)),
    colours: "JPEG of quality 85",
    maskless: true,
  },
];

/** Initial poses farther off than their tolerance: no allowed pose fits the image better. */
const BELIEVED = { degrees: 1, distance: 0.5 };
const TOO_SURE = [
  {
    name: "an initial pose believed too much: bust, window, 64x64",
    sample: sample("bust", "window", 64),
    options: { start: near(9), startTolerance: BELIEVED, scale: 1 },
  },
  {
    name: "an initial pose believed too much: ripples, overcast, 64x64, light known",
    sample: sample("ripples", "overcast", 64),
    options: { light: "known", start: near(9), startTolerance: BELIEVED, scale: 1 },
  },
  {
    name: "an initial pose believed too much: vase with stripes, colourful, 64x64",
    sample: sample("vase", "colourful", 64),
    albedo: { seed: 5, stripes: true },
    options: { start: near(12), startTolerance: BELIEVED, scale: 1 },
  },
  {
    name: "an initial pose believed too much: hills and a light of our own, 64x64",
    sample: sample("hills", "own", 64),
    options: { start: near(10, "rotation", "translation"), startTolerance: { degrees: 2, distance: 1 }, scale: 1 },
  },
];

export const MISSTATED = [...UNITS, ...HOLLOW, ...WITHOUT_MASKS, ...TOO_SURE];
