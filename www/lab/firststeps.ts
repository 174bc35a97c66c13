/** The four steps of the path for own files, made of parts that the settings lend. */

import { make } from "../dom";
import { expectations } from "./expect";
import { lookAt } from "./look";
import type { Settings } from "./settings";
import type { Files, Slot } from "./storage";

export interface Hooks {
  files(): Files;
  settings(): Settings;
  /** Calls back after changes of files or fields. */
  listen(onChange: () => void): void;
  placeOf(slot: Slot): HTMLElement | null | undefined;
  notes(): HTMLElement | null;
  /** Sorts files, as if they had been dropped. */
  drop(files: File[]): void;
  replace(files: Files): void;
  draw(side: "colour" | "depth"): void;
  /** What keeps the pair from being run, in words; empty if nothing does. */
  trouble(): string;
  run(): void;
  /** Draws a step's thumbnail. */
  thumbnail(step: number, canvas: HTMLCanvasElement): void;
}

export const STEPS = [
  { name: "picture", title: "Picture" },
  { name: "depth", title: "Depth" },
  { name: "masks", title: "Masks" },
  { name: "go", title: "Go" },
] as const;
export type StepName = (typeof STEPS)[number]["name"];

/** Parts of the settings that are shown elsewhere for a while. */
export class Borrowed {
  #back: (() => void)[] = [];

  show(element: HTMLElement | null | undefined, parent: HTMLElement): void {
    if (!element) return;
    const mark = document.createComment("");
    element.replaceWith(mark);
    parent.append(element);
    this.#back.push(() => mark.replaceWith(element));
  }

