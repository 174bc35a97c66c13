// Statements of the lessons and exercises that their figures must confirm.
//
// In the words of a claim, [rises|falls] lists the words that the text might use, and [#] stands for a number. `holds` computes from the
// figure which word or number is right.
import { normalDegrees } from "../../protocols/measure-shapes.mjs";
import { figure, labRun, learn } from "./lesson-figures.mjs";
import { lambert, normal, orders, relief, strips } from "./lesson-first-claims.mjs";
import { colours, grey, pixel } from "./lesson-light-claims.mjs";
import { Estimator, init, sample } from "./support.mjs";

await init();

/** The word for a change from one number to another. */
const change = (from, to, [more, less]) => (to > from ? more : less);
const claim = (where, words, holds) => ({ where, words, holds });
const numberOf = (state, key) => figure(state)[key];
const statusOf = (state) => figure(state).status;

/** The words of a status, without its reason. */
const wordOf = (state) => statusOf(state).split(":")[0];

const surface = [
  claim("surface", "slopes are [blind|sensitive] to a step", () =>
    Math.abs(numberOf("surface&step=8&through=1", "jump")) < 0.1 ? "blind" : "sensitive",
  ),
  claim("surface", "the normals of both are [unaffected|changed] by it", () =>
    Math.abs(numberOf("surface&step=8&through=1", "jump") - numberOf("surface&step=4&through=1", "jump")) < 0.1
      ? "unaffected"
      : "changed",
  ),
  claim("surface", "The estimated height [falls short of|exceeds] the true one by more than half", () => {
    const shares = [3, 6, 12].map((step) => numberOf(`surface&step=${step}&robust=0`, "jump") / step);
    return shares.every((share) => share < 0.5) ? "falls short of" : "exceeds";
  }),
  claim("surface", "at a step of 6 px. There the error of the depth [falls|rises]", () =>
    change(numberOf("surface&step=6&robust=0", "error"), numberOf("surface&step=6", "error"), ["rises", "falls"]),
  ),
  claim("surface", "robust or not, its height is [wrong|right]", () =>
    [0, 1].every((robust) => numberOf(`surface&through=1&robust=${robust}`, "jump") < 1) ? "wrong" : "right",
  ),
  claim("surface", "the dome has [more|less] than 100 % of its true relief", () =>
    change(100.5, numberOf("surface&step=0&noise=0.1", "kept"), ["more", "less"]),
  ),
  claim("surface", "the dome comes out too [high|low]", () =>
    change(100.5, numberOf("surface&step=0&noise=0.2", "kept"), ["high", "low"]),
  ),
];

const prior = [
  claim("prior", "The surface [improves|gets worse] with the share", () => {
    const errors = [0, 20, 50, 100].map((share) => numberOf(`prior&share=${share}`, "degrees"));
    return errors.every((error, at) => at === 0 || error < errors[at - 1]) ? "improves" : "gets worse";
  }),
  claim("prior", "at first [more|less] than proportionally", () => {
    const [none, some, all] = [0, 20, 100].map((share) => numberOf(`prior&share=${share}`, "degrees"));
    return change(0.2 * (none - all), none - some, ["more", "less"]);
  }),
  claim("prior", "Pixels without a prior [gain|lose], too", () =>
    change(numberOf("prior&share=0", "others"), numberOf("prior&share=20", "others"), ["lose", "gain"]),
  ),
  claim("prior", "the prior is [hardly|always] needed", () => {
    const [none, all] = [0, 100].map((share) => numberOf(`prior&share=${share}&light=colourful`, "degrees"));
    return none - all < 0.1 * none ? "hardly" : "always";
  }),
  claim("prior", "The error is about [as large as|half of that] without a prior", () =>
    Math.abs(numberOf("prior&share=20&weight=-4", "degrees") / numberOf("prior&share=0", "degrees") - 1) < 0.1
      ? "as large as"
      : "half of that",
  ),
  claim("prior", "with a very large one the result [copies|contradicts] the depth map", () =>
    numberOf("prior&share=100&weight=1", "degrees") < 0.2 ? "copies" : "contradicts",
  ),
];

