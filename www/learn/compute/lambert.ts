/** Lambert's law on a ball, a vase and a face, with lines of equal intensity. */

import { shadeLamp } from "../../../pkg/index.js";
import type { Drawing, Mark, Values } from "../protocol";
import { plot } from "./draw";
import { degreesOf, intensities, isophotes, lampOf, onBall, shaded, shapeNamed } from "./lamp";
import { isOn, numberOf } from "./scenes";

const SHAPES = [
  ["ball", "A ball"],
  ["vase", "A vase"],
  ["bust", "A face"],
] as const;
const LEVELS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
/** Rays that show the cone of normals. */
const RAYS = 16;
const FRONT = [0, 0, -1];
/** Angles of the curve, degrees. */
const ANGLES = Array.from({ length: 61 }, (_, i) => 3 * i);

/** Intensity at an angle from the lamp. */
const law = (): number[] => {
  const directions = ANGLES.map((angle) => (angle * Math.PI) / 180).flatMap((a) => [Math.sin(a), 0, -Math.cos(a)]);
  const intensity = shadeLamp(FRONT, Float32Array.from(directions));
  return ANGLES.flatMap((angle, i) => [angle, intensity[i] ?? NaN]);
};

/** Rays from the centre of the ball to its chosen isophote. The normals of that intensity lie along them and form a cone. */
function raysTo(lines: Mark[]): Mark {
  const { points } = lines.find(({ ink }) => ink === "intensity") ?? { points: [] };
  const places = Array.from(
    { length: points.length / 2 },
    (_, i) => [points[2 * i] ?? NaN, points[2 * i + 1] ?? NaN] as const,
  );
  const known = places.filter(([x, y]) => Number.isFinite(x + y));
  const [left, top] = [0, 1].map(
    (axis) => known.reduce((sum, place) => sum + (place[axis] ?? 0), 0) / known.length,
  ) as [number, number];
  const around = known.sort(([ax, ay], [bx, by]) => Math.atan2(ay - top, ax - left) - Math.atan2(by - top, bx - left));
  const ends = Array.from({ length: RAYS }, (_, i) => around[Math.floor((i * around.length) / RAYS)] ?? [NaN, NaN]);
  return { ink: "normal", shape: "line", points: ends.flatMap(([x, y]) => [0.5, 0.5, x, y, NaN, NaN]), isFine: true };
}

export function* lambert(values: Values): Generator<Drawing> {
  const lamp = lampOf(values);
  const level = numberOf(values, "level");
  const levels = isOn(values, "lines") ? LEVELS : [];
  const shapes = SHAPES.map(([name, title]) => ({ name, title, shape: shapeNamed(name) }));
  const pictures = shapes.map(({ name, title, shape }) => {
    const intensity = intensities(lamp, shape);
    const lines = isophotes(intensity, shape, levels, level);
    const spot: Mark[] =
      name === "ball" ? [raysTo(lines), { ink: "light", shape: "cross", points: onBall(lamp), size: 3 }] : [];
    const words = {
      key: name,
      title,
      alt: `${title} under one lamp, with lines of equal intensity.`,
      legend: name === "ball" ? "drag: the cross faces the lamp; rays: the cone of normals" : "drag to move the lamp",
    };
    return {
      panel: shaded(words, shape, intensity, [...lines, ...spot]),
      intensity,
    };
  });
  const seen = (pictures[0]?.intensity ?? new Float32Array()).filter(Number.isFinite);
  yield {
    panels: [
      ...pictures.map(({ panel }) => panel),
      plot(
        { key: "law", title: "Lambert's law", alt: "Intensity against the angle between normal and lamp: a cosine." },
        "angle, °",
        "intensity",
        [{ name: "intensity", ink: "intensity", points: law() }],
        { at: degreesOf(level), range: [0, 1], hasAngles: true },
      ),
    ],
    numbers: {
      angle: degreesOf(level),
      lamp: degreesOf(-lamp[2]),
      shadow: (100 * seen.filter((value) => value === 0).length) / seen.length,
    },
  };
}
