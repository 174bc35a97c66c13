/** Which place of the page an address refers to. An address without a place holds settings of the Lab. */

export type Place = "lab" | "learn" | "tables" | "rig";

const NAMED = /^#(learn|tables|rig)(?=&|$)/;

export const placeOf = (hash: string): Place => (NAMED.exec(hash)?.[1] as Place | undefined) ?? "lab";

/** Whether one figure of Learn is to be shown alone, as in a frame of another page. */
export const isEmbedded = (hash: string): boolean =>
  placeOf(hash) === "learn" && new URLSearchParams(hash.replace(/^#/, "")).has("embed");

/** Beside its settings an address may ask that the run begins; once it has begun the word is taken out. */
export const asksToPlay = (hash: string): boolean => new URLSearchParams(hash.replace(/^#/, "")).has("play");
