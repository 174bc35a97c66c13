/** Lessons 9 and 10: from normals to a surface, and what a depth map from elsewhere adds. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, colourTerm, comma, frac, mi, mo, norm, row, sub, symbol } from "../maths";

const n = (index: string) => sub(symbol("n"), mi(index));
const change = (axis: "x" | "y") => frac(row(mo("∂"), symbol("z")), row(mo("∂"), symbol(axis)));

export const surface: Lesson = {
  id: "surface",
  title: "From normals to a surface",
  gist: "Normals give slopes, and adding up slopes gives a surface, with errors that the slopes cannot show.",
  formula: () =>
    block(
      change("x"),
      mo("="),
      mo("−"),
      frac(n("x"), n("z")),
      comma(),
      change("y"),
      mo("="),
      mo("−"),
      frac(n("y"), n("z")),
    ),
  formulaWords: "The slope of the depth z along x is minus n x over n z, and along y minus n y over n z.",
  text: [
    "A normal {n} fixes the slope of the depth {z} in both directions. The figure integrates the normals of a plate with a dome and a step. Integration finds the surface whose differences from pixel to pixel fit these slopes best in the least-squares sense. The absolute depth stays undetermined: adding a constant changes no slope.",
    "Discontinuities: slopes are blind to a step. At a step, here of {=step}, the depth jumps between two pixels, and the normals of both are unaffected by it. If the step ends somewhere, a path around it gives its height, and the path across contradicts that. Least squares spreads the contradiction over the neighbours; robust weights reduce the influence of a pair of pixels the worse it fits the surface found so far, and repeat, until the few pairs across the step hardly count. If the step cuts the object in two, no path leads around it, and its height is undetermined: least squares then takes the surface without a step.",
    "Bias: noise tilts normals at random, but the result is not only noisy. A slope is the tangent of a tilt, so a normal tilted too far adds more slope than a normal tilted too little removes. The errors do not cancel: steep flanks come out too steep, and the dome has more than 100 % of its true relief. Normals that would face away from the camera are clipped, which offsets part of the bias.",
  ],
  tasks: [
    "Switch the robust weights off and raise the step. The estimated height falls short of the true one by more than half.",
    "Switch the robust weights on at a step of 6 px. There the error of the depth falls.",
    "Let the step cut the plate in two. Then, robust or not, its height is wrong, because nothing in the slopes determines it.",
    "Set the step to 0 and raise the noise. Now the dome comes out too high.",
  ],
  tries: [
    { set: { robust: 0, through: 0, noise: 0, step: 0 }, sweep: { key: "step", to: 10 } },
    { set: { robust: 1, through: 0, noise: 0, step: 6 } },
    { set: { robust: 1, through: 1, noise: 0, step: 8 } },
    { set: { step: 0, through: 0, noise: 0 }, sweep: { key: "noise", to: 0.2 } },
  ],
  guesses: [
    {
      question: "A step of 8 px cuts the plate in two. How many of the 8 px does integration find?",
      before: 1,
      at: { step: 0, through: 1, robust: 1, noise: 0 },
      number: { key: "jump", unit: " px", digits: 1, within: 0.5 },
      reveal: { sweep: { key: "step", to: 8 } },
      answer:
        "None. The normals on both sides are those of a plate without a step, so the slopes say nothing about it.",
    },
  ],
  can: "You can integrate normals, and say which errors integration cannot notice.",
  controls: [
    { kind: "slider", key: "step", label: "Height of the step", min: 0, max: 12, step: 0.5, initial: 6, unit: "px" },
    { kind: "box", key: "robust", label: "Robust weights", initial: 1 },
    { kind: "box", key: "through", label: "The step cuts the plate in two", initial: 0 },
    { kind: "slider", key: "noise", label: "Noise of the picture", min: 0, max: 0.2, step: 0.01, initial: 0 },
  ],
  readouts: [
    { key: "error", label: "Error of the depth (rms)", unit: "px", digits: 2, ink: "error" },
    { key: "jump", label: "Estimated height of the step", unit: "px", digits: 2, ink: "normal" },
    { key: "kept", label: "Relief of the dome, estimated over true", unit: "%", digits: 0, ink: "normal" },
  ],
  drags: {},
  more: {
    paper: "Eq. 4, 10 and 11",
    sections: ["integration"],
    others: [
      [
        "10.1109/34.3909",
        "Frankot and Chellappa, A method for enforcing integrability in shape from shading algorithms, 1988",
      ],
    ],
  },
};

export const prior: Lesson = {
  id: "prior",
  title: "A depth map from elsewhere",
  gist: "Where a depth map gives a normal as well, the pixel prefers a normal near it.",
  formula: () => block(colourTerm(), mo("+"), symbol("lambda"), norm(row(symbol("n"), mo("−"), symbol("m")))),
  formulaWords:
    "The cost of the colours plus lambda times the squared distance between the normal and the one that the depth map gives.",
  text: [
    "A second camera measures depth. If its pose is known, that is, where it stands and how it is turned (lesson 11), each of its points lands on a pixel and brings a normal {m}. That normal enters the cost as a prior, an estimate made beforehand, with the weight {lambda}: of all normals that explain the colours, choose one near {m}. So the depth map settles what a picture leaves open (lessons 3 and 7): a bump and a dent, or a head and its flat relief, share a picture but not a depth map. Its points also have what slopes lack, the absolute depth and the heights of steps; lesson 13 uses them.",
    "The figure repeats an experiment of the paper whose method these lessons extend (its Figure 5). The light is known except for the exposure, one factor for the brightness of the whole picture; the picture has 2 % noise, and a share of the pixels, chosen at random, is given the true normal. All other pixels have only their colours.",
    "The surface improves with the share, at first more than proportionally. Pixels without a prior gain, too, because all pixels share the exposure, and a few given normals determine it.",
    "With too small a weight the prior is ignored; with a very large one the result copies the depth map and ignores the picture. Here the prior is perfect, so a large weight does no harm. A real depth map is noisy and lacks fine detail.",
  ],
  tasks: [
    "Give every pixel a prior. The error of the normals falls to its least.",
    "Choose the coloured lamps. There the prior is hardly needed.",
    "Set λ to its minimum, 0. The error is about as large as without a prior.",
  ],
  tries: [
    { set: { share: 100, weight: -1.3, light: "window" } },
    { set: { light: "colourful", share: 20, weight: -1.3 } },
    { set: { weight: -4, share: 20, light: "window" } },
  ],
  guesses: [
    {
      question: "A fifth of the pixels is given a prior. By how much does the mean error of the normals fall?",
      before: 2,
      at: { share: 0, weight: -1.3, light: "window" },
      choices: ["By a fifth of what all priors achieve", "By less than that", "By more than that"],
      right: 2,
      reveal: { set: { share: 20 } },
      answer: "By more than that. Pixels without a prior gain, too, because all pixels share one exposure.",
    },
  ],
  can: "You can explain how a depth map enters the estimate as a prior, and what its weight does.",
  controls: [
    { kind: "slider", key: "share", label: "Pixels with a prior", min: 0, max: 100, step: 1, initial: 0, unit: "%" },
    {
      kind: "slider",
      key: "weight",
      label: "Weight λ of the prior",
      min: -4,
      max: 1,
      step: 0.1,
      initial: -1.3,
      logarithmic: true,
    },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "window" },
  ],
  readouts: [
    { key: "degrees", label: "Mean error of the normals", unit: "°", digits: 2, ink: "error" },
    { key: "others", label: "Those without a prior", unit: "°", digits: 2, ink: "error" },
    { key: "depth", label: "Error of the depth (rms)", unit: "px", digits: 2, ink: "error" },
    { key: "pixels", label: "Pixels with a prior", digits: 0, ink: "prior" },
  ],
  drags: {},
  more: { paper: "Eq. 6 to 9 and Figure 5", sections: ["normals", "protocols"] },
};
