/** Errors that programs can handle by their codes. */
export type ErrorCode =
  | "size"
  | "range"
  | "missing"
  | "empty"
  | "degenerate"
  | "memory"
  | "unsupported"
  | "option"
  | "type"
  | "file"
  | "state"
  | "init"
  | "freed"
  | "panic"
  | "poisoned"
  | "internal";

/** An error with a cause that the caller can identify. */
export class BimodalError extends Error {
  /** Always "BimodalError". */
  override readonly name = "BimodalError";
  /** Stable, for programs; docs/codes.md has cause and remedy of each. */
  readonly code: ErrorCode;
  /** The input at fault, as a path in the contract, e.g. "depth.camera.fx". */
  declare readonly field?: string;
  /** Index into the field's array, if one entry is at fault. */
  declare readonly index?: number;
  /** The number at fault, if there is only one. */
  declare readonly value?: number;

  /** The values in the message. For a file they are `file`, `reason` and, if it is known, `problem`. */
  declare readonly details?: ErrorDetails;

  constructor(code: ErrorCode, message: string, field?: string, options?: BimodalErrorOptions) {
    super(message, options);
    this.code = code;
    // Absent rather than undefined, so that `"field" in error` works.
    if (field !== undefined) this.field = field;
    if (options?.index !== undefined) this.index = options.index;
    if (options?.value !== undefined) this.value = options.value;
    if (options?.details !== undefined) this.details = options.details;
  }
}

/** Further members of an error. */
interface BimodalErrorOptions extends ErrorOptions {
  index?: number | undefined;
  value?: number | undefined;
  details?: ErrorDetails;
}

/** Details of an error besides its code, for programs. */
export interface ErrorDetails {
  /** The file that could not be read. */
  readonly file?: string;
  /** The fault of the file; the text does not name the file. */
  readonly reason?: string;
  /**
   * "too-large": it exceeds a limit of the readers; "picture": its format is an image that browsers can read and these readers cannot;
   * "disparity": its name says that it holds disparities or inverse depths, which the option `inverse` reads; "kind": its name or its
   * numbers suggest another kind of file, and the option `as` overrides that.
   */
  readonly problem?: "too-large" | "picture" | "disparity" | "kind";
  /** For the problem "kind", the kind of file that the name or the numbers suggest, in words without a remedy. */
  readonly finding?: string;
  /** Columns of the file's picture, if the size is the problem. */
  readonly width?: number;
  /** Rows of the file's picture, if the size is the problem. */
  readonly height?: number;
}

/** The part of an error about a refused value: the number itself, and its index in the field. */
export const refused = (value: unknown, index?: number): { value: number | undefined; index: number | undefined } => ({
  value: typeof value === "number" ? value : undefined,
  index,
});

/** The message of any kind of error. */
export const reasonOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** The error about a file that has no name yet. */
export const badFile = (message: string, cause?: unknown, details?: ErrorDetails) =>
  new BimodalError("file", message, "file", {
    ...(cause !== undefined && { cause }),
    details: { reason: message, ...details },
  });

/** The error about the file with this name. */
export const badNamed = (name: string, reason: string, cause?: unknown, details?: ErrorDetails): BimodalError =>
  badFile(`${name}: ${reason}`, cause, { ...details, file: name, reason });

/** An error as it comes from wasm: plain data. */
interface Crossing {
  code: ErrorCode;
  field: string;
  message: string;
  index?: number;
  value?: number;
}

function isCrossing(value: unknown): value is Crossing {
  return (
    typeof value === "object" &&
    value !== null &&
    !(value instanceof Error) &&
    "code" in value &&
    "field" in value &&
    "message" in value &&
    typeof value.code === "string" &&
    typeof value.field === "string" &&
    typeof value.message === "string"
  );
}

/** Whether the numerics crashed during a call, so that their state can no longer be trusted. */
export const isPanic = (error: unknown): boolean => error instanceof WebAssembly.RuntimeError;

/** Turns an error of wasm into that of the contract; anything else passes unchanged. */
export function translate(error: unknown): unknown {
  if (isCrossing(error)) {
    const { code, message, field, index, value } = error;
    return new BimodalError(code, message, field, { index, value });
  }
  if (isPanic(error)) {
    const message = "the numerics crashed, which is a bug. Free this estimator and create another one";
    return new BimodalError("panic", message, undefined, { cause: error });
  }
  return error;
}
