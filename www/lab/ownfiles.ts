/** The visitor's files: recognised, put into their slots, and kept by the browser. */

import { Intake } from "./intake";
import { runAmong } from "./kind";
import type { Offer } from "./offer";
import type { OwnCameras } from "./owncameras";
import type { Origin, Settings, Value } from "./settings";
import type { Files, Slot } from "./storage";

export interface OwnFilesHooks {
  /** Called when the files have changed. */
  onChange(): void;
  /** Called with a saved run that was dropped instead of a pair. */
  onRun(file: File): void;
  /** Called when the suspicion that a file is in the wrong slot changes. */
  onDoubt(): void;
  /** Names of the files being recognised; empty if none of them went into a slot. */
  onLooking(names: string): void;
  /** The present fields. */
  settings(): Settings;
  /** Fields that files fill; `isFollowed` if a change of files follows at once. */
  onFields(fields: Record<string, Value>, isFollowed: boolean): void;
}

export class OwnFiles {
  /** Called after a change of the files. */
  onFiles = (): void => {};
  readonly intake = new Intake({ onChange: () => this.#changed(), onForget: () => void this.#forget() });
  readonly #hooks: OwnFilesHooks;
  /** Whether the stored files have been requested. */
  #restored = false;
  #doubt = "";
  /** How often files were chosen by hand: stored files are not restored after the first time. */
  #hands = 0;
  /** Exists once a file of cameras was opened. */
  #cameras: OwnCameras | undefined;

  constructor(hooks: OwnFilesHooks) {
    this.#hooks = hooks;
  }

  /** Files that seem to be in the wrong slot, and the correction; empty if all is well. */
  get doubt(): string {
    return this.#doubt;
  }

  /** The visitor switches to their own files, or away from them and their errors. */
  choose(origin: Origin): void {
    if (origin === "files") void this.#restore();
    else this.intake.silence();
  }

  /** Removes the remarks about cameras whose numbers are no longer in the fields. */
  adapt(settings: Settings): void {
    if (this.#cameras && !this.#cameras.areIn(settings)) this.intake.remarks("cameras", []);
  }

  /** Puts any number of files into the slots that match their content. */
  async drop(files: readonly File[]): Promise<void> {
    this.#restored = true;
    this.#hands++;
    const run = await runAmong(files);
    if (run) return this.#hooks.onRun(run);
    this.#hooks.onLooking(files.map(({ name }) => name).join(", "));
    const { sorted } = await import("./sorted");
    const there = this.intake.files;
    const { slots, isPair, fields, cameras, remarks } = await sorted(files, there, this.#hooks.settings());
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

  /** Opens the tool that draws a mask of the colour image; it replaces the present one. */
  async drawMask(): Promise<void> {
    const { colour } = this.intake.files;
    if (!colour) return;
    const { drawMask } = await import("./drawmask");
    await drawMask(colour, (mask) => this.intake.files.colour === colour && this.intake.put("colourMask", mask));
  }

  /** Opens the tool for a mask of the depth map, of which a range of depths can be used. */
  async drawDepthMask(): Promise<void> {
    const { depth } = this.intake.files;
    if (!depth) return;
    const { drawDepthMask } = await import("./drawmask");
    await drawDepthMask(depth, (mask) => this.intake.files.depth === depth && this.intake.put("depthMask", mask));
  }

  /** Fills the cameras' numbers for these pictures and shows remarks about them. */
  async #assign(files: Files): Promise<Record<string, Value>> {
    const assigned = await this.#cameras?.assign(files, this.#hooks.settings());
    if (assigned) this.intake.remarks("cameras", assigned.remarks);
    return assigned?.fields ?? {};
  }

  /** Restores the stored files, once, unless others were chosen in the meantime. */
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
    this.onFiles();
    void this.#look();
    void this.#keep();
  }

  /** Shows what each file was recognised as, and proposes a change if one seems to be in the wrong slot. */
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
      // Files stored earlier must not come back instead.
      await forget().catch(() => {});
      this.intake.keeping(
        `This browser could not store the files (${reasonOf(error)}). They work, but a reload removes them.`,
        true,
      );
    }
  }

  /** Another tab has replaced or removed the stored files. */
  #overtaken(isEmpty: boolean): void {
    if (Object.keys(this.intake.files).length === 0) return;
    const words = isEmpty
      ? "The stored files were removed in another tab of this page. A reload removes them here, too."
      : "Another tab of this page has stored its own files. A reload shows those files instead of these.";
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
