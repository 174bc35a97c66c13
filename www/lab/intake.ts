/** Four slots for the visitor's own files: dropped anywhere, or picked. `look.ts`, loaded with the first file, recognises what a file holds. */

import { freshId, make } from "../dom";
import type { Look } from "./look";
import type { Offer } from "./offer";
import type { Slot } from "./storage";

const slots: readonly { slot: Slot; label: string; accept: string; hint: string; paths: readonly string[] }[] = [
  {
    slot: "colour",
    label: "Colour image",
    accept: ".png,.npy,.tif,.tiff,.exr,.ppm,image/*",
    hint: "PNG, JPEG, WebP, TIFF, EXR, PPM, .npy",
    paths: ["image", "image.data"],
  },
  {
    slot: "depth",
    label: "Depth map",
    accept: ".png,.npy,.tif,.tiff,.exr,.pfm,.pgm,.ply,.pcd",
    hint: "PNG, .npy, TIFF, EXR, PFM, PGM, PLY, PCD",
    paths: ["depth", "depth.data"],
  },
  {
    slot: "colourMask",
    label: "Colour mask",
    accept: ".png,.npy,.tif,.tiff,.pgm,image/*",
    hint: "optional; black is background",
    paths: ["image.mask"],
  },
  {
    slot: "depthMask",
    label: "Depth mask",
    accept: ".png,.npy,.tif,.tiff,.pgm,image/*",
    hint: "optional; black is background",
    paths: ["depth.mask"],
  },
];

interface Entry {
  zone: HTMLElement;
  name: HTMLElement;
  note: HTMLElement;
  clear: HTMLButtonElement;
  thumb: HTMLCanvasElement;
  says: HTMLElement;
  paths: readonly string[];
}

/** A remark about the files, with a possible action. */
export interface Remark {
  words: string;
  wrong: boolean;
  action?: { label: string; press(): void };
}

/** Topics of remarks: dropped files, the pair, its cameras. */
const TOPICS = ["files", "pair", "cameras"] as const;
type Topic = (typeof TOPICS)[number];

export interface IntakeHooks {
  /** Called when the files have changed. */
  onChange(): void;
  onForget(): void;
}

export class Intake {
  readonly element: HTMLElement;
  #files: Partial<Record<Slot, File>> = {};
  #entries = new Map<Slot, Entry>();
  #said: Partial<Record<Topic, readonly Remark[]>> = {};
  readonly #hooks: IntakeHooks;
  readonly #offer = make("p", { class: "offer", role: "status" });
  readonly #remarks = make("ul", { class: "remarks", hidden: true });
  readonly #keeping = make("span", {});
  readonly #forget = make("button", { type: "button", hidden: true }, "Remove my files");

