/**
 * Keeps the page's files, so that it opens without a network. All of them are fetched once, checked against the hashes that the build wrote down,
 * and answered from the cache: one version is never mixed with the next. A new version is fetched beside the old one, and takes its place once
 * no tab shows that any more. Not kept: the .wasm of the two that this machine does not run.
 */

import { hasSimd } from "../../js/wasm";

interface Site {
  /** A hash of all contents. */
  version: string;
  /** Paths below the page's own, and hashes of what is in them. */
  files: Record<string, string>;
}
declare const self: ServiceWorkerGlobalScope & { site: Site };

const { scope } = self.registration;
/** Two copies of the page may lie on one host, and each sees all caches there. */
const OURS = `bimodal-stereo ${scope} `;
const NAME = OURS + self.site.version;

/** The .wasm of the loop that runs on other machines. */
const OTHER = hasSimd() ? /bimodal_stereo_scalar_bg/ : /bimodal_stereo_bg/;
/** Names in here hold a hash of the content: what an earlier version has fetched under one of them serves again. */
const NAMED_BY_CONTENT = /^assets\//;

/** The document has the folder's own address: some servers redirect requests for index.html there. */
const addressOf = (path: string): string => new URL(path === "index.html" ? "./" : path, scope).href;

self.addEventListener("install", (event) => event.waitUntil(keepAll()));
self.addEventListener("activate", (event) => event.waitUntil(takeOver()));
self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method === "GET" && request.url.startsWith(scope)) event.respondWith(answer(request));
});

/** One after the other, behind whatever the page itself loads. A file that is missing or another one makes all of it fail, to be tried again at the next visit. */
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

/** Without the mark of having been sent elsewhere, with which no document may be answered. */
function plain(response: Response): Response {
  if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
  return response.redirected ? new Response(response.body, { headers: response.headers }) : response;
}

async function takeOver(): Promise<void> {
  const others = (await caches.keys()).filter((name) => name.startsWith(OURS) && name !== NAME);
  for (const name of others) await caches.delete(name);
  // The page requests more later on: other places and their workers.
  await self.clients.claim();
}

async function answer(request: Request): Promise<Response> {
  const { origin, pathname } = new URL(request.url);
  const address = addressOf(`${origin}${pathname}`.slice(scope.length) || "index.html");
  const kept = await (await caches.open(NAME)).match(address, { ignoreVary: true });
  return kept ?? fetch(request);
}
