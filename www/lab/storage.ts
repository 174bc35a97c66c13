/** The visitor's files of the Lab, kept over a reload. */

import { change, records } from "../database";

export { reasonOf } from "../database";

/** The slot of a visitor's file. */
export type Slot = "colour" | "depth" | "colourMask" | "depthMask";

export type Files = Partial<Record<Slot, File>>;

const STORE = "own-files";

/** All tabs of the page store files in the same place and notify each other of changes. */
const tabs = channel();

function channel(): BroadcastChannel | undefined {
  try {
    return new BroadcastChannel(`bimodal-stereo ${STORE}`);
  } catch {
    // Some browsers forbid the channel together with storage; nothing is stored then.
    return undefined;
  }
}

/** Identifies files without reading them. */
const namesOf = (files: Files): string =>
  JSON.stringify(
    Object.entries(files)
      .map(([slot, { name, size, lastModified }]) => [slot, name, size, lastModified])
      .sort(),
  );

/** Reports what another tab has stored, or that it has removed everything. */
export function hearOthers(here: () => Files, tell: (isEmpty: boolean) => void): void {
  if (!tabs) return;
  tabs.onmessage = ({ data }: MessageEvent<string>) => {
    if (data !== namesOf(here())) tell(data === namesOf({}));
  };
}

/** Stores these files and no others. */
export async function keep(files: Files): Promise<void> {
  await change(STORE, (store) => {
    store.clear();
    for (const [slot, file] of Object.entries(files)) store.put(file, slot);
  });
  tabs?.postMessage(namesOf(files));
}

export const forget = (): Promise<void> => keep({});

export async function kept(): Promise<Map<string, File>> {
  const all = [...(await records(STORE))];
  return new Map(all.filter((entry): entry is [string, File] => entry[1] instanceof File));
}