const SEARCH = ["pose&run=search", "error"];
/** The residual beyond the range of the slider. */
const residualAt = (offset) => learn.pose({ run: "hold", light: "window", offset }).next().value.numbers.residual;
const HOME = ["pose&offset=20&run=register", "error"];
const pose = [
  claim("pose", "Move the pose away from 0°. Watch the residual [rise|fall]", () => {
    const away = [-30, -14, 0, 14, 30].map((offset) => numberOf(`pose&offset=${offset}`, "residual"));
    const isValley = away[0] > away[1] && away[1] > away[2] && away[2] < away[3] && away[3] < away[4];
    return isValley ? "rise" : "fall";
  }),
  claim("pose", "the tolerance, so the given pose is [kept|left] and the status is ambiguous.", () =>
    Math.abs(numberOf("pose&offset=40&run=register", "error") - 40) < 0.01 ? "kept" : "left",
  ),
  claim("pose", "so the given pose is kept and the status is [ambiguous|converged|lost].", () =>
    wordOf("pose&offset=40&run=register"),
  ),
  claim("pose", "Here the true pose lies [beyond|within] the tolerance", () => {
    const isNear = [20, -20].every((offset) => numberOf(`pose&offset=${offset}&run=register`, "error") < 1);
    return isNear && numberOf("pose&offset=40&run=register", "error") > 30 ? "beyond" : "within";
  }),
  claim("pose", "the residual falls from [#] there", () => numberOf("pose&offset=40", "residual")),
  claim("pose", "to [#] at 10°, where the tolerance ends", () => numberOf("pose&offset=10", "residual")),
  claim("pose", "it would fall on to [#] at the true pose", () => numberOf("pose&offset=0", "residual")),
  claim("pose", "The residual then reads [#] instead", () => numberOf("pose&offset=40&run=register", "residual")),
  claim("pose", "instead of [#], because the run", () => numberOf("pose&offset=40", "residual")),
  claim("pose", "the residual [falls again|rises] from 60° to 100°", () => {
    const [near, middle, far] = [60, 80, 100].map(residualAt);
    return near > middle && middle > far ? "falls again" : "rises";
  }),
  claim("pose", "From 20° it reaches the [true|given] pose", () => (numberOf(...HOME) < 1 ? "true" : "given")),
];

const CHEEK = "loop&offset=0&px=0.42&py=0.56";
/** Mean error of the pixels' normals under the right pose and a prior of this weight, in the scene of the lesson. */
function meanUnder(weight) {
  const view = { surface: "bust", light: "window", size: 64, angles: { beta: 20 }, noise: 0.01 };
  const { image, depth, pose, light, truth } = sample(view);
  const held = { light, start: pose, scale: 1, registration: "fixed", shading: "pixel" };
  const estimator = new Estimator(image, depth, { ...held, lambda: { prior: weight } });
  for (let stage = 0; stage < 3; stage++) estimator.stepStage();
  const error = normalDegrees(estimator.imageNormals(), truth.imageNormals);
  estimator.free();
  return error;
}

