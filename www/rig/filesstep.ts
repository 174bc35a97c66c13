/** Step 1: files, frames, cameras. */

import { make } from "../dom";
import { advice } from "./advice";
import { CameraForm } from "./cameralist";
import { dropTarget, type Named } from "./drop";
import { FileList, unitName } from "./filelist";
import { FrameList } from "./framelist";
import type { MaskTool } from "./masktool";
import { press } from "./parts";
import type { LiveCard } from "./livecard";
import type { RecordingList } from "./recordinglist";
import { messageOf, type Rig } from "./rig";

export class FilesStep {
  readonly element = make("div", { class: "rig-step rig-files-step" });
  readonly #rig: Rig;
  readonly #files: FileList;
  readonly #frames: FrameList;
  readonly #cameras: readonly CameraForm[];
  readonly #status = make("p", { class: "rig-status soft", role: "status" });
  readonly #alert = make("p", { class: "rig-error", role: "alert", hidden: true });
  readonly #guess = make("div", { class: "rig-row rig-guess", role: "group", "aria-label": "Units", hidden: true });
  readonly #guessWords = make("p");
  readonly #notes = make("ul", { class: "rig-notes" });
  readonly #example = press("Load an example", () => void this.#loadExample());
  readonly #clear = press("Start over", () => this.#rig.clear());
  readonly #restore = press("Restore", () => void this.#onRestore(), { hidden: true });
  #onRestore: () => Promise<void> = async () => {};
  /** How the files are kept. */
  readonly #keeping = make("p", { class: "soft", hidden: true });
  readonly #missing = make("p", { class: "rig-missing" });
  readonly #next: HTMLButtonElement;
  readonly #framesCard: HTMLElement;
  /** Recordings are listed once there are any. */
  readonly #recordingsBox = make("div", { hidden: true });
  #recordings: RecordingList | undefined;
  #live: LiveCard | undefined;
  readonly #filesCard: HTMLDetailsElement;
  #tool: Promise<MaskTool> | undefined;

