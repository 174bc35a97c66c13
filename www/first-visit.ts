/** Whether this browser has shown the page before; asking counts as a visit. */

const KEY = "bimodal-stereo.visited";

/** Private windows may refuse storage: each visit is then the first. */
export function isFirstVisit(): boolean {
  try {
    const known = localStorage.getItem(KEY) !== null;
    localStorage.setItem(KEY, "yes");
    return !known;
  } catch {
    return true;
  }
}