const loop = [
  claim("loop", "the error of the pose falls to [#]° in the first pass", () =>
    numberOf("loop&offset=12&pass=1", "pose"),
  ),
  claim("loop", "in the first pass and to [#]° in six", () => numberOf("loop&offset=12&pass=6", "pose")),
  claim("loop", "and the ring moves [to|away from] the cross", () =>
    change(numberOf("loop&offset=12&pass=6", "off"), numberOf("loop&offset=12", "off"), ["to", "away from"]),
  ),
  claim("loop", "A small {lambda} leaves [several minima|one minimum]", () =>
    [0, 20].every((offset) => numberOf(`loop&offset=${offset}&weight=-3`, "minima") > 1)
      ? "several minima"
      : "one minimum",
  ),
  claim("loop", "With a larger one they [merge into one|split]", () =>
    [0, 20].every((offset) => numberOf(`loop&offset=${offset}&weight=0`, "minima") === 1) ? "merge into one" : "split",
  ),
  claim("loop", "Raise λ until the minima of the pixel, now another one, have [merged|split]", () =>
    [0, 20].every((offset) => numberOf(`loop&offset=${offset}&weight=0`, "minima") === 1) ? "merged" : "split",
  ),
  claim("loop", "far from the true normal: [#]° off at λ = 1", () => numberOf("loop&offset=20&weight=0", "end")),
  claim("loop", "If the pose is right, the prior is [near|far from] the true normal", () =>
    ["off", "end"].every((key) => numberOf("loop&offset=0&weight=0", key) < 4) ? "near" : "far from",
  ),
  claim("loop", "the minimum moves [away from|toward] the true normal", () =>
    change(numberOf("loop&offset=20&weight=-3", "end"), numberOf("loop&offset=20&weight=0", "end"), [
      "away from",
      "toward",
    ]),
  ),
  claim("loop", "off is [ignored|followed]", () =>
    numberOf("loop&offset=40&weight=-1.3&robust=1", "end") < 0.3 * numberOf("loop&offset=40&weight=-1.3", "end")
      ? "ignored"
      : "followed",
  ),
  claim("loop", "the minima [merge into one|split] near the true normal", () =>
    numberOf(`${CHEEK}&weight=-3`, "minima") > 1 && numberOf(`${CHEEK}&weight=0`, "minima") === 1
      ? "merge into one"
      : "split",
  ),
  claim("loop", "near the true normal: the solver is [#]° off", () => numberOf(`${CHEEK}&weight=-3`, "end")),
  claim("loop", "at λ = 0.001 and [#]° at λ = 1", () => numberOf(`${CHEEK}&weight=0`, "end")),
  claim("loop", "the mean error is then [#]° without a prior", () => meanUnder(0)),
  claim("loop", "without a prior, [#]° at λ = 0.05", () => meanUnder(0.05)),
  claim("loop", "and [#]° at λ = 10", () => meanUnder(10)),
  claim("loop", "The solver ends [#]° off; with", () => numberOf("loop&offset=40&weight=-1.3&robust=1", "end")),
  claim("loop", "with the plain prior it was [#]°", () => numberOf("loop&offset=40&weight=-1.3", "end")),
  claim("loop", "the error of the solver?\nIt [grows|falls|stays]", () =>
    change(numberOf("loop&offset=20&weight=-3", "end"), numberOf("loop&offset=20&weight=0", "end"), ["grows", "falls"]),
  ),
  claim("loop", "It grows, from [#]° to", () => numberOf("loop&offset=20&weight=-3", "end")),
  claim("loop", "to [#]°. The larger λ", () => numberOf("loop&offset=20&weight=0", "end")),
  claim("loop", "a prior that is wrong by [#]°", () => numberOf("loop&offset=20", "off")),
];

/** Mean error of the normals of a depth map without noise, whose side has this many pixels. */
function floorOf(size) {
  const { image, depth, pose, truth } = sample({ surface: "bust", light: "colourful", size, angles: { beta: 15 } });
  const estimator = new Estimator(image, depth, { start: pose, scale: 1, registration: "fixed" });
  const error = normalDegrees(estimator.depthNormals(), truth.depthNormals);
  estimator.free();
  return error;
}

const sensor = [
  claim("sensor", "Without any noise the normals are still about [#]° off", () => floorOf(64)),
  claim("sensor", "With twice as many pixels [#]° is left", () => floorOf(128)),
  claim("sensor", "The measured normals become [rough|smooth]; the refined ones stay smooth", () =>
    numberOf("sensor&noise=1", "normalsBefore") > 1.5 * numberOf("sensor", "normalsBefore") ? "rough" : "smooth",
  ),
  claim("sensor", "The measured normals become rough; the refined ones stay [smooth|rough]", () =>
    numberOf("sensor&noise=1", "normalsAfter") < 1.2 * numberOf("sensor", "normalsAfter") ? "smooth" : "rough",
  ),
  claim("sensor", "Once the pose is known, the picture [can|cannot] refine the depth map", () =>
    ["sensor", "sensor&noise=1"].every((state) => numberOf(state, "after") < 0.5 * numberOf(state, "before"))
      ? "can"
      : "cannot",
  ),
  claim("sensor", "Holes are [filled|left] where the colour camera sees the surface", () =>
    numberOf("sensor&holes=40", "filled") > 90 ? "filled" : "left",
  ),
  claim("sensor", "Of these holes [#] % are filled", () => numberOf("sensor&noise=0.4&holes=40", "filled")),
  claim("sensor", "cut off from the rest, such as the crown, are [dropped|kept]", () =>
    numberOf("sensor&noise=0.4&holes=40", "kept") < 95 && numberOf("sensor&noise=0.4", "kept") > 99
      ? "dropped"
      : "kept",
  ),
  claim("sensor", "it is less informative, and the refined depth gets [worse|better]", () =>
    change(numberOf("sensor", "after"), numberOf("sensor&picture=0.2", "after"), ["worse", "better"]),
  ),
];

