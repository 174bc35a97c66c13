/** Step 2: the calibration to check, and others to compare it with. */

import { make } from "../dom";
import { decimals } from "../draw/numbers";
import { dropTarget } from "./drop";
import { choose, Keyed, labelled, numberField, press } from "./parts";
import { fromEuler, fromQuaternion, identity, inverse, isOfWorld, matrixText, poseOf, type EulerOrder } from "./poses";
import { isOfCarrier, placeInWords } from "./words";
import { messageOf, type Candidate, type Rig } from "./rig";

type By = "quaternion" | EulerOrder;

const TURNS: Record<By, readonly string[]> = {
  quaternion: ["qx", "qy", "qz", "qw"],
  rpy: ["roll", "pitch", "yaw"],
  xyz: ["about x", "about y", "about z"],
};

/** Distance of two cameras, metres, above which a wrong unit or a pose in the world is likelier than a rig. */
const FAR = 0.5;
/** The same limit for a LiDAR and a camera on one vehicle, metres. */
const FAR_ON_VEHICLE = 3;

export class CalibrationStep {
  readonly element = make("div", { class: "rig-step" });
  readonly #rig: Rig;
  readonly #list = make("ol", { class: "rig-candidates", "aria-label": "Calibrations to check" });
  readonly #rows: Keyed<Candidate>;
  readonly #none = make(
    "p",
    { class: "rig-none" },
    make("strong", {}, "No calibration given. "),
    "Without a calibration the check only estimates one; add yours to have it checked. If the depth maps are already registered to the images, as phones and many drivers save them, the calibration is the identity. ",
    press("Add the identity", () => this.#rig.addPose({ name: "identity", pose: identity }, "the identity")),
  );
  /** A hint that is shown once for all candidates. */
  readonly #hint = make("p", { class: "soft rig-hint" });
  readonly #alert = make("p", { class: "rig-error", role: "alert", hidden: true });
  readonly #next: HTMLButtonElement;

