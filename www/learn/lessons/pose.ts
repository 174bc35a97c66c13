/** Lesson 11: the pose between the cameras. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { block, comma, lines, mo, overPixels, row, symbol } from "../maths";

export const pose: Lesson = {
  id: "pose",
  title: "Finding the pose",
  gist: "Under the right pose the normals of the depth map explain the colours. This is how the pose is found.",
  formula: () =>
    lines(
      block(symbol("r"), row(mo("("), symbol("R"), mo(")")), mo("="), overPixels(), comma()),
      block(symbol("n"), mo("="), symbol("R"), symbol("m")),
    ),
  formulaWords:
    "The residual of a rotation is the sum, over all pixels and colours, of the squared difference between the measured log intensity and the one predicted for the depth map's normal after that rotation.",
  text: [
    "The pose says how the depth camera stands to the colour camera: a rotation {R}, a translation and, without known cameras, a scale. A photograph and a depth map look nothing alike, so there are no features to match. The image model of lessons 5 and 6 links them: every normal comes from the depth map, {n} = {R}{m}, its normal {m} rotated by the pose. No normal is free yet, and for a given pose the best light follows by linear least squares (27 unknowns). So the residual {r} depends on the pose alone: it says how far the colours that these normals predict are from the measured ones. Translation and scale count, too: they decide on which pixel a point of the depth map falls.",
    "Under a wrong pose the colours do not fit, and the residual grows. Here the pose is off by {=offset}. The number and the curve give the residual as a mean per pixel, the curve for errors about the vertical axis.",
    "Joint registration moves downhill on this residual until it rests in a minimum; if the light is unknown, light and pose are estimated together. It needs an initial pose within some 20 to 30 degrees, because farther off, downhill can lead away: on the right of this curve the residual falls again from 60° to 100°, since ever fewer points are compared. So the result may turn at most 30° from this given pose and may move the centre of the object by about the object's width; this is its tolerance. If nothing is known, a search comes first: it scores a coarse grid over all rotations and passes the best ones to the registration. The report ends with a status: converged, ambiguous (the data leave the pose open) or lost.",
    "“Register from there” takes the pose on the slider as the initial pose. From 20° it reaches the true pose. From 40° it goes downhill, too: the residual falls from 0.35 there to 0.12 at 10°, where the tolerance ends. But it would fall on to 0.04 at the true pose, so a pose at the edge is no minimum. A registration that ends outside the tolerance is discarded. If none ends within it, the given pose is kept and the status is ambiguous; “no pose within the tolerance fits better” compares such ends, not the poses on the way. The residual then reads 0.29 instead of 0.35, because the run has also refined the depth map (lesson 13).",
  ],
  tasks: [
    "Move the pose away from 0°. Watch the residual rise and the two surfaces separate.",
    "Let it register from 20° away. The pose comes home.",
    "Let it register from 40° away. Here the true pose lies beyond the tolerance, so the given pose is kept and the status is ambiguous.",
    "Let it search from scratch. It needs no initial pose and takes longer, and the error ends below one degree.",
  ],
  tries: [
    { set: { run: "hold", offset: 0 }, sweep: { key: "offset", to: 30 } },
    { set: { offset: 20, run: "register" } },
    { set: { offset: 40, run: "register" } },
    { set: { run: "search" } },
  ],
  guesses: [
    {
      question: "The given pose is 40° off. Registration from there may move it by up to 30°. What will it report?",
      before: 3,
      at: { offset: 40, run: "hold" },
      choices: ["The true pose, converged", "A pose 10° off, converged", "The given pose, ambiguous"],
      right: 2,
      reveal: { set: { run: "register" } },
      answer:
        "The given pose, ambiguous. From 40° the residual falls all the way to the true pose, so there is no minimum within the tolerance of 30°. A pose at its edge is no answer.",
    },
  ],
  can: "You can say what a pose is, how colours and normals fix it, and why a registration needs an initial pose.",
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
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "window" },
  ],
  readouts: [
    { key: "error", label: "Error of the rotation", unit: "°", digits: 2, ink: "pose" },
    { key: "residual", label: "Residual of the colours", digits: 3, ink: "error" },
    { key: "status", label: "Status" },
  ],
  drags: {},
  more: {
    paper: "Eq. 12 to 16",
    sections: ["search", "registration"],
    others: [["10.1109/34.121791", "Besl and McKay, A method for registration of 3-D shapes, 1992"]],
  },
};
