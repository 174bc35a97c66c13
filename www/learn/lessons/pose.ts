/** Lessons 11 and 12: the pose between the cameras, and the refinement of the sensor's depth. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, colourTerm, lines, mi, mo, norm, row, squared, sub, symbol } from "../maths";

export const pose: Lesson = {
  id: "pose",
  title: "Finding the pose",
  gist: "Under the right pose the normals of the depth map explain the colours. This is how the pose is found.",
  formula: () =>
    block(colourTerm(), mo("+"), symbol("lambda"), norm(row(symbol("n"), mo("−"), symbol("R"), symbol("m")))),
  formulaWords:
    "The cost of the colours plus lambda times the squared distance between the normal and the depth map's normal rotated by the pose.",
  text: [
    "A photograph and a depth map look nothing alike, so there are no features to match. The image model links them. In a first step every normal comes from the depth map: {n} = {R}{m}, its normal {m} rotated by the pose's rotation {R}. The residual is the first term of the formula over all pixels, so it depends on the pose alone. Translation and scale count, too: they decide on which pixel a point of the depth map falls. Under a wrong pose the colours do not fit, and the residual grows. Here the pose is off by {=offset}. The curve shows the residual for errors about the vertical axis.",
    "Joint registration minimises this residual; if the light is unknown, light and pose are estimated together. A pose also has a translation and, without known cameras, a scale; both are found with the rotation. It needs an initial pose within some 20 to 30 degrees. If nothing is known, a search comes first: it scores a coarse grid over all rotations and passes the best ones to the registration.",
    "“Register from there” gives the registration an initial pose. The result may turn at most 30° from this given pose and may move the centre of the object by about the object's width; this is its tolerance. The registration moves downhill on the residual until it rests in a minimum. If it finds no minimum within the tolerance, the given pose is kept and the status is ambiguous: a pose at the edge of the tolerance is no answer.",
    "In a second step the normal {n} of each pixel is free again, and the second term keeps it near {R}{m}. The last map shows the cost of one pixel over all normals, with the prior that the depth map gives under the present pose. The ring marks the prior, the dots mark the minima, and the line shows the solver's steps from the prior. A small {lambda} leaves several minima. With a larger one they merge into one near the prior. If the pose is right, the prior is near the true normal, and so is that minimum. If the pose is wrong, the minimum moves away from the true normal. The robust prior is a compromise: a prior that is far off is ignored.",
  ],
  tasks: [
    "Move the pose away from 0°. Watch the residual rise and the two surfaces separate.",
    "Set the pose 20° off. Raise λ until the minima of the pixel have merged. The solver then ends far from the true normal: 17.1° off at λ = 1.",
    "Let it register from 20° away. The pose comes home.",
    "Let it register from 40° away. Here the true pose lies beyond the tolerance, so the given pose is kept and the status is ambiguous.",
    "Let it search from scratch. It needs no initial pose and takes longer, and the error ends below one degree.",
  ],
  tries: [
    { set: { run: "hold", offset: 0 }, sweep: { key: "offset", to: 30 } },
    { set: { run: "hold", offset: 20, robust: 0, weight: -3 }, sweep: { key: "weight", to: 0 } },
    { set: { offset: 20, run: "register" } },
    { set: { offset: 40, run: "register" } },
    { set: { run: "search" } },
  ],
  guesses: [
    {
      question: "The given pose is 40° off. Registration from there may move it by up to 30°. What will it report?",
      at: { offset: 40, run: "hold" },
      choices: ["The true pose, converged", "A pose 10° off, converged", "The given pose, ambiguous"],
      right: 2,
      reveal: { set: { run: "register" } },
      answer:
        "The given pose, ambiguous. From 40° the residual falls all the way to the true pose, so there is no minimum within the tolerance of 30°. A pose at its edge is no answer.",
    },
  ],
  can: "You can describe how colours and normals fix a pose, and what a wrong pose does to the estimate.",
  controls: [
    {
      kind: "slider",
      key: "offset",
      label: "Error of the pose",
      min: -40,
      max: 40,
      step: 1,
      initial: 12,
      unit: "°",
      when: ({ run }) => run !== "search",
    },
    {
      kind: "choice",
      key: "run",
      label: "Action",
      choices: [
        ["hold", "hold it there"],
        ["register", "register from there"],
        ["search", "search from scratch"],
      ],
      initial: "hold",
    },
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
    { key: "error", label: "Error of the rotation", unit: "°", digits: 2, ink: "pose" },
    { key: "residual", label: "Residual of the colours", digits: 3, ink: "error" },
    { key: "minima", label: "Minima of the pixel", digits: 0, ink: "minimum" },
    { key: "off", label: "Error of the prior", unit: "°", digits: 1, ink: "prior" },
    { key: "end", label: "Error of the solver", unit: "°", digits: 1, ink: "normal" },
    { key: "status", label: "Status" },
  ],
  drags: { picture: { x: "px", y: "py" } },
  more: {
    paper: "Eq. 1, 9 and 12 to 16",
    sections: ["normals", "search", "registration", "loop"],
    others: [["10.1109/34.121791", "Besl and McKay, A method for registration of 3-D shapes, 1992"]],
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
      block(symbol("mu"), mo("="), squared(sub(symbol("sigma"), mi("S")), mo("/"), sub(symbol("sigma"), symbol("d")))),
    ),
  formulaWords:
    "A weight mu times the squared distance between the refined and the measured depth, plus the cost of the colours for the normals of the refined depth. Mu is the variance of the shading over that of the sensor.",
  text: [
    "A depth sensor is right on the large scale and noisy on the small one. Shading is the opposite: it gives slopes from pixel to pixel and drifts over long distances. The two complement each other.",
    "Once the pose is known, the refinement finds a depth {z} that stays near the measured depth {d} and whose normals explain the colours. The weight {mu} is not tuned by hand: it is a ratio of two variances {sigma}², both measured from the data. Index S stands for the scatter of the colours about the model, index d for the noise of the depth. Holes are filled where the colour camera sees the surface. Noise spoils the normals most, because differences between neighbouring pixels amplify it. Without any noise the normals are still about 4° off: the depth map of this figure is only 64 pixels wide, too coarse for the fine shape of the face. With twice as many pixels 1° is left.",
    "Parts that the picture does not show stay as measured: the side facing away from the camera, and parts in shadow.",
  ],
  tasks: [
    "Raise the noise of the sensor. The measured normals become rough; the refined ones stay smooth.",
    "Cut holes into the depth map, here in 40 % of it. Of these holes 99 % are filled.",
    "Raise the noise of the picture. Now it is less informative, and the refined depth gets worse.",
  ],
  tries: [
    { set: { picture: 0.005, noise: 0.02 }, sweep: { key: "noise", to: 1 } },
    { set: { noise: 0.4, holes: 40 } },
    { set: { noise: 0.4, picture: 0.2 } },
  ],
  guesses: [
    {
      question: "The noise of the sensor grows from 0.4 to 1 px. What happens to the refined normals?",
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
