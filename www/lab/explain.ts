/** Explanations of the method that is used, with formulas. Loaded with the first question. */

import type { Stage } from "../../pkg/index.js";
import { make } from "../dom";

/** Properties of the run on which the explanations depend. */
export interface Method {
  shading: "surface" | "pixel";
  registration: "joint" | "icp" | "fixed";
  lightIsKnown: boolean;
  searches: boolean;
}

/** Numbers of the page that have an explanation. */
export type Term = "pose" | "overlap" | "inliers" | "residual" | "change" | "sigma" | "weakest" | "objective";

interface Text {
  title: string;
  /** MathML. */
  formula?: string;
  words: string;
  source?: string;
}

const i = (name: string) => `<mi>${name}</mi>`;
const bold = (name: string) => `<mi mathvariant="normal" class="vector">${name}</mi>`;
const o = (sign: string) => `<mo>${sign}</mo>`;
const row = (...parts: string[]) => `<mrow>${parts.join("")}</mrow>`;
const sub = (base: string, index: string) => `<msub>${base}${index}</msub>`;
const sup = (base: string, index: string) => `<msup>${base}${index}</msup>`;
/** The sign of a transposed vector, as a letter that every font has. */
const transposed = (vector: string) => sup(vector, '<mi mathvariant="normal">T</mi>');
const squared = (...parts: string[]) => sup(row(o("‖"), ...parts, o("‖")), "<mn>2</mn>");
const least = (what: string) => `<munder><mi>min</mi>${what}</munder>`;
const sum = o("∑");
/** A term in the colour of its curve in the chart. */
const term = (series: 1 | 2 | 3 | 4, ...parts: string[]) => `<mrow class="series-${series}">${parts.join("")}</mrow>`;
const math = (...parts: string[]) => `<math display="block">${parts.join("")}</math>`;

/** Space around the name of a function, which browsers set too close. */
const space = "<mspace width='0.1667em'></mspace>";
const logS = row(i("log"), space, i("S"));
const n = bold("n");
/** The normal with a fourth component 1, as in the lessons. */
const extended = bold("ñ");
const nR = sub(bold("n"), i("R"));
const R = bold("R");
const model = (normal: string) => row(i("B"), o("("), normal, o(")"), i("L"));
const lambda = (index: string) => sub(i("λ"), `<mn>${index}</mn>`);
const unit = row(o("+"), lambda("3"), sup(row(o("("), transposed(n), n, o("−"), "<mn>1</mn>", o(")")), "<mn>2</mn>"));

const SEARCH: Text = {
  title: "Search",
  formula: math(
    `<munder><mi>max</mi>${row(i("R"), o(","), i("s"), o(","), bold("t"))}</munder>`,
    space,
    "<mroot><mi>V</mi><mn>3</mn></mroot>",
    space,
    i("ln"),
    space,
    "<mfrac><mtext>spread of log S</mtext><mtext>noise left</mtext></mfrac>",
  ),
  words:
    "If nothing is known about the pose, a coarse grid over all rotations is tried; a Fourier transform evaluates every shift of each at once. V counts the points that both views see. Photometric registration refines the best candidates. The loop starts from the one with the smallest residual; those that fit almost as well are listed as alternatives. The surface moves to the best candidate so far.",
  source: "Before Algorithm 1; not in the paper",
};

function light({ lightIsKnown }: Method): Text {
  const formula = math(logS, o("="), transposed(extended), bold("M"), extended, o("="), model(n));
  if (lightIsKnown) {
    return {
      title: "Light, known",
      formula,
      words:
        "The normal ñ has a fourth component 1, and the matrix M of each colour holds 9 of the 27 numbers L. These are given and stay fixed. Only the exposure of the image, one offset of its logarithm, is estimated along with the normals.",
      source: "Equations 3 and 5",
    };
  }
  return {
    title: "Light",
    formula,
    words:
      "The normal ñ has a fourth component 1, and the matrix M of each colour holds 9 of the 27 numbers L. With the normals held, the logarithm of every colour is linear in L, nine spherical harmonics for each channel. Robust least squares fits them, with a Gaussian prior learned from natural lights.",
    source: "Equations 2, 3 and 5",
  };
}

