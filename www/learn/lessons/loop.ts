/** Lessons 12 and 13: the loop of the method, and the refinement of the sensor's depth. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, colourTerm, lines, mn, mo, norm, row, sup, symbol } from "../maths";

export const loop: Lesson = {
  id: "loop",
  title: "The loop",
  gist: "A pose gives each pixel a prior for its normal. A better pose gives a better prior, again and again.",
  formula: () =>
    block(colourTerm(), mo("+"), symbol("lambda"), norm(row(symbol("n"), mo("−"), symbol("R"), symbol("m")))),
  formulaWords:
    "For one pixel: the cost of the colours plus lambda times the squared distance between the normal and the depth map's normal rotated by the pose.",
  stages: ["Light", "Normals", "Surface", "Pose", "Depth map"],
  text: [
    "Lesson 11 took every normal from the depth map, for all pixels at once. In box 2, the formula here, the normal {n} of each single pixel is free again. The first term asks it to explain the colours of its pixel. The second one keeps it near {R}{m}, the depth map's normal under the present pose.",
    "The boxes show one pass of the loop: (1) fit the light, with the normals held; (2) find the normal of each pixel; (3) integrate them to a surface (lesson 9); (4) estimate the pose anew; (5) refine the depth map (lesson 13). The paper finds the pose by moving the depth map onto the surface. This program registers as in lesson 11, which needs no surface; the surface is then a result. The slider of passes goes the way of the paper. The next pass begins with the new pose, and so with a better prior. The loop ends when the pose no longer changes.",
    "The map shows the cost of one pixel over all normals, with the prior that the depth map gives under an initial pose that is off by {=offset}. The ring marks the prior, the dots mark the minima, and the line shows the solver's steps from the prior. A small {lambda} leaves several minima. With a larger one they merge into one near the prior.",
    "If the pose is right, the prior is near the true normal, and so is that minimum. Over all pixels of this picture, the mean error is then 13.7° without a prior, 3.2° at λ = 0.05 and 4.9° at λ = 10, where the picture hardly counts. If the pose is wrong, the minimum moves away from the true normal. The robust prior is a compromise: a prior more than about 23° off is ignored.",
  ],
  tasks: [
    "Run the next pass. From an initial pose 12° off, the error of the pose falls to 4.8° in the first pass and to 1.0° in six, and the ring moves to the cross.",
    "Raise λ under the right pose. Here, for a pixel of the cheek, the minima merge into one near the true normal: the solver is 14.5° off at λ = 0.001 and 1.0° at λ = 1.",
    "Set the pose 20° off. Raise λ until the minima of the pixel, now another one, have merged. The solver then ends far from the true normal: 17.1° off at λ = 1.",
    "Set the pose 40° off and make the prior robust, with λ = 0.05. The solver ends 3.3° off; with the plain prior it was 38.7°.",
  ],
  tries: [
    { set: { offset: 12, px: 0.48, py: 0.72 }, step: "pass" },
    { set: { pass: 0, offset: 0, robust: 0, weight: -3, px: 0.42, py: 0.56 }, sweep: { key: "weight", to: 0 } },
    { set: { pass: 0, offset: 20, robust: 0, weight: -3, px: 0.48, py: 0.72 }, sweep: { key: "weight", to: 0 } },
    { set: { pass: 0, offset: 40, robust: 1, weight: -1.3, px: 0.48, py: 0.72 } },
  ],
  guesses: [
    {
      question: "The pose is 20° off. λ rises from 0.001 to 1. What happens to the error of the solver?",
      before: 3,
      at: { pass: 0, offset: 20, robust: 0, weight: -3, px: 0.48, py: 0.72 },
      choices: ["It falls", "It stays", "It grows"],
      right: 2,
      reveal: { sweep: { key: "weight", to: 0 } },
      answer: "It grows, from 2.4° to 17.1°. The larger λ, the more the pixel repeats a prior that is wrong by 23°.",
    },
  ],
  can: "You can describe one pass of the loop, and what a wrong pose does to the normals.",
  controls: [
    {
      kind: "slider",
      key: "offset",
      label: "Error of the initial pose",
      min: -40,
      max: 40,
      step: 1,
      initial: 12,
      unit: "°",
    },
    { kind: "slider", key: "pass", label: "Passes", min: 0, max: 8, step: 1, initial: 0 },
    {
      kind: "slider",
      key: "weight",
      label: "Weight λ of the prior",
      min: -4,
      max: 1.5,
      step: 0.05,
      initial: -3,
      logarithmic: true,
    },
    { kind: "box", key: "robust", label: "Robust prior", initial: 0 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "window" },
    { kind: "slider", key: "px", label: "Pixel, across", min: 0, max: 1, step: 0.01, initial: 0.48 },
    { kind: "slider", key: "py", label: "Pixel, down", min: 0, max: 1, step: 0.01, initial: 0.72 },
  ],
  readouts: [
    { key: "pose", label: "Error of the pose", unit: "°", digits: 1, ink: "pose" },
    { key: "minima", label: "Minima of the pixel", digits: 0, ink: "minimum" },
    { key: "off", label: "Error of the prior", unit: "°", digits: 1, ink: "prior" },
    { key: "end", label: "Error of the solver", unit: "°", digits: 1, ink: "normal" },
  ],
  drags: { picture: { x: "px", y: "py" } },
  more: {
    paper: "Eq. 1 and 9",
    sections: ["normals", "loop"],
  },
};

export const sensor: Lesson = {
  id: "sensor",
  title: "Refining the sensor",
  gist: "The picture shows fine shape that the sensor's noise hides. Once the pose is known, the picture can refine the depth map.",
  formula: () =>
    lines(
      block(
        symbol("mu"),
        norm(row(symbol("z"), mo("−"), symbol("d"))),
        mo("+"),
        colourTerm(() => row(symbol("N"), mo("("), symbol("z"), mo(")"))),
        mo(","),
      ),
      block(symbol("mu"), mo("="), row(sup(symbol("sigmaS"), mn("2")), mo("/"), sup(symbol("sigmad"), mn("2")))),
    ),
  formulaWords:
    "A weight mu times the squared distance between the refined and the measured depth, plus the cost of the colours for the normals of the refined depth. Mu is the variance of the shading over that of the sensor.",
  text: [
    "The figure shows normals of a depth map with noise and holes, as measured and as refined by the picture. Noise spoils the normals most, because differences between neighbouring pixels amplify it.",
    "A depth sensor is right on the large scale and noisy on the small one. Shading is the opposite: it gives slopes from pixel to pixel and drifts over long distances. The two complement each other.",
    "Once the pose is known, the refinement finds a depth {z} that stays near the measured depth {d} and whose normals explain the colours. The weight {mu} is not tuned by hand: it is a ratio of two variances, both measured from the data. {sigmaS} is how far the log colours scatter about the model, and {sigmad} how far the sensor's depths scatter about the surface. Holes are filled where the colour camera sees the surface. The readout counts all holes inside the object, whether the colour camera sees them or not; the background is no hole. Without any noise the normals are still about 4° off: the depth map of this figure is only 64 pixels wide, too coarse for the fine shape of the face. With twice as many pixels 1° is left.",
    "Parts that the picture does not show stay as measured: the side facing away from the camera, and parts in shadow.",
  ],
  tasks: [
    "Raise the noise of the sensor. The measured normals become rough; the refined ones stay smooth.",
    "Cut holes into the depth map, here in 40 % of it. Of these holes 99 % are filled. Small pieces that the holes cut off from the rest, such as the crown, are dropped.",
    "Raise the noise of the picture. Now it is less informative, and the refined depth gets worse.",
  ],
  tries: [
    { set: { picture: 0.005, noise: 0.02, holes: 5 }, sweep: { key: "noise", to: 1 } },
    { set: { noise: 0.4, holes: 40, picture: 0.005 } },
    { set: { noise: 0.4, picture: 0.2, holes: 5 } },
  ],
  guesses: [
    {
      question: "The noise of the sensor grows from 0.4 to 1 px. What happens to the refined normals?",
      before: 1,
      at: { noise: 0.4, holes: 5, picture: 0.005 },
      choices: ["They get as rough as the measured ones", "They hardly change", "They get better"],
      right: 1,
      reveal: { set: { noise: 1 } },
      answer: "They hardly change. Fine shape comes from the picture, and the sensor gives the large forms.",
    },
  ],
  can: "You can say what picture and sensor each contribute to a refined depth map, and where it stays as measured.",
  controls: [
    {
      kind: "slider",
      key: "noise",
      label: "Noise of the sensor",
      min: 0.02,
      max: 1,
      step: 0.02,
      initial: 0.4,
      unit: "px",
    },
    { kind: "slider", key: "holes", label: "Holes", min: 0, max: 40, step: 1, initial: 5, unit: "%" },
    { kind: "slider", key: "picture", label: "Noise of the picture", min: 0, max: 0.2, step: 0.005, initial: 0.005 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "colourful" },
  ],
  readouts: [
    { key: "before", label: "Depth error, measured (rms)", unit: "px", digits: 3, ink: "error" },
    { key: "after", label: "Depth error, refined", unit: "px", digits: 3, ink: "sensor" },
    { key: "normalsBefore", label: "Normals, measured", unit: "°", digits: 1, ink: "error" },
    { key: "normalsAfter", label: "Normals, refined", unit: "°", digits: 1, ink: "sensor" },
    { key: "filled", label: "Holes filled", unit: "%", digits: 0, ink: "sensor" },
  ],
  drags: {},
  more: { paper: "Eq. 17 to 19", sections: ["refinement"] },
};
