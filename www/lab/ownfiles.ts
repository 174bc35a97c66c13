/** The visitor's files: what they are, where they belong, and that the browser keeps them. */

import { Intake } from "./intake";
import { runAmong } from "./kind";
import type { Offer } from "./offer";
import type { OwnCameras } from "./owncameras";
import type { Origin, Settings, Value } from "./settings";
import type { Files, Slot } from "./storage";

export interface OwnFilesHooks {
  /** Other files than before. */
  onChange(): void;
  /** A saved run in place of a pair. */
  onRun(file: File): void;
  /** Something of them seems to be in the wrong place, or no longer. */
  onDoubt(): void;
  /** Files are being looked at before they go anywhere: their names, or nothing once none of them went anywhere. */
  onLooking(names: string): void;
  /** What is in the fields now. */
  settings(): Settings;
  /** Fields that files fill; other files follow at once where `isFollowed`. */
  onFields(fields: Record<string, Value>, isFollowed: boolean): void;
}

export class OwnFiles {
  readonly intake = new Intake({ onChange: () => this.#changed(), onForget: () => void this.#forget() });
  readonly #hooks: OwnFilesHooks;
  /** Whether the stored files have been requested. */
  #restored = false;
  #doubt = "";
  /** How often files have come by hand: those of last time come too late after the first. */
  #hands = 0;
  /** There once a file of cameras has come. */
  #cameras: OwnCameras | undefined;

  constructor(hooks: OwnFilesHooks) {
    this.#hooks = hooks;
  }

  /** What seems to be in the wrong place, and how to correct it; empty if all is well. */
  get doubt(): string {
    return this.#doubt;
  }

  /** The visitor turns to their own files, or away from them and from what was wrong with any. */
  choose(origin: Origin): void {
    if (origin === "files") void this.#restore();
    else this.intake.silence();
  }

  /** Other fields than before: what is said of cameras that are no longer in them is over. */
  adapt(settings: Settings): void {
    if (this.#cameras && !this.#cameras.areIn(settings)) this.intake.remarks("cameras", []);
  }

  /** Any number of them, each into the slot that its content is of. */
  async drop(files: readonly File[]): Promise<void> {
    this.#restored = true;
    this.#hands++;
    const run = await runAmong(files);
    if (run) return this.#hooks.onRun(run);
    this.#hooks.onLooking(files.map(({ name }) => name).join(", "));
    const { sorted } = await import("./sorted");
    const { slots, fields, cameras, remarks } = await sorted(files, this.intake.files, this.#hooks.settings());
    const isPair = slots.has("colour") && slots.has("depth");
    const placed = Object.fromEntries(slots);
    this.intake.remarks("files", remarks);
    if (cameras.length > 0) {
      this.#cameras ??= new (await import("./owncameras")).OwnCameras();
      this.#cameras.bring(cameras);
    }
    const filled = await this.#assign(isPair ? placed : { ...this.intake.files, ...placed });
    const all = { ...fields, ...filled };
    if (Object.keys(all).length > 0) this.#hooks.onFields(all, slots.size > 0);
    if (isPair) this.intake.replaceAll(placed);
    else if (slots.size > 0) this.intake.putAll(slots);
    else this.#hooks.onLooking("");
  }

  /** Has a mask of the colour image drawn, in the place of the one that there is. */
  async drawMask(): Promise<void> {
    const { colour } = this.intake.files;
    if (!colour) return;
    const { drawMask } = await import("./drawmask");
    await drawMask(colour, (mask) => this.intake.files.colour === colour && this.intake.put("colourMask", mask));
  }

  /** The cameras' numbers for these pictures, and what is said of them. */
  async #assign(files: Files): Promise<Record<string, Value>> {
    const assigned = await this.#cameras?.assign(files, this.#hooks.settings());
    if (assigned) this.intake.remarks("cameras", assigned.remarks);
    return assigned?.fields ?? {};
  }

  /** The files of last time, once, unless there are others by then. */
  async #restore(): Promise<void> {
    if (this.#restored) return;
    this.#restored = true;
    const before = this.#hands;
    const { kept } = await import("./storage");
    const files = await kept().catch(() => new Map<string, File>());
    if (files.size > 0 && this.#hands === before) this.intake.putAll(files as Map<Slot, File>);
  }

  #changed(): void {
    this.#restored = true;
    this.#hands++;
    this.#hooks.onChange();
    void this.#look();
    void this.#keep();
  }

  /** Shows what each file is, and asks where one seems to be in the wrong place. */
  async #look(): Promise<void> {
    const files: Files = { ...this.intake.files };
    this.#offer(undefined);
    if (Object.keys(files).length === 0) return;
    const [{ lookIn, release }, { offerFor }] = await Promise.all([import("./look"), import("./offer")]);
    release(files);
    await Promise.all(
      Object.entries(files).map(async ([slot, file]) =>
        this.intake.show(slot as Slot, file, await lookIn(slot as Slot, file)),
      ),
    );
    const offer = await offerFor(files);
    if (!this.#areStill(files)) return;
    this.#offer(offer);
    const fields = await this.#assign(files);
    const isNew = Object.entries(fields).some(([key, value]) => this.#hooks.settings()[key] !== value);
    if (isNew && this.#areStill(files)) this.#hooks.onFields(fields, false);
  }

  #areStill(files: Files): boolean {
    const now = this.intake.files;
    return Object.keys({ ...files, ...now }).every((slot) => files[slot as Slot] === now[slot as Slot]);
  }

  #offer(offer: Offer | undefined): void {
    this.intake.offer(offer);
    this.#doubt = offer ? `${offer.words.replace(/\.$/, "")}: Settings, ${offer.button}.` : "";
    this.#hooks.onDoubt();
  }

  async #keep(): Promise<void> {
    const files: Files = { ...this.intake.files };
    if (Object.keys(files).length === 0) return this.#forget();
    const { forget, hearOthers, keep, reasonOf } = await import("./storage");
    hearOthers(
      () => this.intake.files,
      (isEmpty) => this.#overtaken(isEmpty),
    );
    try {
      await keep(files);
      this.intake.keeping("These files stay in this browser, also after a reload, until you remove them.", true);
    } catch (error) {
      // Those of another time must not come back in their place.
      await forget().catch(() => {});
      this.intake.keeping(
        `This browser could not store the files (${reasonOf(error)}). They work, but a reload removes them.`,
        true,
      );
    }
  }

  /** Another tab has put its files in the place of these, or has had them forgotten. */
  #overtaken(isEmpty: boolean): void {
    if (Object.keys(this.intake.files).length === 0) return;
    const words = isEmpty
      ? "The stored files were removed in another tab of this page. A reload removes them here, too."
      : "Another tab of this page has stored its own files. A reload brings those, not these.";
    this.intake.keeping(words, true);
  }

  async #forget(): Promise<void> {
    this.#cameras?.forget();
    this.intake.remarks("cameras", []);
    const { forget } = await import("./storage");
    const isDone = await forget().then(
      () => true,
      () => false,
    );
    if (Object.keys(this.intake.files).length > 0) return;
    this.intake.keeping(
      isDone
        ? "No files are stored in this browser."
        : "The browser's storage does not respond. To remove files of this page, clear its site data in the browser's settings.",
      false,
    );
  }
}
