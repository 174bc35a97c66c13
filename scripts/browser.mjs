// Chromium and its driver, for the tests that need a browser.
import { existsSync } from "node:fs";
import { Failure, ask, must, say, watch } from "./shell.mjs";

const INSTALL = "apt-get update && apt-get install -y chromium chromium-driver";

/** The folders of browsers on macOS, which are not in PATH. */
const APPLICATIONS = [
  "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
  "/Applications/Chromium.app/Contents/MacOS/Chromium",
];

const inPath = (name) => ask("sh", ["-c", 'command -v -- "$1"', "sh", name]);

const canInstall = () => process.getuid?.() === 0 && Boolean(inPath("apt-get"));
const QUIET = { env: { DEBIAN_FRONTEND: "noninteractive" } };

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

/** Debian's Firefox and its driver. The second engine is used if present and never installed. */
export const firefox = () => ({
  firefox: named("FIREFOX") ?? ["firefox-esr", "firefox"].map(inPath).find(Boolean),
  geckodriver: named("GECKODRIVER") ?? inPath("geckodriver"),
});

/** Chromium without windows and menus, which no test needs: the same release and engine for three fifths of the processor time. */
const SHELL = "chromium-headless-shell";

/**
 * The browser of the page's tests: the one that CHROMIUM names, or the headless shell, which is installed when run as root on Debian.
 * If the shell is missing, the tests use the whole Chromium, which takes longer.
 */
export async function headless() {
  if (!process.env.CHROMIUM && !inPath(SHELL) && canInstall()) {
    say(`${SHELL}: installing Debian's package`);
    // No package may be removed, because a shell of another release would replace the installed files that both need.
    const installed = () => watch("apt-get", ["install", "-y", "--no-remove", "--no-install-recommends", SHELL], QUIET);
    // The lists of packages may be missing or too old.
    if ((await installed()).code !== 0 && (await watch("apt-get", ["update"], QUIET)).code === 0) await installed();
  }
  return named("CHROMIUM") ?? inPath(SHELL) ?? (await browser()).chromium;
}

/** The paths of Chromium and its driver. Debian's package manager installs them if that needs no further rights. */
export async function browser() {
  let found = find();
  if (found.chromium && found.chromedriver) return found;
  if (canInstall()) {
    say("Chromium and chromedriver: installing Debian's packages");
    await must("apt-get", ["update"], QUIET);
    await must("apt-get", ["install", "-y", "chromium", "chromium-driver"], QUIET);
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
