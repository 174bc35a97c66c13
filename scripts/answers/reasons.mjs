// Results that a refactoring has moved beyond the limits of compare.mjs, and the sum that was reordered. Empty the list after writing
// new figures.
//   { scene: "its name", moved: ["heights", "light"], sum: "the normal equations of the light are added up row by row" }
export const REASONS = [];
