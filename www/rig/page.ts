/** Check a rig: is the calibration between a colour camera and a depth camera right? Three steps on one page. */

import "../style/rig.css";
import "../style/rig-steps.css";
import "../style/rig-verdict.css";
import "../style/rig-narrow.css";
import { make } from "../dom";
import { placeOf } from "../place";
import { CalibrationStep } from "./calibrationstep";
import { FilesStep } from "./filesstep";
import { Kept } from "./kept";
import { press } from "./parts";
import { Rig } from "./rig";
import { VerdictStep } from "./verdictstep";

const STEPS = ["files", "calibration", "verdict"] as const;
type Step = (typeof STEPS)[number];

const titles: Record<Step, string> = {
  files: "Files and cameras",
  calibration: "Your calibration",
  verdict: "Verdict",
};
const isStep = (name: string | null): name is Step => STEPS.some((step) => step === name);

export class RigPage {
  readonly #rig = new Rig();
  readonly #steps: { files: FilesStep; calibration: CalibrationStep; verdict: VerdictStep };
  readonly #links = new Map<Step, HTMLButtonElement>();
  readonly #body = make("div", { class: "rig-body" });
  readonly #heading = make("h2", { tabindex: "-1" });
  readonly #undo = press("Undo", () => this.#rig.undo.back(), { class: "rig-undo" });
  #step: Step = "files";

  constructor(parent: HTMLElement) {
    const rig = this.#rig;
    this.#steps = {
      files: new FilesStep(
        rig,
        () => this.#go("calibration"),
        () => this.#go("verdict"),
      ),
      calibration: new CalibrationStep(
        rig,
        () => this.#go("files"),
        () => this.#run(),
      ),
      verdict: new VerdictStep(rig, () => this.#go("calibration")),
    };
    this.#body.append(...STEPS.map((step) => this.#steps[step].element));
    parent.append(
      make(
        "div",
        { class: "rig-intro" },
        make(
          "p",
          {},
          "Are the extrinsics between your colour and depth cameras right? Drop a few frames and get a verdict, with evidence.",
        ),
        this.#stepper(),
      ),
      make("div", { class: "rig-title" }, this.#heading, this.#undo),
      this.#body,
    );
    rig.listen(() => this.#show());
    void this.#restore();
  }

  /** A reload restores the rig and shows the step of the address. */
  async #restore(): Promise<void> {
    const { files } = this.#steps;
    const kept = new Kept(this.#rig, (words) => files.keeping(words));
    const count = await kept.open();
    if (count > 0) files.offer(count, () => kept.restore());
    else if (placeOf(location.hash) === "rig") this.open(location.hash);
  }

  /** Shows the step named in the address, if there is something to show. */
  open(hash: string): void {
    const asked = new URLSearchParams(hash.replace(/^#/, "")).get("step");
    this.#turnTo(isStep(asked) && this.#may(asked) ? asked : "files", false);
  }

  /** Nothing is computed for a hidden page; its files stay. */
  leave(): void {
    this.#steps.verdict.leave();
  }

  recolour(): void {
    this.#steps.verdict.recolour();
  }

  download(): Promise<void> {
    return this.#steps.verdict.download();
  }

  #stepper(): HTMLElement {
    const items = STEPS.map((step, i) => {
      const button = make(
        "button",
        { type: "button" },
        make("span", { class: "rig-number" }, String(i + 1)),
        titles[step],
      );
      button.addEventListener("click", () => this.#go(step));
      this.#links.set(step, button);
      return make("li", {}, button);
    });
    return make("nav", { "aria-label": "Steps" }, make("ol", { class: "rig-stepper" }, ...items));
  }

  #may(step: Step): boolean {
    if (step === "files") return true;
    return this.#rig.missing.length === 0 || (step === "verdict" && this.#rig.run !== undefined);
  }

  #run(): void {
    this.#go("verdict");
    void this.#steps.verdict.start();
  }

  /** A separate entry in the history, so that the browser's back button works. */
  #go(step: Step): void {
    if (!this.#may(step)) return;
    if (step !== this.#step) history.pushState(null, "", step === "files" ? "#rig" : `#rig&step=${step}`);
    this.#turnTo(step, true);
  }

  #turnTo(step: Step, isMove: boolean): void {
    const isNew = step !== this.#step;
    this.#step = step;
    this.#show();
    if (!isMove || !isNew) return;
    this.#heading.focus({ preventScroll: true });
    this.#heading.scrollIntoView({ block: "nearest" });
    if (scrollY > 0) scrollTo({ top: 0, behavior: "instant" });
  }

  #show(): void {
    for (const step of STEPS) {
      const isHere = step === this.#step;
      this.#steps[step].element.hidden = !isHere;
      const link = this.#links.get(step);
      if (isHere) link?.setAttribute("aria-current", "step");
      else link?.removeAttribute("aria-current");
      if (link) link.disabled = !this.#may(step);
    }
    const words = this.#rig.undo.wordsAt(this.#step);
    this.#undo.hidden = words === undefined;
    this.#undo.textContent = words === undefined ? "" : `Undo ${words}`;
    this.#heading.textContent = `${STEPS.indexOf(this.#step) + 1}. ${titles[this.#step]}`;
    this.#steps[this.#step].show();
  }
}