  constructor(rig: Rig, goOn: () => void, seeVerdict: () => void) {
    this.#rig = rig;
    this.#files = new FileList(rig);
    this.#frames = new FrameList(
      rig,
      () => (this.#tool ??= import("./masktool").then(({ MaskTool }) => new MaskTool())),
    );
    this.#cameras = [new CameraForm(rig, "colour"), new CameraForm(rig, "depth")];
    this.#next = press("Next: your calibration", goOn, { class: "primary" });
    const drop = dropTarget(
      {
        title: "Drop files or a folder here",
        hint: "Colour images, depth maps or LiDAR scans, camera parameters, a calibration; a folder of a phone, KITTI or nuScenes; or a recording. File types are detected from the contents. Nothing leaves your device.",
        files: "Choose files",
        folder: "Choose a folder",
      },
      (files, isFolder) => void this.#take(files, isFolder),
      this.element,
    );
    this.#guess.append(
      this.#guessWords,
      press("Confirm", () => void this.#rig.confirmUnits()),
    );
    this.#filesCard = make(
      "details",
      { class: "rig-card rig-files-card" },
      make("summary", {}, make("h3", {}, "Files")),
      this.#files.element,
    );
    this.#framesCard = make(
      "section",
      { class: "rig-card" },
      make("h3", {}, "Frames"),
      make(
        "p",
        { class: "soft" },
        "Each frame is a colour image and a depth map taken at the same moment. Each further frame makes the result more precise.",
      ),
      this.#frames.element,
    );
    this.element.append(
      make(
        "section",
        { class: "rig-card" },
        drop,
        make("div", { class: "rig-row" }, this.#example, this.#restore, this.#clear, this.#status),
        this.#keeping,
        this.#alert,
        this.#guess,
        this.#notes,
      ),
      make("aside", { class: "rig-aside" }, advice(), formats()),
      make(
        "div",
        { class: "rig-main" },
        this.#liveBox(seeVerdict),
        this.#recordingsBox,
        this.#filesCard,
        this.#framesCard,
        make(
          "section",
          { class: "rig-card" },
          make("h3", {}, "Cameras"),
          make("div", { class: "rig-cameras" }, ...this.#cameras.map(({ element }) => element)),
        ),
        make("div", { class: "rig-row rig-foot" }, this.#missing, this.#next),
      ),
    );
  }

  show(): void {
    this.#showRecordings();
    this.#live?.show();
    this.#files.show();
    this.#frames.show();
    for (const camera of this.#cameras) camera.show();
    const { items, notes, missing } = this.#rig;
    this.#filesCard.hidden = items.length === 0;
    this.#framesCard.hidden = this.#rig.frames.length === 0;
    this.#notes.replaceChildren(...notes.map(({ message }) => make("li", {}, message)));
    const guessed = this.#rig.unitsGuessed;
    const names = [...new Set(guessed.map(({ summary }) => unitName(summary?.unit ?? 1)))];
    this.#guess.hidden = guessed.length === 0;
    this.#guessWords.textContent =
      guessed.length === 0
        ? ""
        : `The unit of ${guessed.length === 1 ? guessed[0]?.name : `${guessed.length} depth maps`} was guessed: ${names.join(" and ")}.`;
    this.#clear.hidden = items.length === 0;
    if (items.length > 0) this.#restore.hidden = true;
    const files = items.filter(({ recording }) => recording === undefined);
    const reading = files.filter(({ state }) => state === "reading").length;
    const failed = files.filter(({ state }) => state === "failed").length;
    this.#status.textContent = this.#rig.busy
      ? this.#rig.busy
      : items.length === 0
        ? ""
        : reading > 0
          ? `Reading ${reading} of ${files.length} files`
          : `${files.length - failed} of ${files.length} ${files.length === 1 ? "file" : "files"} read`;
    this.#missing.textContent = missing.length === 0 ? "" : `Still missing: ${missing.join("; ")}.`;
    this.#next.disabled = missing.length > 0;
  }

  /** Says how the files are kept. */
  keeping(words: string): void {
    this.#keeping.textContent = words;
    this.#keeping.hidden = words === "";
  }

  /** Offers the files of another visit. */
  offer(count: number, restore: () => Promise<void>): void {
    this.#restore.textContent = `Restore the last rig (${count} ${count === 1 ? "file" : "files"})`;
    this.#onRestore = restore;
    this.#restore.hidden = false;
  }

  #liveBox(seeVerdict: () => void): HTMLElement {
    const box = make("details", { class: "rig-card" }, make("summary", {}, make("h3", {}, "Connect to a robot")));
    box.addEventListener("toggle", () => {
      if (!box.open || this.#live) return;
      void import("./livecard").then(({ LiveCard }) => {
        this.#live ??= new LiveCard(this.#rig, seeVerdict);
        box.append(this.#live.element);
        this.#live.show();
      });
    });
    return box;
  }

  #showRecordings(): void {
    const isNeeded = this.#rig.items.some(({ summary }) => summary?.kind === "recording");
    this.#recordingsBox.hidden = !isNeeded;
    this.#recordings?.show();
    if (!isNeeded || this.#recordings) return;
    void import("./recordinglist").then(({ RecordingList }) => {
      if (this.#recordings) return;
      this.#recordings = new RecordingList(this.#rig);
      this.#recordingsBox.append(this.#recordings.element);
      this.#recordings.show();
    });
  }

  /** A folder is read as a whole, since its frames may be matched by time; files that were added one by one are listed for review. */
  async #take(files: Named[], isFolder: boolean): Promise<void> {
    this.#complain("");
    this.#filesCard.open ||= !isFolder;
    const before = new Set(this.#rig.items);
    try {
      if (isFolder) await this.#rig.addFolder(files);
      else await this.#rig.add(files);
      const added = this.#rig.items.filter((item) => !before.has(item) && item.recording === undefined);
      // A recording has a separate card.
      if (added.length > 0 && added.every(({ summary }) => summary?.kind === "recording")) this.#filesCard.open = false;
    } catch (error) {
      this.#complain(messageOf(error));
    }
  }

  async #loadExample(): Promise<void> {
    this.#complain("");
    this.#example.disabled = true;
    this.#status.textContent = "Rendering the example";
    try {
      await this.#rig.loadExample();
    } catch (error) {
      this.#complain(`The example could not be rendered: ${messageOf(error)}`);
    } finally {
      this.#example.disabled = false;
      this.show();
    }
  }

  #complain(message: string): void {
    this.#alert.textContent = message;
    this.#alert.hidden = message === "";
  }
}

/** The readers' own list, loaded when it is opened. */
function formats(): HTMLElement {
  const list = make("dl", { class: "rig-formats" });
  const box = make("details", { class: "rig-card" }, make("summary", {}, "Supported files"), list);
  box.addEventListener("toggle", () => {
    if (!box.open || list.childElementCount > 0) return;
    void import("./supported").then(({ SUPPORTED }) =>
      list.replaceChildren(...SUPPORTED.flatMap(([what, names]) => [make("dt", {}, what), make("dd", {}, names)])),
    );
  });
  return box;
}