const paint = [
  claim("paint", "It [appears in|stays out of] the albedo and", () =>
    numberOf("paint&paint=1", "likeness") > 0.8 ? "appears in" : "stays out of",
  ),
  claim("paint", "[Nearly all|Hardly any] of it appears in the albedo", () =>
    [0.5, 0.9].every((shadow) => numberOf(`paint&paint=0&shadow=${shadow}`, "taken") > 90)
      ? "Nearly all"
      : "Hardly any",
  ),
  claim("paint", "takes [nearly all|a small part] of it for albedo", () =>
    numberOf("paint&shadow=0.9", "taken") > 90 ? "nearly all" : "a small part",
  ),
  claim("paint", "The remainder {ej} is [largest|smallest] where the shadow meets the silhouette", () => {
    const { rim, silhouette, inside, lit } = figure("paint&paint=0&shadow=0.9");
    return silhouette > 5 * Math.max(rim, inside, lit) ? "largest" : "smallest";
  }),
  claim("paint", "Along the edge of the shadow on the face it is [small|large]", () => {
    const { rim, lit } = figure("paint&paint=0&shadow=0.9");
    return rim < 1.5 * lit ? "small" : "large";
  }),
  claim("paint", "The remainder is [bright|dark] only where the shadow meets the silhouette", () => {
    const { rim, silhouette, inside, lit } = figure("paint&paint=0&shadow=0.9");
    return silhouette > 0.2 && Math.max(rim, inside, lit) < 0.04 ? "bright" : "dark";
  }),
  claim("paint", "The correlation of albedo and paint [falls|rises]", () =>
    change(numberOf("paint", "likeness"), numberOf("paint&shadow=0.9", "likeness"), ["rises", "falls"]),
  ),
  claim("paint", "but the status is still [converged|ambiguous|lost]", () => wordOf("paint&shadow=0.9")),
  claim("paint", "Chromaticity is now [less|more] informative", () =>
    change(numberOf("paint", "likeness"), numberOf("paint&light=colourful", "likeness"), ["more", "less"]),
  ),
  claim("paint", "falls from [#] to 0.857", () => numberOf("paint", "likeness")),
  claim("paint", "from 0.896 to [#].", () => numberOf("paint&light=colourful", "likeness")),
];

const failure = [
  claim("failure", "At 100 % the rotation [cannot|can] be determined, and the report names the axis", () =>
    /rotation about z is not observable/.test(statusOf("failure&case=symmetry&amount=100")) ? "cannot" : "can",
  ),
  claim("failure", "Without 95 % of its width no pose fits, and the status is [lost|ambiguous|converged]", () =>
    wordOf("failure&amount=100"),
  ),
  claim("failure", "Without 90 % the status is [converged|ambiguous|lost]", () => wordOf("failure&amount=95")),
  claim("failure", "with a sigma of [#]°", () => numberOf("failure&amount=95", "sigma")),
  claim("failure", "instead of the [#]° of the whole map", () => numberOf("failure", "sigma")),
  claim("failure", "within a quarter turn has a sigma of [#]°", () => 90 / Math.sqrt(12)),
  claim("failure", "Errors of two or three sigmas are [rare|usual]", () =>
    [0, 25, 50, 75].every((amount) => {
      const { error, sigma } = figure(`failure&amount=${amount}`);
      return error < 2 * sigma;
    })
      ? "rare"
      : "usual",
  ),
  claim("failure", "with the print at 100 %, [more|less] of the colour stays unexplained than with none", () =>
    change(numberOf("failure&case=texture", "residual"), numberOf("failure&case=texture&amount=100", "residual"), [
      "more",
      "less",
    ]),
  ),
  claim("failure", "the rotation is so uncertain that the status is [lost|ambiguous|converged]", () =>
    wordOf("failure&case=texture&amount=100"),
  ),
  claim("failure", "Here at 90° and with a narrow depth map, [little|much] remains to compare", () =>
    numberOf("failure&case=turn&amount=100", "sigma") > 5 * numberOf("failure&case=turn", "sigma") ? "little" : "much",
  ),
  // A rotation counts as found within 3 degrees.
  claim("failure", "“Ambiguous” and “lost” do [not|always] mean that the pose is wrong", () =>
    wordOf("failure&case=turn&amount=100") !== "converged" && numberOf("failure&case=turn&amount=100", "error") < 3
      ? "not"
      : "always",
  ),
];

