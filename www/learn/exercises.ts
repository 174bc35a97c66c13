/** Exercises for a course: each begins with a link that opens the state to which it refers, and ends with its answer, which is folded. */

import { OPTIONS } from "../../pkg/options.js";
import { make } from "../dom";
import { phrase } from "../words";
import { sentence } from "./maths";
import { translated } from "./translation";

export interface Exercise {
  title: string;
  /** Addresses of the states, with the words of the links. */
  links: readonly (readonly [address: string, words: string])[];
  question: string;
  answer: readonly string[];
}

export const exercises: readonly Exercise[] = [
  {
    title: "Bump or dent",
    links: [["#learn&at=grey&turn=0&height=0.8", "Open the bump and the dent"]],
    question:
      "Find the angle of the lamp at which the two pictures agree. Use the image model to show why it must be this angle. Would three coloured lamps help?",
    answer: [
      "At 180°. A dent has the normals ({−n_x}, {−n_y}, {n_z}) where the bump has ({n_x}, {n_y}, {n_z}): every normal is rotated by 180° about the line of sight. Call that rotation D, a matrix that leaves a fourth component as it is. The light {L} rotated by D gives each rotated normal D{N} the old intensity: {M} becomes D{M}Dᵀ, and the two rotations cancel.",
      "Coloured lamps do not help as long as the light is unknown: each of the three lights can be rotated in the same way. They help once the light is known.",
    ],
  },
  {
    title: "Why colour matters",
    links: [
      ["#learn&at=colours&light=colourful&colour=1&noise=0.03", "Open the coloured lamps"],
      ["#learn&at=colours&light=window&colour=1&noise=0.03", "Open the window"],
    ],
    question:
      "Both pictures have 3 % noise. Compare the mean errors of the normals, and explain the difference by the shapes of the two cost maps.",
    answer: [
      "The coloured lamps leave a few small dark spots. The three curves of equal intensity cross at large angles, so noise moves the crossing only a little. Under the window light the three colours change almost in proportion, so the curves almost coincide. The valley is long and flat, and noise moves its lowest point far along it.",
      "In numbers: near its minimum, the cost rises like a quadratic form of the step. The matrix of that form, the Gauss-Newton matrix, is the sum over the colours of each gradient times its transpose, and the variance of the normal is that of the noise divided by the smallest eigenvalue. With three nearly parallel gradients that eigenvalue is nearly zero.",
    ],
  },
  {
    title: "The step that cannot be seen",
    links: [
      ["#learn&at=surface&step=8&robust=0&through=0", "Open a step that ends"],
      ["#learn&at=surface&step=8&robust=1&through=1", "Open a step that cuts through"],
    ],
    question:
      "In the first state, switch the robust weights on. Why is the height of the step recovered? Why is it not in the second state?",
    answer: [
      "The step ends at a ramp, whose slopes do appear in the normals. A path around the step sums to the height of the step, a path across it to zero. Least squares distributes this contradiction over all pairs of pixels. With robust weights, the few pairs across the step fit worst and lose their influence, so the height follows from the path around: 7.7 of 8 px instead of 2.1.",
      "If the step cuts the plate in two, every path leads across it, and no contradiction can be detected. Slopes alone do not determine the height; a depth map does.",
    ],
  },
  {
    title: "When minima merge",
    links: [
      ["#learn&at=loop&offset=0&weight=-3&robust=0", "Open the right pose"],
      ["#learn&at=loop&offset=20&weight=-3&robust=0", "Open a pose 20° off"],
    ],
    question:
      "Raise λ from the left until the pixel has a single minimum. Note λ and how far the solver ends from the truth. Repeat with the pose 20° off, and then with the robust prior. Which λ would you choose for a loop that starts with a wrong pose?",
    answer: [
      "In both states a single minimum is left from about λ = 0.02. With the right pose the prior is 3.0° off, and so the solver ends near the true normal at every λ: 1.9° off at 0.001, 2.2° at 0.05, 2.8° at 10. With the pose 20° off the prior is 23° off. The solver then ends 2.4° off at 0.001, but 11° at 0.05, and at 10 the pixel simply repeats the prior.",
      "So with a wrong pose the smallest λ is the best one for this pixel. At 0.001 the pixel still has several minima, but the solver starts at the prior and descends to the one near the true normal. The robust prior loses its influence only beyond about 23°, so here it helps a little: 7.3° off at 0.05.",
      `For the loop, the program uses ${OPTIONS.lambda.members.prior.default} against squared log residuals. It can, because it registers the depth map before it solves the pixels, so the prior is nearly right by then.`,
    ],
  },
  {
    title: "A rotation that cannot be seen",
    links: [
      ["#learn&at=failure&case=symmetry&amount=100", "Open the round disc"],
      ["#surface=bust&light=window&size=64&beta=40&noise=0.02&overlap=0.3&play", "Open a narrow depth map in the Lab"],
    ],
    question:
      "What does the report say about the round disc, and which of its numbers would have warned you if the truth were unknown? In the Lab, find the smallest overlap at which the pose is still within a degree and the status is converged.",
    answer: [
      "The status is lost, because the rotation about z is not observable: rotating the disc about its axis changes no colour. The residual is as small as for a good pose, so it does not warn. The reported sigma and the alternative poses do warn.",
      "With decreasing overlap the sigma grows before the error does. The status becomes ambiguous once sigma exceeds 1.5°, and lost a little later. In this scene the pose is still within a degree and converged at an overlap of 0.2, ambiguous at 0.16 and lost at 0.125. Where this happens depends on light, noise and size; vary them.",
    ],
  },
];

/** `tools` stand above the exercises. */
export function exerciseList(...tools: HTMLElement[]): HTMLElement {
  return make(
    "section",
    { class: "learn-exercises", id: "learn-exercises", "aria-labelledby": "learn-exercises-title" },
    make("h2", { id: "learn-exercises-title", tabindex: "-1" }, phrase("exercises.title", "Exercises for a course")),
    make(
      "p",
      { class: "soft" },
      phrase(
        "exercises.use",
        "Each link opens the figure in the state the exercise refers to. To make your own exercise, set a figure and use the Link button at the top of the page: the address holds the lesson and all control settings.",
      ),
    ),
    ...tools,
    make(
      "ol",
      {},
      ...translated(exercises, ["exercises"]).map(({ title, links, question, answer }) =>
        make(
          "li",
          {},
          make("h3", {}, title),
          make("p", {}, ...sentence(question)),
          make("p", { class: "learn-links" }, ...links.map(([address, words]) => make("a", { href: address }, words))),
          answerOf(answer),
        ),
      ),
    ),
  );
}

/** An answer, which is folded at first. */
export const answerOf = (answer: readonly string[]): HTMLDetailsElement =>
  make(
    "details",
    {},
    make("summary", {}, phrase("answer", "Answer")),
    ...answer.map((words) => make("p", {}, ...sentence(words))),
  );
