/** Step 3: runs the check and shows its result. */

import type { CheckCue } from "../../pkg/index.js";
import { make } from "../dom";
import { saveJson } from "../save";
import type { SensitivityCharts } from "./curves";
import { Overlay } from "./overlay";
import { choose, labelled, press, saveFile } from "./parts";
import type { PoseFormat } from "./protocol";
import { isSaved, isUncertain, isUsable } from "./placement";
import { messageOf, type Rig, type Run } from "./rig";
import { wasCancelled } from "./session";
import { candidatesTable, card, CUES, ending, nextCard, sharesCard } from "./verdict";
import { whole } from "./words";

const formats: readonly { value: PoseFormat; label: string }[] = [
  { value: "matrix", label: "4x4 text" },
  { value: "opencv", label: "OpenCV YAML" },
  { value: "kalibr", label: "Kalibr camchain" },
  { value: "ros2", label: "ROS 2 static_transform_publisher" },
  { value: "open3d", label: "Open3D JSON" },
  { value: "realsense", label: "RealSense JSON" },
];

export class VerdictStep {
  readonly element = make("div", { class: "rig-step rig-verdict-step" });
  readonly #rig: Rig;
  readonly #run: HTMLButtonElement;
  readonly #cancel: HTMLButtonElement;
  readonly #progress = make("progress", { max: 1, value: 0, "aria-label": "Progress of the check" });
  readonly #status = make("p", { class: "rig-status", role: "status" });
  readonly #alert = make("p", { class: "rig-error", role: "alert", hidden: true });
  readonly #live = make("p", { class: "rig-status soft", hidden: true });
  readonly #stale = make(
    "p",
    { class: "rig-stale", hidden: true },
    "Files, cameras or calibrations have changed since this verdict. Run the check again.",
  );
  readonly #card = make("div", { class: "rig-card rig-verdict-box", hidden: true });
  readonly #results = make("div", { class: "rig-results", hidden: true });
  /** The two columns are in reading order; on wide screens the pictures stand beside them. */
  readonly #first = make("div", { class: "rig-column" });
  readonly #last = make("div", { class: "rig-column" });
  readonly #overlay: Overlay;
  readonly #curvesBox = make("section", { class: "rig-card" });
  #curves: SensitivityCharts | undefined;
  #shown: Run | undefined;
  /** The visitor's choice of what to write is kept between runs. */
  #wish: { format: PoseFormat; pose?: string; frame?: string } = { format: "matrix" };
  #busy = false;

  constructor(rig: Rig, goBack: () => void) {
    this.#rig = rig;
    this.#overlay = new Overlay(rig);
    this.#run = press("Run the check", () => void this.start(), { class: "primary" });
    this.#cancel = press("Cancel", () => rig.session.cancel());
    this.#curvesBox.append(
      make("h3", {}, "How well this scene constrains each axis"),
      make(
        "p",
        { class: "soft" },
        "Loss of log likelihood when the calibration found is moved. The band, not the valley, is the 95 % interval of the result: neighbouring pixels share their errors, so the band is wider than the valley. A flat valley means that this scene does not constrain the axis. The dot marks the minimum of all cues together, the triangle the calibration checked; an arrow at the end of the axis means that it lies beyond.",
      ),
    );
    this.#results.append(
      this.#first,
      make("div", { class: "rig-column rig-pictures" }, this.#overlay.element, this.#curvesBox),
      this.#last,
    );
    this.element.append(
      make(
        "section",
        { class: "rig-card rig-run" },
        make("div", { class: "rig-row" }, press("Back", goBack), this.#run, this.#cancel, this.#status, this.#progress),
        this.#live,
        this.#cueChoice(),
        this.#alert,
        this.#stale,
      ),
      this.#card,
      this.#results,
    );
  }

  get busy(): boolean {
    return this.#busy;
  }

  show(): void {
    const { run, missing } = this.#rig;
    const { live } = this.#rig;
    this.#run.disabled = this.#busy || live.isRunning || missing.length > 0;
    this.#run.textContent = run ? "Run again" : "Run the check";
    this.#cancel.hidden = !this.#busy;
    this.#progress.toggleAttribute("data-idle", !this.#busy);
    this.#stale.hidden = !run || this.#busy || live.isRunning || isSame(run, this.#rig);
    this.#live.hidden = !live.isRunning;
    const words = `Live, ${live.views} views taken: ${live.state === "checking" ? "checking" : "looking for another view"}.`;
    if (this.#live.textContent !== words) this.#live.textContent = words;
    this.#card.hidden = this.#results.hidden = !run;
    if (run && run !== this.#shown) this.#showRun(run);
    this.#shown = run;
  }

  recolour(): void {
    this.#curves?.recolour();
  }

  leave(): void {
    if (this.#busy) this.#rig.session.cancel();
  }

  async start(): Promise<void> {
    if (this.#busy || this.#rig.live.isRunning || this.#rig.missing.length > 0) return;
    this.#busy = true;
    this.#complain("");
    this.#tell(0, "starting");
    this.show();
    try {
      await this.#rig.check((share, message) => this.#tell(share, message));
      this.#busy = false;
      this.show();
      const run = this.#rig.run;
      this.#status.textContent = run ? ending(run) : "";
      this.#card.querySelector<HTMLElement>(".rig-word")?.focus({ preventScroll: true });
    } catch (error) {
      this.#status.textContent = wasCancelled(error) ? "Cancelled. Files and calibrations are kept." : "";
      if (!wasCancelled(error)) this.#complain(`The check failed: ${messageOf(error)}`);
    } finally {
      const wasFocused = document.activeElement === this.#cancel;
      this.#busy = false;
      this.show();
      // A hidden button loses the focus.
      if (wasFocused) this.#run.focus();
    }
  }

  /** Saves nothing before there is a verdict. */
  async download(): Promise<void> {
    const { run } = this.#rig;
    if (!run) return;
    const { inputsOf } = await import("./reportfile");
    const { inputs } = await inputsOf(this.#rig);
    saveJson("rig-check.json", "the verdict, its numbers and the hashes of the files", {
      format: "bimodal-stereo check",
      version: 1,
      ...whole(run),
      inputs,
    });
  }

  #tell(share: number, message: string): void {
    this.#progress.value = share;
    // Screen readers read this text when it changes, so it does not contain the share, which changes all the time.
    if (this.#status.textContent !== message) this.#status.textContent = message;
  }

  #showRun(run: Run): void {
    this.#card.replaceChildren(card(run));
    this.#overlay.show(run);
    this.#first.replaceChildren(candidatesTable(run), nextCard(run));
    this.#last.replaceChildren(sharesCard(run, this.#rig.history), this.#out(run));
    void this.#showCurves(run);
  }

  async #showCurves(run: Run): Promise<void> {
    const { SensitivityCharts } = await import("./curves");
    if (!this.#curves) this.#curvesBox.append((this.#curves = new SensitivityCharts()).element);
    this.#curvesBox.hidden = run.report.sensitivity.length === 0;
    this.#curves.show(run);
  }

  #cueChoice(): HTMLElement {
    const boxes = Object.entries(CUES).map(([cue, words]) => {
      const box = make("input", { type: "checkbox", checked: true, value: cue });
      box.addEventListener("change", () => {
        const on = [...this.element.querySelectorAll<HTMLInputElement>(".rig-cues input:checked")].map(
          ({ value }) => value as CheckCue,
        );
        // A check needs at least one cue.
        if (on.length === 0) box.checked = true;
        else this.#rig.cues = on.length === Object.keys(CUES).length ? [] : on;
      });
      return make("label", {}, box, words);
    });
    return make(
      "details",
      { class: "rig-cues" },
      make("summary", {}, "Cues to use"),
      make("div", { class: "rig-row" }, ...boxes),
    );
  }

  #out(run: Run): HTMLElement {
    const note = make("p", { class: "rig-error", role: "alert" });
    const remark = make("p", { class: "soft", role: "status" });
    const isLeftOut = isUsable(run) && !isSaved(run);
    const leftOut = make(
      "p",
      { class: "soft" },
      "The calibration found is not offered here, because it is too uncertain to use.",
    );
    const attempt = (action: () => Promise<void>) => async () => {
      note.textContent = remark.textContent = "";
      await action().catch(
        (error: unknown) => (note.textContent = `The file could not be written: ${messageOf(error)}`),
      );
    };
    const poses = [
      ...(isSaved(run) ? [{ value: "", label: isUncertain(run) ? "found (too uncertain to use)" : "found" }] : []),
      ...(run.estimateOnly ? [] : Object.keys(run.candidates)).map((name) => ({ value: name, label: name })),
    ];
    // The visitor's calibration is the initial choice, unless the verdict is "off".
    const isKept = !run.estimateOnly && run.report.verdict !== "off";
    const isConfirmed = !run.estimateOnly && run.report.verdict === "consistent";
    const wish = this.#wish;
    const wished = poses.find(({ value }) => value === wish.pose)?.value;
    const which = choose(
      poses,
      wished ?? (isKept ? Object.keys(run.candidates)[0] : poses[0]?.value) ?? "",
      (pose) => (wish.pose = pose),
    );
    const format = choose(formats, wish.format, (format) => (wish.format = format as PoseFormat));
    const seen = run.plans.findIndex(({ name }) => name === wish.frame);
    const frame = choose(
      run.plans.map(({ name }, i) => ({ value: String(i), label: name })),
      String(Math.max(0, seen)),
      (index) => (wish.frame = run.plans[Number(index)]?.name ?? ""),
    );
    const pose = () => run.candidates[which.value] ?? run.report.estimate;
    const { session } = this.#rig;
    const save = press(
      "Save calibration",
      attempt(async () => {
        const isEstimate = which.value === "" && !isConfirmed;
        const ask = { pose: pose(), format: format.value as PoseFormat, isEstimate };
        const { name, text, notes } = await session.call("pose", ask);
        saveFile(name, text, "text/plain");
        remark.textContent = notes.length > 0 ? `Note: ${notes.join("; ")}.` : `Saved as ${name}.`;
      }),
      { class: "primary", disabled: poses.length === 0 },
    );
    const clouds = press(
      "Save clouds (PLY)",
      attempt(async () => {
        const index = Number(frame.value);
        const both = Object.entries(run.candidates)
          .slice(0, run.estimateOnly ? 0 : 1)
          .map(([name, pose]) => ({ name, pose }));
        const poses = [{ name: "found", pose: run.report.estimate }, ...both];
        saveFile(
          `${run.plans[index]?.name ?? "frame"}.ply`.replaceAll(/[^\w.-]+/g, "-"),
          (await session.call("clouds", { frame: index, poses })) as BlobPart,
          "application/octet-stream",
        );
      }),
    );
    const html = press(
      "Save report (HTML)",
      attempt(async () => {
        const { reportOf } = await import("./reportfile");
        saveFile("rig-check.html", await reportOf(this.#rig, run, await this.#overlay.forReport()), "text/html");
      }),
    );
    return make(
      "section",
      { class: "rig-card" },
      make("h3", {}, "Export"),
      make("div", { class: "rig-row rig-bottom" }, labelled("Calibration", which), labelled("Format", format), save),
      ...(isLeftOut ? [leftOut] : []),
      make(
        "div",
        { class: "rig-row rig-bottom" },
        labelled("Frame", frame),
        clouds,
        html,
        press(
          "Save numbers (JSON)",
          attempt(() => this.download()),
        ),
      ),
      note,
      remark,
    );
  }

  #complain(message: string): void {
    this.#alert.textContent = message;
    this.#alert.hidden = message === "";
  }
}

/** Whether the verdict refers to the present state. */
function isSame(run: Run, rig: Rig): boolean {
  const now = rig.plans();
  const plain = (plans: Run["plans"]) => JSON.stringify(plans.map(({ paint: _, ...rest }) => rest));
  const given = run.estimateOnly ? {} : run.candidates;
  return (
    plain(now) === plain(run.plans) &&
    now.every(({ paint }, i) => paint === run.plans[i]?.paint) &&
    JSON.stringify(Object.entries(given)) === JSON.stringify(rig.candidates.map(({ name, pose }) => [name, pose]))
  );
}
