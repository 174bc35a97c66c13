/** Functions that Node has and browsers lack. */

interface Modules {
  "node:fs/promises": typeof import("node:fs/promises");
  "node:worker_threads": typeof import("node:worker_threads");
}

/**
 * A module of Node; undefined in a browser. It is loaded by name at run time instead of imported: bundlers for browsers follow every
 * import, even one that no browser reaches, and fail on Node's modules or replace them by empty ones.
 */
export const nodeModule = <K extends keyof Modules>(name: K): Modules[K] | undefined =>
  globalThis.process?.getBuiltinModule?.(name) as Modules[K] | undefined;
