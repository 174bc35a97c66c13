/** The contents of a report: the result of the check, and the caller's additions. */
import type { CheckReport, Pose, Warning } from "../../../types/index.js";

/** The result of a check; its warnings may include messages of the caller. */
export interface Checked extends Omit<CheckReport, "warnings"> {
  /** Warnings need no codes, because the report shows the messages. */
  warnings: readonly (string | Pick<Warning, "message">)[];
}

/** A picture that the report shows. */
export interface Picture {
  /** The title above the picture. */
  title: string;
  /** `data:image/png;base64,..`, or JPEG, WebP, AVIF or GIF. */
  dataUrl: string;
}

/** A frame with its depth edges under a pose, as `projectFrame` returns them. */
export interface Overlay {
  /** Name of the frame. */
  frame: string;
  /** Columns of the colour image, whose pixels the edges refer to. */
  width: number;
  /** Rows of the colour image. */
  height: number;
  /** The image, at any size: `data:image/jpeg;base64,..`, or PNG, WebP, AVIF or GIF. */
  picture: string;
  /** Column and row of each point of a depth edge, with the calibration in question; absent if there is only an estimate. */
  before?: ArrayLike<number> | undefined;
  /** Column and row of each of these points with the best fit. */
  after: ArrayLike<number>;
}

/** A file that the report names. */
export interface ReportInput {
  /** The name of the file. */
  name: string;
  /** A description of what was read from it. */
  says?: string | undefined;
  /** Size of the file, bytes. */
  bytes?: number | undefined;
  /** The codes of its warnings, including guesses. */
  notes?: readonly string[] | undefined;
  /** SHA-256 of the file's bytes, in hexadecimal. */
  sha256?: string | undefined;
}

/** A name and a value, in the form in which the report shows them. */
export type ReportEntry = readonly [name: string, value: string];

/** The contents of a report besides the result. */
export interface ReportOptions {
  /** The title. Default "Check of a calibration". */
  title?: string | undefined;
  /** Date of the report; without it the report shows none. */
  made?: Date | undefined;
  /** The files that were read. */
  inputs?: readonly ReportInput[] | undefined;
  /** Whether no calibration was in question, so that the candidate is only a placeholder. */
  isEstimate?: boolean | undefined;
  /** The extrinsics that were checked, under the names of the report's candidates. */
  calibrations?: Readonly<Record<string, Pick<Pose, "rotation" | "translation" | "angles">>> | undefined;
  /** Frames with their depth edges, the most important first. */
  overlays?: readonly Overlay[] | undefined;
  /** The command that repeats the check in a shell, and its limits. */
  shell?:
    | {
        /** The command, of one or more lines; absent if no command can repeat it. */
        command?: string | undefined;
        /** Where to type the command, and how its result differs from this one. */
        note?: string | undefined;
      }
    | undefined;
  /** Options of the check with their values. */
  settings?: readonly ReportEntry[] | undefined;
  /** Versions of the programs that made the report. */
  versions?: readonly ReportEntry[] | undefined;
}
