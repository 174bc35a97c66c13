/** The metadata that realsense-viewer saves beside each picture of a snapshot, as CSV: the stream, its size and its intrinsics. */
import { badFile } from "../../errors.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { cameraOf } from "./cameras.js";
import { numberOf } from "./numbers.js";
import type { Calibration } from "./tree.js";

export const isMetadata = (text: string): boolean => /^Stream,[^\n]{1,60}\r?\nFormat,/.test(text);

export function readMetadata(text: string): Calibration {
  const entries = new Map(
    text.split(/\r?\n/).map((line) => {
      const [name = "", value = ""] = line.split(",");
      return [name.trim().toLowerCase().replace(/:$/, ""), value.trim()];
    }),
  );
  const number = (name: string) => numberOf(entries.get(name) ?? "") ?? NaN;
  if (!entries.has("fx"))
    throw badFile(
      "it is the metadata of a picture of realsense-viewer, without intrinsics; rs-enumerate-devices -c prints these",
    );
  const warnings: ReaderWarning[] = [];
  const name = entries.get("stream") ?? "";
  const model = entries.get("distorsion") ?? entries.get("distortion") ?? "";
  const size = { width: number("resolution x"), height: number("resolution y") };
  const camera = cameraOf(
    { name, focal: [number("fx"), number("fy")], centre: [number("ppx"), number("ppy")], ...size },
    warnings,
  );
  if (!/^(?:none)?$/i.test(model))
    warnings.push(
      warning(
        "lens-approximated",
        `The camera "${name}" has a lens of ${model}, whose coefficients these metadata do not give; it is read without distortion.`,
        { model },
      ),
    );
  return { cameras: [camera], poses: [], warnings };
}
