// The output of `npm run build` can be installed into an empty folder, with types, and the README's examples work.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { build } from "vite";
import { inRoot } from "../../scripts/shell.mjs";
import * as fresh from "./fresh.mjs";

const folder = fresh.freshProject();
const run = (program, args) => fresh.run(program, args, folder);
/** The README's fenced examples of one language. */
const examples = (language) => fresh.examples(inRoot("README.md"), language);

test("the README's example runs in Node", () => {
  const [example] = examples("ts");
  assert.ok(example, "README.md has an example in TypeScript");
  writeFileSync(join(folder, "example.mjs"), example);
  assert.match(run(process.execPath, ["example.mjs"]), /converged/);
});

/** The lights that a one-line program gets from the package after `init`. */
function lightsAfter(specifier, argument) {
  const code = `import init, { sampleLights } from ${JSON.stringify(specifier)}; await init(${argument}); console.log(...sampleLights());`;
  return run(process.execPath, ["--input-type=module", "-e", code]).trim().split(" ");
}

test("the file without SIMD can be asked for by its address", () => {
  const address = 'import.meta.resolve("bimodal-stereo/bimodal_stereo_scalar_bg.wasm")';
  for (const argument of [address, `new URL(${address})`])
    assert.ok(lightsAfter("bimodal-stereo", argument).includes("window"));
});

test("Node may import the module by its path, too", () => {
  const path = pathToFileURL(join(folder, "node_modules/bimodal-stereo/index.js")).href;
  assert.ok(lightsAfter(path, "").includes("window"));
});

test("a .wasm that is not there is a BimodalError", () => {
  const code = `import init from "bimodal-stereo";
    await init(new URL("file:///no/such.wasm")).catch(({ name, code, field }) => console.log(name, code, field));`;
  assert.equal(run(process.execPath, ["--input-type=module", "-e", code]).trim(), "BimodalError init wasm");
});

test("bundled for browsers it carries its files along, and asks for nothing of Node's", async () => {
  writeFileSync(
    join(folder, "page.js"),
    'import init, { Estimator } from "bimodal-stereo"; console.log(init, Estimator);',
  );
  const warnings = [];
  const warn = (message) => void warnings.push(message);
  const logger = {
    info() {},
    warn,
    warnOnce: warn,
    error: warn,
    clearScreen() {},
    hasErrorLogged: () => false,
    hasWarned: false,
  };
  const { output } = await build({
    ...{ root: folder, configFile: false, logLevel: "warn", customLogger: logger, worker: { format: "es" } },
    // This warning about slow plugins depends on the load of the machine.
    build: { write: false, rollupOptions: { input: join(folder, "page.js"), checks: { bundlerTimings: false } } },
  });
  assert.deepEqual(warnings, []);
  const bundled = output.map(({ fileName }) => fileName.replace(/^assets\/|-[\w-]{8}(?=\.)/g, "")).sort();
  // The check's files are emitted although this page never loads them, because their addresses are resolved before unused code is removed.
  const wasm = ["", "_check", "_rigs", "_scalar"].map((which) => `bimodal_stereo${which}_bg.wasm`);
  const files = [...wasm, "page.js", "thread.js"];
  assert.deepEqual(bundled, files);
  for (const { fileName, imports = [], dynamicImports = [] } of output)
    assert.deepEqual([...imports, ...dynamicImports], [], fileName);
});

test("the files module loads by itself", () => {
  const code = 'import { decodeDepth } from "bimodal-stereo/files"; console.log(typeof decodeDepth);';
  assert.equal(run(process.execPath, ["--input-type=module", "-e", code]).trim(), "function");
});

test("the writers load by themselves", () => {
  const code = 'import { poseFormats } from "bimodal-stereo/rig-write"; console.log(...poseFormats);';
  assert.match(run(process.execPath, ["--input-type=module", "-e", code]), /matrix opencv kalibr/);
});

