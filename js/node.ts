/** What Node has and browsers lack. */

interface Modules {
  "node:fs/promises": typeof import("node:fs/promises");
  "node:worker_threads": typeof import("node:worker_threads");
}

/**
 * A module of Node's own; nothing elsewhere. It is asked for by name while the program runs: bundlers for browsers follow
 * every import, also one that a browser never reaches, and refuse what they find or put something empty in its place.
 */
export const nodeModule = <K extends keyof Modules>(name: K): Modules[K] | undefined =>
  globalThis.process?.getBuiltinModule?.(name) as Modules[K] | undefined;
