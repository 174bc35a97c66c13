/** Whether this is the browser's first visit to the page; the query itself counts as a visit. */

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
