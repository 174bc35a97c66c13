/**
 * The visitor's files in the browser's own database, so that a reload keeps them. Every access may fail, because storage is full or
 * forbidden.
 */

/** The slot of a visitor's file. */
export type Slot = "colour" | "depth" | "colourMask" | "depthMask";

export type Files = Partial<Record<Slot, File>>;

const [NAME, STORE] = ["bimodal-stereo", "own-files"];

const done = <T>(request: IDBRequest<T>): Promise<T> =>
  new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error("the browser's storage failed"));
  });

function opened(): Promise<IDBDatabase> {
  const request = indexedDB.open(NAME, 1);
  request.onupgradeneeded = () => request.result.createObjectStore(STORE);
  return done(request);
}

/** One transaction. */
async function change(work: (store: IDBObjectStore) => void): Promise<void> {
  const database = await opened();
  try {
    const transaction = database.transaction(STORE, "readwrite");
    const end = new Promise<void>((resolve, reject) => {
      transaction.oncomplete = () => resolve();
      transaction.onabort = transaction.onerror = () =>
        reject(transaction.error ?? new Error("the browser's storage failed"));
    });
    end.catch(() => {}); // reported once, whichever comes first
    work(transaction.objectStore(STORE));
    await end;
  } finally {
    database.close();
  }
}

/** All tabs of the page store files in the same place and notify each other of changes. */
const tabs = channel();

function channel(): BroadcastChannel | undefined {
  try {
    return new BroadcastChannel(`${NAME} ${STORE}`);
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
  await change((store) => {
    store.clear();
    for (const [slot, file] of Object.entries(files)) store.put(file, slot);
  });
  tabs?.postMessage(namesOf(files));
}

export const forget = (): Promise<void> => keep({});

export async function kept(): Promise<Map<string, File>> {
  const database = await opened();
  try {
    const store = database.transaction(STORE).objectStore(STORE);
    const [keys, values] = await Promise.all([done(store.getAllKeys()), done(store.getAll())]);
    return new Map(
      keys.flatMap((key, i): [string, File][] => (values[i] instanceof File ? [[String(key), values[i]]] : [])),
    );
  } finally {
    database.close();
  }
}

/** Why files could not be stored, in words. */
export function reasonOf(error: unknown): string {
  const name = error instanceof DOMException ? error.name : "";
  return name === "QuotaExceededError" ? "its storage is full" : "it does not let this page store files";
}
