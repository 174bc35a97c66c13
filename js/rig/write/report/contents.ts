/** The contents of a report: the result of the check, and what the caller adds. */
import type { CheckReport, Warning } from "../../../types/index.js";

/** The result of a check; its warnings may include messages of the caller. */
export interface Checked extends Omit<CheckReport, "warnings"> {
  warnings: readonly (string | Pick<Warning, "message">)[];
}

/** A picture that the report shows. */
export interface Picture {
  /** Shown above it. */
  title: string;
  /** `data:image/png;base64,..`, or JPEG, WebP, AVIF or GIF. */
  dataUrl: string;
}

/** A file that the report names. */
export interface ReportInput {
  /** Of the file. */
  name: string;
  /** A description of what was read from it. */
  says?: string | undefined;
  /** Of its bytes, in hexadecimal. */
  sha256?: string | undefined;
}

/** What a report states besides the result. */
export interface ReportOptions {
  /** "Check of a calibration" without it. */
  title?: string | undefined;
  /** When it was made; no date without it. */
  made?: Date | undefined;
  /** The files that were read. */
  inputs?: readonly ReportInput[] | undefined;
}
