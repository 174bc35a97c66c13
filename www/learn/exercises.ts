/** Exercises for a course: each begins with a link that opens the state it speaks of, and ends with its answer, folded. */

import { OPTIONS } from "../../pkg/options.js";
import { make } from "../dom";
import { sentence } from "./maths";

interface Exercise {
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
      "Find the turn of the lamp at which both pictures agree. Show with the image model why it has to be this angle, and say whether three coloured lamps would help.",
    answer: [
      "At 180°. A dent has the normals ({−n_x}, {−n_y}, {n_z}) where the bump has ({n_x}, {n_y}, {n_z}): every normal is turned by 180° about the line of sight. A light {L} turned by the same rotation gives each turned normal the old intensity, for {M} becomes Q {M} Qᵀ, with Q the turn, and the two rotations cancel.",
      "Coloured lamps do not help as long as the light is unknown: each of the three lights can be turned in the same way. They help once the light is known.",
    ],
  },
  {
    title: "Why colour matters",
    links: [
      ["#learn&at=colours&light=colourful&colour=1&noise=0.03", "Open the coloured lamps"],
      ["#learn&at=colours&light=window&colour=1&noise=0.03", "Open the window"],
    ],
    question:
      "Both pictures have the same noise of 3 %. Compare the mean errors of the normals. Explain the difference by the shapes of the two cost maps.",
    answer: [
      "The coloured lamps leave a few small dark spots: the three curves of equal intensity cross at large angles, so noise moves the crossing little. Under the window the three colours change nearly alike; the curves almost coincide, the valley is long and flat, and noise moves its lowest point far along it.",
      "In numbers: the Gauss-Newton matrix of the pixel is the sum over colours of gradient times gradient, and its smallest eigenvalue is what the noise is divided by. With three nearly parallel gradients it is nearly zero.",
    ],
  },
  {
    title: "The step that cannot be seen",
    links: [
      ["#learn&at=surface&step=8&robust=0&through=0", "Open a step that ends"],
      ["#learn&at=surface&step=8&robust=1&through=1", "Open a step that cuts through"],
    ],
    question:
      "In the first state, switch the robust weights on. Why does the height of the step come back? Why does it not in the second state?",
    answer: [
      "The step ends at a ramp, whose slopes the normals do see. A way around the step sums to the height of the step, the way across it to zero. Least squares shares out this contradiction among all pairs of pixels; robust weights find that the few pairs across the step fit worst and let go of them. The height then comes from the way around.",
      "If the step cuts the plate in two, every way leads across it, and there is no contradiction that could be found. Slopes alone don't hold the height; a depth map does.",
    ],
  },
  {
    title: "When valleys merge",
    links: [
      ["#learn&at=pose&offset=0&weight=-3&robust=0", "Open the right pose"],
      ["#learn&at=pose&offset=20&weight=-3&robust=0", "Open a pose 20° off"],
    ],
    question:
      "Raise λ from the left until the pixel has one valley. Note λ and how far the solver ends from the truth. Do the same with the pose 20° off, and then with the robust prior. Which λ would you choose for a loop that starts with a wrong pose?",
    answer: [
      "With the right pose a larger λ is only good: the wrong valleys vanish and the one that is left is the true normal. With the pose 20° off they vanish, too, but what is left moves toward the wrong prior; at large λ the pixel just repeats it.",
      `So λ should be just large enough to choose among valleys and too small to move them: the module's ${OPTIONS.lambda.members.prior.default} against squared log residuals. The robust prior lets go beyond some 23°: at that λ it chooses among near valleys, and one that is far off hardly moves the pixel. A much larger λ drags it all the same.`,
    ],
  },
  {
    title: "A turn that nobody can see",
    links: [
      ["#learn&at=failure&case=symmetry&amount=100", "Open the round disc"],
      ["#surface=bust&light=colourful&beta=40&overlap=0.125&play", "Open a narrow depth map in the Lab"],
    ],
    question:
      "What does the report say of the round disc, and which of its numbers would have warned you without the truth at hand? In the Lab, find the smallest overlap at which the pose still comes within a degree and is called converged.",
    answer: [
      "The status is lost, because the rotation about z is not observable: turning the disc about its axis changes no colour. The residual is as small as for a good pose, so the residual can't warn; the reported sigma and the other poses that fit as well do.",
      "With decreasing overlap the sigma grows before the error does; the status turns to ambiguous once it passes 1.5°. Which overlap that is depends on noise and size: vary both.",
    ],
  },
];

export function exerciseList(): HTMLElement {
  return make(
    "section",
    { class: "learn-exercises", id: "learn-exercises", "aria-labelledby": "learn-exercises-title" },
    make("h2", { id: "learn-exercises-title", tabindex: "-1" }, "Exercises for a course"),
    make(
      "p",
      { class: "soft" },
      "Each link opens the state that the exercise speaks of. For your own, set a figure and copy the link on top of the page: it holds the lesson and all its sliders.",
    ),
    make(
      "ol",
      {},
      ...exercises.map(({ title, links, question, answer }) =>
        make(
          "li",
          {},
          make("h3", {}, title),
          make("p", {}, ...sentence(question)),
          make("p", { class: "learn-links" }, ...links.map(([address, words]) => make("a", { href: address }, words))),
          make(
            "details",
            {},
            make("summary", {}, "Answer"),
            ...answer.map((words) => make("p", {}, ...sentence(words))),
          ),
        ),
      ),
    ),
  );
}
