/** The page's canvases as pictures to save, including those drawn in a separate thread. */

import { ink, make } from "../dom";

export interface Shown {
  title: string;
  /** The names of a chart's curves, which stand beside its canvas. */
  words: string | undefined;
  canvas: HTMLCanvasElement;
}

/** The title of a figure: its caption, the heading of its section, or the first words of its description for screen readers. */
function titleOf(canvas: HTMLCanvasElement): string {
  const said = canvas.getAttribute("aria-label")?.split(/[:.]/)[0];
  const figure = canvas.closest("figure")?.querySelector(".view-title")?.textContent;
  const section = canvas.closest("section")?.querySelector("h2")?.firstChild?.textContent;
  return (figure || said || section || "Picture").trim();
}

/** All canvases that are on the page now, in its order. */
export function shownIn(root: HTMLElement): Shown[] {
  const all = [...root.querySelectorAll("canvas")].filter(
    (canvas) =>
      canvas.getAttribute("aria-hidden") !== "true" &&
      !canvas.closest(".drawer") &&
      canvas.width > 1 &&
      canvas.checkVisibility({ visibilityProperty: true }),
  );
  return all.map((canvas) => ({
    title: titleOf(canvas),
    words: canvas.closest(".chart")?.getAttribute("aria-label") ?? undefined,
    canvas,
  }));
}

/** The pictures that can be saved now. */
export function offerPictures(root: HTMLElement, select: HTMLSelectElement): void {
  const titles = shownIn(root).map(({ title }) => title);
  const before = select.value;
  if (titles.join("\n") === [...select.options].map(({ value }) => value).join("\n")) return;
  select.replaceChildren(...titles.map((title) => make("option", { value: title }, title)));
  if (titles.includes(before)) select.value = before;
}

/** A copy of the canvas on the page's background, because curves may be invisible on another one. */
function flat(canvas: HTMLCanvasElement): HTMLCanvasElement {
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext("2d");
  if (!context) throw new Error("This browser provides no canvas to draw the picture.");
  context.fillStyle = ink("card");
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(canvas, 0, 0, copy.width, copy.height);
  return copy;
}

export function pngOf(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) =>
    flat(canvas).toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error("This browser could not create the picture."))),
      "image/png",
    ),
  );
}

/** Saved as a blob, which the browser encodes in a separate thread. */
export async function dataUrlOf(canvas: HTMLCanvasElement): Promise<string> {
  const blob = await pngOf(canvas);
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(String(reader.result));
    reader.onerror = () => reject(reader.error ?? new Error("This browser could not create the picture."));
    reader.readAsDataURL(blob);
  });
}
