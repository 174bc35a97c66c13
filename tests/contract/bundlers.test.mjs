// Runs the README's example in a browser or in Node, in a fresh project for every line of the README's table of bundlers.
import assert from "node:assert/strict";
import { cpSync, readFileSync, readdirSync } from "node:fs";
import { createServer as createHttpServer } from "node:http";
import { join } from "node:path";
import { after, describe, test } from "node:test";
import { build, createServer } from "vite";
import webpack from "webpack";
import { decodeDepth } from "../../pkg/files.js";
import { depthPng } from "../../pkg/write.js";
import { inRoot } from "../../scripts/shell.mjs";
import { examples, freshProject, html, pairFiles, run, served, visit, write } from "./fresh.mjs";
import { LONG } from "./long.mjs";

const README = inRoot("pkg/README.md");
const [MADE, OWN] = examples(README, "js");

/** The table's lines, each as a name and the code in the second column. */
const [, section] = /^\| with \| it needs \|\n\|---\|---\|\n((?:\|.*\n)+)/m.exec(readFileSync(README, "utf8"));
const table = new Map(
  section
    .trim()
    .split("\n")
    .map((row) => {
      const [, name, needs] = /^\| (.+?) \| (.+) \|$/.exec(row);
      return [name, [...needs.matchAll(/`([^`]+)`/g)].map(([, code]) => code)];
    }),
);
const tested = [];
/** A test of a line of the table. */
function line(name, body, options = {}) {
  tested.push(name);
  test(name, options, () => body(...table.get(name)));
}

/** README's example, followed by a thread and by a file that loads on demand. */
const APP = `${MADE}
import { projectFrame } from "bimodal-stereo";
const together = new Estimator(image, depth, { workers: 2 });
await together.run({ maxIterations: 1 });
const view = { width: 16, height: 16, camera: { fx: 20, fy: 20, cx: 7.5, cy: 7.5 } };
const frame = { image: { ...view, data: new Uint8Array(1024).fill(99) }, depth: { ...view, data: new Float32Array(256).fill(1) } };
const { points } = await projectFrame(frame, { ...pose, rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: [0, 0, 0] });
console.log(points.length, "numbers of points");
console.log("end");
`;

/** Checks that everything was found and works. */
function complete({ lines, missing, threads }) {
  assert.deepEqual(missing, []);
  // The console also has the message of Vite's development server.
  const ours = lines.filter((text) => !text.startsWith("[vite]"));
  assert.match(ours.join("\n"), /^converged (49|50)\.\d+ true: .+\n768 numbers of points\nend$/);
  assert.deepEqual(threads, ["function"]);
}

const project = freshProject();
write(project, { "app.js": APP });
/** A page of the project in a separate folder, with its script beside it. */
const page = (folder, head = '<script type="module" src="app.js"></script>') =>
  write(project, { [`${folder}/index.html`]: html(head) });

describe("README's example in", () => {
  line(
    "Vite",
    async (_, config) => {
      write(project, {
        "vite/index.html": html('<script type="module" src="./app.js"></script>'),
        "vite/app.js": APP,
        "vite/older.config.js": `export default { ${config} };`,
      });
      const root = join(project, "vite");
      const options = { root, configFile: false, logLevel: "silent", cacheDir: join(root, "cache") };
      await build(options);
      complete(await visit(await served(join(root, "dist")), { threads: 1 }));
      for (const configFile of [false, join(root, "older.config.js")]) {
        const server = await createServer({
          ...options,
          configFile,
          server: { port: 0, host: "127.0.0.1", fs: { allow: [project] } },
        });
        await server.listen();
        complete(await visit(server.resolvedUrls.local[0], { threads: 1 }));
        await server.close();
      }
    },
    LONG,
  );

  line(
    "webpack 5",
    async () => {
      const path = join(project, "webpack");
      const stats = await new Promise((done, fail) => {
        const options = {
          context: project,
          mode: "production",
          entry: "./app.js",
          output: { path, filename: "app.js" },
          performance: false,
        };
        webpack(options, (error, result) => (error ? fail(error) : done(result)));
      });
      assert.equal(stats.toString({ all: false, errors: true, warnings: true }), "");
      page("webpack");
      complete(await visit(await served(path), { threads: 1 }));
      // A bundle must not contain the path of its project.
      for (const file of readdirSync(path))
        assert.ok(!readFileSync(join(path, file), "latin1").includes(project), file);
    },
    LONG,
  );

  line("esbuild", async (command, script) => {
    run("sh", ["-c", command], project);
    page("dist", script.replace("dist/", ""));
    complete(await visit(await served(join(project, "dist")), { threads: 1 }));
  });

  line("no bundler", async (map) => {
    write(project, { "plain.html": html(`${map}<script type="module">${APP}</script>`) });
    complete(await visit(`${await served(project)}plain.html`, { threads: 1 }));
  });

  line("anything else", async (address) => {
    write(project, { "other.js": `${MADE.replace("await init()", address)}\nconsole.log("end");` });
    run("esbuild", ["other.js", "--bundle", "--format=esm", "--outfile=other/app.js"], project);
    cpSync(
      join(project, "node_modules/bimodal-stereo/bimodal_stereo_bg.wasm"),
      join(project, "other/assets/bimodal_stereo_bg.wasm"),
    );
    page("other");
    const { lines, missing } = await visit(await served(join(project, "other")));
    assert.deepEqual(missing, []);
    assert.match(lines[0], /^converged/);
  });

  line("Node", () => {
    write(project, { "made.js": MADE });
    assert.match(run(process.execPath, ["made.js"], project), /^converged (49|50)\./);
  });

  line("`require`", (code) => {
    const body = MADE.replace(/^import .*$/m, 'const { sample } = require("bimodal-stereo");');
    write(project, { "made.cjs": `${code}\n(async () => {\n${body}\n})();` });
    assert.match(run(process.execPath, ["made.cjs"], project), /^converged (49|50)\./);
  });

  line("TypeScript", (_, ...resolutions) => {
    write(project, {
      "made.ts": MADE,
      "typed.cts":
        'import stereo = require("bimodal-stereo");\nexport const loaded: Promise<void> = stereo.default();\n',
    });
    assert.equal(resolutions.length, 3);
    for (const resolution of resolutions.map((word) => JSON.parse(word))) {
      const files = resolution === "nodenext" ? ["made.ts", "typed.cts"] : ["made.ts"];
      const options = ["--module", resolution === "bundler" ? "esnext" : resolution, "--moduleResolution", resolution];
      run(
        "tsc",
        [
          "--noEmit",
          "--strict",
          "--target",
          "es2022",
          "--types",
          "",
          "--lib",
          "es2022,dom,esnext.disposable",
          ...options,
          ...files,
        ],
        project,
      );
    }
  });

  // These lines are tested in other-origin.test.mjs and runtimes.test.mjs.
  const elsewhere = ["another origin", "Deno", "Bun"];
  test("no other: the table has no line without a test", () =>
    assert.deepEqual([...table.keys()].sort(), [...tested, ...elsewhere].sort()));
});

test("README's example with files of one's own", async () => {
  const { colour, depth } = await pairFiles({ angles: { beta: 20 }, size: 48 });
  const { bytes, step } = await depthPng(decodeDepth(depth), "px");
  write(project, { "own.js": OWN, "image.png": colour, "depth.png": bytes });
  assert.equal(step, 0.001);
  assert.match(run(process.execPath, ["own.js"], project), /^converged/);
  const { unit, angles } = JSON.parse(readFileSync(join(project, "pose.json"), "utf8"));
  assert.ok(unit === "px" && Math.abs(angles.beta - 20) < 2, JSON.stringify(angles));
  assert.ok(readFileSync(join(project, "refined.png")).length > 1000);
});

describe("a .wasm that was left behind is an error that names the cure", () => {
  const fails = `import init from "bimodal-stereo";
    (async () => { try { await init(); } catch ({ name, code, field, message }) { console.log(name, code, field, message); } console.log("end"); })();`;
  const head = { esm: '<script type="module" src="app.js"></script>', iife: '<script src="app.js"></script>' };
  const bundle = (format) => {
    write(project, { "fails.js": fails });
    run("esbuild", ["fails.js", "--bundle", `--format=${format}`, `--outfile=left-${format}/app.js`], project);
    page(`left-${format}`, head[format]);
    return join(project, `left-${format}`);
  };
  const CURE =
    /^BimodalError init wasm init: the \.wasm could not be loaded \((.+?)\. Bundlers .* Copy them next to the bundle.* or pass their address to init\(url\)/;
  const said = async (address) =>
    CURE.exec((await visit(address)).lines.find((text) => text.startsWith("BimodalError")))?.[1];

  test("where nothing is", async () => {
    const address = await served(bundle("esm"));
    assert.equal(await said(address), `status 404 at ${address}bimodal_stereo_bg.wasm`);
  });

  test("where a server answers with its page", async () => {
    const path = bundle("esm");
    const server = createHttpServer(({ url }, response) => {
      const file = url === "/app.js" ? "app.js" : "index.html";
      response
        .writeHead(200, { "Content-Type": file === "app.js" ? "text/javascript" : "text/html" })
        .end(readFileSync(join(path, file)));
    });
    after(() => server.close());
    await new Promise((done) => server.listen(0, "127.0.0.1", done));
    const address = `http://127.0.0.1:${server.address().port}/`;
    assert.equal(await said(address), `an HTML page is at ${address}bimodal_stereo_bg.wasm`);
  });

  test("where the bundle is no ES module", async () => {
    assert.equal(await said(await served(bundle("iife"))), "this bundle does not know its own address");
  });
});
