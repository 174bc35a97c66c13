/** Lessons 8 and 9: what the image model leaves out, and when the method fails. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, frac, log, mi, mn, mo, row, sub, sup, symbol } from "../maths";

export const paint: Lesson = {
  id: "paint",
  title: "Shadows and paint",
  gist: "The image model knows no shadows and one albedo. Paint is told from shading by its hue; shadows are outliers.",
  formula: () =>
    block(
      log(symbol("S")),
      mo("="),
      symbol("a"),
      mo("+"),
      sup(symbol("n"), mi("⊤")),
      symbol("M"),
      symbol("n"),
      mo("+"),
      symbol("e"),
    ),
  formulaWords: "Log intensity is log albedo plus shading plus what is left over.",
  text: [
    "Print is not shape. A model with one albedo would read every painted edge as a fold. So once the pose has come to rest, the module asks whether a few paints explain the picture better: each pixel has the shading of its measured normal, plus one of a few offsets {a}. How many paints there are follows from the evidence.",
    "Hue decides: coloured paint changes red, green and blue by different amounts, while shading under whitish light changes them nearly alike. Grey paint is much harder to tell, and so is any paint under light of all colours.",
    "A cast shadow breaks the model: there the light is another one. Robust weights count such pixels less, so that they pull light and pose little. A hard shadow edge can still pass for paint, and its inside stays in the remainder {e}.",
  ],
  tasks: [
    "Raise the paint. It appears in the albedo and leaves the shading.",
    "Remove the paint and raise the shadow. See where it goes: some into the albedo, the rest into what is left over.",
    "Choose the coloured lamps: now hue says less, and the normals get worse.",
  ],
  controls: [
    { kind: "slider", key: "paint", label: "Strength of the paint", min: 0, max: 1, step: 0.05, initial: 0.8 },
    { kind: "slider", key: "shadow", label: "Depth of the shadow", min: 0, max: 0.95, step: 0.05, initial: 0 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "window" },
  ],
  readouts: [
    { key: "likeness", label: "Albedo found against the paint (correlation)", digits: 3, ink: "albedo" },
    { key: "degrees", label: "Mean error of the normals", unit: "°", digits: 1, ink: "normal" },
    { key: "lit", label: "Left over in the light", digits: 3, ink: "error" },
    { key: "shaded", label: "Left over in the shadow", digits: 3, ink: "error" },
    { key: "status", label: "Status" },
  ],
  drags: {},
  more: {
    sections: ["light"],
    others: [
      ["10.1109/TPAMI.2014.2377712", "Barron and Malik, Shape, illumination, and reflectance from shading, 2015"],
    ],
  },
};

export const failure: Lesson = {
  id: "failure",
  title: "When it fails",
  gist: "Some scenes do not hold the answer. Then the module should say so, and mostly it does.",
  formula: () =>
    block(
      sup(sub(mi("σ"), symbol("R")), mn("2")),
      mo("≈"),
      frac(sup(mi("σ"), mn("2")), row(mi("information"), mo("("), symbol("R"), mo(")"))),
    ),
  formulaWords:
    "The variance of the rotation is about the variance of the noise over the information that the scene has on the rotation.",
  text: [
    "Here nothing is told: light and pose are unknown, and the search runs from nothing. What is reported at the end is more than a pose: a status, a reason, a sigma of the rotation, and other poses that explain the colours as well.",
    "Symmetry: a round object looks the same when it is turned about its axis. No method can see that turn. Little overlap: if the depth map covers a narrow strip, few normals have to explain everything. Texture: fine print that changes from pixel to pixel hides the shading. A large turn: the cameras share less and less of the object, and what they share is seen at a slant.",
    "Compare the true error, which is known here because the scene is made, with the reported sigma and status. A good method is allowed to fail. It should not be sure of it.",
    "The reported sigma is that of the rotation about its least certain axis, and the degrees of a status are this one sigma, too. Above 1.5° the status is ambiguous: two sigmas are then more than the 3° within which a pose counts as found. Above 5° it is lost: so uncertain a rotation is no answer. Above 25° the rotation counts as not observable. A status can have other reasons as well: it is ambiguous if other poses explain the colours as well, and lost if too much of the colours is left unexplained.",
  ],
  tasks: [
    "Symmetry: remove the nose of the disc. At 100 % the turn can't be seen, and the report names the axis.",
    "Overlap: find the share at which the status stops being converged.",
    "Texture: with all of the print more of the colours is left than with none, and the rotation is so uncertain that the status is lost. It names the axis.",
    "A quarter turn: at 90° with a narrow depth map little is left to compare.",
  ],
  controls: [
    {
      kind: "choice",
      key: "case",
      label: "What goes wrong",
      choices: [
        ["symmetry", "symmetry"],
        ["overlap", "little overlap"],
        ["texture", "texture"],
        ["turn", "a large turn"],
      ],
      initial: "overlap",
    },
    { kind: "slider", key: "amount", label: "How much of it", min: 0, max: 100, step: 5, initial: 0, unit: "%" },
  ],
  readouts: [
    { key: "status", label: "Status" },
    { key: "error", label: "True error of the rotation", unit: "°", digits: 2, ink: "error" },
    { key: "sigma", label: "Reported sigma", unit: "°", digits: 2, ink: "pose" },
    { key: "rivals", label: "Other poses that fit as well", digits: 0, ink: "pose" },
    { key: "residual", label: "Residual of the colours", digits: 3, ink: "error" },
  ],
  drags: {},
  more: { sections: ["loop", "uncertainty"] },
};
