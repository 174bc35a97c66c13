/** Advice on a good scene, given before anything is measured, with two drawings. */

import { make } from "../dom";
import { svg } from "./parts";

/** Two cameras and a scene in front of them, seen from above. The caption explains the drawing. */
function drawing(...scene: SVGElement[]): SVGElement {
  const camera = (x: number, kind: string) =>
    svg(
      "g",
      { class: `ink-${kind}` },
      svg("rect", { x: x - 9, y: 104, width: 18, height: 11, rx: 2 }),
      svg("path", { d: `M${x - 4} 104l-3-6h14l-3 6z` }),
    );
  const sight = svg("path", { class: "sight", d: "M88 98L34 20M88 98L150 20M112 98L50 20M112 98L166 20" });
  return svg(
    "svg",
    { viewBox: "0 0 200 122", "aria-hidden": "true" },
    sight,
    ...scene,
    camera(88, "image"),
    camera(112, "depth"),
  );
}

const wall = () =>
  svg("path", {
    class: "wall",
    d: "M20 20H180M20 20l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7m10 7l6-7",
  });

function good(): SVGElement {
  const sheet = svg("path", {
    class: "thing",
    d: "M66 58c4-10 9-2 13-9s8 8 13 0 9-9 13 1 8-8 13-1 9 6 12 2c4 6 2 12 1 14-18 3-44 4-64 1-1-3-2-5-1-8z",
  });
  const gap = svg("g", { class: "measure" }, svg("path", { d: "M140 24v28M137 27l3-3 3 3M137 49l3 3 3-3" }));
  const text = svg("text", { x: 147, y: 42 });
  text.textContent = "0.3 m";
  return drawing(wall(), gap, text, sheet);
}

const poor = (): SVGElement => drawing(wall());

export function advice(): HTMLElement {
  const figure = (picture: SVGElement, kind: string, ...caption: (Node | string)[]) =>
    make("figure", { class: kind }, picture as unknown as HTMLElement, make("figcaption", {}, ...caption));
  return make(
    "section",
    { class: "rig-card rig-advice" },
    make("h3", {}, "What makes a good scene"),
    make(
      "div",
      { class: "rig-figures" },
      figure(good(), "good", make("strong", {}, "Good: "), "an object with edges and folds, and free space behind it"),
      figure(poor(), "poor", make("strong", {}, "Poor: "), "a bare wall looks the same after a small sideways shift"),
    ),
    make(
      "ul",
      {},
      make("li", {}, "A matte object of one colour, such as crumpled paper or a sheet draped over a chair."),
      make("li", {}, "A background about 0.3 m behind it, so that its silhouette is visible to both cameras."),
      make("li", {}, "Nothing shiny, mirrored or transparent; nothing that moves."),
      make(
        "li",
        {},
        "With a LiDAR: a street or a hall with edges near and far; drive on or turn the vehicle between frames.",
      ),
      make(
        "li",
        {},
        "Three frames with the object turned by about 30° are better than one. Record both cameras at the same moment.",
      ),
    ),
  );
}
