/** Four slots for the visitor's own files: dropped anywhere on them, or picked. */

import { freshId, make } from "../dom";

export type Slot = "colour" | "depth" | "colourMask" | "depthMask";

const slots: readonly { slot: Slot; label: string; accept: string; hint: string; paths: readonly string[] }[] = [
  { slot: "colour", label: "Colour image", accept: ".png,.jpg,.jpeg,.webp,image/*", hint: "PNG or JPEG, 8 or 16 bit", paths: ["image", "image.data"] },
  { slot: "depth", label: "Depth map", accept: ".png,.npy", hint: "16-bit PNG, or .npy of float32 or uint16", paths: ["depth", "depth.data"] },
  { slot: "colourMask", label: "Colour mask", accept: ".png,image/*", hint: "optional PNG; black is background", paths: ["image.mask"] },
  { slot: "depthMask", label: "Depth mask", accept: ".png,image/*", hint: "optional PNG; black is background", paths: ["depth.mask"] },
];

interface Entry {
  zone: HTMLElement;
  name: HTMLElement;
  note: HTMLElement;
  clear: HTMLButtonElement;
  paths: readonly string[];
}

export class Intake {
  readonly element: HTMLElement;
  #files: Partial<Record<Slot, File>> = {};
  #entries = new Map<Slot, Entry>();
  readonly #onChange: () => void;

  constructor(onChange: () => void) {
    this.#onChange = onChange;
    this.element = make("div", { class: "intake" });
    for (const each of slots) this.#build(each);
  }

  get files(): Partial<Record<Slot, File>> {
    return this.#files;
  }

  /** Puts an error beside the slot that the library's path belongs to; false when none does. */
  complain(path: string, message: string): boolean {
    return this.#say(path, message, true);
  }

  /** A remark that is no error, such as that the picture was scaled down. */
  remark(path: string, message: string): boolean {
    return this.#say(path, message, false);
  }

  clearMessages(): void {
    for (const { note, zone } of this.#entries.values()) {
      note.hidden = true;
      note.textContent = "";
      zone.removeAttribute("data-invalid");
    }
  }

  #say(path: string, message: string, isError: boolean): boolean {
    const entry = [...this.#entries.values()].find(({ paths }) => paths.includes(path));
    if (!entry) return false;
    entry.note.textContent = message;
    entry.note.hidden = false;
    entry.note.classList.toggle("error", isError);
    entry.zone.toggleAttribute("data-invalid", isError);
    return true;
  }

  #build({ slot, label, accept, hint, paths }: (typeof slots)[number]): void {
    const id = freshId("file");
    const picker = make("input", { id, type: "file", accept, class: "visually-hidden", "aria-label": label, "aria-describedby": `${id}-note` });
    const name = make("span", { class: "file-name" }, hint);
    const zone = make("label", { class: "drop", for: id }, make("strong", {}, label), name);
    const clear = make("button", { type: "button", class: "quiet", "aria-label": `Remove ${label.toLowerCase()}`, hidden: true }, "×");
    const note = make("p", { class: "note", id: `${id}-note`, hidden: true });
    this.#entries.set(slot, { zone, name, note, clear, paths });
    this.element.append(make("div", { class: "slot" }, picker, zone, clear, note));

    picker.addEventListener("change", () => {
      const file = picker.files?.[0];
      if (file) this.#put(slot, file);
      picker.value = ""; // so that the same file, mended on disk, can be picked again
    });
    clear.addEventListener("click", () => this.#put(slot, undefined));
    zone.addEventListener("dragover", (event) => {
      event.preventDefault();
      zone.toggleAttribute("data-over", true);
    });
    zone.addEventListener("dragleave", () => zone.removeAttribute("data-over"));
    zone.addEventListener("drop", (event) => {
      event.preventDefault();
      event.stopPropagation();
      zone.removeAttribute("data-over");
      const file = event.dataTransfer?.files[0];
      if (file) this.#put(slot, file);
    });
  }

  /** Several files at once, which are looked at together. */
  putAll(files: ReadonlyMap<Slot, File>): void {
    for (const [slot, file] of files) this.#set(slot, file);
    this.#onChange();
  }

  #put(slot: Slot, file: File | undefined): void {
    this.#set(slot, file);
    this.#onChange();
  }

  #set(slot: Slot, file: File | undefined): void {
    const entry = this.#entries.get(slot);
    if (!entry) return;
    if (file) this.#files[slot] = file;
    else delete this.#files[slot];
    const hint = slots.find((each) => each.slot === slot)?.hint ?? "";
    entry.name.textContent = file ? `${file.name} (${size(file.size)})` : hint;
    entry.zone.toggleAttribute("data-filled", file !== undefined);
    entry.clear.hidden = file === undefined;
  }
}

const size = (bytes: number): string => (bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`);
