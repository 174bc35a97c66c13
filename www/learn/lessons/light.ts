/** Lessons 6 to 8: what the colours of a pixel reveal about its normal. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, colourTerm, comma, log, mi, mn, mo, shading, symbol } from "../maths";

const logS = () => log(symbol("S"));

export const pixel: Lesson = {
  id: "pixel",
  title: "What a pixel shows",
  gist: "A pixel's colour depends on only three things: the surface normal, the albedo and the light.",
  formula: () => block(logS(), mo("="), symbol("a"), mo("+"), shading()),
  formulaWords:
    "The logarithm of the intensity of colour j is the log albedo plus a quadratic form of the normal, whose matrix is the light of that colour.",
  symbols: ["L"],
  text: [
    "A matte surface under one distant lamp follows Lambert's law: its intensity is the albedo times {n}·l, the cosine of the angle between the unit normal {n} and the direction l of the lamp. Light from many directions adds up. So a pixel's intensity {S} in red, green and blue depends on its normal, on the albedo (how much light the surface reflects; {a} is its logarithm) and on the light {L}, the 27 numbers in the three matrices {M}. It does not depend on the position of the pixel in the picture.",
    "Each colour has its own light {M}. Light that is red from one side and blue from the other gives each direction another colour, and so the colour of a pixel says more about its normal than its brightness does. The ball shows the colour of every normal that the camera can see. In the plot across the ball, each curve is one colour.",
    "Under this model a darker surface is the same surface with a smaller {a}: all three logarithms fall by the same number. Here the albedo is {=albedo}. In a picture, a dark surface in bright light and a bright one in dim light are therefore the same. The model leaves out cast shadows, highlights and light that other parts of the object reflect.",
  ],
  tasks: [
    "Walk across the ball from left to right. The patch shows the colour of each normal.",
    "Rotate the light. The same normal now has a different colour.",
    "Lower the albedo. All three curves move down by the same amount: in the logarithm, the albedo is an additive constant.",
  ],
  tries: [
    { set: { nx: -0.9 }, sweep: { key: "nx", to: 0.9 } },
    { set: { beta: 0 }, sweep: { key: "beta", to: 60 } },
    { set: { albedo: 1 }, sweep: { key: "albedo", to: 0.3 } },
  ],
  guesses: [
    {
      question: "The albedo falls to a half. What happens to the three curves of log S?",
      before: 2,
      at: { albedo: 1 },
      choices: ["The highest falls most", "All fall by the same amount", "They become flatter"],
      right: 1,
      reveal: { sweep: { key: "albedo", to: 0.5 } },
      answer:
        "All fall by log 2, about 0.69. Halving a number lowers its logarithm by the same amount, however large it is.",
    },
  ],
  can: "You can say what the colour of a pixel depends on, and what the model leaves out.",
  controls: [
    { kind: "slider", key: "nx", label: "Normal, to the right", min: -0.95, max: 0.95, step: 0.01, initial: 0.45 },
    { kind: "slider", key: "ny", label: "Normal, down", min: -0.95, max: 0.95, step: 0.01, initial: -0.3 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "colourful" },
    {
      kind: "slider",
      key: "beta",
      label: "Rotate the light sideways",
      min: -90,
      max: 90,
      step: 1,
      initial: 0,
      unit: "°",
    },
    { kind: "slider", key: "alpha", label: "Tilt the light", min: -90, max: 90, step: 1, initial: 0, unit: "°" },
    { kind: "slider", key: "albedo", label: "Albedo", min: 0.1, max: 1, step: 0.01, initial: 1 },
  ],
  readouts: [
    { key: "red", label: "log S, red", digits: 3, ink: "red" },
    { key: "green", label: "log S, green", digits: 3, ink: "green" },
    { key: "blue", label: "log S, blue", digits: 3, ink: "blue" },
  ],
  drags: { ball: { x: "nx", y: "ny" }, bust: { x: "beta", y: "alpha" } },
  more: {
    paper: "Eq. 3 and 5",
    sections: ["imageModel"],
    others: [
      ["10.1109/TPAMI.2014.2377712", "Barron and Malik, Shape, illumination, and reflectance from shading, 2015"],
    ],
  },
};

export const grey: Lesson = {
  id: "grey",
  title: "One grey light is not enough",
  gist: "Under a single grey light, a whole curve of normals explains each pixel, and a bump can look like a dent.",
  formula: () => block(logS(), mo("="), shading(), comma(), mi("j"), mo("="), mn("1")),
  formulaWords: "One colour gives one equation. The unit normal has two unknowns.",
  text: [
    "From here to lesson 13 the whole object has one albedo. Its logarithm is then a constant, which {M} includes.",
    "A normal has two degrees of freedom; grey light gives one equation. In the cost map each place of the disc is one normal, as on the ball of lesson 1; its shade says how far the log intensity of this normal is from the measured one. The normals that explain the pixel form a curve, dark in the map. The pixel alone does not determine where on that curve the true normal lies.",
    "The picture as a whole is ambiguous, too. Rotate every normal by half a turn about the line of sight, and a bump becomes a dent. Rotate its lamp by half a turn, too, and every pixel keeps its brightness. In the figure the lamp has turned by {=turn} so far. This is why craters in photographs sometimes look like hills.",
    "The reason is that a rotated light is again a light of nine numbers. If the light is unknown, colour does not resolve the ambiguity. A known light does, and so does a depth map, though under grey light each pixel keeps its curve. Cast shadows, occluding contours (where the surface turns away from the camera) and the assumption that light comes from above help as well.",
  ],
  tasks: [
    "Move the lamp of the dent from 0° to 180°. At 180° the two pictures are the same, and the difference falls to zero.",
    "Flatten the bump. Then the two pictures cannot differ.",
    "Move the pixel across the bump. The dark curve of its normals moves, but it stays a curve.",
  ],
  tries: [
    { set: { height: 0.8, turn: 0 }, sweep: { key: "turn", to: 180 } },
    { set: { turn: 60 }, sweep: { key: "height", to: 0 } },
    { set: { height: 0.8, py: 0.42, px: 0.25 }, sweep: { key: "px", to: 0.75 } },
  ],
  guesses: [
    {
      question:
        "A dent lies beside a bump. By which angle must its lamp be rotated so that both make the same picture?",
      before: 2,
      at: { turn: 0, height: 0.8 },
      number: { key: "turn", unit: "°", digits: 0, within: 10 },
      reveal: { sweep: { key: "turn", to: 180 } },
      answer: "By 180°. A dent has the normals of the bump, rotated by half a turn about the line of sight.",
    },
  ],
  can: "You can show why one grey picture leaves a curve of normals, and when a bump looks like a dent.",
  controls: [
    {
      kind: "slider",
      key: "turn",
      label: "Rotate the lamp of the dent",
      min: 0,
      max: 180,
      step: 1,
      initial: 60,
      unit: "°",
    },
    { kind: "slider", key: "height", label: "Height of the bump", min: 0, max: 1, step: 0.05, initial: 0.8 },
    { kind: "slider", key: "px", label: "Pixel, across", min: 0, max: 1, step: 0.01, initial: 0.38 },
    { kind: "slider", key: "py", label: "Pixel, down", min: 0, max: 1, step: 0.01, initial: 0.42 },
  ],
  readouts: [
    { key: "difference", label: "Difference between the two pictures (rms of log S)", digits: 4, ink: "error" },
    {
      key: "explained",
      label: "Normals that explain the pixel within 2 %",
      unit: "% of the map",
      digits: 1,
      ink: "normal",
    },
  ],
  drags: { hill: { x: "px", y: "py" } },
  more: {
    sections: ["imageModel"],
    others: [["10.1023/A:1008154927611", "Belhumeur, Kriegman and Yuille, The bas-relief ambiguity, 1999"]],
  },
};

export const colours: Lesson = {
  id: "colours",
  title: "Three colours",
  gist: "Three coloured lights give three equations for two unknowns, and only a few normals remain.",
  formula: () => block(colourTerm(), mo("→"), mi("min")),
  formulaWords:
    "Minimise the sum over the three colours of the squared difference between the measured and the predicted logarithm.",
  text: [
    "A unit normal has two unknowns, and the colour of a pixel gives up to three numbers. One lamp of one colour leaves a cone of normals around it (lesson 2). A second lamp of another colour adds a second cone, and two cones meet in at most two normals. A third one decides between them.",
    "Let the light be red from one side, green from another and blue from a third. Each colour leaves a different curve of normals: the red, the green and the blue line in the map. Where the three curves meet, all colours are explained. The cost of a normal, shown by the shade of the map, is the squared distance between measured and predicted log colours; the solver looks for its global minimum.",
    "The light is known here; lesson 11 estimates it together with the pose. Even so the cost, a sum of squares of quadratic forms, can have several minima. The solver therefore first compares 600 directions all over the hemisphere and then descends from the best one. White dots mark the local minima; the larger the dot, the more starting points end there. The readouts say how far the colour of the lowest one is from that of the pixel, and how many others are as good within the noise.",
    "Natural light is nearly white. Its three curves almost coincide, and the valley of low cost becomes long and flat: a little noise moves the lowest point by tens of degrees. The picture now has a noise of {=noise}. A single pixel then determines almost nothing. Noise may also give the pixel a colour that no normal has. Then no normal explains it within 2 %, and the lowest minimum is merely the closest match.",
  ],
  tasks: [
    "Raise the colour of the light from 0 to 1. The three lines move apart, the dark valley shrinks to the spots where they meet, and the error of the normals falls.",
    "Choose the window light at full colour. The three lines run side by side, and the dark valley stays long.",
    "Add noise under the coloured lamps. At 5 % the error of the normals is 3.1°, up from 0.6° at 1 %. Under the window the same noise makes it grow from 13.4° to 39.3°.",
  ],
  tries: [
    { set: { light: "colourful", noise: 0.01, colour: 0 }, sweep: { key: "colour", to: 1 } },
    { set: { light: "window", colour: 1, noise: 0.01 } },
    { set: { light: "colourful", colour: 1, noise: 0 }, sweep: { key: "noise", to: 0.05 } },
  ],
  guesses: [
    {
      question:
        "Both lights at full colour, a noise of 1 %. Under which light are the normals of single pixels better?",
      before: 3,
      at: { light: "colourful", colour: 1, noise: 0.01 },
      choices: ["Under the coloured lamps", "Under the window, which is more natural", "Under both alike"],
      right: 0,
      reveal: { set: { light: "window" } },
      answer:
        "Under the coloured lamps. Light from a window is nearly white, its three curves almost coincide, and the error is many times larger.",
    },
  ],
  can: "You can explain why three coloured lights determine a normal, and why natural light hardly does.",
  controls: [
    {
      kind: "slider",
      key: "colour",
      label: "Colour of the light",
      min: 0,
      max: 1,
      step: 0.02,
      initial: 0.3,
      hint: "0: grey; 1: as it is",
    },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "colourful" },
    { kind: "slider", key: "noise", label: "Noise of the picture", min: 0, max: 0.1, step: 0.005, initial: 0.01 },
    { kind: "slider", key: "px", label: "Pixel, across", min: 0, max: 1, step: 0.01, initial: 0.42 },
    { kind: "slider", key: "py", label: "Pixel, down", min: 0, max: 1, step: 0.01, initial: 0.4 },
  ],
  readouts: [
    { key: "degrees", label: "Mean error of the normals", unit: "°", digits: 1, ink: "error" },
    {
      key: "explained",
      label: "Normals that explain the pixel within 2 %",
      unit: "% of the map",
      digits: 2,
      ink: "normal",
    },
    { key: "off", label: "Mismatch at best normal", unit: "%", digits: 1, ink: "minimum" },
    { key: "good", label: "Equally good minima", digits: 0, ink: "minimum" },
  ],
  drags: { picture: { x: "px", y: "py" } },
  more: { paper: "Eq. 8", sections: ["normals"] },
};
