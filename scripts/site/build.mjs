// The built page, closed against everything but its own files, and with the service worker that keeps these for a visit without a network.
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
 * What the page may do. Nothing but its own files, no script or style in the document itself; .wasm may be compiled. Pictures may be a
 * page's own data: its icon, and what a visitor has opened. WebSockets may be opened, since a visitor may name the bridge of a robot, which
 * is anywhere; nothing else on the page opens one. Frames that show the page elsewhere are not forbidden.
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

/** The policy before anything that it is about. */
function close(path) {
  const text = readFileSync(path, "utf8");
  const before = text.includes("<head>") ? "<head>" : "<!doctype html>";
  writeFileSync(
    path,
    text.replace(before, `${before}\n    <meta http-equiv="Content-Security-Policy" content="${POLICY}" />`),
  );
}

/** A hash as browsers check it. */
const integrity = (path) => `sha256-${createHash("sha256").update(readFileSync(path)).digest("base64")}`;

/** The service worker, told which files there are and what is in them; another content is another version. */
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
  // It names the hashes of all other files, the notices among them, so that these can't tell of it any more.
  if (npm.entries().length > 0) throw new Failure("The service worker contains code of others, which has no notice.");
}

/** The licences of the page, and the notices of what it contains: of its own, and of the package in it. */
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
