/** What can go wrong, for programs. */
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

/** Everything that goes wrong here for a reason the caller can name. */
export class BimodalError extends Error {
  /** Always "BimodalError". */
  override readonly name = "BimodalError";
  /** Stable, for programs; docs/codes.md has cause and remedy of each. */
  readonly code: ErrorCode;
  /** The input at fault, as a path in the contract, e.g. "depth.camera.fx". */
  declare readonly field?: string;
  /** Index into the field's array, where one entry is at fault. */
  declare readonly index?: number;
  /** The number at fault, where the numerics name it. */
  declare readonly value?: number;

  constructor(
    code: ErrorCode,
    message: string,
    field?: string,
    options?: ErrorOptions & { index?: number | undefined; value?: number | undefined },
  ) {
    super(message, options);
    this.code = code;
    // Absent rather than undefined, so that `"field" in error` tells the truth.
    if (field !== undefined) this.field = field;
    if (options?.index !== undefined) this.index = options.index;
    if (options?.value !== undefined) this.value = options.value;
  }
}

/** What is wrong with a file. */
export const badFile = (message: string, cause?: unknown) =>
  new BimodalError("file", `file: ${message}`, "file", cause === undefined ? undefined : { cause });

/** How errors cross from wasm: plain data. */
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

/** Whether the numerics broke off in the middle: whatever they were working on is suspect from then on. */
export const isPanic = (error: unknown): boolean => error instanceof WebAssembly.RuntimeError;

/** What came out of wasm as what the contract promises; anything else passes unchanged. */
export function translate(error: unknown): unknown {
  if (isCrossing(error)) {
    const { code, message, field, index, value } = error;
    return new BimodalError(code, message, field, { index, value });
  }
  if (isPanic(error)) {
    const message = "the numerics broke off; this is a bug. Free this estimator and make another one";
    return new BimodalError("panic", message, undefined, { cause: error });
  }
  return error;
}