  constructor(hooks: IntakeHooks) {
    this.#hooks = hooks;
    this.element = make("div", { class: "intake" });
    for (const each of slots) this.#build(each);
    this.#forget.addEventListener("click", () => {
      this.replaceAll({});
      this.silence();
      this.#hooks.onForget();
    });
    // Notes are below the slots, which therefore do not move; one that needs an answer is scrolled into view.
    this.element.append(
      make("div", { class: "said" }, this.#offer, this.#remarks),
      make("p", { class: "note keeping", role: "status" }, this.#keeping),
      this.#forget,
    );
  }

  get files(): Partial<Record<Slot, File>> {
    return this.#files;
  }

  /** The element of a slot, or the element with the messages about all slots. The short path through the files borrows these elements. */
  placeOf(slot: Slot): HTMLElement | null | undefined {
    return this.#entries.get(slot)?.zone.parentElement;
  }
  get notes(): HTMLElement | null {
    return this.#remarks.parentElement;
  }

  /** The files with their readings. */
  get said(): { file: File; says: string }[] {
    return slots.flatMap(({ slot, label }) => {
      const [file, entry] = [this.#files[slot], this.#entries.get(slot)];
      return file && entry ? [{ file, says: [label, entry.says.textContent].filter(Boolean).join(": ") }] : [];
    });
  }

  /** Shows what a file is, unless another has taken its place. */
  show(slot: Slot, file: File, { says, warnings, fault, picture }: Look): void {
    const entry = this.#entries.get(slot);
    if (!entry || this.#files[slot] !== file) return;
    entry.says.textContent = [says, ...warnings].join(". ");
    entry.says.classList.toggle("error", fault !== undefined);
    entry.thumb.hidden = !picture;
    if (!picture) return;
    entry.thumb.width = picture.width;
    entry.thumb.height = picture.height;
    entry.thumb.getContext("2d")?.drawImage(picture, 0, 0);
    entry.thumb.setAttribute("aria-label", `Preview of ${file.name}`);
  }

  /** Proposes to swap files that seem to be in the wrong slots; undefined if all seem right. */
  offer(offer: Offer | undefined): void {
    this.#offer.replaceChildren();
    if (!offer) return;
    const button = make("button", { type: "button" }, offer.button);
    button.addEventListener("click", () => {
      this.remarks("files", []);
      this.replaceAll(offer.slots);
    });
    this.#offer.append(offer.words, " ", button);
  }

  /** Replaces the remark about one topic. */
  remarks(topic: Topic, said: readonly Remark[]): void {
    this.#said[topic] = said;
    // There may be more remarks than fit on the screen.
    const rank = ({ wrong, action }: Remark) => (wrong ? 0 : action ? 1 : 2);
    const all = TOPICS.flatMap((each) => this.#said[each] ?? []).sort((a, b) => rank(a) - rank(b));
    this.#remarks.hidden = all.length === 0;
    this.#remarks.replaceChildren(
      ...all.map(({ words, wrong, action }) => {
        const line = make("li", { class: wrong ? "note error" : "note" }, words);
        if (!action) return line;
        const button = make("button", { type: "button" }, action.label);
        button.addEventListener("click", action.press);
        line.append(" ", button);
        return line;
      }),
    );
  }

  /** Removes all remarks. */
  silence(): void {
    for (const topic of TOPICS) this.remarks(topic, []);
  }

  /** Where the files are stored while the page is closed, in words, and whether there are any to remove. */
  keeping(words: string, canForget: boolean): void {
    this.#keeping.textContent = words;
    this.#forget.hidden = !canForget;
  }

  /** Shows an error beside the slot of this path and returns that slot; nothing if no slot has this path. */
  complain(path: string, message: string): string | undefined {
    return this.#say(path, message, true);
  }

  /** A remark that is not an error, such as that the picture was scaled down. */
  remark(path: string, message: string): boolean {
    return this.#say(path, message, false) !== undefined;
  }

  clearMessages(): void {
    for (const { note, zone } of this.#entries.values()) {
      note.hidden = true;
      note.textContent = "";
      zone.removeAttribute("data-invalid");
    }
  }

  #say(path: string, message: string, isError: boolean): string | undefined {
    const entry = [...this.#entries.values()].find(({ paths }) => paths.includes(path));
    if (!entry) return undefined;
    entry.note.textContent = message;
    entry.note.hidden = false;
    entry.note.classList.toggle("error", isError);
    entry.zone.toggleAttribute("data-invalid", isError);
    // Scrolls only within the settings, which may be longer than their sheet.
    if (isError) entry.note.scrollIntoView({ block: "nearest" });
    return slots.find(({ paths }) => paths === entry.paths)?.label;
  }

  #build({ slot, label, accept, hint, paths }: (typeof slots)[number]): void {
    const id = freshId("file");
    const picker = make("input", {
      id,
      type: "file",
      accept,
      class: "visually-hidden",
      "aria-label": label,
      "aria-describedby": `${id}-note`,
    });
    const name = make("span", { class: "file-name" }, hint);
    const zone = make("label", { class: "drop", for: id }, make("strong", {}, label), name);
    const clear = make(
      "button",
      { type: "button", class: "quiet", "aria-label": `Remove ${label.toLowerCase()}`, hidden: true },
      "×",
    );
    const note = make("p", { class: "note", id: `${id}-note`, hidden: true });
    const thumb = make("canvas", { class: "thumb", role: "img", width: 1, height: 1, hidden: true });
    const says = make("span", { class: "note says" });
    this.#entries.set(slot, { zone, name, note, clear, thumb, says, paths });
    zone.append(says, thumb);
    this.element.append(make("div", { class: "slot" }, picker, zone, clear, note));

    picker.addEventListener("change", () => {
      const file = picker.files?.[0];
      if (file) this.put(slot, file);
      picker.value = ""; // Emptied, so that the same file can be picked again after a change on disk.
    });
    clear.addEventListener("click", () => this.put(slot, undefined));
    zone.addEventListener("dragover", (event) => {
      event.preventDefault();
      zone.toggleAttribute("data-over", true);
    });
    zone.addEventListener("dragleave", () => zone.removeAttribute("data-over"));
    zone.addEventListener("drop", (event) => {
      event.preventDefault();
      zone.removeAttribute("data-over");
      const files = event.dataTransfer?.files ?? [];
      // Several files are sorted by their contents, as everywhere on the page.
      if (files.length > 1) return;
      event.stopPropagation();
      if (files[0]) this.put(slot, files[0]);
    });
  }

  /** Handles several files at once, so that they are recognised together. */
  putAll(files: ReadonlyMap<Slot, File>): void {
    for (const [slot, file] of files) this.#set(slot, file);
    this.#hooks.onChange();
  }

  /** Replaces all files by these. */
  replaceAll(files: Partial<Record<Slot, File>>): void {
    for (const { slot } of slots) this.#set(slot, files[slot]);
    this.#hooks.onChange();
  }

  /** A choice by hand removes remarks about earlier files. */
  put(slot: Slot, file: File | undefined): void {
    this.remarks("files", []);
    this.#set(slot, file);
    this.#hooks.onChange();
  }

  #set(slot: Slot, file: File | undefined): void {
    const entry = this.#entries.get(slot);
    if (!entry) return;
    if (this.#files[slot] !== file) {
      entry.says.textContent = "";
      entry.thumb.hidden = true;
    }
    if (file) this.#files[slot] = file;
    else delete this.#files[slot];
    const hint = slots.find((each) => each.slot === slot)?.hint ?? "";
    entry.name.title = file ? file.name : hint;
    // The size stays visible beside a name of any length.
    entry.name.replaceChildren(
      make("span", {}, file ? file.name : hint),
      ...(file ? [` (${sizeInWords(file.size)})`] : []),
    );
    entry.zone.toggleAttribute("data-filled", file !== undefined);
    entry.clear.hidden = file === undefined;
  }
}

export const sizeInWords = (bytes: number): string =>
  bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