test("types resolve for Node and for bundlers, without help from other type packages", () => {
  mkdirSync(join(folder, "typed"), { recursive: true });
  writeFileSync(join(folder, "typed/readme.ts"), examples("ts").join("\n"));
  writeFileSync(
    join(folder, "typed/contract.ts"),
    `import init, { BimodalError, Estimator, checkCalibration, sample, wasmUrl } from "bimodal-stereo";
     import type { CheckReport, ColorImage, DepthMap, Options, Pose, Stage, StepReport } from "bimodal-stereo";
     import { decodeColour, decodeDepth, decodeMask } from "bimodal-stereo/files";
     import { type RigContext, type WrittenPose, reportHtml, writeClouds, writePose } from "bimodal-stereo/rig-write";
     import { type RunReport, depthPng, runReportHtml, writeNpy } from "bimodal-stereo/write";
     export const run = (report: RunReport): string => runReportHtml(report);
     export const step = async (data: Float32Array): Promise<number> => (await depthPng({ width: 1, height: 1, data }, "m")).step;
     export const array: Uint8Array = writeNpy({ width: 1, height: 1, channels: 1, data: new Uint16Array(1) });
     const context: RigContext = { colour: { fx: 1, fy: 1, cx: 0, cy: 0, model: "fisheye" }, sizes: { depth: [640, 480] } };
     export const written = (report: CheckReport): WrittenPose => writePose(report.estimate, "kalibr", context);
     export const page = (report: CheckReport): string => reportHtml(report, [{ title: "", dataUrl: "" }], { made: new Date(0) });
     export const ply: Uint8Array = writeClouds([{ points: new Float32Array(3) }]);
     // @ts-expect-error a format that does not exist
     export const none = (report: CheckReport): WrittenPose => writePose(report.estimate, "urdf");
     const image: ColorImage = decodeColour(new Uint8Array());
     const depth: DepthMap = { ...decodeDepth(new ArrayBuffer(0)), mask: decodeMask(new Uint8Array()).data };
     const start: Partial<Pose> = { angles: { alpha: 0, beta: 20, gamma: 0 } };
     const options: Options = { light: new Float64Array(27), start, registration: "icp", lambda: { prior: 0.1 } };
     export async function all(signal: AbortSignal): Promise<[StepReport, CheckReport]> {
       await init(new URL("https://example.org/x.wasm"));
       await init(new Response((await fetch(wasmUrl())).body));
       const estimator = new Estimator(sample({ surface: "bust", light: "window" }).image, depth, options);
       const correspondence: Int32Array = estimator.correspondence();
       const light: Float64Array = estimator.light();
       const cloud: Float32Array = estimator.points("image");
       estimator.free();
       console.log(image, light, cloud, correspondence);
       return [await estimator.run({ maxIterations: 3, signal, onStep: (report) => report.status }), await checkCalibration([], {})];
     }
     export const code = (error: BimodalError): string => error.code + (error.field ?? "");
     export const isSearch = ({ stage }: StepReport): Stage | undefined => (stage === "search" ? stage : undefined);
     // @ts-expect-error a misspelt stage is a type error
     export const isOther = ({ stage }: StepReport): boolean => stage === "serach";
     // @ts-expect-error a misspelt option is a type error as well
     export const misspelt: Options = { regstration: "icp" };
     // @ts-expect-error a report is not any
     export const wrong = (report: StepReport): string => report.nothing;`,
  );
  for (const module of ["nodenext", "bundler"]) {
    const resolution =
      module === "bundler" ? ["--module", "esnext", "--moduleResolution", "bundler"] : ["--module", "nodenext"];
    run(process.execPath, [
      ...[inRoot("node_modules/typescript/bin/tsc"), "--noEmit", "--strict", "--target", "es2022", "--types", ""],
      ...["--lib", "es2022,dom,esnext.disposable", ...resolution, "typed/readme.ts", "typed/contract.ts"],
    ]);
  }
});

