/** Single-key shortcuts for frequent actions. They are off while the visitor types or a dialog is open. */

const typing = "input:not([type=checkbox], [type=range], [type=file]), select, textarea, [contenteditable]";

/** Elements for which Space or Enter already has a meaning. */
const pressable = "button, a, summary, label, input";

const KEY = "bimodal-stereo.keys";

/** Whether the visitor wants shortcuts. Single keys interfere with speech input. */
export function areKeysOn(): boolean {
  try {
    return localStorage.getItem(KEY) !== "off";
  } catch {
    return true;
  }
}

export function rememberKeys(on: boolean): void {
  try {
    localStorage.setItem(KEY, on ? "on" : "off");
  } catch {
    // Private windows may refuse storage; the choice then lasts as long as the page.
  }
}

export function listenToKeys(isOn: () => boolean, actions: Record<string, () => void>): void {
  document.addEventListener("keydown", (event) => {
    if (!isOn() || event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target;
    if (target instanceof Element && target.closest(typing)) return;
    if (document.querySelector("dialog[open]")) return;
    if (event.key === " " && target instanceof Element && target.closest(pressable)) return;
    const action = actions[event.key];
    if (!action) return;
    // Escape also closes what the browser has opened.
    if (event.key !== "Escape") event.preventDefault();
    action();
  });
}
