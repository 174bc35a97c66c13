/** Everything that goes wrong here for a reason the caller can name. */
export class BimodalError extends Error {
  override readonly name = "BimodalError";
  /** Stable, for programs: "size", "range", "missing", "empty", "option", "type", "unsupported", "freed", "state", "panic", "poisoned", ... */
  readonly code: string;
  /** The input at fault, as a path in the contract, e.g. "depth.camera.fx". */
  declare readonly field?: string;

  constructor(code: string, message: string, field?: string, options?: ErrorOptions) {
    super(message, options);
    this.code = code;
    // Absent rather than undefined, so that `"field" in error` tells the truth.
    if (field !== undefined) this.field = field;
  }
}

/** What is wrong with a file. */
export const badFile = (message: string, cause?: unknown) =>
  new BimodalError("file", `file: ${message}`, "file", cause === undefined ? undefined : { cause });

/** How errors cross from wasm: plain data. */
interface Crossing {
  code: string;
  field: string;
  message: string;
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

/** Whether the numerics broke off in the middle: whatever they were working on is suspect from then on. */
export const isPanic = (error: unknown): boolean => error instanceof WebAssembly.RuntimeError;

/** What came out of wasm as what the contract promises; anything else passes unchanged. */
export function translate(error: unknown): unknown {
  if (isCrossing(error)) return new BimodalError(error.code, error.message, error.field);
  if (isPanic(error)) {
    const message = "the numerics broke off; this is a bug. Free this estimator and make another one";
    return new BimodalError("panic", message, undefined, { cause: error });
  }
  return error;
}