  giveBack(): void {
    for (const back of this.#back.reverse()) back();
    this.#back = [];
  }
}

const field = (key: string): HTMLElement | null => document.querySelector(`#lab [data-key="${key}"]`);
/** The fields of a camera, folded. */
const camera = (side: "colour" | "depth"): HTMLElement | null | undefined =>
  document.getElementById(`fields-${side}`)?.closest("details");

const soft = (words: string): HTMLElement => make("p", { class: "soft" }, words);

const short = (value: number): string => String(Number(value.toPrecision(3)));

/** The range of depths in the present unit. */
async function rangeInWords({ depth }: Files, settings: Settings): Promise<string> {
  if (!depth) return "";
  const { measured } = await lookAt(depth);
  if (!measured) return "";
  const stored = measured.range.map(short).join(" to ");
  const { unit } = settings;
  if (settings.meaning === "inverse") return `Stored numbers ${stored}; larger is nearer.`;
  if (typeof unit !== "number") return `Stored numbers ${stored}. Without a camera, one unit is one pixel.`;
  const unitName = settings["depth.fx"] === null ? "pixels" : "m";
  const metres = measured.range.map((value) => short(value * unit)).join(" to ");
  return `Stored numbers ${stored}, which is ${metres} ${unitName}. Was the object that far away? If not, change the unit.`;
}

async function expected(files: Files, settings: Settings): Promise<{ words: string; isDoubt: boolean }[]> {
  const { colour, depth, colourMask, depthMask } = files;
  if (!colour || !depth) return [];
  const [first, second] = await Promise.all([lookAt(colour), lookAt(depth)]);
  const [fx, depthFx] = [settings["colour.fx"], settings["depth.fx"]];
  const isBoth = typeof fx === "number" && typeof depthFx === "number";
  return expectations({
    colour: first,
    depth: second,
    masks: { colour: colourMask !== undefined, depth: depthMask !== undefined },
    cameras: { colour: typeof fx === "number", depth: typeof depthFx === "number" },
    ...(isBoth ? { focal: { colour: fx, depth: depthFx } } : {}),
  });
}

function gallery(hooks: Hooks): HTMLElement {
  const cards = make("div", { class: "renders" });
  const element = make(
    "details",
    {},
    make("summary", {}, "No pictures at hand? Six rendered pairs"),
    soft(
      "Renders, not photographs: bodies that the project has modelled, seen through a model of a depth sensor with noise, steps, holes and shadows. Each card says how its run ends.",
    ),
    cards,
  );
  element.addEventListener("toggle", () => {
    if (!element.open) return;
    // The cards open below the end of the dialog.
    const reveal = () => element.scrollIntoView({ block: "start" });
    if (cards.childElementCount > 0) return reveal();
    void import("./rendered").then(({ showGallery }) => {
      showGallery(cards, (files) => hooks.drop(files));
      reveal();
    });
  });
  return element;
}

/** A button that takes several files of any kind at once, for devices without drag and drop. */
function several(hooks: Hooks): HTMLElement {
  const picker = make("input", { type: "file", multiple: true, class: "visually-hidden", id: "first-run-all" });
  picker.addEventListener("change", () => {
    const files = [...(picker.files ?? [])];
    picker.value = "";
    if (files.length > 0) hooks.drop(files);
  });
  return make(
    "div",
    { class: "several" },
    picker,
    make("label", { class: "button", for: picker.id }, "Choose several files at once"),
  );
}

function press(label: string, action: () => void): HTMLButtonElement {
  const button = make("button", { type: "button" }, label);
  button.addEventListener("click", action);
  return button;
}

/** The parts of the steps that the path makes itself. */
function partsOf(hooks: Hooks) {
  const lent = () => make("div", { class: "lent" });
  const places = { picture: lent(), depth: lent(), masks: lent() };
  const range = make("p", { class: "range", role: "status" });
  const doubts = make("ul", { class: "expect" });
  const drawColour = press("Draw on the picture", () => hooks.draw("colour"));
  const drawDepth = press("Draw on the depth map, or restrict its depths", () => hooks.draw("depth"));
  const section = (label: string, ...parts: Node[]) => make("section", { "aria-label": label }, ...parts);
  const bodies = {
    picture: section("Picture", soft(PICTURE), places.picture, several(hooks), gallery(hooks)),
    depth: section("Depth", soft(DEPTH), places.depth, range),
    masks: section("Masks", soft(MASKS), places.masks, make("p", { class: "row" }, drawColour, drawDepth)),
    go: section("Go", make("h3", {}, "What to expect"), doubts),
  };
  return { bodies, places, range, doubts, drawColour, drawDepth };
}

const PICTURE =
  "One colour picture of one object. Drop it anywhere, with everything else that you have, or choose it. Nothing leaves your device.";
const DEPTH = "A depth map of the same object, best from another viewpoint 10 to 40 degrees away.";
const MASKS =
  "Which pixels show the object. Without masks, black counts as background in the picture, and the largest connected piece of the depth map as the object.";

export function stepsOf(
  hooks: Hooks,
  borrowed: Borrowed,
  onShown: () => void,
): { bodies: Record<StepName, HTMLElement>; show(step: StepName): void } {
  const { bodies, places, range, doubts, drawColour, drawDepth } = partsOf(hooks);
  /** Only the newest answer is shown. */
  let turn = 0;
  const refresh = async (): Promise<void> => {
    const now = ++turn;
    const [files, settings] = [hooks.files(), hooks.settings()];
    drawColour.disabled = !files.colour;
    drawDepth.disabled = !files.depth;
    const [words, found] = await Promise.all([rangeInWords(files, settings), expected(files, settings)]);
    if (now !== turn) return;
    range.textContent = words;
    doubts.replaceChildren(
      ...found.map(({ words: each, isDoubt }) => make("li", isDoubt ? { class: "doubt" } : {}, each)),
    );
    onShown();
  };
  const show = (step: StepName): void => {
    const lend = (element: HTMLElement | null | undefined) => step !== "go" && borrowed.show(element, places[step]);
    if (step === "picture") [hooks.placeOf("colour"), field("transfer"), camera("colour")].forEach(lend);
    if (step === "depth")
      [hooks.placeOf("depth"), field("unit"), field("meaning"), field("numerator"), camera("depth")].forEach(lend);
    if (step === "masks") [hooks.placeOf("colourMask"), hooks.placeOf("depthMask")].forEach(lend);
    // The last step already says the same as the notes.
    if (step !== "go") borrowed.show(hooks.notes(), bodies[step]);
    void refresh();
  };
  hooks.listen(() => void refresh());
  return { bodies, show };
}
