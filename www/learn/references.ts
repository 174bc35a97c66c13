/** Where a lesson's method is written down, as links out of the page: nothing is requested before a click. */

import { make } from "../dom";

/** The paper, where everybody may read it. */
const PAPER = "https://arxiv.org/abs/1905.06499";
const DOCS = "https://github.com/bimodal-stereo/bimodal-stereo/blob/main/docs";

/** The sections of the method that lessons refer to, with their headings. */
const SECTIONS = {
  2: "The image model",
  3: "The light and its prior",
  5: "Normals of single pixels",
  6: "Integration of gradients",
  8: "Refinement of the depth map",
  9: "Initialisation: search over poses",
  10: "Registration by colours",
  13: "The loop, its objective and its end",
  14: "Uncertainty",
  15: "Experimental protocols",
} as const;

export interface References {
  sections: readonly (keyof typeof SECTIONS)[];
  /** What of the paper. */
  paper?: string;
  /** The original publication on the subject, by its DOI. */
  others?: readonly (readonly [doi: string, words: string])[];
}

/** The name that a heading has in an address. */
const anchor = (heading: string): string =>
  heading
    .toLowerCase()
    .replace(/[^\w\s-]/g, "")
    .replace(/\s/g, "-");

export function referencesOf({ sections, paper, others = [] }: References): HTMLElement {
  const links = [
    ...(paper ? [make("a", { href: PAPER }, `The paper, ${paper}`)] : []),
    ...sections.map((number) =>
      make(
        "a",
        { href: `${DOCS}/method.md#${anchor(`${number} ${SECTIONS[number]}`)}` },
        `The method, ${number}: ${SECTIONS[number]}`,
      ),
    ),
    ...others.map(([doi, words]) => make("a", { href: `https://doi.org/${doi}` }, words)),
  ];
  return make("ul", { class: "soft learn-more" }, ...links.map((link) => make("li", {}, link)));
}
