// The three verdicts of the calibration check on three candidates for one rendered frame, with the reason that the check gives.
import { chance, wrong } from "../rigs/draws.mjs";
import { Failure } from "../shell.mjs";
import { lookUp } from "../thresholds.mjs";
import { picture } from "./raster.mjs";
import { BLUE, GREEN, INK, ORANGE, SOFT, dots, figure, line, over, placed, text } from "./svg.mjs";

const RIG = { kind: "objects", seed: 5 };
/** The part of the frame that is shown, as shares of the frame's width and height. */
const PART = { left: 0.22, top: 0.38, width: 0.56, height: 0.62 };
/** The candidates: the error of each (degrees about the camera, and millimetres), the expected verdict, and the verdict's colour. */
const CANDIDATES = [
  { degrees: 0, millimetres: 0, verdict: "consistent", colour: GREEN },
  { degrees: 1, millimetres: 10, verdict: "off", colour: ORANGE },
  { degrees: 0.3, millimetres: 3, verdict: "undecided", colour: BLUE },
];
/** Largest number of characters in a line beside a picture. */
const LETTERS = 42;
/** The scale of the intervals: the largest error on it in image pixels, and its left end and width in the figure. */
const SCALE = { most: 18, left: 372, width: 300 };
const STEP = 6;
const PINK = "#d1006c";
const TALL = 186;
const APART = TALL + 22;

/** Text broken into lines of at most `LETTERS` characters. */
const wrapped = (words) =>
  words.split(" ").reduce(
    (lines, word) => {
      const longer = `${lines.at(-1)} ${word}`.trim();
      return longer.length <= LETTERS ? [...lines.slice(0, -1), longer] : [...lines, word];
    },
    [""],
  );

/** Draws the expected error with its interval, and the range of errors that pass. */
function scale(y, { pixels, interval }, passing, colour) {
  const at = (value) => SCALE.left + (SCALE.width * value) / SCALE.most;
  const ticks = Array.from({ length: SCALE.most / STEP + 1 }, (_, index) => STEP * index);
  return [
    `<rect x="${SCALE.left}" y="${y - 9}" width="${at(passing) - SCALE.left}" height="18" fill="#dafbe1"/>`,
    line(SCALE.left, y + 9, SCALE.left + SCALE.width, y + 9, { colour: SOFT }),
    line(at(interval[0]), y, at(interval[1]), y, { colour, width: 4 }),
    `<circle cx="${at(pixels).toFixed(1)}" cy="${y}" r="5" fill="${colour}"/>`,
    ...ticks.map((value) =>
      text(at(value), y + 24, `${value}${value > 0 ? "" : " px"}`, { size: 12, anchor: "middle", colour: SOFT }),
    ),
  ];
}

/** The part of a frame as a picture. Dark colours are brightened, so that edges are visible on them. */
function part(image) {
  const { width, height, data } = image;
  const box = {
    left: Math.round(PART.left * width),
    top: Math.round(PART.top * height),
    width: Math.round(PART.width * width),
    height: Math.round(PART.height * height),
  };
  const pale = (value) => 90 + (165 * value) / 255;
  return picture({ width }, box, (index) => [0, 1, 2].map((channel) => pale(data[4 * index + channel])));
}

const isInside =
  ({ left, top, width, height }) =>
  ([x, y]) =>
    x > left && y > top && x < left + width && y < top + height;

const pairs = (values) => Array.from({ length: values.length / 2 }, (_, at) => [values[2 * at], values[2 * at + 1]]);

/** The row of one candidate: the picture with its edges, its verdict and its interval. */
function row({ colour, degrees, millimetres, verdict }, { found, edges, box, wide, passing }, y) {
  if (found.verdict !== verdict) throw new Failure(`The check says "${found.verdict}" where "${verdict}" is expected.`);
  // The centre of a pixel is half a pixel from its corner.
  const inside = pairs(edges)
    .map(([column, row]) => [column + 0.5, row + 0.5])
    .filter(isInside(box));
  const turned = `turned by ${degrees} ${degrees === 1 ? "degree" : "degrees"}, shifted by ${millimetres} mm`;
  const left = SCALE.left - 14;
  return [
    `<use href="#frame" y="${y}"/>`,
    over(box, 20, y, wide, [dots(inside, PINK, 2.2)]),
    text(left, y + 16, verdict, { size: 17, bold: true, colour }),
    text(left, y + 36, degrees > 0 ? turned : "the true calibration", { colour: SOFT }),
    text(left, y + 60, wrapped(found.reason), { colour: INK }),
    ...scale(y + 154, found, passing, colour),
  ];
}

export async function verdicts(api) {
  const frame = await api.sampleRig(RIG);
  const poses = CANDIDATES.map((error) => wrong(frame.pose, error, chance(RIG.seed).direction));
  const named = Object.fromEntries(CANDIDATES.map(({ verdict }, at) => [verdict, poses[at]]));
  const { candidates } = await api.checkCalibration([frame], named);
  const passing = (Number(lookUp("TOLERANCE", "src/calibration/verdict.rs").value) * frame.image.width) / 640;
  const shown = part(frame.image);
  const wide = (TALL * shown.box.width) / shown.box.height;
  // The file contains the picture only once; each row refers to it.
  const parts = [`<defs><g id="frame">${placed(shown, 20, 0, wide)}</g></defs>`];
  for (const [at, candidate] of CANDIDATES.entries()) {
    const { edges } = await api.projectFrame(frame, poses[at]);
    const answer = { found: candidates[candidate.verdict], edges, box: shown.box, wide, passing };
    parts.push(...row(candidate, answer, 20 + APART * at));
  }
  const bottom = 32 + APART * CANDIDATES.length;
  parts.push(
    text(20, bottom, [
      "Pink: depth discontinuities, laid on the image by the candidate. Dot and bar: its error and the 95 %",
      `interval, pixels. Green: errors that pass, up to ${passing.toFixed(1)} pixels.`,
    ]),
  );
  return figure(
    700,
    bottom + 32,
    "Depth edges laid on a rendered image by three calibrations, with the verdicts consistent, off and undecided",
    parts,
  );
}
