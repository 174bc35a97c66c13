// Chromium and its driver, for the tests that need a browser.
import { existsSync } from "node:fs";
import { Failure, ask, must, say } from "./shell.mjs";

const INSTALL = "apt-get update && apt-get install -y chromium chromium-driver";

/** Where macOS keeps browsers: they are not in PATH. */
const APPLICATIONS = [
  "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
  "/Applications/Chromium.app/Contents/MacOS/Chromium",
];

const inPath = (name) => ask("sh", ["-c", 'command -v -- "$1"', "sh", name]);

function named(variable) {
  const path = process.env[variable];
  if (path && !existsSync(path)) throw new Failure(`${variable} names "${path}", which does not exist`);
  return path;
}

function find() {
  const names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
  const chromium =
    named("CHROMIUM") ?? names.map(inPath).find(Boolean) ?? APPLICATIONS.find((path) => existsSync(path));
  const chromedriver = named("CHROMEDRIVER") ?? inPath("chromedriver");
  return { chromium, chromedriver };
}

/** Debian's Firefox and its driver; the second engine is looked for and not installed. */
export const firefox = () => ({
  firefox: named("FIREFOX") ?? ["firefox-esr", "firefox"].map(inPath).find(Boolean),
  geckodriver: named("GECKODRIVER") ?? inPath("geckodriver"),
});

/** Paths of both, installed by Debian's own means where that is possible without asking for more rights. */
export async function browser() {
  let found = find();
  if (found.chromium && found.chromedriver) return found;
  const debian = process.getuid?.() === 0 && inPath("apt-get");
  if (debian) {
    say("Chromium and chromedriver: installing Debian's packages");
    const quiet = { env: { DEBIAN_FRONTEND: "noninteractive" } };
    await must("apt-get", ["update"], quiet);
    await must("apt-get", ["install", "-y", "chromium", "chromium-driver"], quiet);
    found = find();
    if (found.chromium && found.chromedriver) return found;
  }
  const line =
    process.platform === "darwin" ? "brew install --cask google-chrome chromedriver" : `sudo sh -c '${INSTALL}'`;
  throw new Failure(
    `The browser tests need ${found.chromium ? "chromedriver" : "Chromium and chromedriver"}. Type:\n\n    ${line}\n\n` +
      "or name them in the environment variables CHROMIUM and CHROMEDRIVER.",
  );
}
