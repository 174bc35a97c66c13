/** Errors in a form that can be sent between threads. */

import { BimodalError } from "../../pkg/index.js";
import type { Fault } from "./protocol";

/** A failure in a worker, whose module may not have been `loaded`. */
export function faultOf(error: unknown, loaded: boolean): Fault {
  if (error instanceof BimodalError) {
    const { code, message, field, details } = error;
    return {
      code,
      message,
      fatal: code === "panic" || code === "poisoned" || !loaded,
      ...(field === undefined ? {} : { field }),
      ...(details === undefined ? {} : { details }),
    };
  }
  const reason = error instanceof Error ? error.message : String(error);
  const message = loaded ? reason : `the numerics could not be loaded (${reason})`;
  return { code: "internal", message, fatal: error instanceof WebAssembly.RuntimeError || !loaded };
}