  constructor(rig: Rig, goBack: () => void, goOn: () => void) {
    this.#rig = rig;
    this.#rows = new Keyed(this.#list, (candidate) => this.#row(candidate));
    this.#next = press("Run the check", goOn, { class: "primary" });
    this.element.append(
      make(
        "section",
        { class: "rig-card" },
        make("h3", {}, "Calibrations to check"),
        make(
          "p",
          { class: "soft" },
          "A calibration (extrinsics) transforms points from the depth camera to the colour camera: P",
          make("sub", {}, "colour"),
          " = R P",
          make("sub", {}, "depth"),
          " + t, in metres. The first one is checked; the others are compared with it.",
        ),
        this.#none,
        this.#hint,
        this.#list,
        this.#alert,
      ),
      make("aside", { class: "rig-aside" }, this.#fromFile(), this.#fromText(), this.#fromNumbers()),
      make("div", { class: "rig-row rig-foot" }, press("Back", goBack), this.#next),
    );
  }

  show(): void {
    this.#rows.show(this.#rig.candidates);
    this.#none.hidden = this.#rig.candidates.length > 0;
    this.#list.hidden = this.#hint.hidden = this.#rig.candidates.length === 0;
    this.#hint.textContent = `Does this match your rig? ${this.#rig.hasScans ? "If above and below, or in front and behind, are swapped" : "If left and right are swapped"}, invert it; the wrong direction is the most common mistake.`;
    this.#next.textContent = this.#rig.candidates.length === 0 ? "Estimate a calibration" : "Run the check";
    // A file that is still being read may hold a calibration.
    const isReading = this.#rig.busy !== "" || this.#rig.items.some(({ state }) => state === "reading");
    this.#next.disabled = isReading || this.#rig.missing.length > 0;
  }

  #row(candidate: Candidate): { element: HTMLElement; show(candidate: Candidate): void } {
    const rig = this.#rig;
    const name = make("input", { type: "text", value: candidate.name, autocomplete: "off" });
    const note = make("span", { class: "rig-error" });
    name.addEventListener("change", () => {
      const wanted = name.value.trim();
      const isTaken = rig.candidates.some((each) => each !== candidate && each.name === wanted);
      note.textContent = isTaken ? "Another calibration has this name." : "";
      if (wanted && !isTaken) candidate.name = wanted;
      else name.value = candidate.name;
      rig.changed();
    });
    const words = make("p", { class: "rig-words" });
    const origin = make("p", { class: "soft" });
    const notes = make("ul", { class: "rig-notes" });
    const matrix = make("pre", {});
    const rank = make("span", { class: "rig-rank" });
    const invert = press("Invert", () => {
      candidate.pose = inverse(candidate.pose);
      candidate.origin = candidate.origin.endsWith(", inverted")
        ? candidate.origin.slice(0, -", inverted".length)
        : `${candidate.origin}, inverted`;
      rig.changed();
    });
    const first = press("Put first", () => {
      rig.candidates = [candidate, ...rig.candidates.filter((each) => each !== candidate)];
      rig.changed();
    });
    const remove = press(
      "×",
      () => {
        rig.undo.keep(`removing ${candidate.name}`, {
          where: "calibration",
          isMoot: () => rig.candidates.some(({ name }) => name === candidate.name),
        });
        rig.candidates = rig.candidates.filter((each) => each !== candidate);
        rig.changed();
      },
      { class: "icon" },
    );
    const element = make(
      "li",
      { class: "rig-candidate" },
      make("div", { class: "rig-row" }, rank, labelled("Name", name, note)),
      words,
      notes,
      origin,
      make("details", {}, make("summary", {}, "Matrix"), matrix),
      make("div", { class: "rig-row" }, invert, first, remove),
    );
    return {
      element,
      show: () => {
        if (document.activeElement !== name) name.value = candidate.name;
        words.textContent = placeInWords(candidate.pose, rig.hasScans);
        const apart = Math.hypot(...candidate.pose.translation);
        const isFar = apart > (rig.hasScans ? FAR_ON_VEHICLE : FAR);
        const farWords = `${decimals(apart, apart > 10 ? 0 : 2)} m apart is far for one rig. Is the translation in metres, and does the pose relate the two cameras?`;
        // Guesses about a file appear here as well, because it may have been dropped here.
        const warnings = candidate.guessed ?? rig.item(candidate.file)?.summary?.warnings ?? [];
        notes.replaceChildren(
          ...[...(isFar ? [farWords] : []), ...warnings.map(({ message }) => message)].map((each) =>
            make("li", {}, each),
          ),
        );
        origin.textContent = `From ${candidate.origin}.`;
        matrix.textContent = matrixText(candidate.pose);
        const isFirst = rig.candidates[0] === candidate;
        rank.textContent = isFirst ? "being checked" : "for comparison";
        first.hidden = isFirst;
        invert.setAttribute("aria-label", `Invert ${candidate.name}`);
        remove.setAttribute("aria-label", `Remove ${candidate.name}`);
      },
    };
  }

  #fromFile(): HTMLElement {
    const drop = dropTarget(
      { title: "From a file", hint: "4x4 text, Kalibr, ROS tf, Open3D, OpenCV, RealSense", files: "Choose a file" },
      (files) => void this.#add(files),
      this.element,
    );
    return make("section", { class: "rig-card" }, drop);
  }

  async #add(files: { name: string; blob: Blob }[]): Promise<void> {
    this.#complain("");
    const before = this.#rig.candidates.length;
    await this.#rig.add(files);
    const added = this.#rig.items.slice(-files.length);
    const failed = added.find(({ state }) => state === "failed");
    if (failed) this.#complain(failed.error ?? "");
    else if (this.#rig.candidates.length === before)
      this.#complain(`No calibration was found in ${files.map(({ name }) => name).join(", ")}.`);
  }

