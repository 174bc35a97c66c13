/** A drop target for any number of files or a folder, with two buttons that do the same. */

import { freshId, make } from "../dom";

export interface Named {
  name: string;
  blob: Blob;
}

/** A limit far above what a check needs: further files are left out, with a message. */
const MOST_FILES = 4000;

async function walk(entry: FileSystemEntry, path: string, found: Named[]): Promise<void> {
  if (found.length >= MOST_FILES) return;
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    found.push({ name: `${path}${file.name}`, blob: file });
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  for (;;) {
    // A reader returns a hundred entries at a time, and none at the end.
    const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return;
    for (const each of entries) if (!each.name.startsWith(".")) await walk(each, `${path}${entry.name}/`, found);
  }
}

/** The dropped files; entries must be read before anything is awaited. */
async function dropped(data: DataTransfer): Promise<{ files: Named[]; isFolder: boolean }> {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (entries.every((entry) => entry.isFile))
    return { files: [...data.files].map((file) => ({ name: file.name, blob: file })), isFolder: false };
  const files: Named[] = [];
  for (const entry of entries) await walk(entry, "", files);
  return { files, isFolder: true };
}

export function dropTarget(
  words: { title: string; hint: string; files: string; folder?: string },
  onFiles: (files: Named[], isFolder: boolean) => void,
  area?: HTMLElement,
): HTMLElement {
  const id = freshId("drop");
  const picker = make("input", {
    id,
    type: "file",
    multiple: true,
    class: "visually-hidden",
    "aria-describedby": `${id}-hint`,
  });
  const folder = make("input", {
    id: `${id}-folder`,
    type: "file",
    multiple: true,
    webkitdirectory: true,
    class: "visually-hidden",
  });
  const zone = make(
    "div",
    { class: "rig-drop" },
    make("strong", {}, words.title),
    make("span", { class: "soft", id: `${id}-hint` }, words.hint),
    make(
      "div",
      { class: "rig-row" },
      picker,
      make("label", { for: id, class: "rig-button" }, words.files),
      ...(words.folder ? [folder, make("label", { for: `${id}-folder`, class: "rig-button" }, words.folder)] : []),
    ),
  );
  for (const [input, isFolder] of [
    [picker, false],
    [folder, true],
  ] as const) {
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])]
        .slice(0, MOST_FILES)
        .map((file) => ({ name: file.webkitRelativePath || file.name, blob: file }));
      input.value = ""; // Emptied, so that the same file can be picked again after a change on disk.
      if (files.length > 0) onFiles(files, isFolder);
    });
  }
  // Files dropped beside the target are accepted, too.
  const all = area ?? zone;
  all.addEventListener("dragover", (event) => {
    event.preventDefault();
    zone.toggleAttribute("data-over", true);
  });
  all.addEventListener("dragleave", (event) => {
    if (!(event.relatedTarget instanceof Node && all.contains(event.relatedTarget))) zone.removeAttribute("data-over");
  });
  all.addEventListener("drop", (event) => {
    event.preventDefault();
    zone.removeAttribute("data-over");
    if (!event.dataTransfer) return;
    void dropped(event.dataTransfer).then(({ files, isFolder }) => files.length > 0 && onFiles(files, isFolder));
  });
  return zone;
}
