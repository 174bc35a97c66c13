/** Lessons 3 and 4: the ambiguity of one picture, and classical shape from shading under one lamp. */

import type { Lesson } from "../lesson";
import { block, changeOf, comma, gradient, lines, mo, primed, row, symbol, type SymbolName } from "../maths";
import { decimals } from "../digits";
import { stretchOf } from "../stretch";
import { lampSliders } from "./first";

const pair = (make: (name: SymbolName) => Element, first: SymbolName, second: SymbolName) =>
  row(mo("("), make(first), mo(","), make(second), mo(")"));
const change = (name: SymbolName) => changeOf(symbol(name));

export const relief: Lesson = {
  id: "relief",
  title: "One picture, many shapes",
  gist: "A flattened or an inverted surface can make exactly the same picture.",
  formula: () =>
    block(
      primed(symbol("z")),
      mo("="),
      symbol("s"),
      symbol("z"),
      mo("+"),
      symbol("t"),
      symbol("x"),
      comma(),
      primed(symbol("E")),
      mo("="),
      symbol("E"),
    ),
  formulaWords: "The new depth is s times the depth plus t times x, and the new intensity is the old one.",
  text: [
    "Sculptors of coins and medals have always known it: a portrait a few millimetres deep looks like a whole head. Multiply all depths {z} by a factor {s}, here {=stretch}, and add a tilt: a depth that grows by {t} with each step {x} to the right. In this formula a prime marks the other surface and its picture: its depth is {z′}, and its intensity {E′} is to be the old {E}. The plot shows a cross-section of both surfaces as heights: a height is a depth with the opposite sign.",
    "Every normal changes, and yet a lamp in another place, together with another albedo, restores the picture pixel by pixel; the readout gives the root mean square (rms) of what differs. This is the bas-relief ambiguity. It holds for any factor {s} and any tilt {t}, for one picture or a hundred under different lamps.",
    "The reason is a matrix. Scale each normal by its albedo and call the result b: the length of b is the albedo, and the intensity is b·{l}, where the length of {l} is the strength of the lamp. For any invertible matrix A, the vectors A b and A⁻ᵀ {l} have the same product. A normal is parallel to ({z_x}, {z_y}, −1), where an index names a derivative. So {z′} = {s}{z} is the matrix A = diag({s}, {s}, 1), and a tilt puts −{t} at its top right. The length of A b is the other surface's albedo; it changes from place to place, because A stretches vectors of different directions by different factors. Most other matrices turn the normals into vectors that belong to no surface: on a closed path the steps up and down must cancel, and theirs do not (lesson 9 meets such a contradiction).",
    "The most famous case is {s} = −1: near and far are exchanged, and a face becomes its mould. It needs no other albedo, only a lamp rotated by half a turn about the line of sight, because its matrix keeps every length: diag(−1, −1, 1) is that half turn. The lamp here is 35° from the line of sight, so it moves by 70°. People see the mould of a face as a face, because they expect faces, and light from above.",
    "So a single picture does not determine a shape. Something else has to be known: the lamp, the albedo, the silhouette, or a depth map. From lesson 10 on, this page uses the depth map.",
  ],
  tasks: [
    "Flatten the bust to a fifth of its depth. The two pictures stay the same, while the cross-section collapses.",
    "Leave the lamp where it was. The pictures now differ: the lamp has to move with the relief.",
    "Use one albedo for the flat relief. The pictures now differ: only its own albedo hides the flattening.",
    "Turn the surface inside out. The pictures are the same again, and the albedo is white everywhere.",
  ],
  tries: [
    { set: { lamp: 1, paint: 1, slope: 0, stretch: 1 }, sweep: { key: "stretch", to: 0.2 } },
    { set: { stretch: 0.2, slope: 0, paint: 1, lamp: 0 } },
    { set: { stretch: 0.2, slope: 0, lamp: 1, paint: 0 } },
    { set: { slope: 0, lamp: 1, paint: 1, stretch: -1 } },
  ],
  guesses: [
    {
      question:
        "The bust is flattened to half its depth, and its lamp moves to match. Which albedo makes the two pictures the same?",
      before: 1,
      at: { stretch: 1, slope: 0, lamp: 1, paint: 1 },
      choices: ["That of the bust, one value everywhere", "One that changes from place to place", "No albedo can"],
      right: 1,
      reveal: { sweep: { key: "stretch", to: 0.5 } },
      answer:
        "One that changes from place to place. Its brightest value is 1.9 times its darkest, and the difference of the pictures is zero: the ambiguity is exact.",
    },
    {
      question: "The bust is turned inside out and the lamp moves to match. Which albedo makes the picture the same?",
      before: 3,
      at: { stretch: 1, slope: 0, lamp: 1, paint: 1 },
      choices: ["The albedo of the bust, one value everywhere", "A darker albedo on the nose", "No albedo can"],
      right: 0,
      reveal: { set: { stretch: -1 } },
      answer: "The albedo of the bust. Inverting the depth leaves the length of every normal as it is.",
    },
  ],
  can: "You can name shapes that share one picture, and say which extra knowledge distinguishes them.",
  controls: [
    {
      kind: "slider",
      key: "stretch",
      label: "Depth of the other surface",
      min: -1.5,
      max: 1.5,
      step: 0.1,
      initial: 1,
      reads: (value) => `${decimals(stretchOf(value), 1)} ×`,
    },
    { kind: "slider", key: "slope", label: "Added tilt", min: -0.5, max: 0.5, step: 0.05, initial: 0 },
    { kind: "box", key: "lamp", label: "Move its lamp to match", initial: 1 },
    { kind: "box", key: "paint", label: "Choose its albedo to match", initial: 1 },
  ],
  readouts: [
    { key: "difference", label: "Difference of the pictures (rms)", unit: "%", digits: 2, ink: "error" },
    { key: "lamp", label: "Angle between the lamps", unit: "°", digits: 0, ink: "light" },
    { key: "paint", label: "Albedo, brightest over darkest", digits: 2, ink: "albedo" },
  ],
  drags: {},
  more: {
    sections: ["imageModel"],
    others: [["10.1023/A:1008154927611", "Belhumeur, Kriegman and Yuille, The bas-relief ambiguity, 1999"]],
  },
};

