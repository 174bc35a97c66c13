/** Lessons 1 to 3: what the colours of a pixel say about its normal. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, comma, log, math, mi, mn, mo, row, sum, sup, symbol } from "../maths";

const hatted = () => math("mover", {}, symbol("n"), mo("^"));
const predicted = () => row(sup(hatted(), mi("⊤")), symbol("M"), hatted());
const logS = () => log(symbol("S"));

export const pixel: Lesson = {
  id: "pixel",
  title: "What a pixel knows",
  gist: "A pixel's colour depends on three things only: the surface's normal, its albedo and the light.",
  formula: () => block(logS(), mo("="), symbol("a"), mo("+"), predicted()),
  formulaWords:
    "The logarithm of the intensity of colour j is the log albedo plus a quadratic form of the normal, whose matrix is the light of that colour.",
  text: [
    "The surface is matte, and the light comes from far away. Then a pixel's intensity {S} in red, green and blue depends on the unit normal {n} of the surface there, on its albedo (how much light it reflects, here the logarithm {a}), and on the light {L}. It does not depend on where in the picture the pixel is.",
    "The model writes the logarithm of the intensity as a polynomial of order 2 in the normal. That takes nine numbers for each colour, 27 in all, collected in the matrices {M}. The normal gets a fourth component 1, so that one product holds all orders.",
    "Order 0 is the same for every normal. Order 1 is brighter toward one side. Order 2 makes two opposite sides alike. Their sum is what you see on the ball: it shows every normal that the camera can see, so it shows everything the model can say.",
  ],
  tasks: [
    "Drag on the ball. The patch takes the colour of that normal.",
    "Drag on the bust to turn the light. The same normal now has another colour.",
    "Lower the albedo. All three curves move down by the same amount: in the logarithm, albedo is added.",
  ],
  controls: [
    { kind: "slider", key: "nx", label: "Normal, to the right", min: -0.95, max: 0.95, step: 0.01, initial: 0.45 },
    { kind: "slider", key: "ny", label: "Normal, down", min: -0.95, max: 0.95, step: 0.01, initial: -0.3 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "colourful" },
    {
      kind: "slider",
      key: "beta",
      label: "Turn the light sideways",
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
    { key: "order0", label: "log S, green: order 0", digits: 3, ink: "light" },
    { key: "order1", label: "log S, green: order 1", digits: 3, ink: "light" },
    { key: "order2", label: "log S, green: order 2", digits: 3, ink: "light" },
  ],
  drags: { ball: { x: "nx", y: "ny" }, bust: { x: "beta", y: "alpha" } },
  more: {
    paper: "Eq. 3 and 5",
    sections: ["imageModel"],
    others: [
      [
        "10.1145/383259.383317",
        "Ramamoorthi and Hanrahan, An efficient representation for irradiance environment maps, 2001",
      ],
    ],
  },
};

export const grey: Lesson = {
  id: "grey",
  title: "One grey light is not enough",
  gist: "Under one grey light a pixel fits a whole curve of normals, and a bump can look like a dent.",
  formula: () => block(logS(), mo("="), predicted(), comma(), mi("j"), mo("="), mn("1")),
  formulaWords: "One equation for one colour. The unit normal has two unknowns.",
  text: [
    "A normal has two degrees of freedom. Grey light gives one equation. So the normals that explain one pixel form a curve; in the map of costs it is the dark line. Nothing in the pixel says where on that line the true normal lies.",
    "For a picture as a whole there is more trouble. Turn every normal by half a turn about the line of sight: a bump becomes a dent. Turn the lamp likewise, and every pixel keeps its brightness. This is why craters in photographs sometimes look like hills.",
    "The rule behind it: lights of order 2 turned by any rotation are again lights of order 2. If the light is unknown, colour does not help against this; only a known light, or a depth map, does.",
  ],
  tasks: [
    "Move the lamp of the dent from 0° to 180°. At 180° the two pictures are the same, and the difference falls to almost zero.",
    "Make the bump flat. Then there is nothing to tell apart.",
    "Drag the pixel on the bump and watch how the dark curve moves.",
  ],
  controls: [
    {
      kind: "slider",
      key: "turn",
      label: "Turn the lamp of the dent",
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
    { key: "difference", label: "Difference of the two pictures (rms of log S)", digits: 4, ink: "error" },
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
  gist: "Three coloured lights give three equations for two unknowns, and a few normals are left.",
  formula: () =>
    block(sum(mi("j")), sup(row(mo("("), logS(), mo("−"), predicted(), mo(")")), mn("2")), mo("→"), mi("min")),
  formulaWords:
    "The sum over the three colours of the squared difference between the measured and the predicted logarithm is made as small as possible.",
  text: [
    "Let the light be red from one side, green from another and blue from a third. Each colour leaves its own curve of normals. Where the three curves meet, all colours are explained. The cost of a normal is the squared distance between measured and predicted log colours; the solver looks for its lowest valley.",
    "A quadratic form in three colours can still have several valleys. So the solver first compares 600 directions all over the hemisphere and then walks downhill from the best one. The white dots are all valleys, the larger the more starts end there.",
    "Natural light is nearly white. Its three curves almost coincide, and the valley becomes long and flat: a little noise moves the lowest point by tens of degrees. Then a pixel alone is lost. Noise may also give the pixel a colour that no normal has: then no normal explains it within 2 %, and the lowest valley is only the nearest that there is.",
  ],
  tasks: [
    "Drag the colour from 0 to 1. The dark curve shrinks to a few spots and the error of the normals falls.",
    "Choose the window at full colour: the curve stays long.",
    "Add noise and compare how much each light suffers.",
  ],
  controls: [
    {
      kind: "slider",
      key: "colour",
      label: "Colour of the light",
      min: 0,
      max: 1,
      step: 0.02,
      initial: 0.3,
      hint: "0: the mean of its three colours for all; 1: the light as it is",
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
    { key: "off", label: "Lowest valley off by", unit: "%", digits: 1, ink: "minimum" },
    { key: "good", label: "Valleys as low as it", digits: 0, ink: "minimum" },
  ],
  drags: { picture: { x: "px", y: "py" } },
  more: { paper: "Eq. 8", sections: ["normals"] },
};
