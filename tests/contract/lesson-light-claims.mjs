// Statements of lessons 6 to 8 that their figures must confirm; lesson-claims.mjs says how a claim is written.
import { figure } from "./lesson-figures.mjs";

const change = (from, to, [more, less]) => (to > from ? more : less);
const claim = (where, words, holds) => ({ where, words, holds });
const numberOf = (state, key) => figure(state)[key];

export const pixel = [
  claim("pixel", "The same normal now has a [different|brighter red] colour", () =>
    ["red", "green", "blue"].some((key) => Math.abs(numberOf("pixel&beta=60", key) - numberOf("pixel", key)) > 0.1)
      ? "different"
      : "brighter red",
  ),
  claim("pixel", "All three curves move [down|up] by the same amount", () => {
    const moves = ["red", "green", "blue"].map((key) => numberOf("pixel&albedo=0.5", key) - numberOf("pixel", key));
    const isSame = moves.every((move) => Math.abs(move - Math.log(0.5)) < 1e-5);
    return isSame ? change(0, moves[0], ["up", "down"]) : "apart";
  }),
];

const turns = [0, 45, 90, 135, 180];
export const grey = [
  claim("grey", "At [#]° the two pictures are the same", () => {
    const differences = turns.map((turn) => numberOf(`grey&turn=${turn}`, "difference"));
    return turns[differences.indexOf(Math.min(...differences))];
  }),
  claim("grey", "the difference [falls|rises] to zero", () =>
    numberOf("grey&turn=180", "difference") < 1e-4 && numberOf("grey", "difference") > 0.1 ? "falls" : "rises",
  ),
  claim("grey", "Then the two pictures [cannot|always] differ", () =>
    turns.every((turn) => numberOf(`grey&height=0&turn=${turn}`, "difference") < 1e-6) ? "cannot" : "always",
  ),
  claim("grey", "A known light [does|does not], and so does a depth map", () =>
    numberOf("grey&turn=0", "difference") > 0.1 ? "does" : "does not",
  ),
  claim("grey", "every pixel [keeps|loses] its brightness", () =>
    numberOf("grey&turn=180", "difference") < 1e-4 ? "keeps" : "loses",
  ),
];

export const colours = [
  claim("colours", "Each colour leaves [a different|the same] curve of normals", () =>
    numberOf("colours&colour=1&noise=0", "apart") > 20 ? "a different" : "the same",
  ),
  // One sample of the map is about one degree wide.
  claim("colours", "Where the three curves meet, [all colours are|only one colour is] explained", () =>
    ["colourful", "window"].every((light) => numberOf(`colours&colour=1&noise=0&light=${light}`, "meeting") < 1)
      ? "all colours are"
      : "only one colour is",
  ),
  claim("colours", "Its three curves [almost coincide|are far apart]", () =>
    numberOf("colours&colour=1&noise=0&light=window", "apart") < 0.2 * numberOf("colours&colour=1&noise=0", "apart")
      ? "almost coincide"
      : "are far apart",
  ),
  claim("colours", "The three lines [move apart|close up], the dark valley", () =>
    change(numberOf("colours&colour=0", "apart"), numberOf("colours&colour=1", "apart"), ["move apart", "close up"]),
  ),
  claim("colours", "The three lines run [side by side|across each other], and", () =>
    numberOf("colours&colour=1&light=window", "apart") < 10 ? "side by side" : "across each other",
  ),
  claim("colours", "the dark valley [shrinks|grows] to the spots", () =>
    change(numberOf("colours&colour=0", "explained"), numberOf("colours&colour=1", "explained"), ["grows", "shrinks"]),
  ),
  claim("colours", "and the error of the normals [falls|rises]", () =>
    change(numberOf("colours&colour=0", "degrees"), numberOf("colours&colour=1", "degrees"), ["rises", "falls"]),
  ),
  claim("colours", "side by side, and the dark valley stays [long|short]", () =>
    numberOf("colours&colour=1&light=window", "explained") > 10 * numberOf("colours&colour=1", "explained")
      ? "long"
      : "short",
  ),
  claim("colours", "the same noise makes it [grow|shrink] from", () =>
    change(
      numberOf("colours&colour=1&light=window", "degrees"),
      numberOf("colours&colour=1&light=window&noise=0.05", "degrees"),
      ["grow", "shrink"],
    ),
  ),
  claim("colours", "At 5 % the error of the normals is [#]°, up", () =>
    numberOf("colours&colour=1&noise=0.05", "degrees"),
  ),
  claim("colours", "up from [#]° at 1 %", () => numberOf("colours&colour=1&noise=0.01", "degrees")),
  claim("colours", "makes it grow from [#]° to", () => numberOf("colours&colour=1&light=window&noise=0.01", "degrees")),
  claim("colours", "makes it grow from 13.4° to [#]°", () =>
    numberOf("colours&colour=1&light=window&noise=0.05", "degrees"),
  ),
  claim("colours", "a little noise moves the lowest point by [tens|tenths] of degrees", () =>
    numberOf("colours&colour=1&light=window&noise=0.03", "degrees") > 20 ? "tens" : "tenths",
  ),
  claim("colours", "Then [no|some] normal explains it within 2 %", () =>
    numberOf("colours&light=overcast&colour=0.7&noise=0.05&px=0.82&py=0.8", "explained") === 0 ? "no" : "some",
  ),
];