export const strips: Lesson = {
  id: "strips",
  title: "Shape from shading, the classical way",
  gist: "With one known lamp and one albedo, the shape can be followed along strips that start at a bright spot.",
  formula: () =>
    lines(
      block(symbol("E"), pair(symbol, "x", "y"), mo("="), symbol("map"), pair(symbol, "p", "q")),
      block(
        row(pair(change, "x", "y"), mo("="), gradient(symbol("map"))),
        comma(),
        row(pair(change, "p", "q"), mo("="), gradient(symbol("E"))),
      ),
      block(row(change("z"), mo("="), symbol("p"), change("x"), mo("+"), symbol("q"), change("y"))),
    ),
  formulaWords:
    "The intensity of the picture is the reflectance map of the slopes. A strip moves in the picture along the gradient of the map, and its slopes change along the gradient of the picture. Its depth changes by each slope times the step along it.",
  text: [
    "Write the surface as a depth {z} that depends on the place {x}, {y} in the picture. Its slopes {p} and {q} say how fast the depth changes to the right and down; together they say the same as the normal. Under a known lamp, Lambert's law gives each pair of slopes an intensity. All pairs together are the reflectance map {map}, a picture whose axes are slopes.",
    "A pixel of intensity {E} has its slopes somewhere on one isophote of that map. This is the first line of the formula: one equation, two unknowns.",
    "But neighbours have to fit together. Suppose that the slopes at one point are known. One step then has four parts: (1) read grad {map} at these slopes, the direction in which the map grows brighter; (2) step so in the picture, by {Δx} and {Δy}; (3) read grad {E} there, the direction in which the picture grows brighter; (4) change the slopes so, by {Δp} and {Δq}. This is the second line. It follows from the first, where an index names a derivative: along {x}, {E_x} = {map_p}{p_x} + {map_q}{q_x}, and {q_x} = {p_y}, because both are the second derivative of {z} along {x} and {y}. So {E_x} is the change of {p} in the step ({map_p}, {map_q}). In the third line, the depth changes by each slope times the step along it. So place, slopes and depth are carried on, step by step, along a characteristic strip.",
    "A strip starts at a bright spot. There the surface faces the lamp, so its slopes are known. But grad {map} is zero there, so the strips start on a small circle around the spot. Its slopes follow from the curvature of the surface, which that of the picture gives except for its sign: the spot may be a bump or a dent.",
    "Horn invented this in his thesis in 1970, the first computed shape from shading. Strips drift with noise and leave gaps, so later methods solve for all heights at once: his paper of 1989 computes heights and slopes together. Tests of such methods used the bust of Mozart; here, the built-in bust stands in for it.",
    "The method needs one lamp, known exactly, one albedo, and somebody who says whether the spot is a bump. It fails at a saddle, where the surface rises in one direction and falls in the other: strips part there, and the smallest error decides to which side they go.",
  ],
  tasks: [
    "Take the spot for a dent. The same picture now gives a wrong surface, and the error near the spot rises.",
    "Start from the throat, with the lamp in front. Within the first 10 px the strips follow the surface; farther away they go astray.",
    "Drag the pixel across the face. Its isophote in the reflectance map always runs through the cross, its true slopes.",
  ],
  tries: [
    { set: { lx: 0.3, ly: -0.3, sx: 0.56, sy: 0.2, dent: 1 } },
    { set: { lx: 0, ly: 0, dent: 0, sx: 0.47, sy: 0.71 } },
    { set: { py: 0.45, px: 0.25 }, sweep: { key: "px", to: 0.75 } },
  ],
  guesses: [
    {
      question: "A pixel has the intensity 0.7. How many pairs of slopes p, q explain it?",
      before: 1,
      at: { px: 0.4, py: 0.45 },
      choices: ["One", "Two", "A whole curve of them"],
      right: 2,
      reveal: { sweep: { key: "px", to: 0.55 } },
      covers: "map",
      answer: "A whole curve: an isophote of the reflectance map. Only one point of it, the cross, is the true pair.",
    },
  ],
  can: "You can read a reflectance map, explain why a strip can be followed, and name what classical shape from shading has to know.",
  controls: [
    ...lampSliders(0.3, -0.3, 0.6),
    { kind: "box", key: "dent", label: "Take the spot for a dent", initial: 0 },
    { kind: "slider", key: "sx", label: "Bright spot, across", min: 0, max: 1, step: 0.01, initial: 0.56 },
    { kind: "slider", key: "sy", label: "Bright spot, down", min: 0, max: 1, step: 0.01, initial: 0.2 },
    { kind: "slider", key: "px", label: "Pixel, across", min: 0, max: 1, step: 0.01, initial: 0.4 },
    { kind: "slider", key: "py", label: "Pixel, down", min: 0, max: 1, step: 0.01, initial: 0.45 },
  ],
  readouts: [
    { key: "near", label: "Error of the height, first 10 px", unit: "px", digits: 2, ink: "error" },
    { key: "far", label: "Farther away", unit: "px", digits: 2, ink: "error" },
    { key: "intensity", label: "Intensity of the pixel", digits: 2, ink: "intensity" },
    { key: "strips", label: "Strips", digits: 0, ink: "normal" },
  ],
  drags: { picture: { x: "px", y: "py" } },
  more: {
    sections: ["integration"],
    others: [
      ["10.1007/BF00056771", "Horn, Height and gradient from shading, 1990 (a memo of 1989)"],
      ["10.1109/34.784284", "Zhang, Tsai, Cryer and Shah, Shape from shading: a survey, 1999"],
    ],
  },
};
