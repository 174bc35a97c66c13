/** Formulas in MathML whose symbols have the colours of the figure, and sentences with such symbols in them. */

import { make } from "../dom";
import { phrase } from "../words";
import type { Ink } from "./protocol";

const SPACE = "http://www.w3.org/1998/Math/MathML";

/** A MathML element; strings become its text. */
export function math(tag: string, attributes: Record<string, string>, ...children: (Element | string)[]): Element {
  const element = document.createElementNS(SPACE, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/**
 * A letter in the italics of a text font. By itself a browser replaces it by a letter from the mathematical block of Unicode, which only
 * mathematics fonts have.
 */
const letter = (content: string, weight = ""): Element =>
  math("mi", { mathvariant: "normal", class: `learn-letter${weight}` }, content);
export const mi = (content: string): Element => (content.length > 1 ? math("mi", {}, content) : letter(content));
export const mn = (content: string): Element => math("mn", {}, content);
/** Brackets do not grow, because without a mathematics font browsers enlarge them at random. */
export const mo = (content: string): Element =>
  math("mo", "()||".includes(content) ? { stretchy: "false" } : {}, content);
export const row = (...children: Element[]): Element => math("mrow", {}, ...children);
export const sub = (base: Element, index: Element): Element => math("msub", {}, base, index);
export const sup = (base: Element, exponent: Element): Element => math("msup", {}, base, exponent);
export const frac = (up: Element, down: Element): Element => math("mfrac", {}, up, down);
export const sum = (below: Element): Element => math("munder", {}, mo("∑"), below);
/** The exponent belongs to the bracket, whose height does not depend on what is inside. */
export const squared = (...inside: Element[]): Element => row(mo("("), ...inside, sup(mo(")"), mn("2")));
export const norm = (inside: Element): Element => row(mo("||"), inside, sup(mo("||"), mn("2")));
/** The prime of a text font is raised by itself; as an exponent it would be raised twice. */
export const primed = (base: Element): Element => row(base, math("mtext", { class: "learn-prime" }, "′"));
export const changeOf = (quantity: Element): Element => row(math("mtext", {}, "Δ"), quantity);
/** The sign of a transposed vector, as a letter that every font has. */
export const transposed = (base: Element): Element => sup(base, math("mi", { mathvariant: "normal" }, "T"));

/** Space before and after, as in print; browsers add none. */
const space = (width: string): Element => math("mspace", { width });
export const log = (of: Element): Element => row(mi("log"), space("0.1667em"), of);
export const gradient = (of: Element): Element => row(mi("grad"), space("0.1667em"), of);
export const comma = (): Element => row(mo(","), space("0.6em"));

interface Symbol {
  make(): Element;
  ink: Ink;
  /** The meaning of the symbol, shown when the pointer rests on it. */
  name: string;
}

const bold = (name: string) => letter(name, " learn-bold");

/** Every symbol of the lessons, once. */
export const SYMBOLS = {
  n: { make: () => bold("n"), ink: "normal", name: "unit normal of the surface" },
  // It has no hat, which would mean a unit vector: its length is the square root of two.
  N: { make: () => bold("ñ"), ink: "normal", name: "unit normal with a fourth component 1" },
  m: { make: () => bold("m"), ink: "prior", name: "normal of the depth map at that point" },
  M: { make: () => sub(bold("M"), mi("j")), ink: "light", name: "light of colour j, a 4 by 4 matrix of 9 numbers" },
  l: { make: () => bold("l"), ink: "light", name: "unit vector to the lamp" },
  lj: { make: () => sub(bold("l"), mi("j")), ink: "light", name: "part of order 1 in colour j, a vector" },
  c: { make: () => sub(mi("c"), mi("j")), ink: "light", name: "part of order 0 in colour j, a number" },
  Q: { make: () => sub(bold("Q"), mi("j")), ink: "light", name: "part of order 2 in colour j, a 3 by 3 matrix" },
  E: { make: () => mi("E"), ink: "intensity", name: "intensity of the pixel" },
  x: { make: () => mi("x"), ink: "pixel", name: "place in the picture, to the right" },
  y: { make: () => mi("y"), ink: "pixel", name: "place in the picture, down" },
  p: { make: () => mi("p"), ink: "normal", name: "slope: change of the depth per step to the right" },
  q: { make: () => mi("q"), ink: "normal", name: "slope: change of the depth per step down" },
  map: { make: () => mi("R"), ink: "isophote", name: "reflectance map: the intensity for each pair of slopes" },
  s: { make: () => mi("s"), ink: "normal", name: "factor of all depths" },
  t: { make: () => mi("t"), ink: "normal", name: "added tilt" },
  rho: { make: () => mi("ρ"), ink: "albedo", name: "albedo" },
  L: { make: () => mi("L"), ink: "light", name: "light, 27 numbers" },
  a: { make: () => mi("a"), ink: "albedo", name: "logarithm of the albedo" },
  aj: { make: () => sub(mi("a"), mi("j")), ink: "albedo", name: "logarithm of the albedo in colour j" },
  S: { make: () => sub(mi("S"), mi("j")), ink: "colour", name: "intensity of colour j" },
  lambda: { make: () => mi("λ"), ink: "prior", name: "weight of the prior" },
  R: { make: () => bold("R"), ink: "pose", name: "rotation of the pose" },
  z: { make: () => mi("z"), ink: "truth", name: "depth" },
  d: { make: () => mi("d"), ink: "sensor", name: "depth measured by the sensor" },
  mu: { make: () => mi("μ"), ink: "sensor", name: "weight of the measured depth" },
  r: { make: () => mi("r"), ink: "error", name: "residual: the colours that the pose does not explain" },
  sigma: { make: () => mi("σ"), ink: "error", name: "standard deviation of the noise in log S" },
  sigmaR: { make: () => sub(mi("σ"), mi("R")), ink: "pose", name: "standard deviation of the rotation" },
  sigmaS: { make: () => sub(mi("σ"), mi("S")), ink: "error", name: "scatter of the log colours about the model" },
  sigmad: {
    make: () => sub(mi("σ"), mi("d")),
    ink: "sensor",
    name: "scatter of the measured depths: the sensor's noise",
  },
  j: { make: () => mi("j"), ink: "colour", name: "red, green or blue" },
  ej: {
    make: () => sub(mi("e"), mi("j")),
    ink: "error",
    name: "remainder in colour j that the model does not explain",
  },
} as const satisfies Record<string, Symbol>;

export type SymbolName = keyof typeof SYMBOLS;

/** A symbol in the colour that it has in the figure. */
export function symbol(name: SymbolName): Element {
  const { make: draw, ink, name: words } = SYMBOLS[name];
  return math(
    "mrow",
    { class: `learn-ink-${ink}`, title: phrase(`symbol.${name}`, words), "data-symbol": name },
    draw(),
  );
}

const hasColours = (formula: Element): boolean =>
  [...formula.querySelectorAll("mi")].some(({ textContent }) => textContent === "j");

/** The symbols of a formula with their meanings, in their order, and after them those of its text alone. */
export function symbolList(formula: Element, ofText: readonly SymbolName[] = []): HTMLElement {
  const found = [...formula.querySelectorAll("[data-symbol]")].map((each) => each.getAttribute("data-symbol") ?? "");
  const names = new Set([...found, ...(hasColours(formula) ? ["j"] : []), ...ofText]) as Set<SymbolName>;
  const items = [...names].map((name) => {
    const drawn = symbol(name);
    return make("li", {}, inline(drawn), ` ${drawn.getAttribute("title") ?? ""}`);
  });
  return make("ul", { class: "soft learn-symbols" }, ...items);
}

/** The shading of the model: the extended normal on both sides of the light's matrix. */
export const shading = (normal: () => Element = () => symbol("N")): Element =>
  row(transposed(normal()), symbol("M"), normal());
/** The squared difference of one colour of a pixel from its prediction. */
const mismatch = (normal?: () => Element): Element => squared(log(symbol("S")), mo("−"), shading(normal));
/** The cost of a normal by the colours alone. */
export const colourTerm = (normal?: () => Element): Element => row(sum(mi("j")), mismatch(normal));
/** The same over all pixels. */
export const overPixels = (): Element => row(sum(math("mtext", {}, phrase("pixels", "pixels"))), colourTerm());

export const inline = (...children: Element[]): Element => math("math", {}, row(...children));
export const block = (...children: Element[]): Element => math("math", { display: "block" }, row(...children));
/** Formulas below each other, because one line would be wider than the text of a small window. */
export const lines = (...blocks: Element[]): Element => make("div", {}, ...blocks);

/**
 * A sentence in which {n} is the symbol n, {−n_x} its negative component along x, {Δz} a change of z, {z′} a primed z, {link|address} a
 * link, and {=key} the value of the control with that key, which can be dragged.
 */
export function sentence(words: string): (Node | string)[] {
  return words.split(/(\{[^}]+\})/).map((part) => {
    // A number and its sign stay on one line.
    if (!part.startsWith("{")) return part.replace(/(\d) %/g, "$1\u00a0%");
    const inside = part.slice(1, -1);
    if (inside.startsWith("="))
      return make("span", {
        class: "learn-number",
        "data-control": inside.slice(1),
        title: phrase("drag", "Drag to the left or to the right"),
      });
    const [label = "", address] = inside.split("|");
    if (address !== undefined) return make("a", { href: address }, label);
    const [, sign, name = "", prime, index] = /^([−Δ]?)([^_′]+)(′?)(?:_(.+))?$/.exec(inside) ?? [];
    if (!(name in SYMBOLS)) return inside;
    const plain = symbol(name as SymbolName);
    const drawn = prime ? primed(plain) : plain;
    const whole = index ? sub(drawn, mi(index)) : drawn;
    return inline(...(sign === "Δ" ? [changeOf(whole)] : sign ? [mo(sign), whole] : [whole]));
  });
}