/** Error of the solver in the states of exercise 4. */
const solver = (offset, weight, robust = 0) =>
  numberOf(`loop&offset=${offset}&weight=${weight}&robust=${robust}`, "end");
const MERGE = "When minima merge";
/** Logarithms of the weights that the slider is set to, from left to right. */
const WEIGHTS = [-3, -2.5, -2, -1.75, -1.5, -1.3, -1, 0, 1];

const merging = [
  claim(MERGE, "a single minimum is left from about λ = [#]", () => {
    const isSingle = (weight) =>
      [0, 20].every((offset) => numberOf(`loop&offset=${offset}&weight=${weight}`, "minima") === 1);
    return 10 ** WEIGHTS.find((weight, at) => WEIGHTS.slice(at).every(isSingle) && isSingle(weight));
  }),
  claim(MERGE, "With the right pose the prior is [#]° off", () => numberOf("loop&offset=0", "off")),
  claim(MERGE, "With the pose 20° off the prior is [#]° off", () => numberOf("loop&offset=20", "off")),
  claim(MERGE, "at every λ: [#]° off at 0.001", () => solver(0, -3)),
  claim(MERGE, "1.9° off at 0.001, [#]° at 0.05", () => solver(0, -1.3)),
  claim(MERGE, "2.2° at 0.05, [#]° at 10", () => solver(0, 1)),
  claim(MERGE, "The solver then ends [#]° off at 0.001", () => solver(20, -3)),
  claim(MERGE, "2.4° off at 0.001, but [#]° at 0.05", () => solver(20, -1.3)),
  claim(MERGE, "at 10 the pixel simply [repeats|ignores] the prior", () =>
    Math.abs(solver(20, 1) - numberOf("loop&offset=20", "off")) < 2 ? "repeats" : "ignores",
  ),
  claim(MERGE, "So with a wrong pose the [smallest|largest] λ is the best one", () => {
    const errors = [-3, -2, -1.3, -1, 0, 1].map((weight) => solver(20, weight));
    return errors.every((error, at) => at === 0 || error > errors[at - 1]) ? "smallest" : "largest";
  }),
  claim(MERGE, "so here it helps a little: [#]° off at 0.05", () => solver(20, -1.3, 1)),
];

const STEP = "The step that cannot be seen";
const step = [
  claim(STEP, "the path around: [#] of 8 px instead of", () => numberOf("surface&step=8&robust=1", "jump")),
  claim(STEP, "of 8 px instead of [#].", () => numberOf("surface&step=8&robust=0", "jump")),
  claim(STEP, "Slopes alone do [not|well] determine the height", () =>
    Math.abs(numberOf("surface&step=8&through=1", "jump")) < 1 ? "not" : "well",
  ),
];

