/** Explanations that fit the method that runs, with formulas. Loaded with the first question. */

import type { Stage } from "../../pkg/index.js";
import { make } from "../dom";

/** What the explanations depend on. */
export interface Method {
  shading: "surface" | "pixel";
  registration: "joint" | "icp" | "fixed";
  lightIsKnown: boolean;
  searches: boolean;
}

/** Numbers of the page that have an explanation. */
export type Term = "overlap" | "inliers" | "residual" | "change" | "sigma" | "weakest" | "objective";

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
const squared = (...parts: string[]) => sup(row(o("‖"), ...parts, o("‖")), "<mn>2</mn>");
const least = (what: string) => `<munder><mi>min</mi>${what}</munder>`;
const sum = o("∑");
/** A term in the colour of its curve in the chart. */
const term = (series: 1 | 2 | 3 | 4, ...parts: string[]) => `<mrow class="series-${series}">${parts.join("")}</mrow>`;
const math = (...parts: string[]) => `<math display="block">${parts.join("")}</math>`;

/** Around the name of a function, which browsers set close. */
const space = "<mspace width='0.1667em'></mspace>";
const logS = row(i("log"), space, i("S"));
const n = bold("n");
const nR = sub(bold("n"), i("R"));
const R = bold("R");
const model = (normal: string) => row(i("B"), o("("), normal, o(")"), i("L"));
const lambda = (index: string) => sub(i("λ"), `<mn>${index}</mn>`);
const unit = row(o("+"), lambda("3"), sup(row(o("("), sup(n, i("⊤")), n, o("−"), "<mn>1</mn>", o(")")), "<mn>2</mn>"));

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
    "Where nothing is known of the pose, rotations from all over are tried on a coarse grid, every shift of each at once by a Fourier transform; V counts the points that both views see. The best candidates are registered by their colours; the loop starts from the one that leaves the least noise, and those that explain nearly as much are reported as its rivals. The surface moves to the best candidate so far.",
  source: "Before Algorithm 1; not in the paper",
};

function light({ lightIsKnown }: Method): Text {
  const formula = math(logS, o("="), sup(n, i("⊤")), bold("M"), n, o("="), model(n));
  if (lightIsKnown) {
    return {
      title: "Light, known",
      formula,
      words:
        "The 27 numbers L were told and stay as they are; only the exposure of the picture, one offset of its logarithm, is found, along with the normals.",
      source: "Equations 3 and 5",
    };
  }
  return {
    title: "Light",
    formula,
    words:
      "With the normals held, the logarithm of every colour is linear in 27 numbers L, nine spherical harmonics for each channel. They are fitted by robust least squares; a Gaussian learned from natural lights says which are likely.",
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
        "With light and pose held, each pixel of the image looks for the normal that explains its three colours, stays close to the normal that the depth map has at the corresponding point, and has length one. Nothing ties it to its neighbours.",
      source: "Equations 6 to 9",
    };
  }
  return {
    title: "Shading, each pixel first",
    formula: pixel,
    words:
      "With light and pose held, each pixel looks for the normal that explains its three colours and is close to the depth map's. Under nearly white light that leaves many normals open: the surface of the next stage decides between them.",
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
        "Normals are slopes. The depth whose slopes fit them best, in least squares over the object's pixels, turns the normals of the image into a surface that can be compared with the depth map.",
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
      "The unknowns are the heights themselves, so that every normal belongs to one surface. They explain the colours, and follow the slopes g that the pixels' own normals give, each by how well its colours determine it.",
    source: "In the place of Equations 4, 10 and 11; not in the paper",
  };
}

function registration({ registration }: Method): Text {
  if (registration === "fixed")
    return {
      title: "Registration, none",
      words: "The pose is kept as it was at the start. Shapes and light are found under it.",
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
        "As in the paper, the depth map's points are moved onto the image's surface: nearest neighbours first, then a robust fit of twelve linear parameters, from which the scale s, the rotation R and the shift t are taken apart.",
      source: "Equations 12 to 16",
    };
  }
  return {
    title: "Registration by colours",
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
      "The image's own surface is not asked: the depth map is turned until its normals predict the colours at the places where its points fall, the light following along. ρ discards what disagrees; it starts tolerant and becomes strict. A painted object is compared by the contrast around each place and by its outline instead; then the paint that is found under the pose is taken off, and the pose follows.",
    source: "In the place of Equations 12 to 14; not in the paper",
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
    "Where both views overlap, the colours correct the depth map's own normals, and the normals its depth, which is anchored where it was measured: noise goes down and holes are filled. The next iteration starts from the better map.",
  source: "Equations 17 to 19",
};

const terms: Readonly<Record<Term, (method: Method) => Text>> = {
  overlap: () => ({
    title: "Overlap",
    words:
      "Share of the depth map's pixels that the colour camera sees under this pose. Below 5 % nothing can be said.",
  }),
  inliers: () => ({
    title: "Inliers",
    words:
      "Share of these whose colours or distances agree with the pose, as far as the noise explains. Below 40 % the pose is not trusted.",
  }),
  residual: () => ({
    title: "Colour residual",
    formula: math(o("‖"), logS, o("−"), model(n), o("‖")),
    words:
      "How far the predicted colours are from the image, in natural logarithms: 0.01 is one percent. A robust mean; the view of the same name shows it pixel by pixel.",
  }),
  change: ({ registration }) => ({
    title: "Rotation change",
    words: `By how much the last iteration turned the depth map. ${registration === "icp" ? "ICP ends once it proposes less than the setting Stop below." : "It falls to zero once the registration by colours has settled."}`,
  }),
  sigma: () => ({
    title: "σ, the uncertainty",
    words:
      "One standard deviation of each part of the pose, from how sharply the colours (or surfaces) determine it. It knows noise, not what the model leaves out: shadows, paint, or a rival pose elsewhere. So a lost pose has none.",
  }),
  weakest: () => ({
    title: "The weakest direction",
    words:
      "The turn that changes the picture least. More noise, or a rounder object, and it is the first that can't be seen.",
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
      "ℓ₁: colours against the image's normals. ℓ₂: these against the depth map's. f: distance of both surfaces. g: colours against the depth map's normals as measured. Each is a robust mean; the sum decides whether an iteration is kept.",
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
  // Markup of this file alone.
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
