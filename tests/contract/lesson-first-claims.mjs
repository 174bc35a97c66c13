// Statements of the first five lessons that their figures must confirm; lesson-claims.mjs says how a claim is written.
import { figure, learn, normalColour } from "./lesson-figures.mjs";
import { sample, shadeLamp, shadeNormals } from "../../pkg/index.js";

const change = (from, to, [more, less]) => (to > from ? more : less);
const claim = (where, words, holds) => ({ where, words, holds });
const numberOf = (state, key) => figure(state)[key];

/** The colour of a direction in the map, as the word for its strongest and weakest parts. */
function colourOf(state) {
  const { red, green, blue } = figure(state);
  if (Math.min(green, blue) > 1.5 * red) return "Turquoise";
  return green > blue ? "Orange" : "Purple";
}

export const normal = [
  claim("normal", "Straight toward the camera the normal is (0, 0, [−1|1])", () => {
    const { nx, ny, nz } = figure("normal&surface=ball&px=0.5&py=0.5");
    return Math.hypot(nx, ny) < 0.02 && nz < -0.99 ? "−1" : "1";
  }),
  claim("normal", "A surface that faces the camera is [light blue|dark blue|grey]", () => {
    const [red, green, blue] = normalColour(0, 0, -1);
    return blue === 255 && Math.round(red) === 128 && Math.round(green) === 128 ? "light blue" : "grey";
  }),
  claim(
    "normal",
    "The cheek on the left of the picture turns toward the camera, and its map becomes [bluer|less blue]",
    () =>
      change(numberOf("normal&px=0.36&py=0.56&turn=-40", "blue"), numberOf("normal&px=0.36&py=0.56&turn=40", "blue"), [
        "bluer",
        "less blue",
      ]),
  ),
  claim("normal", "The arrow [shrinks to a dot|grows] in the middle and is longest at the edge", () => {
    const lengths = [0.16, 0.3, 0.5].map((px) => Math.sin((numberOf(state(px), "tilt") * Math.PI) / 180));
    return lengths[0] > lengths[1] && lengths[1] > lengths[2] && lengths[2] < 0.03 ? "shrinks to a dot" : "grows";
  }),
  claim("normal", "Its [dots|cheeks] move, but", () => {
    const dots = [-60, 60].map((turn) => marksOf({ surface: "ball", px: 0.4, py: 0.4, turn })[0].points.join());
    return dots[0] !== dots[1] ? "dots" : "cheeks";
  }),
  claim("normal", "Its dots move, but its map [stays the same|turns with it]", () => {
    const [left, right] = [-60, 60].map((turn) => figure(`normal&surface=ball&px=0.4&py=0.4&turn=${turn}`));
    return ["red", "green", "blue"].every((key) => left[key] === right[key]) ? "stays the same" : "turns with it";
  }),
  claim("normal", "At the silhouette of a ball the normal is [perpendicular|parallel] to the line of sight", () =>
    numberOf(state(0.02), "tilt") > 80 ? "perpendicular" : "parallel",
  ),
  claim("normal", "in the normal map?\n[Turquoise|Orange|Purple].", () =>
    colourOf("normal&surface=ball&px=0.29&py=0.31"),
  ),
];

/** The marks on the surface of lesson 1. */
const marksOf = (values) => learn.normal(values).next().value.panels[0].marks;

function state(px) {
  return `normal&surface=ball&py=0.5&px=${px}`;
}

const angleAt = (level) => numberOf(`lambert&level=${level}`, "angle");
export const lambert = [
  claim("lambert", "At [#]° half of the intensity is left", () => angleAt(0.5)),
  claim("lambert", "for half of the largest intensity, on the cone of [#]°", () => angleAt(0.5)),
  claim("lambert", "so two lamps leave at most [two|three|four] normals", () => {
    const lamps = [
      [0.6, 0, -0.8],
      [-0.28, 0, -0.96],
    ];
    const counts = [
      [0.9, 0.8],
      [0.7, 0.6],
      [0.5, 0.4],
    ].map((levels) => normalsUnder(lamps, levels));
    return Math.max(...counts) === 2 ? "two" : "four";
  }),
  claim("lambert", "The cosine is [flat|steep] near 0°", () =>
    angleAt(0.9) > 4 * (angleAt(0.05) - angleAt(0.1)) ? "flat" : "steep",
  ),
  claim("lambert", "fallen to one half?\nAt [#]°, because", () => angleAt(0.5)),
  claim("lambert", "At 45° the intensity is still [#].", () => Math.cos(Math.PI / 4)),
  claim("lambert", "Nothing that the camera sees of the ball is in [shadow|light]", () =>
    numberOf("lambert&lx=0&ly=0", "shadow") === 0 ? "shadow" : "light",
  ),
  claim("lambert", "the shadow [grows|shrinks] on the other side", () =>
    change(numberOf("lambert&lx=0&ly=-0.2", "shadow"), numberOf("lambert&lx=0.8&ly=-0.2", "shadow"), [
      "grows",
      "shrinks",
    ]),
  ),
  claim("lambert", "The line [shrinks|grows] toward the bright spots", () =>
    change(angleAt(0.9), angleAt(0.1), ["shrinks", "grows"]),
  ),
];

