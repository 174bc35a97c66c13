/** Lessons 1 and 2: normals, and the intensity of a matte surface under one lamp. */

import type { Lesson, SliderControl } from "../lesson";
import { block, comma, mi, mn, mo, row, sub, sup, symbol } from "../maths";

const n = (index: string) => sub(symbol("n"), mi(index));
const squared = (index: string) => sup(n(index), mn("2"));

/** Two sliders for the direction to a lamp, which a drag on a picture sets. */
export const lampSliders = (right: number, down: number, reach = 0.95): readonly SliderControl[] => [
  { kind: "slider", key: "lx", label: "Lamp, to the right", min: -reach, max: reach, step: 0.01, initial: right },
  { kind: "slider", key: "ly", label: "Lamp, down", min: -reach, max: reach, step: 0.01, initial: down },
];

export const normal: Lesson = {
  id: "normal",
  title: "What a normal is",
  gist: "A normal is the direction in which a surface faces. A normal map shows it as a colour.",
  formula: () =>
    block(
      symbol("n"),
      mo("="),
      row(mo("("), n("x"), mo(","), n("y"), mo(","), n("z"), mo(")")),
      comma(),
      squared("x"),
      mo("+"),
      squared("y"),
      mo("+"),
      squared("z"),
      mo("="),
      mn("1"),
    ),
  formulaWords: "The normal has three components, whose squares add up to 1.",
  text: [
    "Put a pencil upright on a surface: it points along the normal {n}. The normal says which way the surface faces at that point, and nothing about where the point is. Its length is 1, so of its three components only two are free.",
    "This page measures x to the right, y down and z away from the camera. A surface that the camera can see faces the camera, so its {n_z} is negative. Straight toward the camera the normal is (0, 0, −1), and the arrow in the figure shrinks to a dot. At the silhouette of a ball the normal is perpendicular to the line of sight.",
    "A normal map turns the three components into red, green and blue: the farther a normal points to the right, the more red; up (against y), the more green; toward the camera, the more blue. A surface that faces the camera is light blue. The ball in the figure shows every visible normal once, so it is the key to all such maps.",
    "Turn the surface, now by {=turn}, and its normals turn with it. Point at the nose before and after: it is the same point of the bust, but its normal has another colour. Brightness plays no part in a normal map. The next lessons ask how much of it brightness reveals.",
  ],
  tasks: [
    "Turn the bust to the right and back. The cheek on the left of the picture turns toward the camera, and its map becomes bluer.",
    "Choose the ball and walk across it. The arrow shrinks to a dot in the middle and is longest at the edge.",
    "Turn the ball. Its dots move, but its map stays the same: in each pixel, another point of the ball now faces the same way.",
  ],
  tries: [
    { set: { surface: "bust", px: 0.36, py: 0.56, turn: -40 }, sweep: { key: "turn", to: 40 } },
    { set: { surface: "ball", py: 0.5, px: 0.16 }, sweep: { key: "px", to: 0.84 } },
    { set: { surface: "ball", px: 0.4, py: 0.4, turn: -60 }, sweep: { key: "turn", to: 60 } },
  ],
  guesses: [
    {
      question: "A surface faces to the left and up. Which colour does it have in the normal map?",
      before: 3,
      at: { surface: "ball", px: 0.5, py: 0.5, turn: 0 },
      choices: ["Orange", "Turquoise", "Purple"],
      right: 1,
      reveal: { set: { px: 0.29, py: 0.31 } },
      answer: "Turquoise. Left leaves little red; up gives much green, and the part toward the camera adds blue.",
    },
  ],
  can: "You can read a normal map, and say what a normal tells about a surface and what it does not.",
  controls: [
    {
      kind: "choice",
      key: "surface",
      label: "Surface",
      choices: [
        ["bust", "bust"],
        ["vase", "vase"],
        ["ball", "ball"],
      ],
      initial: "bust",
    },
    { kind: "slider", key: "turn", label: "Turn the surface", min: -60, max: 60, step: 1, initial: -15, unit: "°" },
    { kind: "slider", key: "px", label: "Point, across", min: 0, max: 1, step: 0.01, initial: 0.62 },
    { kind: "slider", key: "py", label: "Point, down", min: 0, max: 1, step: 0.01, initial: 0.3 },
  ],
  readouts: [
    { key: "nx", label: "To the right (x)", digits: 2, ink: "normal" },
    { key: "ny", label: "Down (y)", digits: 2, ink: "normal" },
    { key: "nz", label: "Away (z)", digits: 2, ink: "normal" },
    { key: "tilt", label: "Angle to the line of sight", unit: "°", digits: 0, ink: "normal" },
    { key: "red", label: "Red", digits: 0, ink: "red" },
    { key: "green", label: "Green", digits: 0, ink: "green" },
    { key: "blue", label: "Blue", digits: 0, ink: "blue" },
  ],
  drags: { surface: { x: "px", y: "py", follows: true }, map: { x: "px", y: "py", follows: true } },
  more: { sections: ["normals"] },
};

