/** What a normal is: a surface that can be turned, the normal under the pointer as an arrow, and the colours of a normal map. */

import { shadeLamp } from "../../../pkg/index.js";
import { normalColour } from "../../draw/colours";
import type { Drawing, Mark, Values } from "../protocol";
import { atPixel, normalsOf } from "./draw";
import { SIDE, ball, degreesOf, onBall, shaded, shapeNamed, type Shape } from "./lamp";
import { numberOf, pixelAt, scene, vectorAt } from "./scenes";

/** Above the left shoulder of the camera, so that all visible forms are lit. */
const LAMP = [-0.4, -0.45, -0.8];
/** Length of an arrow that is seen from the side, as a share of the picture. */
const ARROW = 0.22;
/** The ball leaves room for the arrow on its edge, which is as much shorter. */
const BALL = { radius: 0.7, arrow: 0.15 };
/** Longitudes of the dots on the ball's equator, which show how it turns, degrees. */
const DOTS = [-150, -120, -70, -10, 20, 80, 140];
const HEAD = 0.05;

/** A surface that is turned about its upright axis: the view of the depth camera. */
function turnedShape(name: string, beta: number): Shape {
  const { depth, truth } = scene({ surface: name, light: "overcast", size: SIDE, angles: { beta } });
  const normals = truth.depthNormals;
  const mask = Uint8Array.from({ length: SIDE * SIDE }, (_, index) => (Number.isFinite(normals[3 * index]) ? 1 : 0));
  return { width: depth.width, height: depth.height, normals, depth: truth.depth, mask };
}

/** A normal that starts at a place, foreshortened as the camera sees it. */
function arrow([x, y]: [number, number], [nx, ny]: readonly [number, number, number], reach: number): Mark[] {
  const [tipX, tipY] = [x + reach * nx, y + reach * ny];
  const length = Math.hypot(nx, ny);
  const head = (side: 1 | -1): [number, number] => {
    const bearing = Math.atan2(ny, nx) + side * 2.6;
    return [tipX + HEAD * length * Math.cos(bearing), tipY + HEAD * length * Math.sin(bearing)];
  };
  return [
    { ink: "normal", shape: "line", points: [x, y, tipX, tipY, NaN, NaN, ...head(1), tipX, tipY, ...head(-1)] },
    { ink: "normal", shape: "dot", points: [x, y], size: 1.4 },
  ];
}

/** The dots of the ball's front after a turn. */
function dotsOf(turn: number): Mark[] {
  const bearings = DOTS.map((longitude) => ((longitude + turn) * Math.PI) / 180).filter((each) => Math.cos(each) > 0.1);
  const points = bearings.flatMap((bearing) => [(1 + BALL.radius * Math.sin(bearing)) / 2, 0.5]);
  return [{ ink: "truth", shape: "dot", points, size: 1.6 }];
}

export function* normal(values: Values): Generator<Drawing> {
  const name = String(values.surface);
  const [isBall, turn] = [name === "ball", numberOf(values, "turn")];
  const shape = isBall ? ball(SIDE, BALL.radius) : turnedShape(name, turn);
  const chosen = pixelAt(shape.mask, shape.width, shape.height, numberOf(values, "px"), numberOf(values, "py"));
  const one = vectorAt(shape.normals, chosen);
  const colour = normalColour(...one).map(Math.round) as [number, number, number];
  const place = atPixel(chosen, shape);
  const ring = (points: [number, number]): Mark => ({ ink: "normal", shape: "ring", points, size: 3 });
  const key = shapeNamed("ball");
  yield {
    panels: [
      shaded(
        {
          key: "surface",
          title: "The surface and one normal",
          alt: "A shaded surface. An arrow stands on it at the chosen point, perpendicular to the surface.",
          legend: "point at the surface",
        },
        shape,
        shadeLamp(LAMP, shape.normals),
        [...(isBall ? dotsOf(turn) : []), ...arrow(place, one, isBall ? BALL.arrow : ARROW)],
      ),
      normalsOf(
        { key: "map", title: "Its normal map", alt: "The same surface, each pixel in the colour of its normal." },
        shape,
        shape.normals,
        [ring(place)],
      ),
      normalsOf(
        {
          key: "key",
          title: "All directions on a ball",
          alt: "A ball in the colours of its normals. A ring marks the direction of the chosen normal.",
          legend: "the same direction has the same colour",
        },
        key,
        key.normals,
        [ring(onBall(one))],
      ),
    ],
    numbers: {
      nx: one[0],
      ny: one[1],
      nz: one[2],
      length: Math.hypot(...one),
      tilt: degreesOf(-one[2]),
      red: colour[0],
      green: colour[1],
      blue: colour[2],
    },
  };
}
