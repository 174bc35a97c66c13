/** The browser's own database, which keeps the visitor's files over a reload. Every access may fail: storage may be full or forbidden. */

const NAME = "bimodal-stereo";
const STORES = ["own-files", "rig"] as const;
/** The version of the database, which rises with each store that is added. */
const VERSION = 2;

type StoreName = (typeof STORES)[number];

const done = <T>(request: IDBRequest<T>): Promise<T> =>
  new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error("the browser's storage failed"));
  });

function opened(): Promise<IDBDatabase> {
  const request = indexedDB.open(NAME, VERSION);
  request.onupgradeneeded = () => {
    const { result } = request;
    for (const store of STORES) if (!result.objectStoreNames.contains(store)) result.createObjectStore(store);
  };
  return done(request);
}

/** One transaction. */
export async function change(name: StoreName, work: (store: IDBObjectStore) => void): Promise<void> {
  const database = await opened();
  try {
    const transaction = database.transaction(name, "readwrite");
    const end = new Promise<void>((resolve, reject) => {
      transaction.oncomplete = () => resolve();
      transaction.onabort = transaction.onerror = () =>
        reject(transaction.error ?? new Error("the browser's storage failed"));
    });
    end.catch(() => {}); // The first failure, of the work or of the transaction, is reported.
    work(transaction.objectStore(name));
    await end;
  } finally {
    database.close();
  }
}

/** All records by their keys. */
export async function records(name: StoreName): Promise<Map<string, unknown>> {
  const database = await opened();
  try {
    const store = database.transaction(name).objectStore(name);
    const [keys, values] = await Promise.all([done(store.getAllKeys()), done<unknown[]>(store.getAll())]);
    return new Map(keys.map((key, i): [string, unknown] => [String(key), values[i]]));
  } finally {
    database.close();
  }
}

/** Why files could not be stored, in words. */
export function reasonOf(error: unknown): string {
  const name = error instanceof DOMException ? error.name : "";
  return name === "QuotaExceededError" ? "its storage is full" : "it does not let this page store files";
}
