/** What can be taken away, by the names of its buttons. */

export const kinds = ["pose", "matrix", "clouds", "depth", "light"] as const;
export type Kind = (typeof kinds)[number];
