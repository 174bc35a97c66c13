/** Lessons 13 and 14: what the image model ignores, and when the method fails. */

import type { Lesson } from "../lesson";
import { LIGHTS } from "../lesson";
import { phrase } from "../../words";
import { decimals, withUnit } from "../digits";
import { LARGEST_TURN, LEAST_OVERLAP } from "../protocol";
import { block, frac, log, mi, mn, mo, row, shading, sup, symbol } from "../maths";

export const paint: Lesson = {
  id: "paint",
  title: "Shadows and paint",
  gist: "The image model ignores shadows and assumes one albedo. The ratio of the three colours separates paint from shading.",
  formula: () => block(log(symbol("S")), mo("="), symbol("aj"), mo("+"), shading(), mo("+"), symbol("ej")),
  formulaWords: "The log intensity of colour j is its log albedo plus its shading plus a remainder.",
  text: [
    "Print is not shape. A model with a single albedo would interpret every painted edge as a fold. So once the pose has converged, the program tests whether a few different albedos explain the picture better: each pixel has the shading of its measured normal plus one of a few offsets {aj}, one number for each colour. Another albedo is kept only if it explains the picture better than its additional numbers would by chance.",
    "Chromaticity, the ratio of red, green and blue whatever the brightness, decides: coloured paint changes red, green and blue by different amounts, while shading under whitish light changes them almost equally. Grey paint is harder to separate, and any paint is harder to separate under light of many colours.",
    "A cast shadow violates the model, because the light there is different. But a shadow that darkens red, green and blue by the same factor has the same effect on a pixel as dark paint, so the program takes nearly all of it for albedo. The remainder {ej} is largest where the shadow meets the silhouette of the object, and robust weights reduce the influence of the pixels there. Along the edge of the shadow on the face it is small. The estimated albedo then follows the shadow as well as the paint, and the status does not warn of it.",
  ],
  tasks: [
    "Raise the strength of the paint. It appears in the albedo and disappears from the shading.",
    "Remove the paint and deepen the shadow. Nearly all of it appears in the albedo. The remainder is bright only where the shadow meets the silhouette.",
    "Deepen the shadow with the paint at 0.8. The correlation of albedo and paint falls, but the status is still converged.",
    "Choose the coloured lamps. Chromaticity is now less informative: the correlation of albedo and paint falls from 0.896 to 0.857.",
  ],
  tries: [
    { set: { light: "window", shadow: 0, paint: 1 } },
    { set: { light: "window", paint: 0, shadow: 0.9 } },
    { set: { light: "window", paint: 0.8, shadow: 0.9 } },
    { set: { light: "colourful", paint: 0.8, shadow: 0 } },
  ],
  guesses: [
    {
      question: "A deep shadow falls on a surface without paint. What does the program mistake it for?",
      before: 2,
      at: { light: "window", paint: 0, shadow: 0 },
      choices: ["Shading, so the normals bend", "Dark paint", "A remainder that nothing explains"],
      right: 1,
      reveal: { set: { shadow: 0.9 } },
      answer: "Dark paint. A shadow that darkens all colours alike has the effect of a smaller albedo.",
    },
  ],
  can: "You can say how paint is separated from shading, and why a shadow is not.",
  controls: [
    { kind: "slider", key: "paint", label: "Strength of the paint", min: 0, max: 1, step: 0.05, initial: 0.8 },
    { kind: "slider", key: "shadow", label: "Depth of the shadow", min: 0, max: 0.95, step: 0.05, initial: 0 },
    { kind: "choice", key: "light", label: "Light", choices: LIGHTS, initial: "window" },
  ],
  readouts: [
    { key: "likeness", label: "Correlation of estimated albedo and paint", digits: 3, ink: "albedo" },
    { key: "degrees", label: "Mean error of the normals", unit: "°", digits: 1, ink: "normal" },
    { key: "taken", label: "Share of the shadow in the albedo", unit: "%", digits: 0, ink: "albedo" },
    { key: "lit", label: "Remainder in the light", digits: 3, ink: "error" },
    { key: "shaded", label: "Remainder in the shadow", digits: 3, ink: "error" },
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

const percent = (value: number): string => withUnit(decimals(value, 0), "%");
/** The meaning of the slider in each case, as the figure computes with it. */
const AMOUNTS: Readonly<Record<string, { label: string; reads(value: number): string }>> = {
  symmetry: { label: "Part of the nose removed", reads: percent },
  overlap: { label: "Part of the depth map cut away", reads: (value) => percent((1 - LEAST_OVERLAP) * value) },
  texture: { label: "Strength of the print", reads: percent },
  turn: {
    label: "Rotation between the views",
    reads: (value) => withUnit(decimals((LARGEST_TURN * value) / 100, 1), "°"),
  },
};

export const failure: Lesson = {
  id: "failure",
  title: "When it fails",
  gist: "Some scenes do not contain the answer. A good program says so; this one usually does.",
  formula: () =>
    block(
      sup(symbol("sigmaR"), mn("2")),
      mo("≈"),
      frac(sup(symbol("sigma"), mn("2")), row(mi(phrase("information", "information")), mo("("), symbol("R"), mo(")"))),
    ),
  formulaWords:
    "The variance of the rotation is about the variance of the noise divided by the information that the scene contains about the rotation.",
  text: [
    "Here nothing is given: light and pose are both unknown, and the search starts from scratch. The report at the end contains more than a pose: a status, a reason, alternative poses that fit the image equally well, and a sigma of the rotation, the size of error to expect. In the formula, {sigmaR} is this sigma, {sigma} the noise of the picture, and the information says how fast the residual rises when the rotation changes: the curvature of the sum of squares at its minimum. “Ambiguous” and “lost” do not mean that the pose is wrong. They mean that the data do not show that it is right.",
    "Symmetry: a round object looks the same when it is rotated about its axis. No method can detect that rotation; only a less symmetric object helps. Little overlap: if the depth map covers only a narrow strip, a few normals have to explain everything; a wider one helps. Texture: fine print that changes from pixel to pixel hides the shading; less print helps. A large turn: the cameras share less and less of the object, and they see the shared part at a grazing angle; a smaller turn helps.",
    "Compare the true error, which is known here because the scene is synthetic, with the reported sigma and status. Errors of two or three sigmas are rare but possible. Sigma counts the noise, not what the model leaves out: a shadow that passes for albedo (lesson 14) can shift the result and stay unnoticed. Once the status is lost, sigma is only a lower bound: expect the error to be larger, even much larger. A good method is allowed to fail. It should not be confident when it does.",
    "The reported sigma is that of the rotation about its least certain axis; the degrees quoted in a status are also one sigma. Above 1.5° the status is ambiguous, because two sigmas then exceed the 3° within which a pose counts as found. Above 5° it is lost: for poses that were found, sigma stayed below 3° in tests with random scenes. Above 25° the rotation counts as not observable: an angle that can be anything within a quarter turn has a sigma of 26°. Converged means that sigma is below 1.5°, no other pose fits as well, and the colours are explained. A status can have other reasons. It is ambiguous if other poses fit the image equally well, against which an initial pose helps, or if an initial pose was kept (lesson 11). It is lost if too much of the colours remains unexplained.",
  ],
  tasks: [
    "Remove the nose of the disc. At 100 % the rotation cannot be determined, and the report names the axis.",
    "Cut away as much of the depth map as possible. Without 95 % of its width no pose fits, and the status is lost. Without 90 % the status is converged, with a sigma of 0.53° instead of the 0.12° of the whole map.",
    "Print texture on the object. Now, with the print at 100 %, more of the colour stays unexplained than with none, and the rotation is so uncertain that the status is lost. The report names the axis.",
    "Increase the rotation between the views. Here at 90° and with a narrow depth map, little remains to compare.",
  ],
  tries: [
    { set: { case: "symmetry", amount: 100 } },
    { set: { case: "overlap", amount: 100 } },
    { set: { case: "texture", amount: 100 } },
    { set: { case: "turn", amount: 100 } },
  ],
  guesses: [
    {
      question:
        "In the case “symmetry”, a disc of rings has a nose, which shows how it is rotated. It loses the nose. What will the report say about its pose?",
      before: 1,
      at: { case: "symmetry", amount: 0 },
      choices: ["Converged, with a small sigma", "Lost, and which rotation cannot be seen", "A wrong pose, converged"],
      right: 1,
      reveal: { set: { amount: 100 } },
      answer:
        "Lost, and which rotation cannot be seen: that about z. The residual is small, so it would not have warned.",
    },
  ],
  can: "You can judge from status, sigma and alternative poses whether a result can be trusted.",
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
    {
      kind: "slider",
      key: "amount",
      label: ({ case: what }) => AMOUNTS[String(what)]?.label ?? "Amount",
      reads: (value, { case: what }) => AMOUNTS[String(what)]?.reads(value) ?? percent(value),
      min: 0,
      max: 100,
      step: 5,
      initial: 0,
    },
  ],
  readouts: [
    { key: "status", label: "Status" },
    { key: "error", label: "True error of the rotation", unit: "°", digits: 2, ink: "error" },
    { key: "sigma", label: "Reported sigma", unit: "°", digits: 2, ink: "pose" },
    { key: "rivals", label: "Alternative poses", digits: 0, ink: "pose" },
    { key: "residual", label: "Residual of the colours", digits: 3, ink: "error" },
  ],
  drags: {},
  more: { sections: ["loop", "uncertainty"] },
};