export const lambert: Lesson = {
  id: "lambert",
  title: "Light and angle",
  gist: "Under one lamp, a matte surface is as bright as the cosine of the angle between its normal and the lamp.",
  formula: () =>
    block(
      symbol("E"),
      mo("="),
      symbol("rho"),
      mi("max"),
      row(mo("("), mn("0"), mo(","), symbol("n"), mo("·"), symbol("l"), mo(")")),
    ),
  formulaWords:
    "The intensity is the albedo times the cosine of the angle between normal and lamp, and zero beyond 90 degrees.",
  text: [
    "Hold a sheet of paper under a lamp. It is brightest when it faces the lamp. Tilt it, and the same light is spread over more paper, so each part gets less. This is Lambert's law: the intensity {E} is the albedo {rho}, the share of light that the surface reflects, times the cosine {n}·{l} of the angle between the normal {n} and the direction {l} to the lamp. The sliders of the lamp set the parts of this unit vector to the right and down. A matte surface looks equally bright wherever the camera is.",
    "The cosine is flat near 0° and steep near 90°. At 60° half of the intensity is left, and beyond 90° the surface is in its own shadow. Light does not add up to less than nothing, hence the maximum in the formula.",
    "A line of equal intensity is called an isophote. The figure marks that of {=level}; drag this number to change it. On a ball, an isophote is a circle around the point that faces the lamp, because all normals on it have the same angle to the lamp. On any other surface, an isophote still joins all points with that angle, but now the line runs wherever the surface has such normals. Bright spots mark the places that face the lamp.",
    "One intensity fixes only one angle. The normal may lie anywhere on a cone, which contains all directions at this angle to the lamp: for half of the largest intensity, on the cone of 60°. The rays on the ball show it: they lead from its centre to the isophote, each along a normal of this intensity. In the normal map of lesson 1 the pixels of an isophote all have different colours, and yet they all look the same here. A second lamp in another place gives a second cone. Two cones meet in at most two lines, so two lamps leave at most two normals.",
  ],
  tasks: [
    "Move the lamp from the left to the right. The isophotes follow it, and the shadow grows on the other side.",
    "Bring the lamp to the front. Nothing that the camera sees of the ball is in shadow.",
    "Raise the chosen intensity from 0.1 to 0.9. The line shrinks toward the bright spots.",
  ],
  tries: [
    { set: { lx: -0.8, ly: -0.2 }, sweep: { key: "lx", to: 0.8 } },
    { set: { ly: 0, lx: 0.8 }, sweep: { key: "lx", to: 0 } },
    { set: { lx: 0.35, ly: -0.3, level: 0.1 }, sweep: { key: "level", to: 0.9 } },
  ],
  guesses: [
    {
      question: "At which angle between normal and lamp has the intensity fallen to one half?",
      before: 1,
      at: { level: 0.95 },
      number: { key: "angle", unit: "°", digits: 0, within: 5 },
      reveal: { sweep: { key: "level", to: 0.5 } },
      covers: "law",
      answer: "At 60°, because the cosine of 60° is one half. At 45° the intensity is still 0.71.",
    },
  ],
  can: "You can predict where a matte surface is bright, draw its isophotes, and say what one intensity leaves open.",
  controls: [
    ...lampSliders(0.35, -0.3),
    { kind: "slider", key: "level", label: "Chosen intensity", min: 0.05, max: 0.95, step: 0.01, initial: 0.7 },
    { kind: "box", key: "lines", label: "More isophotes", initial: 1 },
  ],
  readouts: [
    { key: "angle", label: "Angle at the chosen intensity", unit: "°", digits: 0, ink: "light" },
    { key: "lamp", label: "Lamp to the line of sight", unit: "°", digits: 0, ink: "light" },
    { key: "shadow", label: "Part of the ball in shadow", unit: "%", digits: 0, ink: "error" },
  ],
  drags: { ball: { x: "lx", y: "ly" }, vase: { x: "lx", y: "ly" }, bust: { x: "lx", y: "ly" } },
  more: {
    sections: ["imageModel"],
    others: [["10.1016/0004-3702(77)90020-0", "Horn, Understanding image intensities, 1977"]],
  },
};
