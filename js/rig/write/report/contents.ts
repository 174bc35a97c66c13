/** What a report may hold beside what the check found. */

export interface Picture {
  title: string;
  /** `data:image/png;base64,..`, or JPEG, WebP, AVIF or GIF. */
  dataUrl: string;
}

export interface ReportInput {
  name: string;
  /** What was read in it, in words. */
  says?: string | undefined;
  /** Of its bytes, in hexadecimal. */
  sha256?: string | undefined;
}

export interface ReportOptions {
  /** "Check of a calibration" without it. */
  title?: string | undefined;
  /** When it was made; no date without it. */
  made?: Date | undefined;
  /** The files that were read. */
  inputs?: readonly ReportInput[] | undefined;
}
