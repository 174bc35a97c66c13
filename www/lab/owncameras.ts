/** The cameras of the visitor's files: the picture that each one took, its numbers in the Lab's fields, and remarks about them. */

import type { Pinhole } from "../../pkg/index.js";
import type { GivenCamera, PictureSize } from "../rig/protocol";
import type { Remark } from "./intake";
import { camerasFor, lookAt } from "./look";
import type { Settings, Value } from "./settings";
import type { Files } from "./storage";

type Side = "colour" | "depth";
type Fields = Record<string, Value>;

/** A camera in the Lab's fields. */
function fieldsOf(side: Side, { model, fx, fy, cx, cy, distortion = [] }: Pinhole): Fields {
  const isBent = model === "fisheye" || Array.from(distortion).some((value) => value !== 0);
  return {
    [`${side}.fx`]: fx,
    [`${side}.fy`]: fy,
    [`${side}.cx`]: cx,
    [`${side}.cy`]: cy,
    [`${side}.model`]: model ?? "brown",
    [`${side}.distortion`]: isBent ? Array.from(distortion).join(" ") : "",
  };
}

const holds = (settings: Settings, fields: Fields): boolean =>
  Object.entries(fields).every(([key, value]) => settings[key] === value);

async function sizeOf(file: File | undefined): Promise<PictureSize | undefined> {
  const { width, height, organised } = file ? await lookAt(file) : {};
  return width && height ? { width, height, ...(organised ? { organised } : {}) } : undefined;
}

export interface Assigned {
  fields: Fields;
  remarks: Remark[];
}

export class OwnCameras {
  #given: GivenCamera[] = [];
  /** The fields that were filled last; undefined after a new file. */
  #filled: Fields | undefined;

  /** Cameras of new files replace all others. */
  bring(given: GivenCamera[]): void {
    if (given.length === 0) return;
    this.#given = given;
    this.#filled = undefined;
  }

  forget(): void {
    this.#given = [];
    this.#filled = undefined;
  }

  /** Whether the fields still hold the values from the files. */
  areIn(settings: Settings): boolean {
    return this.#filled === undefined || holds(settings, this.#filled);
  }

  /** The numbers for these pictures; undefined without cameras, or if the visitor has changed the fields. */
  async assign(files: Files, settings: Settings): Promise<Assigned | undefined> {
    const given = this.#given;
    if (given.length === 0 || !this.areIn(settings)) return undefined;
    const [colour, depth] = [await sizeOf(files.colour), await sizeOf(files.depth)];
    if (!colour || !depth) {
      const names = [...new Set(given.map(({ file }) => file))].join(", ");
      return {
        fields: {},
        remarks: [{ words: `${names}: intrinsics. They are used once both pictures are here.`, wrong: false }],
      };
    }
    const found = await camerasFor({ cameras: given, colour, depth });
    if (this.#given !== given) return undefined;
    const fields: Fields = {};
    const remarks: Remark[] = [];
    const isShared = given.length === 1 && found.colour !== undefined && found.depth !== undefined;
    const isOfBoth = isShared ? ", used for both images" : "";
    for (const side of ["colour", "depth"] as const) {
      const camera = found[side];
      if (!camera) continue;
      Object.assign(fields, fieldsOf(side, camera.camera));
      const words = `${camera.file}: the ${side} camera${isOfBoth}. Its numbers are in the fields below; Undo removes them.`;
      remarks.push({ words, wrong: false });
    }
    const isLeftOut = found.warnings.some(({ code }) => code === "camera-left-out");
    const isSaid = (code: string) => code === "camera-shared" && colour.width === depth.width;
    for (const { code, message } of found.warnings.filter((each) => !isSaid(each.code)))
      remarks.push({ words: message, wrong: code === "camera-left-out" || (isLeftOut && code === "camera-size") });
    this.#filled = fields;
    return { fields, remarks };
  }
}
