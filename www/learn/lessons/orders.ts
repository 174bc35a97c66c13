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
    "A room has many lamps, walls and windows. Light adds up, so the intensity of a matte surface is a sum of clamped cosines, one for each source: a function of the normal alone, and a smooth one, because each point collects light from half of all directions, which blurs the details of the light. A polynomial of degree 2 describes it well. In the formula, {S} is the intensity in one colour j (red, green or blue), called {E} so far; {c}, {lj} and {Q} are the parts of order 0, 1 and 2. Here the albedo is 1, whose logarithm is 0; lesson 6 adds it, lesson 7 makes it part of {M}, and lesson 13 gives each colour its own. The last paragraph says why the formula has a logarithm.",
    "Three balls show the parts. The zeroth-order term is the same for every normal. First-order terms brighten one side. Second-order terms have the same value for opposite normals, {n} and {−n}, of which a ball shows only one. Added up, they give the fourth ball, which shows every normal that the camera can see, and so shows the whole model.",
    "The polynomial has nine coefficients for each colour, 27 in all. The matrices {M} collect them, and {N} is the normal with a fourth component 1, so that one product contains all orders. A symmetric 4 by 4 matrix has ten numbers. But the squares of the normal's components add up to 1, so a constant (here {=constant}) can be moved from the zeroth order to the squares without any effect, and nine numbers remain.",
    "Nine numbers describe the intensity under any distant light, with an error of about 1 % on average over many lights (Ramamoorthi and Hanrahan); the readouts show the error for the one lamp of this figure. This page follows Barron and Malik and uses nine numbers for the logarithm of the intensity instead. That is a choice, not a theorem. It has a price: under a single lamp in the dark its error is larger. And it has two gains: the albedo becomes a term that is added, and no predicted intensity is negative.",
  ],
  tasks: [
    "Move a constant from order 0 to the squares. Two balls change, and their sum stays the same.",
    "Switch the light from all around nearly off. The curve for the intensity falls below zero in the shadow; the curve for the logarithm stays above it.",
    "Add light from all around. The error of the nine numbers for the logarithm falls.",
  ],
  tries: [
    { set: { constant: -0.6 }, sweep: { key: "constant", to: 0.6 } },
    { set: { around: 0.4 }, sweep: { key: "around", to: 0.02 } },
    { set: { around: 0.02 }, sweep: { key: "around", to: 0.5 } },
  ],
  guesses: [
    {
      question: "A symmetric 4 by 4 matrix has ten numbers. How many of them can a picture determine?",
      at: { constant: 0 },
      choices: ["Ten", "Nine", "Four"],
      right: 1,
      reveal: { sweep: { key: "constant", to: 0.6 } },
      answer: "Nine. A constant moved from order 0 to the squares changes nothing, because the squares add up to 1.",
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
    { kind: "slider", key: "around", label: "Light from all around", min: 0.02, max: 0.5, step: 0.02, initial: 0.1 },
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
