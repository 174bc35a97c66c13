// Rust's standard library is part of every artefact, with further crates; one page of the toolchain states their licences.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { Failure, ask, inRoot } from "../shell.mjs";

/** Crates of the library on the systems for which artefacts are built. The page also lists those of other systems and of its build. */
const LINKED = ["cfg-if", "dlmalloc", "foldhash", "gimli", "hashbrown", "libc", "rustc-demangle"];
/** Names of licence files in order of preference. */
const TEXTS = ["LICENSE-MIT", "LICENSE"];

/** The compiler's version in rust-toolchain.toml. */
export const compiler = () => /^channel = "(.+)"$/m.exec(readFileSync(inRoot("rust-toolchain.toml"), "utf8"))[1];

const plain = (html) =>
  html.replaceAll(/&#(\d+);/g, (_, code) => String.fromCodePoint(Number(code))).replaceAll("&amp;", "&");

/** The part of the page about one crate, from its heading to the next. */
function crateOf(page, name) {
  const part = page.split("<h3>").find((text) => new RegExp(`^\\S+ ${name}-\\d`).test(text));
  const texts = TEXTS.map((file) => part?.split(`<code>${file}</code>`)[1]?.match(/<pre>([\s\S]*?)<\/pre>/)?.[1]);
  const text = texts.find((each) => each !== undefined);
  if (text === undefined) throw new Failure(`The toolchain's copyright page has no licence of ${name} any more.`);
  const version = new RegExp(`^\\S+ ${name}-(\\S+)</h3>`).exec(part)[1];
  const licence = /<b>License:<\/b> (.+?)<\/p>/.exec(part)[1];
  return { name, version, licence, texts: [plain(text)] };
}

/** Entries for `section` of text.mjs. */
export function standardLibrary() {
  const folder = join(ask("rustc", ["--print", "sysroot"]), "share/doc/rust");
  const read = (file) => readFileSync(join(folder, file), "utf8");
  const mit = read("licenses/MIT.txt").replace("<year> <copyright holders>", "The Rust Project Developers");
  const own = {
    name: "rust-std",
    version: compiler(),
    licence: "MIT OR Apache-2.0; its tables of Unicode: Unicode-3.0",
  };
  const page = read("COPYRIGHT-library.html");
  return [{ ...own, texts: [mit, read("licenses/Unicode-3.0.txt")] }, ...LINKED.map((name) => crateOf(page, name))];
}
