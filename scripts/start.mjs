// npm start: sets up, builds and serves the page until ctrl-C. PORT sets the port; by default it is the first free one from 4173.
import { readFileSync } from "node:fs";
import { build } from "./build.mjs";
import { NOTICES } from "./notices/text.mjs";
import { setup } from "./setup.mjs";
import { Failure, inRoot, say, script } from "./shell.mjs";

const FIRST_PORT = 4173;

/** The built page includes the notices of its contents; here, the link leads to those of the package. */
const notices = {
  name: "notices",
  configureServer: ({ middlewares }) =>
    void middlewares.use(`/${NOTICES}`, (_, response) => {
      response.setHeader("Content-Type", "text/plain; charset=utf-8").end(readFileSync(inRoot("pkg", NOTICES)));
    }),
};

function wantedPort() {
  if (!process.env.PORT) return undefined;
  const port = Number(process.env.PORT);
  if (Number.isInteger(port) && port > 0 && port < 65536) return port;
  throw new Failure(`PORT must be a number from 1 to 65535, not "${process.env.PORT}".`);
}

await script(async () => {
  const port = wantedPort();
  await setup();
  await build();
  // Imported late, because before the set-up there are no node_modules.
  const { createServer } = await import("vite");
  const server = await createServer({
    root: inRoot("www"),
    plugins: [notices],
    // The address is numeric, because "localhost" may be IPv6 only, which excludes other clients.
    server: { host: "127.0.0.1", port: port ?? FIRST_PORT, strictPort: port !== undefined },
  });
  try {
    await server.listen();
  } catch (error) {
    // Without this, the file watchers would keep the process alive.
    await server.close();
    throw new Failure(error.message);
  }
  say(`serving the page at ${server.resolvedUrls.local[0]}  (ctrl-C ends it)`);
  for (const signal of ["SIGINT", "SIGTERM"]) {
    process.once(signal, () => void server.close().then(() => process.exit(0)));
  }
});
