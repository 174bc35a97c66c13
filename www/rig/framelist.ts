/** Frames: which colour image and which depth map were taken at the same moment, and which part of them is used. */

import { make } from "../dom";
import { choose, draw, fill, Keyed, press, THUMB } from "./parts";
import { subjectOf } from "./framemask";
import type { MaskTool } from "./masktool";
import type { Frame, Item, Rig } from "./rig";

type Role = "colour" | "depth" | "mask";

const titles: Record<Role, string> = { colour: "Colour image", depth: "Depth map", mask: "Mask" };

export class FrameList {
  readonly element = make("ul", { class: "rig-frames", "aria-label": "Frames" });
  readonly #rig: Rig;
  readonly #rows: Keyed<Frame>;
  readonly #tool: () => Promise<MaskTool>;

  constructor(rig: Rig, tool: () => Promise<MaskTool>) {
    this.#rig = rig;
    this.#tool = tool;
    this.#rows = new Keyed(this.element, (frame) => this.#row(frame));
  }

  show(): void {
    this.#rows.show(this.#rig.frames);
    this.element.hidden = this.#rig.frames.length === 0;
  }

  #row(frame: Frame): { element: HTMLElement; show(frame: Frame): void } {
    const rig = this.#rig;
    const canvases = {
      colour: make("canvas", { class: "rig-thumb", "aria-hidden": "true" }),
      depth: make("canvas", { class: "rig-thumb", "aria-hidden": "true" }),
    };
    const name = make("strong");
    const state = make("p", { class: "soft" });
    const select = (role: Role) =>
      choose([], "", (value) => {
        if (value === "") delete frame[role];
        else frame[role] = Number(value);
        if (role === "colour") delete frame.paint;
        rig.changed();
      });
    const selects: Record<Role, HTMLSelectElement> = {
      colour: select("colour"),
      depth: select("depth"),
      mask: select("mask"),
    };
    const boxes = (Object.keys(selects) as Role[]).map((role) =>
      make("label", { class: "rig-choice", "data-role": role }, make("span", {}, titles[role]), selects[role]),
    );
    const restrict = press(
      "Restrict what is used",
      () => {
        const subject = subjectOf(rig, frame);
        if (subject)
          void this.#tool().then(
            (tool) => tool.open(subject),
            () => {},
          );
      },
      { "aria-haspopup": "dialog" },
    );
    const remove = press("×", () => rig.removeFrame(frame), { class: "icon", "aria-label": `Remove ${frame.name}` });
    const element = make(
      "li",
      { class: "rig-frame" },
      make("div", { class: "rig-pair" }, canvases.colour, canvases.depth),
      make("div", { class: "rig-frame-words" }, name, state),
      make("div", { class: "rig-row rig-corrections" }, ...boxes, restrict, remove),
    );
    const drawn = { colour: "", depth: "" };
    return {
      element,
      show: () => {
        name.textContent = frame.name;
        state.textContent = describe(rig, frame);
        state.classList.toggle("rig-error", frame.colour === undefined || frame.depth === undefined);
        for (const role of Object.keys(selects) as Role[]) {
          const files = rig.of(role).map(({ id, name }) => ({ value: String(id), label: name }));
          fill(
            selects[role],
            [{ value: "", label: role === "mask" ? "none" : "missing" }, ...files],
            String(frame[role] ?? ""),
          );
        }
        (boxes.at(-1) as HTMLElement).hidden = rig.of("mask").length === 0;
        restrict.disabled = frame.colour === undefined;
        for (const role of ["colour", "depth"] as const) this.#draw(canvases[role], rig.item(frame[role]), drawn, role);
      },
    };
  }

  #draw(
    canvas: HTMLCanvasElement,
    item: Item | undefined,
    drawn: Record<"colour" | "depth", string>,
    role: "colour" | "depth",
  ): void {
    const wanted = item?.state === "read" ? `${item.id} ${item.summary?.kind}` : "";
    if (drawn[role] === wanted) return;
    drawn[role] = wanted;
    canvas.getContext("2d")?.clearRect(0, 0, canvas.width, canvas.height);
    if (item && wanted)
      void this.#rig.session.call("picture", { file: item.id, width: THUMB }).then(
        (bitmap) => drawn[role] === wanted && draw(canvas, bitmap),
        () => {},
      );
  }
}

function describe(rig: Rig, { colour, depth, mask, paint, range }: Frame): string {
  if (colour === undefined) return "A colour image is missing.";
  if (depth === undefined) return "A depth map is missing.";
  const size = (id: number) => {
    const summary = rig.item(id)?.summary;
    return `${summary?.width}×${summary?.height} px`;
  };
  const limits = [
    ...(mask === undefined ? [] : ["mask file"]),
    ...(paint
      ? [
          `${((100 * paint.reduce((sum, value) => sum + (value ? 1 : 0), 0)) / paint.length).toFixed(0)} % of the image, as drawn`,
        ]
      : []),
    ...(range ? [`depths from ${range[0]} to ${range[1]} m`] : []),
  ];
  return `Colour ${size(colour)}, depth ${size(depth)}; ${limits.length === 0 ? "all of it is used." : `used: ${limits.join(", ")}.`}`;
}
