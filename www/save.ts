/** Saves a file on the visitor's machine. */

/** `content` says in words what the file contains. */
export function saveJson(name: string, content: string, value: unknown): void {
  saveBlob(name, new Blob([JSON.stringify(value, null, 2)], { type: "application/json" }));
  saves.dispatchEvent(new CustomEvent("saved", { detail: `${name}: ${content}` }));
}

/** Sends an event "saved" for each saved file of numbers, with its name and its content in words. */
export const saves = new EventTarget();

export function saveBlob(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  // Some browsers read the blob only after the click has returned.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
