// The built page, restricted to its own files, with the service worker that caches these for offline visits.
import { createHash } from "node:crypto";
import { cpSync, readFileSync, writeFileSync } from "node:fs";
import { relative, sep } from "node:path";
import { collector } from "../notices/bundled.mjs";
import { NOTICES, section } from "../notices/text.mjs";
import { Failure, filesBelow, inRoot } from "../shell.mjs";

export const SITE = "site";
const WORKER = "sw.js";
const LICENCES = ["LICENSE-MIT", "LICENSE-APACHE"];

/**
 * The policy of the page: it may load only its own files, with no script or style in the document itself, and compile .wasm. Pictures may
 * be inline data or blobs: the icon, and files that a visitor has opened. WebSockets may connect anywhere, since a visitor may enter the
 * address of a robot's bridge; nothing else on the page opens one. Other sites may embed the page in a frame.
 */
export const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self'",
  "style-src 'self'",
  "img-src 'self' blob: data:",
  "connect-src 'self' ws: wss:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

/** Puts the policy before everything that it applies to. */
function close(path) {
  const text = readFileSync(path, "utf8");
  const before = text.includes("<head>") ? "<head>" : "<!doctype html>";
  writeFileSync(
    path,
    text.replace(before, `${before}\n    <meta http-equiv="Content-Security-Policy" content="${POLICY}" />`),
  );
}

/** A hash in the form that browsers check. */
const integrity = (path) => `sha256-${createHash("sha256").update(readFileSync(path)).digest("base64")}`;

/** Builds the service worker with the list of files and their hashes; other contents are another version. */
async function addWorker(paths) {
  const files = Object.fromEntries(
    paths.map((path) => [relative(inRoot(SITE), path).split(sep).join("/"), integrity(path)]),
  );
  const version = createHash("sha256").update(JSON.stringify(files)).digest("hex").slice(0, 16);
  const { rolldown } = await import("rolldown");
  const npm = collector();
  const bundle = await rolldown({
    input: inRoot("www/offline/service-worker.ts"),
    platform: "browser",
    plugins: [npm.plugin],
  });
  await bundle.write({
    file: inRoot(SITE, WORKER),
    format: "iife",
    banner: `self.site = ${JSON.stringify({ version, files })};`,
    minify: true,
  });
  await bundle.close();
  // The service worker contains the hashes of all other files, including the notices, so the notices cannot cover the service worker
  // itself.
  if (npm.entries().length > 0) throw new Failure("The service worker contains code of others, which has no notice.");
}

/** The licences of the page, and the notices of its contents: for its own scripts and for the package. */
function addLicences(entries) {
  for (const file of LICENCES) cpSync(inRoot(file), inRoot(SITE, file));
  const own = section("Contained in the scripts of this page:", entries);
  writeFileSync(inRoot(SITE, NOTICES), [own, readFileSync(inRoot("pkg", NOTICES), "utf8")].join("\n"));
}

/** Builds site/ from pkg/ and www/. */
export async function buildSite() {
  const { build } = await import("vite");
  const npm = collector();
  await build({
    root: inRoot("www"),
    configFile: inRoot("www/vite.config.ts"),
    logLevel: "warn",
    plugins: [npm.plugin],
    worker: { plugins: () => [npm.plugin] },
  });
  addLicences(npm.entries());
  const paths = filesBelow(inRoot(SITE));
  for (const path of paths) if (path.endsWith(".html")) close(path);
  await addWorker(paths);
  const all = filesBelow(inRoot(SITE));
  return { files: all.length, bytes: all.reduce((sum, path) => sum + readFileSync(path).length, 0) };
}
