/**
 * Stores the page's files, so that it opens without a network. All of them are fetched once, checked against the hashes that the build
 * recorded, and answered from the cache; versions are never mixed. A new version is fetched beside the old one, and replaces it once no tab
 * shows the old one any more. The .wasm that this machine does not run is not stored.
 */

import { hasSimd } from "../../js/wasm";

interface Site {
  /** A hash of all contents. */
  version: string;
  /** Paths relative to the page's folder, and hashes of the files. */
  files: Record<string, string>;
}
declare const self: ServiceWorkerGlobalScope & { site: Site };

const { scope } = self.registration;
/** A host may have two copies of the page, each of which sees all caches. */
const OURS = `bimodal-stereo ${scope} `;
const NAME = OURS + self.site.version;

/** The .wasm of the loop for other machines. */
const OTHER = hasSimd() ? /bimodal_stereo_scalar_bg/ : /bimodal_stereo_bg/;
/** Names in this folder contain a hash of the content, so files fetched by an earlier version can be used again. */
const NAMED_BY_CONTENT = /^assets\//;

/** The document's address is the folder's: some servers redirect requests for index.html to it. */
const addressOf = (path: string): string => new URL(path === "index.html" ? "./" : path, scope).href;

self.addEventListener("install", (event) => event.waitUntil(keepAll()));
self.addEventListener("activate", (event) => event.waitUntil(takeOver()));
self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method === "GET" && request.url.startsWith(scope)) event.respondWith(answer(request));
});

/**
 * Fetches one file after the other, after everything that the page itself loads. A missing or changed file makes the whole installation
 * fail; it is repeated at the next visit.
 */
async function keepAll(): Promise<void> {
  const cache = await caches.open(NAME);
  for (const [path, integrity] of Object.entries(self.site.files)) {
    const address = addressOf(path);
    if (OTHER.test(path)) continue;
    const named = NAMED_BY_CONTENT.test(path);
    const earlier = named ? await caches.match(address) : undefined;
    await cache.put(
      address,
      earlier ?? plain(await fetch(address, { integrity, cache: named ? "default" : "no-cache" })),
    );
  }
}

/** Removes the mark of a redirect, because a document with that mark may not be answered. */
function plain(response: Response): Response {
  if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
  return response.redirected ? new Response(response.body, { headers: response.headers }) : response;
}

async function takeOver(): Promise<void> {
  const others = (await caches.keys()).filter((name) => name.startsWith(OURS) && name !== NAME);
  for (const name of others) await caches.delete(name);
  // The page requests more files later: other parts and their workers.
  await self.clients.claim();
}

async function answer(request: Request): Promise<Response> {
  const { origin, pathname } = new URL(request.url);
  const address = addressOf(`${origin}${pathname}`.slice(scope.length) || "index.html");
  const kept = await (await caches.open(NAME)).match(address, { ignoreVary: true });
  return kept ?? fetch(request);
}
