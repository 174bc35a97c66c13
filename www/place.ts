/** The part of the page to which an address refers. An address without a part holds settings of the Lab. */

export type Place = "lab" | "learn" | "tables" | "rig";

const NAMED = /^#(learn|tables|rig)(?=&|$)/;

export const placeOf = (hash: string): Place => (NAMED.exec(hash)?.[1] as Place | undefined) ?? "lab";

/** Whether the page shows only one figure of Learn, for example in a frame of another page. */
export const isEmbedded = (hash: string): boolean =>
  placeOf(hash) === "learn" && new URLSearchParams(hash.replace(/^#/, "")).has("embed");

/** Beside its settings an address may request that the run begins; this word is removed once the run has begun. */
export const asksToPlay = (hash: string): boolean => new URLSearchParams(hash.replace(/^#/, "")).has("play");
