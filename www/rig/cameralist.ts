/** The two cameras of the rig: from a file, typed in, by a field of view, or of a common sensor. */

import { make } from "../dom";
import { decimals } from "../draw/numbers";
import { choose, fill, labelled, numberField, press, show, toNumber } from "./parts";
import { cameraDoubt } from "./doubts";
import { typedFrom, type Rig, type Side, type TypedCamera } from "./rig";
import type { Sensor } from "./sensors";
import { hasShape } from "./typed";

const fields = [
  { key: "fx", label: "fx", unit: "px" },
  { key: "fy", label: "fy", unit: "px" },
  { key: "cx", label: "cx", unit: "px" },
  { key: "cy", label: "cy", unit: "px" },
  { key: "view", label: "Horizontal field of view", unit: "°" },
] as const;

export class CameraForm {
  readonly element: HTMLElement;
  readonly #rig: Rig;
  readonly #side: Side;
  readonly #source = make("select");
  readonly #sensor = make("select");
  readonly #sensorField = labelled("Sensor", this.#sensor);
  /** The table, once it has loaded. */
  #sensors: readonly Sensor[] | undefined;
  readonly #numbers = make("p", { class: "soft rig-camera-numbers" });
  readonly #form = make("div", { class: "rig-camera-form" });
  readonly #inputs = new Map<keyof TypedCamera, { element: HTMLElement; input: HTMLInputElement }>();
  readonly #by: HTMLSelectElement;
  readonly #model: HTMLSelectElement;
  readonly #distortion = make("input", { type: "text", autocomplete: "off", spellcheck: "false", placeholder: "none" });
  readonly #distortionNote = make("span", { class: "soft rig-hint" });
  readonly #edit: HTMLButtonElement;

