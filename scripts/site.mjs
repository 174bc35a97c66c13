// npm run site: the page as static files in site/, for any web server, below any path.
//   --serve PORT  serves them afterwards for a look, below as deep a path as a host may choose, until ctrl-C
// docs/hosting.md explains how to put them on a server.
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { setup } from "./setup.mjs";
import { Failure, script, say } from "./shell.mjs";
import { buildSite } from "./site/build.mjs";
import { serveSite } from "./site/serve.mjs";

function wantedPort() {
  let text;
  try {
    text = parseArgs({ options: { serve: { type: "string" } } }).values.serve;
  } catch (error) {
    throw new Failure(error.message);
  }
  const port = Number(text);
  if (text !== undefined && !(Number.isInteger(port) && port > 0 && port < 65536))
    throw new Failure(`--serve takes a port, a number from 1 to 65535, not "${text}".`);
  return text === undefined ? undefined : port;
}

await script(async () => {
  const port = wantedPort();
  await setup();
  await build();
  const { files, bytes } = await buildSite();
  say(`site/: ${files} files, ${(bytes / 1e6).toFixed(1)} MB`);
  if (port !== undefined)
    say(`serving it at ${(await serveSite({ port, below: "/any/folder/" })).address}  (ctrl-C ends it)`);
});