/** The clusters of directions that two lamps at these places light with these intensities. */
function normalsUnder(lamps, levels) {
  const count = 200_000;
  // A spiral of directions all over the sphere.
  const directions = Float32Array.from({ length: 3 * count }, (_, at) => {
    const [i, axis] = [Math.floor(at / 3), at % 3];
    const [z, turn] = [1 - (2 * (i + 0.5)) / count, i * Math.PI * (3 - Math.sqrt(5))];
    return [Math.sqrt(1 - z * z) * Math.cos(turn), Math.sqrt(1 - z * z) * Math.sin(turn), z][axis];
  });
  const lit = lamps.map((lamp) => shadeLamp(lamp, directions));
  const found = [];
  for (let i = 0; i < count; i++) {
    if (lit.some((values, lamp) => Math.abs(values[i] - levels[lamp]) > 0.01)) continue;
    const one = [...directions.subarray(3 * i, 3 * i + 3)];
    if (!found.some((each) => Math.hypot(...each.map((part, axis) => part - one[axis])) < 0.2)) found.push(one);
  }
  return found.length;
}

const ZERO = 1e-4;
const reliefs = [-1.5, -1, -0.5, 0.2, 0.5, 1.5];
export const relief = [
  claim("relief", "can make [exactly|roughly] the same picture", () =>
    reliefs.every((s) => numberOf(`relief&stretch=${s}&slope=0.3`, "difference") < ZERO) ? "exactly" : "roughly",
  ),
  claim("relief", "a lamp in another place, together with [another|the same] albedo, restores the picture", () =>
    numberOf("relief&stretch=0.5", "paint") > 1.2 ? "another" : "the same",
  ),
  claim("relief", "The two pictures [stay the same|differ], while the cross-section collapses", () =>
    numberOf("relief&stretch=0.2", "difference") < ZERO ? "stay the same" : "differ",
  ),
  claim("relief", "The pictures now [differ|agree]: the lamp has to move", () =>
    numberOf("relief&stretch=0.2&lamp=0", "difference") > 1 ? "differ" : "agree",
  ),
  claim("relief", "The pictures now [differ|agree]: only its own albedo", () =>
    numberOf("relief&stretch=0.2&paint=0", "difference") > 1 ? "differ" : "agree",
  ),
  claim("relief", "The pictures are [the same|different] again, and the albedo is white everywhere", () =>
    numberOf("relief&stretch=-1", "difference") < ZERO ? "the same" : "different",
  ),
  claim("relief", "the albedo is [white|darker] everywhere", () =>
    Math.abs(numberOf("relief&stretch=-1", "paint") - 1) < ZERO ? "white" : "darker",
  ),
  claim("relief", "It needs [no other|another] albedo, only a lamp", () =>
    numberOf("relief&stretch=-1&paint=0", "difference") < ZERO ? "no other" : "another",
  ),
  claim("relief", "two pictures the same?\nOne that [changes from place to place|is the same everywhere]", () => {
    const { paint, difference } = figure("relief&stretch=0.5");
    return paint > 1.2 && difference < ZERO ? "changes from place to place" : "is the same everywhere";
  }),
  claim("relief", "Its brightest value is [#] times its darkest", () => numberOf("relief&stretch=0.5", "paint")),
  claim("relief", "so it moves by [#]°", () => numberOf("relief&stretch=-1", "lamp")),
  claim("relief", "The lamp here is [#]° from the line of sight", () => numberOf("relief&stretch=-1", "lamp") / 2),
  claim("relief", "its matrix keeps every [length|direction]", () =>
    Math.abs(numberOf("relief&stretch=-1", "paint") - 1) < ZERO ? "length" : "direction",
  ),
];