  constructor(rig: Rig, side: Side) {
    this.#rig = rig;
    this.#side = side;
    const mine = rig.cameras[side];
    this.#source.addEventListener("change", () => {
      mine.source = this.#source.value;
      mine.chosen = true;
      rig.changed();
    });
    this.#sensor.addEventListener("change", () => {
      const found = this.#sensors?.find(({ name }) => name === this.#sensor.value);
      if (found) mine.sensor = found;
      else delete mine.sensor;
      rig.changed();
    });
    this.#by = choose(
      [
        { value: "focal", label: "focal lengths and centre" },
        { value: "view", label: "field of view" },
      ],
      "focal",
      (value) => {
        mine.typed.by = value as TypedCamera["by"];
        rig.changed();
      },
    );
    this.#model = choose(
      [
        { value: "brown", label: "Brown (OpenCV)" },
        { value: "fisheye", label: "fisheye (Kannala-Brandt)" },
      ],
      "brown",
      (value) => {
        mine.typed.model = value as TypedCamera["model"];
        rig.changed();
      },
    );
    this.#distortion.addEventListener("input", () => {
      const numbers = this.#distortion.value
        .trim()
        .split(/[\s,;[\]]+/)
        .filter(Boolean)
        .map(toNumber);
      mine.typed.distortion = numbers;
      rig.changed();
    });
    this.#edit = press("Edit these parameters", () => {
      const camera = rig.cameraOf(side);
      if (!camera) return;
      mine.typed = typedFrom(camera);
      mine.source = "typed";
      mine.chosen = true;
      rig.changed();
      this.#inputs.get("fx")?.input.focus();
    });
    for (const { key, label, unit } of fields) {
      this.#inputs.set(
        key,
        numberField(label, unit, (value) => {
          mine.typed[key] = value;
          rig.changed();
        }),
      );
    }
    const title = side === "colour" ? "Colour camera" : "Depth camera";
    this.#form.append(
      labelled("Given as", this.#by),
      ...fields.map(({ key }) => this.#inputs.get(key)?.element ?? ""),
      labelled("Distortion model", this.#model),
      labelled("Distortion", this.#distortion, this.#distortionNote),
    );
    this.element = make(
      "fieldset",
      { class: "rig-camera" },
      make("legend", {}, title),
      labelled("Source of its parameters", this.#source),
      this.#sensorField,
      this.#numbers,
      this.#edit,
      this.#form,
    );
  }

  /** The sensors whose pictures have the shape of this one; the table loads when it is first asked for. */
  #showSensors(): void {
    if (!this.#sensors) {
      void import("./sensors").then(({ SENSORS }) => {
        this.#sensors = SENSORS;
        this.show();
      });
      return;
    }
    const { sensor } = this.#rig.cameras[this.#side];
    const size = this.#rig.sizeOf(this.#side);
    const fitting = this.#sensors.filter((each) => each.sides.includes(this.#side) && hasShape(each, size));
    const shape = size ? ` for ${size.width}×${size.height} px` : "";
    const none = { value: "", label: fitting.length > 0 ? "Select one" : `No sensor in the list${shape}` };
    fill(this.#sensor, [none, ...fitting.map(({ name }) => ({ value: name, label: name }))], sensor?.name ?? "");
  }

  show(): void {
    const { given, cameras } = this.#rig;
    const { source, typed } = cameras[this.#side];
    const unknown = this.#side === "colour" ? "Unknown: estimate its focal length" : "Not given yet";
    const same =
      this.#side === "depth" ? [{ value: "same", label: "The colour camera's (depth aligned to colour)" }] : [];
    fill(
      this.#source,
      [
        { value: "", label: unknown },
        ...same,
        ...given.map((each) => ({ value: each.source, label: each.label })),
        { value: "typed", label: "Enter them" },
        { value: "sensor", label: "A common sensor (a guess)" },
      ],
      source,
    );
    this.#sensorField.hidden = source !== "sensor";
    if (source === "sensor") this.#showSensors();
    this.#form.hidden = source !== "typed";
    const isNeeded = this.#side === "colour" || this.#rig.needsDepthCamera;
    const camera = isNeeded ? this.#rig.cameraOf(this.#side) : undefined;
    const isFile = source !== "" && source !== "typed" && camera !== undefined;
    this.#edit.hidden = !isFile;
    this.#numbers.textContent = camera
      ? words(camera, cameraDoubt(this.#rig, this.#side))
      : source === "typed"
        ? "Some numbers are missing."
        : source === "sensor"
          ? "Select the sensor. Its published figures are a guess, so the verdict will be capped."
          : isNeeded
            ? ""
            : "Not needed: the depth maps are clouds, which hold the positions of their points.";
    this.#by.value = typed.by;
    this.#model.value = typed.model;
    for (const { key } of fields) {
      const field = this.#inputs.get(key);
      if (!field) continue;
      field.element.hidden = (key === "view") !== (typed.by === "view");
      show(field.input, typed[key]);
    }
    if (document.activeElement !== this.#distortion) this.#distortion.value = typed.distortion.join(" ");
    const count = typed.distortion.length;
    const allowed = typed.model === "brown" ? [0, 4, 5, 8] : [0, 4];
    const isWrong = !allowed.includes(count) || typed.distortion.some(Number.isNaN);
    this.#distortion.toggleAttribute("aria-invalid", isWrong);
    this.#distortionNote.textContent =
      typed.model === "brown"
        ? "k1 k2 p1 p2 [k3 [k4 k5 k6]]: 4, 5 or 8 numbers, or none"
        : "k1 k2 k3 k4: 4 numbers, or none";
  }
}

function words(
  camera: { fx: number; fy: number; cx: number; cy: number; model?: string; distortion?: ArrayLike<number> },
  remark: string,
): string {
  const { fx, fy, cx, cy, model = "brown", distortion } = camera;
  const px = (value: number) => decimals(value, 2);
  const lens =
    distortion && distortion.length > 0
      ? `${model === "brown" ? "Brown" : "fisheye"} distortion ${Array.from(distortion, (value) => decimals(value, 4)).join(" ")}`
      : "no distortion";
  return `fx ${px(fx)}, fy ${px(fy)}, cx ${px(cx)}, cy ${px(cy)} px; ${lens}.${remark && ` Note: ${remark}`}`;
}