function shading({ shading }: Method): Text {
  const pixel = math(
    least(n),
    term(1, squared(logS, o("−"), model(n))),
    o("+"),
    term(2, lambda("2"), squared(n, o("−"), R, nR)),
    unit,
  );
  if (shading === "pixel") {
    return {
      title: "Shading, pixel by pixel",
      formula: pixel,
      words:
        "With light and pose held fixed, the solver finds for each pixel of the image the unit normal that explains its three colours and stays close to the depth map's normal at the corresponding point. Pixels are solved independently of their neighbours.",
      source: "Equations 6 to 9",
    };
  }
  return {
    title: "Shading, each pixel first",
    formula: pixel,
    words:
      "With light and pose held fixed, the solver finds for each pixel the normal that explains its three colours and is close to the depth map's. Under nearly white light many normals remain possible; the surface of the next stage decides between them.",
    source: "Equations 6 to 9; the surface is not in the paper",
  };
}

function surface({ shading }: Method): Text {
  if (shading === "pixel") {
    const slope = (axis: string) =>
      row(
        `<mfrac>${row(o("∂"), i("z"))}${row(o("∂"), i(axis))}</mfrac>`,
        o("="),
        o("−"),
        `<mfrac>${sub(i("n"), i(axis))}${sub(i("n"), i("z"))}</mfrac>`,
      );
    return {
      title: "Surface from normals",
      formula: math(slope("x"), o(","), "<mspace width='1em'></mspace>", slope("y")),
      words:
        "Normals give slopes. The depth whose slopes fit them best, in least squares over the object's pixels, is a surface that can be compared with the depth map.",
      source: "Equations 4, 10 and 11",
    };
  }
  return {
    title: "Surface from shading",
    formula: math(
      least(i("z")),
      term(1, sum, i("ρ"), o("("), o("|"), logS, o("−"), model(row(n, o("("), i("z"), o(")"))), o("|"), o(")")),
      o("+"),
      sum,
      i("w"),
      sup(row(o("("), sub(i("z"), i("k")), o("−"), sub(i("z"), i("i")), o("−"), i("g"), o(")")), "<mn>2</mn>"),
    ),
    words:
      "The unknowns are the heights themselves, so that every normal belongs to one surface. They are fitted to the colours and to the slopes g of the single pixels' normals, each slope weighted by how well its colours determine it.",
    source: "Replaces Equations 4, 10 and 11; not in the paper",
  };
}

function registration({ registration }: Method): Text {
  if (registration === "fixed")
    return {
      title: "No registration",
      words: "The pose stays at its initial value. Shapes and light are estimated for this pose.",
    };
  if (registration === "icp") {
    const P = sub(bold("P"), i("R"));
    return {
      title: "Registration by ICP",
      formula: math(
        least(row(i("s"), o(","), R, o(","), bold("t"))),
        term(3, sum, squared(bold("P"), o("−"), o("("), i("s"), R, P, o("+"), bold("t"), o(")"))),
      ),
      words:
        "As in the paper, the depth map's points are moved onto the image's surface. Nearest neighbours are matched first; then a robust fit of twelve linear parameters is decomposed into the scale s, the rotation R and the translation t.",
      source: "Equations 12 to 16",
    };
  }
  return {
    title: "Photometric registration",
    formula: math(
      least(row(i("T"), o(","), i("L"))),
      term(
        3,
        sum,
        i("ρ"),
        o("("),
        o("‖"),
        logS,
        o("("),
        i("π"),
        o("("),
        i("T"),
        sub(bold("P"), i("R")),
        o(")"),
        o(")"),
        o("−"),
        model(row(R, nR)),
        o("‖"),
        o(")"),
      ),
    ),
    words:
      "The surface recovered from the image is not used here. The depth map is rotated until its normals predict the colours where its points project; the light is re-estimated along the way. ρ rejects outliers; it starts tolerant and becomes strict. An object with varying albedo is compared by local contrast and by its silhouette instead; then the estimated albedo is divided out and the pose is refined again.",
    source: "Replaces Equations 12 to 14; not in the paper",
  };
}