/** The package's entry points for programs, by their import names. */
const typedEntries = () => {
  const { name, exports } = JSON.parse(readFileSync(join(folder, "node_modules/bimodal-stereo/package.json"), "utf8"));
  return Object.entries(exports).flatMap(([path, { types }]) => (types === undefined ? [] : [join(name, path)]));
};

test("every entry point has all of its types, which are checked themselves", () => {
  const entries = typedEntries();
  assert.ok(entries.length >= 5, entries.join(" "));
  const lines = entries.map((entry, i) => `import * as e${i} from "${entry}";\nexport const used${i} = e${i};`);
  mkdirSync(join(folder, "entries"), { recursive: true });
  writeFileSync(join(folder, "entries/all.ts"), lines.join("\n"));
  for (const [module, moduleResolution] of [
    ["esnext", "bundler"],
    ["nodenext", "nodenext"],
  ]) {
    const compilerOptions = {
      ...{ module, moduleResolution, target: "es2022", lib: ["es2022", "dom", "esnext.disposable"], types: [] },
      ...{ strict: true, exactOptionalPropertyTypes: true, skipLibCheck: false, noEmit: true },
    };
    writeFileSync(join(folder, "entries/tsconfig.json"), JSON.stringify({ compilerOptions, include: ["*.ts"] }));
    run(process.execPath, [inRoot("node_modules/typescript/bin/tsc"), "-p", "entries"]);
  }
});

test("nothing is wrong with the types of the packed file", () => {
  const [packed] = readdirSync(folder).filter((name) => name.endsWith(".tgz"));
  // .wasm files and thread.js have paths for bundlers, but no types.
  const entries = typedEntries().map((entry) => entry.replace(/^bimodal-stereo/, "."));
  run("attw", [packed, "--profile", "esm-only", "--no-color", "--no-definitely-typed", "--entrypoints", ...entries]);
});

test("nothing of the workshop is packed, and the package says where it comes from", () => {
  const installed = join(folder, "node_modules/bimodal-stereo");
  const { files, dependencies, exports, version, author, repository, homepage, bugs } = JSON.parse(
    readFileSync(join(installed, "package.json"), "utf8"),
  );
  assert.ok(files.includes("*.wasm"));
  assert.equal(dependencies, undefined);
  const cargo = readFileSync(inRoot("Cargo.toml"), "utf8");
  const [, address] = /^repository = "(https:.+)"$/m.exec(cargo);
  assert.ok(cargo.includes(`\nversion = "${version}"\n`));
  assert.match(author, /contributors/);
  assert.deepEqual(
    [repository.url, homepage, bugs.url],
    [`git+${address}.git`, `${address}#readme`, `${address}/issues`],
  );
  for (const licence of ["LICENSE-MIT", "LICENSE-APACHE"])
    assert.ok(readFileSync(join(installed, licence)).equals(readFileSync(inRoot(licence))));
  // Every exported path exists.
  for (const target of Object.values(exports).flatMap((each) =>
    typeof each === "string" ? each : Object.values(each),
  )) {
    assert.ok(existsSync(join(installed, target)), target);
  }
});

test("the package's README speaks of the package alone, with the sizes of its files", () => {
  const installed = join(folder, "node_modules/bimodal-stereo");
  const text = readFileSync(join(installed, "README.md"), "utf8");
  assert.doesNotMatch(text, /\]\((?!https:)|npm (run|start|test)|cargo|docs\/|\{[a-z ]*size/);
  const rows = [...text.matchAll(/^\| `(\S+\.wasm)` \| .+ \| (\d+) kB \| (\d+) kB \|$/gm)];
  assert.equal(rows.length, 4);
  for (const [, file, kilobytes] of rows)
    assert.equal(Math.round(readFileSync(join(installed, file)).length / 1000), Number(kilobytes));
});