const HIDDEN = "A rotation that cannot be seen";
const overlaps = [0.3, 0.25, 0.2, 0.16, 0.125];
const hidden = [
  claim(HIDDEN, "The residual is as [small|large] as for a good pose", () =>
    numberOf("failure&case=symmetry&amount=100", "residual") < 1.2 * numberOf("failure&case=symmetry", "residual")
      ? "small"
      : "large",
  ),
  claim(HIDDEN, "The reported sigma and the alternative poses [do|do not] warn.", () => {
    const [good, round] = [figure("failure&case=symmetry"), figure("failure&case=symmetry&amount=100")];
    return round.sigma > 20 * good.sigma && good.rivals === 0 && round.rivals > 0 ? "do" : "do not";
  }),
  claim(HIDDEN, "the sigma grows [before|after] the error does", () => {
    const runs = overlaps.map((overlap) => labRun({ overlap }));
    const firstOf = (key) => runs.findIndex((run) => run[key] > 1.5);
    return firstOf("sigma") < firstOf("error") ? "before" : "after";
  }),
  claim(HIDDEN, "converged at an overlap of [#]", () => overlaps.findLast(isGood)),
  claim(HIDDEN, "ambiguous at [#] and", () => overlaps.find((overlap) => labRun({ overlap }).status === "ambiguous")),
  claim(HIDDEN, "and lost at [#].", () => overlaps.find((overlap) => labRun({ overlap }).status === "lost")),
];

function isGood(overlap) {
  const { status, error } = labRun({ overlap });
  return status === "converged" && error < 1;
}

const bump = [claim("Bump or dent", "At [#]°. A dent has", () => grey[0].holds())];

/** The answers of the guesses, each after the end of its question. */
const guessed = [
  claim("pixel", "curves of log S?\nAll fall by log 2, about [#]", () => -Math.log(0.5)),
  claim("grey", "both make the same picture?\nBy [#]°", () => grey[0].holds()),
  claim("colours", "normals of single pixels better?\nUnder the [coloured lamps|window].", () =>
    numberOf("colours&colour=1", "degrees") < numberOf("colours&colour=1&light=window", "degrees")
      ? "coloured lamps"
      : "window",
  ),
  claim("colours", "almost coincide, and the error is many times [larger|smaller]", () =>
    numberOf("colours&colour=1&light=window", "degrees") > 3 * numberOf("colours&colour=1", "degrees")
      ? "larger"
      : "smaller",
  ),
  claim("surface", "does integration find?\n[None|All].", () =>
    Math.abs(numberOf("surface&step=8&through=1", "jump")) < 0.1 ? "None" : "All",
  ),
  claim("prior", "error of the normals fall?\nBy [more|less] than that", () => {
    const [none, some, all] = [0, 20, 100].map((share) => numberOf(`prior&share=${share}`, "degrees"));
    return change(0.2 * (none - all), none - some, ["more", "less"]);
  }),
  claim("prior", "The error of the normals [falls|rises] to its least", () => {
    const [some, all] = [20, 100].map((share) => numberOf(`prior&share=${share}`, "degrees"));
    return change(some, all, ["rises", "falls"]);
  }),
  claim("pose", "What will it report?\nThe given pose, [ambiguous|converged|lost].", () =>
    wordOf("pose&offset=40&run=register"),
  ),
  claim("pose", "Let it register from 20° away. The pose [comes home|stays away]", () =>
    numberOf(...HOME) < 1 ? "comes home" : "stays away",
  ),
  claim("pose", "takes longer, and the error ends [below|above] one degree", () =>
    numberOf(...SEARCH) < 1 ? "below" : "above",
  ),
  claim("sensor", "the refined normals?\nThey [hardly|greatly] change", () =>
    numberOf("sensor&noise=1", "normalsAfter") < 1.2 * numberOf("sensor", "normalsAfter") ? "hardly" : "greatly",
  ),
  claim("paint", "does the program mistake it for?\n[Dark paint|Shading].", () =>
    numberOf("paint&paint=0&shadow=0.9", "taken") > 90 ? "Dark paint" : "Shading",
  ),
  claim(
    "failure",
    "report say about its pose?\n[Lost|Converged], and which rotation cannot be seen: that about z",
    () =>
      /^lost: .*rotation about z is not observable/.test(statusOf("failure&case=symmetry&amount=100"))
        ? "Lost"
        : "Converged",
  ),
];

export const claims = [
  ...[normal, lambert, relief, strips, orders],
  ...[pixel, grey, colours, surface, prior, pose, loop, sensor, paint, failure],
  ...[guessed, bump, step, merging, hidden],
].flat();
