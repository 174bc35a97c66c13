// A minimal file server: only files of site/ exist, and the only header is the type.
//   node scripts/site/serve.mjs PORT /below/ builds the page from pkg/ as it is and serves it there, for the page's tests
import { createReadStream, existsSync, realpathSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { inRoot, script } from "../shell.mjs";
import { SITE, buildSite } from "./build.mjs";

const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
  ".txt": "text/plain; charset=utf-8",
};

/** The file of an address, or undefined. */
function fileOf(url, below, folder) {
  const { pathname } = new URL(url, "http://localhost");
  if (!pathname.startsWith(below)) return undefined;
  const path = join(folder, normalize(`/${pathname.slice(below.length)}`), pathname.endsWith("/") ? "index.html" : "");
  return existsSync(path) && statSync(path).isFile() ? path : undefined;
}

/** Serves the folder and returns its address; port 0 is any free port. `headers` imitate those of a host. */
export function serveSite({ port, below, folder = inRoot(SITE), headers = {} }) {
  const server = createServer(({ url }, response) => {
    const path = fileOf(url, below, folder);
    if (!path) return response.writeHead(404).end();
    response.writeHead(200, {
      ...headers,
      "Content-Type": TYPES[extname(path)] ?? "application/octet-stream",
      "Content-Length": statSync(path).size,
    });
    createReadStream(path).pipe(response);
  });
  return new Promise((done, failed) => {
    server.once("error", failed);
    server.listen(port, "127.0.0.1", () =>
      done({ address: `http://127.0.0.1:${server.address().port}${below}`, close: () => server.close() }),
    );
  });
}

// `import.meta` has the real path, the command line the path that was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  const [port, below] = process.argv.slice(2);
  await script(async () => {
    await buildSite();
    await serveSite({ port: Number(port), below });
  });
}
