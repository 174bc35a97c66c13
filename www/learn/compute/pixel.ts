/** What a pixel shows: normal, albedo and a second-order light determine its colour. */

import { shadeNormals, turnLight } from "../../../pkg/index.js";
import type { Drawing, Ink, Values } from "../protocol";
import { onDisc, pictureOf, plot } from "./draw";
import { ballNormals, predicted } from "../../engine/ball";
import { lightNamed, normalAt, numberOf, scene } from "./scenes";

const BALL = { width: 192, height: 192 };
const normals = ballNormals(BALL.width);
const CHANNELS = [
  ["red", "R"],
  ["green", "G"],
  ["blue", "B"],
] as const satisfies readonly (readonly [Ink, string])[];
/** Places along the section through the ball. */
const SECTION = 49;

export function* pixel(values: Values): Generator<Drawing> {
  const light = turnLight(lightNamed(String(values.light)), {
    alpha: numberOf(values, "alpha"),
    beta: numberOf(values, "beta"),
  });
  const albedo = Math.log(numberOf(values, "albedo"));
  const normal = normalAt(numberOf(values, "nx"), numberOf(values, "ny"));
  const one = Float32Array.from(normal);
  const log = [...shadeNormals(light, one)].map((value) => value + albedo);
  const colour = Float32Array.from(log, (value) => Math.exp(value));
  const ball = predicted(light, normals, albedo);
  // The white level is the same for all positions of the sliders, so that a darker albedo looks darker.
  const white = 1;
  const reach = Math.sqrt(Math.max(0.01, 0.96 - normal[1] ** 2));
  const across = Array.from({ length: SECTION }, (_, i) => reach * ((2 * i) / (SECTION - 1) - 1));
  const section = shadeNormals(light, Float32Array.from(across.flatMap((x) => normalAt(x, normal[1]))));
  const bust = scene({ surface: "bust", light: "colourful", size: 192, angles: { beta: 0 } });
  yield {
    panels: [
      pictureOf(
        {
          key: "ball",
          title: "A ball under this light",
          alt: "A ball, which shows every visible normal once. The ring marks the chosen normal.",
          legend: "drag on the ball to choose a normal",
        },
        BALL,
        ball,
        [{ ink: "normal", shape: "ring", points: onDisc(normal), size: 4 }],
        white,
      ),
      pictureOf(
        {
          key: "patch",
          title: "The predicted colour",
          alt: "The colour of the pixel: {red:2}, {green:2}, {blue:2} in linear red, green and blue.",
          details: { red: colour[0] ?? NaN, green: colour[1] ?? NaN, blue: colour[2] ?? NaN },
        },
        { width: 1, height: 1 },
        colour,
        [],
        white,
      ),
      pictureOf(
        {
          key: "bust",
          title: "A bust under the same light",
          alt: "A bust, rendered with the image model from its true normals.",
          legend: "drag here to turn the light",
        },
        bust.image,
        predicted(light, bust.truth.imageNormals, albedo),
        [],
        white,
      ),
      plot(
        {
          key: "section",
          title: "Across the ball, through that normal",
          alt: "log S of red, green and blue against the horizontal part of the normal.",
        },
        "nx",
        "log S",
        CHANNELS.map(([ink, name], channel) => ({
          name,
          ink,
          points: across.flatMap((x, i) => [x, (section[3 * i + channel] ?? NaN) + albedo]),
        })),
        { at: normal[0], range: [-3, 0.5] },
      ),
    ],
    numbers: {
      red: log[0] ?? NaN,
      green: log[1] ?? NaN,
      blue: log[2] ?? NaN,
      nz: normal[2],
    },
  };
}
