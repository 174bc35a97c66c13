/** Lessons 4 and 5: from normals to a surface, and what a depth map from elsewhere adds. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, comma, frac, log, mi, mn, mo, norm, row, sub, sum, sup, symbol } from "../maths";

const n = (index: string) => sub(symbol("n"), mi(index));
const change = (axis: string) => frac(row(mi("∂"), symbol("z")), row(mi("∂"), mi(axis)));

export const surface: Lesson = {
  id: "surface",
  title: "From normals to a surface",
  gist: "Normals tell slopes. Adding slopes up gives a surface, but a step leaves no trace in them.",
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
    "A normal {n} fixes the slope of the depth {z} in both directions. Integration looks for the surface whose differences from pixel to pixel fit these slopes best, in least squares. The depth as a whole stays free: adding a constant changes no slope.",
    "Discontinuities: at a step the depth jumps between two pixels. Both have normals that know nothing of it. If the step ends somewhere, a way around it brings the height back, and the two contradict each other. Least squares spreads the contradiction over the neighbours; robust weights find the few pairs of pixels that do not fit and let go of them. If the step cuts the object in two, no way leads around it, and nothing can know its height.",
    "Bias: noise tilts normals at random, but the result is not only noisy. A slope is the tangent of a tilt: a normal that noise tilts too far adds more slope than one that it tilts too little takes away. So the errors do not cancel, steep flanks come out too steep, and the dome is found with more than 100 % of its true relief. Normals that would turn away from the camera are cut off, which takes a part of it back.",
  ],
  tasks: [
    "Raise the step. The height found across it lags behind the true one.",
    "Switch the robust weights off and on at a step of 6 px: the error of the depth falls with them.",
    "Let the step cut the plate in two: robust or not, its height is wrong, since nothing tells it.",
    "Set the step to 0 and raise the noise: the dome comes out higher than it is.",
  ],
  controls: [
    { kind: "slider", key: "step", label: "Height of the step", min: 0, max: 12, step: 0.5, initial: 6, unit: "px" },
    { kind: "box", key: "robust", label: "Robust weights", initial: 1 },
    { kind: "box", key: "through", label: "The step cuts the plate in two", initial: 0 },
    { kind: "slider", key: "noise", label: "Noise of the picture", min: 0, max: 0.2, step: 0.01, initial: 0 },
  ],
  readouts: [
    { key: "error", label: "Error of the depth (rms)", unit: "px", digits: 2, ink: "error" },
    { key: "jump", label: "Height found across the step", unit: "px", digits: 2, ink: "normal" },
    { key: "kept", label: "Relief of the dome, found over true", unit: "%", digits: 0, ink: "normal" },
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
  gist: "Where a depth map gives a normal as well, the pixel prefers the explanation near it.",
  formula: () =>
    block(
      sum(mi("j")),
      sup(
        row(mo("("), log(symbol("S")), mo("−"), sup(symbol("n"), mi("⊤")), symbol("M"), symbol("n"), mo(")")),
        mn("2"),
      ),
      mo("+"),
      symbol("lambda"),
      norm(row(symbol("n"), mo("−"), symbol("m"))),
    ),
  formulaWords:
    "The cost of the colours plus lambda times the squared distance between the normal and the one that the depth map gives.",
  text: [
    "A second camera measures depth. If its pose is known, each of its points lands on a pixel and brings a normal {m}. It enters the cost as a prior with the weight {lambda}: of all normals that explain the colours, take one near {m}.",
    "This is the paper's Figure 5. The light is known, the picture has 2 % noise, and a share of the pixels, chosen at random, is given the true normal. All others have their colours alone. With more of them the surface improves, at first more than in proportion: pixels without a prior gain, too, for all pixels share the exposure of the picture, and a few given normals fix it.",
    "Too small a weight and the prior is ignored; a very large one copies the depth map and throws the picture away. Here the prior is perfect, so large does no harm. A real depth map is noisy and has no fine detail.",
  ],
  tasks: [
    "Move the share from 0 to 100 %. The curve is computed while you watch.",
    "Choose the coloured lamps: the prior is hardly needed.",
    "Set λ to its least: the given normals are there and hardly count.",
  ],
  controls: [
    { kind: "slider", key: "share", label: "Pixels with a prior", min: 0, max: 100, step: 1, initial: 20, unit: "%" },
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
    { key: "depth", label: "Error of the depth (rms)", unit: "px", digits: 2, ink: "error" },
    { key: "pixels", label: "Pixels with a prior", digits: 0, ink: "prior" },
  ],
  drags: {},
  more: { paper: "Eq. 6 to 9 and Figure 5", sections: ["normals", "protocols"] },
};
