/** The sources of a lesson's method, as links to other sites: nothing is requested before a click. */

import { make } from "../dom";
import { phrase } from "../words";

/** The paper, at an address that everybody can read. */
const PAPER = "https://arxiv.org/abs/1905.06499";
const DOCS = "https://github.com/bimodal-stereo/bimodal-stereo/blob/main/docs";

/** The sections of the method that lessons refer to: their file in `docs/` and their heading. */
const SECTIONS = {
  imageModel: ["method/image-model.md", "The image model"],
  light: ["method/image-model.md", "The light and its prior"],
  normals: ["method/normals.md", "Normals of single pixels"],
  integration: ["method/normals.md", "Integration of gradients"],
  refinement: ["method/heights.md", "Refinement of the depth map"],
  search: ["method/search.md", "Search over poses"],
  registration: ["method/registration.md", "Photometric registration"],
  loop: ["method/loop.md", "The loop, its objective and its end"],
  uncertainty: ["method/uncertainty.md", "Uncertainty"],
  protocols: ["lab/protocols.md", "Protocols of the experiments"],
} as const;

export interface References {
  sections: readonly (keyof typeof SECTIONS)[];
  /** The parts of the paper, such as sections and equations. */
  paper?: string;
  /** The original publication on the subject, by its DOI. */
  others?: readonly (readonly [doi: string, words: string])[];
}

/** The anchor of a heading in an address. */
const anchor = (heading: string): string =>
  heading
    .toLowerCase()
    .replace(/[^\w\s-]/g, "")
    .replace(/\s/g, "-");

/** The page for teachers, in the documents. */
export const teachersLink = (): HTMLAnchorElement =>
  make("a", { href: `${DOCS}/guide/learn.md` }, phrase("teachers", "For teachers"));

export function referencesOf({ sections, paper, others = [] }: References): HTMLElement {
  const links = [
    ...(paper
      ? [make("a", { href: PAPER }, phrase("references.paper", "The paper, {places}", { places: paper }))]
      : []),
    ...sections.map((name) => {
      const [file, heading] = SECTIONS[name];
      const words = make("span", { lang: "en" }, heading);
      return make(
        "a",
        { href: `${DOCS}/${file}#${anchor(heading)}` },
        phrase("references.method", "The method:"),
        " ",
        words,
      );
    }),
    ...others.map(([doi, words]) => make("a", { href: `https://doi.org/${doi}`, lang: "en" }, words)),
  ];
  return make("ul", { class: "soft learn-more" }, ...links.map((link) => make("li", {}, link)));
}