const SPOT = "strips&lx=0.3&ly=-0.3&sx=0.56&sy=0.2";
const CHIN = "strips&lx=0&ly=0&sx=0.47&sy=0.71";
export const strips = [
  claim("strips", "now gives a [wrong|right] surface", () =>
    numberOf(`${SPOT}&dent=1`, "near") > 10 * numberOf(SPOT, "near") ? "wrong" : "right",
  ),
  claim("strips", "the error near the spot [rises|falls]", () =>
    change(numberOf(SPOT, "near"), numberOf(`${SPOT}&dent=1`, "near"), ["rises", "falls"]),
  ),
  claim("strips", "Within the first 10 px the strips [follow|leave] the surface", () =>
    numberOf(CHIN, "near") < 0.5 ? "follow" : "leave",
  ),
  claim("strips", "farther away they [go astray|stay on it]", () =>
    ["far", "plotted"].every((key) => numberOf(CHIN, key) > 10 * numberOf(CHIN, "near")) ? "go astray" : "stay on it",
  ),
  claim("strips", "Its isophote in the reflectance map [always|rarely] runs through the cross", () =>
    [0.25, 0.4, 0.55, 0.75].every((px) => numberOf(`strips&py=0.45&px=${px}`, "off") < 1e-3) ? "always" : "rarely",
  ),
  claim("strips", "explain it?\nA whole [curve|point]", () =>
    numberOf("strips&px=0.4&py=0.45", "curve") > 20 ? "curve" : "point",
  ),
];

/** First coefficients of the three channels, and the first one of the second order within a channel. */
const CHANNELS = [0, 9, 18];
const SECOND = 4;
const NORMAL = [0.3, -0.4, -Math.sqrt(0.75)];

export const orders = [
  claim(
    "orders",
    "nine coefficients for each colour, [#] in all",
    () => sample({ surface: "bust", light: "window", size: 16 }).light.length,
  ),
  claim("orders", "Second-order terms have the [same value|opposite value] for opposite normals", () => {
    const { light } = sample({ surface: "bust", light: "colourful", size: 16 });
    const second = light.map((value, at) =>
      CHANNELS.some((from) => at >= from + SECOND && at < from + 9) ? value : 0,
    );
    const [here, there] = [1, -1].map((sign) =>
      shadeNormals(
        second,
        Float32Array.from(NORMAL, (part) => sign * part),
      ),
    );
    return here.every((value, at) => Math.abs(value - there[at]) < 1e-6) ? "same value" : "opposite value";
  }),
  claim("orders", "their sum [stays the same|changes]", () =>
    [-0.6, 0.6].every((constant) => numberOf(`orders&constant=${constant}`, "change") < 1e-6)
      ? "stays the same"
      : "changes",
  ),
  claim("orders", "[Two balls change|One ball changes], and their sum", () => {
    const [none, much] = [0, 0.6].map((constant) => figure(`orders&constant=${constant}`));
    const changed = ["order0", "order1", "order2"].filter((key) => Math.abs(none[key] - much[key]) > 0.1);
    return changed.length === 2 ? "Two balls change" : "One ball changes";
  }),
  claim("orders", "The curve for the intensity falls [below|above] zero in the shadow", () =>
    numberOf("orders&around=0.02", "least") < 0 ? "below" : "above",
  ),
  claim("orders", "the curve for the logarithm stays [above|below] it", () =>
    numberOf("orders&around=0.02", "leastLog") > 0 ? "above" : "below",
  ),
  claim("orders", "The error of the nine numbers for the logarithm [falls|rises]", () =>
    change(numberOf("orders&around=0.02", "byLog"), numberOf("orders&around=0.5", "byLog"), ["rises", "falls"]),
  ),
  claim("orders", "under a single lamp in the dark its error is [larger|smaller]", () =>
    change(numberOf("orders&around=0.02", "direct"), numberOf("orders&around=0.02", "byLog"), ["larger", "smaller"]),
  ),
  claim("orders", "restores every intensity?\n[It is added to the three squares|No change can]", () =>
    ["order0", "order2"].every(
      (key) => Math.abs(numberOf("orders&constant=0.6", key) - numberOf("orders", key)) > 0.1,
    ) && numberOf("orders&constant=0.6", "change") < 1e-6
      ? "It is added to the three squares"
      : "No change can",
  ),
  claim("orders", "Its part of degree 3 is [zero|large]", () =>
    numberOf("orders", "degree3") < 1e-4 ? "zero" : "large",
  ),
  claim("orders", "a large part of degree 1 and a [smaller|larger] one of degree 2", () =>
    change(numberOf("orders", "degree1"), numberOf("orders", "degree2"), ["larger", "smaller"]),
  ),
  claim("orders", "all higher ones together are [small|large]", () =>
    numberOf("orders", "byDegree") / 100 < 0.3 * numberOf("orders", "degree2") ? "small" : "large",
  ),
  claim("orders", "The curve of degree 3 stays at [zero|one]", () =>
    numberOf("orders", "degree3") < 1e-4 ? "zero" : "one",
  ),
  claim("orders", "the one of this figure leaves [#] %", () => numberOf("orders", "direct")),
  claim("orders", "together come within [#] % of the cosine", () => numberOf("orders", "byDegree")),
];