  #fromText(): HTMLElement {
    const text = make("textarea", {
      rows: 4,
      spellcheck: "false",
      placeholder: "1 0 0 0.025\n0 1 0 0\n0 0 1 0\n0 0 0 1",
    });
    const add = press("Add what I pasted", () => void this.#paste(text.value));
    return make("section", { class: "rig-card" }, labelled("Or paste it in any of these formats", text), add);
  }

  async #paste(text: string): Promise<void> {
    this.#complain("");
    const id = this.#rig.freshId();
    const name = "pasted text";
    try {
      const { poses, warnings } = await this.#rig.session.call("read", {
        file: id,
        name,
        blob: new Blob([text]),
        as: "poses",
      });
      if (poses.length === 0) throw new Error("No calibration was found in the text.");
      if (poses.every(isOfWorld))
        throw new Error(
          "This is the pose of a camera in the world (camera to world). A calibration transforms points from the depth camera to the colour camera.",
        );
      const ofSensors = poses.filter((each) => !isOfWorld(each) && !isOfCarrier(each));
      if (ofSensors.length === 0)
        throw new Error(
          "This pose relates a sensor to a body, a vehicle, a robot or a calibration target. A calibration transforms points from the depth camera or the LiDAR to the colour camera.",
        );
      for (const pose of ofSensors)
        this.#rig.addPose({ ...pose, name: pose.name ?? "pasted" }, name).guessed = warnings;
    } catch (error) {
      this.#complain(messageOf(error));
    } finally {
      void this.#rig.session.call("forget", { file: id }).catch(() => {});
    }
  }

  #fromNumbers(): HTMLElement {
    const shift = [NaN, NaN, NaN];
    const turn = [NaN, NaN, NaN, NaN];
    let by: By = "quaternion";
    const shifts = ["x", "y", "z"].map((axis, i) => numberField(axis, "m", (value) => (shift[i] = value)).element);
    const turns = turn.map((_, i) => numberField("", "", (value) => (turn[i] = value)));
    const label = () =>
      turns.forEach(({ element }, i) => {
        const words = TURNS[by][i];
        element.hidden = words === undefined;
        const text = element.querySelector("label");
        if (text && words) text.textContent = by === "quaternion" ? words : `${words}, °`;
      });
    const kind = choose(
      [
        { value: "quaternion", label: "quaternion (w last)" },
        { value: "rpy", label: "roll, pitch, yaw (ROS)" },
        { value: "xyz", label: "R = Rx Ry Rz" },
      ],
      by,
      (value) => {
        by = value as By;
        label();
      },
    );
    label();
    const note = make("p", { class: "rig-error", role: "alert" });
    const add = press("Add these numbers", () => {
      const count = TURNS[by].length;
      const [a = NaN, b = NaN, c = NaN, d = NaN] = turn;
      const isWhole = [...shift, ...turn.slice(0, count)].every(Number.isFinite);
      const rotation = !isWhole ? undefined : by === "quaternion" ? fromQuaternion(a, b, c, d) : fromEuler(a, b, c, by);
      note.textContent = rotation
        ? ""
        : isWhole
          ? "The quaternion has length zero, so it is not a rotation."
          : "Some numbers are missing.";
      if (rotation) this.#rig.addPose({ name: "typed in", pose: poseOf(rotation, shift) }, "what was typed in");
    });
    return make(
      "section",
      { class: "rig-card" },
      make(
        "fieldset",
        {},
        make("legend", {}, "Or enter it, from depth to colour"),
        make("div", { class: "rig-four" }, ...shifts),
        labelled("Rotation as", kind),
        make("div", { class: "rig-four" }, ...turns.map(({ element }) => element)),
        note,
        add,
      ),
    );
  }

  #complain(message: string): void {
    this.#alert.textContent = message;
    this.#alert.hidden = message === "";
  }
}
