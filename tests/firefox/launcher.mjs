#!/usr/bin/env node
/**
 * Starts Debian's Firefox for Playwright's channel "moz-firefox" (WebDriver BiDi). Firefox ESR does not know one of the commands that
 * Playwright 1.65 sends to every page, so this launcher relays the messages and answers that command. Once ESR supports it
 * (emulation.setMediaFeaturesOverride), FIREFOX itself can be the executable, and this file can be removed.
 */
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import { WebSocket, WebSocketServer } from "ws";

const UNKNOWN = "emulation.setMediaFeaturesOverride";
const LISTENING = /^WebDriver BiDi listening on (ws:\/\/.*)$/;

/** Relays messages both ways and answers the unknown command itself. */
function join(client, address) {
  const browser = new WebSocket(address);
  const early = [];
  browser.on("open", () => early.splice(0).forEach((message) => browser.send(message)));
  browser.on("message", (data) => client.send(data.toString()));
  browser.on("close", () => client.close());
  client.on("close", () => browser.close());
  client.on("message", (data) => {
    const message = data.toString();
    const { id, method } = JSON.parse(message);
    if (method === UNKNOWN) client.send(JSON.stringify({ type: "success", id, result: {} }));
    else if (browser.readyState === WebSocket.OPEN) browser.send(message);
    else early.push(message);
  });
}

const firefox = spawn(process.env.FIREFOX ?? "/usr/bin/firefox-esr", process.argv.slice(2), {
  stdio: ["ignore", "inherit", "pipe"],
});
firefox.on("exit", (code) => process.exit(code ?? 0));
for (const signal of ["SIGTERM", "SIGINT"]) process.on(signal, () => firefox.kill(signal));
for await (const line of createInterface(firefox.stderr)) {
  const address = LISTENING.exec(line)?.[1];
  if (!address) {
    console.error(line);
    continue;
  }
  const server = new WebSocketServer({ host: "127.0.0.1", port: 0 });
  server.on("connection", (client, { url }) => join(client, address + url));
  server.on("listening", () => console.error(`WebDriver BiDi listening on ws://127.0.0.1:${server.address().port}`));
}