const REFINEMENT: Text = {
  title: "Refinement",
  formula: math(
    least(nR),
    term(4, squared(logS, o("−"), model(row(R, nR)))),
    o("+"),
    term(2, lambda("g"), squared(R, nR, o("−"), n)),
    o("+"),
    o("…"),
  ),
  words:
    "Where both views overlap, the colours correct the depth map's normals, and the normals correct its depth, which stays anchored to the measurements. Noise decreases and holes are filled. The next iteration starts from the refined map.",
  source: "Equations 17 to 19",
};

const terms: Readonly<Record<Term, (method: Method) => Text>> = {
  pose: () => ({
    title: "The pose",
    formula: math(
      sub(bold("P"), i("colour")),
      o("="),
      i("s"),
      R,
      sub(bold("P"), i("depth")),
      o("+"),
      bold("t"),
      o(","),
      space,
      R,
      o("="),
      ...[
        ["x", "α"],
        ["y", "β"],
        ["z", "γ"],
      ].flatMap(([axis = "", angle = ""]) => [sub(i("R"), i(axis)), o("("), i(angle), o(")")]),
    ),
    words:
      "It maps points of the depth camera into the colour view. The rotation is about the origin: the camera, or without intrinsics the middle of the picture at depth zero. The object lies in front of the origin, so even a depth map that is only rotated about the object has a translation. An image without intrinsics does not determine the translation along z, which is free.",
  }),
  overlap: () => ({
    title: "Overlap",
    words:
      "Share of the depth map's pixels that the colour camera sees under this pose. Below 5 % no pose can be judged.",
  }),
  inliers: () => ({
    title: "Inliers",
    words:
      "Share of the overlap's pixels whose residual, of colour or of distance, is within the noise. Below 40 % the pose is not trusted.",
  }),
  residual: () => ({
    title: "Colour residual",
    formula: math(o("‖"), logS, o("−"), model(n), o("‖")),
    words:
      "Robust mean of the difference between predicted and observed colours, in natural logarithms: 0.01 is one percent. The view of the same name shows it pixel by pixel.",
  }),
  change: ({ registration }) => ({
    title: "Rotation change",
    words: `The angle by which the last iteration rotated the depth map. ${registration === "icp" ? "ICP ends once the proposed change is smaller than the setting “Stop below”." : "It falls to zero once the photometric registration has converged."}`,
  }),
  sigma: () => ({
    title: "σ, the uncertainty",
    words:
      "One standard deviation of each part of the pose, from how sharply the colours (or surfaces) determine it. It covers noise, not what the model leaves out: shadows, varying albedo, or an alternative pose far away. A lost pose therefore has none.",
  }),
  weakest: () => ({
    title: "The weakest direction",
    words:
      "The rotation that changes the image least. With more noise or a rounder object it is the first that can no longer be determined.",
  }),
  objective: () => ({
    title: "The objective",
    formula: math(
      i("E"),
      o("="),
      term(1, sub(i("ℓ"), "<mn>1</mn>")),
      o("+"),
      term(2, sub(i("ℓ"), "<mn>2</mn>")),
      o("+"),
      term(3, i("f")),
      o("+"),
      term(4, i("g")),
    ),
    words:
      "ℓ₁: colours against the image's normals. ℓ₂: the image's normals against the depth map's. f: distance between the two surfaces. g: colours against the measured normals of the depth map. Each is a robust mean; the sum decides whether an iteration is kept.",
    source: "Equation 1",
  }),
};

const stages: Readonly<Record<Stage, (method: Method) => Text>> = {
  search: () => SEARCH,
  light,
  shading,
  surface,
  registration,
  refinement: () => REFINEMENT,
};

function shown({ title, formula, words, source }: Text): HTMLElement[] {
  const equation = make("div", { class: "equation" });
  // Markup that is made only in this file.
  if (formula) equation.innerHTML = formula;
  return [
    make("h2", {}, title),
    ...(formula ? [equation] : []),
    make("p", {}, words),
    ...(source ? [make("p", { class: "soft" }, source)] : []),
  ];
}

export const explainStage = (stage: Stage, method: Method): HTMLElement[] => shown(stages[stage](method));
export const explainTerm = (term: Term, method: Method): HTMLElement[] => shown(terms[term](method));
