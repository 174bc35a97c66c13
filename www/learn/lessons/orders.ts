/** Lesson 5: the orders of the image model, and why it has nine numbers for each colour. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, log, mo, row, shading, symbol, transposed } from "../maths";
import { LARGEST_CONSTANT } from "../protocol";

export const orders: Lesson = {
  id: "orders",
  title: "Nine numbers for a light",
  gist: "However many lamps there are, nine numbers for each colour describe how a matte surface answers to them.",
  formula: () =>
    block(
      log(symbol("S")),
      mo("="),
      shading(),
      mo("="),
      symbol("c"),
      mo("+"),
      symbol("lj"),
      mo("·"),
      symbol("n"),
      mo("+"),
      row(transposed(symbol("n")), symbol("Q"), symbol("n")),
    ),
  formulaWords:
    "The logarithm of the intensity is a constant, plus a vector times the normal, plus a quadratic form of the normal.",
  text: [
    "A room has many lamps, walls and windows. Light adds up, so the intensity of a matte surface is a sum of clamped cosines, the max(0, {n}·{l}) of lesson 2, one for each source: a function of the normal alone. A single clamped cosine has a kink at 90°. But the kinks of different sources lie at different normals, and the sum is smooth: each point collects light from half of all directions, which blurs the light with a brush as wide as a hemisphere. A polynomial of degree 2 in the components of {n} describes it well: products of two of them, single ones and a constant. Sorted by degree, the number of factors, a clamped cosine has a large constant part, a large part of degree 1 and a smaller one of degree 2. Its part of degree 3 is zero, and all higher ones together are small.",
    "In the formula, {S} is the intensity of a white surface (albedo 1) in one colour j: red, green or blue. It was called {E} so far. Lesson 6 adds the albedo, lesson 7 puts it into {M}, and lesson 14 gives each colour its own {aj}. The parts of degree 0, 1 and 2 are called orders: {c} is a constant, {lj} a vector, no longer that of one lamp, whose product with {n} is largest for the normals along it, and {Q} a matrix that weights the products of two components of {n}. The last paragraph says why the formula has a logarithm.",
    "Three balls show the parts, each as the exponential of its part, so that a negative one is dark. The zeroth-order term is the same for every normal. First-order terms brighten one side. Second-order terms have the same value for opposite normals, {n} and {−n}: one on the side of the ball that the camera sees, the other on its back. Added up, they give the fourth ball, which shows every normal that the camera can see, and so shows the whole model.",
    "The polynomial has nine coefficients for each colour, 27 in all. The matrices {M} collect them, and {N} is the normal with a fourth component 1, so that one product contains all orders. A symmetric 4 by 4 matrix has ten numbers. But the squares of the normal's components add up to 1, so a constant (here {=constant}) can be moved from the zeroth order to the squares without any effect, and nine numbers remain.",
    "Nine numbers describe the intensity under any distant light, with an error of about 1 % on average over many lights (Ramamoorthi and Hanrahan). A single lamp is the hardest light; the one of this figure leaves 3.6 %. This page follows Barron and Malik and uses nine numbers for the logarithm of the intensity instead. That is a choice, not a theorem. It has a price: under a single lamp in the dark its error is larger. And it has two gains: the albedo becomes a term that is added, and no predicted intensity is negative.",
  ],
  tasks: [
    "Move a constant from order 0 to the squares. Two balls change, and their sum stays the same.",
    "Switch the light from all around nearly off. The curve for the intensity falls below zero in the shadow; the curve for the logarithm stays above it.",
    "Add light from all around. The error of the nine numbers for the logarithm falls.",
    "Show the clamped cosine by degree. The curve of degree 3 stays at zero, and degrees 0 to 2 together come within 3.6 % of the cosine on average.",
  ],
  tries: [
    { set: { constant: -0.6 }, sweep: { key: "constant", to: 0.6 } },
    { set: { curves: "lamp", around: 0.4 }, sweep: { key: "around", to: 0.02 } },
    { set: { curves: "lamp", around: 0.02 }, sweep: { key: "around", to: 0.5 } },
    { set: { curves: "degrees" } },
  ],
  guesses: [
    {
      question: "A constant is subtracted from order 0. Which change of order 2 restores every intensity?",
      before: 3,
      at: { constant: 0 },
      choices: ["The constant is added to all its numbers", "It is added to the three squares", "No change can"],
      right: 1,
      reveal: { sweep: { key: "constant", to: 0.6 } },
      answer:
        "It is added to the three squares, because they add up to 1. So no picture can determine all ten numbers of a symmetric 4 by 4 matrix, only nine.",
    },
  ],
  can: "You can explain what the three orders do, why nine numbers are enough, and what the logarithm costs and gains.",
  controls: [
    { kind: "slider", key: "nx", label: "Normal, to the right", min: -0.95, max: 0.95, step: 0.01, initial: 0.45 },
    { kind: "slider", key: "ny", label: "Normal, down", min: -0.95, max: 0.95, step: 0.01, initial: -0.3 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "colourful" },
    {
      kind: "slider",
      key: "constant",
      label: "Constant moved to the squares",
      min: -LARGEST_CONSTANT,
      max: LARGEST_CONSTANT,
      step: 0.05,
      initial: 0,
    },
    {
      kind: "choice",
      key: "curves",
      label: "Curves",
      choices: [
        ["lamp", "one lamp"],
        ["degrees", "by degree"],
      ],
      initial: "lamp",
    },
    {
      kind: "slider",
      key: "around",
      label: "Light from all around",
      min: 0.02,
      max: 0.5,
      step: 0.02,
      initial: 0.1,
      when: ({ curves }) => curves === "lamp",
    },
  ],
  readouts: [
    { key: "order0", label: "log S, green: order 0", digits: 3, ink: "light" },
    { key: "order1", label: "order 1", digits: 3, ink: "light" },
    { key: "order2", label: "order 2", digits: 3, ink: "light" },
    { key: "whole", label: "Sum", digits: 3, ink: "green" },
    { key: "direct", label: "Error: intensity", unit: "%", digits: 1, ink: "error" },
    { key: "byLog", label: "Error: logarithm", unit: "%", digits: 1, ink: "error" },
  ],
  drags: Object.fromEntries(["order0", "order1", "order2", "whole"].map((key) => [key, { x: "nx", y: "ny" }])),
  more: {
    paper: "Eq. 3 and 5",
    sections: ["imageModel"],
    others: [
      [
        "10.1145/383259.383317",
        "Ramamoorthi and Hanrahan, An efficient representation for irradiance environment maps, 2001",
      ],
      ["10.1109/TPAMI.2014.2377712", "Barron and Malik, Shape, illumination, and reflectance from shading, 2015"],
    ],
  },
};
