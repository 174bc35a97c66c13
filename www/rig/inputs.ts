/** The files of a check for its report, with sizes and hashes. A folder is listed by its files, not by the items made from them. */

import { sha256 } from "../hash";
import type { Reading } from "./files";
import type { Calls } from "./protocol";
import type { ReportInput } from "./report";

/** A folder that was read: its items, and its files. */
export interface ReadFolder {
  /** The ids of the folder's items. */
  items: number[];
  files: { name: string; blob: Blob }[];
  readings: Reading[];
}

async function inputOf(name: string, says: string, notes: string[], blob?: Blob): Promise<ReportInput> {
  const hash = blob && (await sha256(blob));
  return { name, says, notes, ...(blob && { bytes: blob.size }), ...(hash ? { sha256: hash } : {}) };
}

/** A file may be read twice, for its cameras and for its poses. */
const ofFolder = ({ files, readings }: ReadFolder): Promise<ReportInput[]> => {
  const blobs = new Map(files.map(({ name, blob }) => [name, blob]));
  const distinct = [...new Map(readings.map((each) => [each.name, each])).values()];
  const codes = ({ warnings }: Reading) => [...new Set(warnings.map(({ code }) => code))];
  return Promise.all(distinct.map((each) => inputOf(each.name, each.says, codes(each), blobs.get(each.name))));
};

export async function inputsOf(
  items: Calls["inputs"]["ask"]["items"],
  folders: readonly ReadFolder[],
): Promise<ReportInput[]> {
  const used = folders.filter((folder) => items.some(({ file }) => folder.items.includes(file)));
  const own = items.filter(
    ({ file, name }) => !used.some((folder) => folder.items.includes(file)) && !(name === FOLDER && used.length > 0),
  );
  const ofItems = await Promise.all(own.map(({ name, says, notes, blob }) => inputOf(name, says, notes, blob)));
  return [...ofItems, ...(await Promise.all(used.map(ofFolder))).flat()];
}

/** The name of the item that holds the cameras of a folder's files. */
const FOLDER = "the folder";

/** The hash of the numerics that this thread runs. */
export async function moduleHash(): Promise<string | undefined> {
  const [entry] = performance.getEntriesByType("resource").filter(({ name }) => /check_bg[^/]*\.wasm$/.test(name));
  const answer = entry && (await fetch(entry.name).catch(() => undefined));
  return answer?.ok ? sha256(await answer.blob()) : undefined;
}
