// One function for every source of a colour image: files and addresses in Node, and objects of a page in Chromium.
import assert from "node:assert/strict";
import { copyFileSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join, relative } from "node:path";
import { after, before, describe, test } from "node:test";
import { pathToFileURL } from "node:url";
import { decodeColour, imageFrom } from "../../pkg/files.js";
import { writeNpy, writePng } from "../../pkg/write.js";
import { inRoot } from "../../scripts/shell.mjs";
import { folder, freshProject, html, served, visit, write } from "./fresh.mjs";

const FIXTURES = inRoot("tests/fixtures/rig");
const SIZE = { width: 3, height: 2 };
const deep = await writePng({ ...SIZE, channels: 3, data: Uint16Array.from({ length: 18 }, (_, i) => 3001 * i + 7) });
const floats = writeNpy({ ...SIZE, channels: 3, data: Float32Array.from({ length: 18 }, (_, i) => 0.1 + i / 7) });

describe("in Node", () => {
  const place = folder();
  const path = join(place, "deep.png");
  let server;
  let address;
  before(async () => {
    write(place, { "deep.png": deep, "broken.png": deep.subarray(0, 60), "empty.png": "" });
    server = createServer(({ url }, response) =>
      url === "/deep.png" ? response.end(deep) : response.writeHead(404).end(),
    );
    await new Promise((done) => server.listen(0, "127.0.0.1", done));
    address = `http://127.0.0.1:${server.address().port}`;
  });
  after(() => server.close());

  test("from a path, an address, bytes and a Blob, with all of 16 bits", async () => {
    const expected = decodeColour(deep);
    assert.ok(expected.data instanceof Uint16Array && expected.data[4] > 255);
    const sources = {
      path,
      "relative path": relative(process.cwd(), path),
      "file URL": pathToFileURL(path),
      "file URL as a text": pathToFileURL(path).href,
      "http URL": `${address}/deep.png`,
      "data URL": `data:image/png;base64,${Buffer.from(deep).toString("base64")}`,
      bytes: deep,
      "Buffer of Node": readFileSync(path),
      ArrayBuffer: deep.slice().buffer,
      Blob: new Blob([deep]),
    };
    for (const [name, source] of Object.entries(sources)) assert.deepEqual(await imageFrom(source), expected, name);
  });

  test("floats stay linear floats", async () => {
    assert.deepEqual(await imageFrom(floats), decodeColour(floats));
  });

  test("photographs come upright and in sRGB", async () => {
    const [wide, plain] = await Promise.all(
      ["colour-wide.png", "colour-srgb.png"].map((name) => imageFrom(join(FIXTURES, name))),
    );
    assert.deepEqual([wide.width, wide.height], [plain.width, plain.height]);
    const { width, height, data } = await imageFrom(join(FIXTURES, "colour.jpg"));
    assert.equal(data.length, 4 * width * height);
  });

  test("what cannot be had is an error that says why", async () => {
    const refused = (source, code, message, options) =>
      assert.rejects(imageFrom(source, options), (error) => {
        assert.equal(error.name, "BimodalError", String(error));
        assert.equal(error.code, code);
        assert.match(error.message, message);
        return true;
      });
    await refused(join(place, "none.png"), "file", /none\.png: it cannot be read .*ENOENT/);
    await refused(`${address}/none.png`, "file", /none\.png: its server answered with status 404/);
    await refused("http://127.0.0.1:1/a.png", "file", /a\.png: it cannot be reached/);
    await refused(join(place, "empty.png"), "file", /empty/);
    await refused(join(place, "broken.png"), "file", /cut off/);
    await refused(join(FIXTURES, "cloud.ply"), "file", /cloud/);
    for (const source of [5, null, undefined, {}, [], Symbol("a")]) await refused(source, "type", /^source: must be/);
    await refused(path, "option", /signl/, { signl: 1 });
  });

  test("a file that cannot be read or decoded is named", async () => {
    const broken = deep.subarray(0, 60);
    for (const [source, name] of [
      [join(place, "none.png"), join(place, "none.png")],
      [join(place, "empty.png"), join(place, "empty.png")],
      [join(place, "broken.png"), join(place, "broken.png")],
      [join(FIXTURES, "cloud.ply"), join(FIXTURES, "cloud.ply")],
      [pathToFileURL(join(place, "broken.png")), pathToFileURL(join(place, "broken.png")).href],
      [`${address}/none.png`, `${address}/none.png`],
      [new File([broken], "mine.png"), "mine.png"],
      [new Blob([broken]), "image"],
      [broken, "image"],
    ])
      await assert.rejects(imageFrom(source), ({ code, message, details }) => {
        assert.deepEqual([code, details.file, message], ["file", name, `${name}: ${details.reason}`]);
        return true;
      });
    // An address that contains the picture is repeated only in part.
    const picture = `data:image/png;base64,${Buffer.from(broken).toString("base64").repeat(9)}`;
    await assert.rejects(imageFrom(picture), ({ message }) => message.startsWith("data:") && message.length < 200);
  });

  test("a signal breaks it off", async () => {
    const reason = new Error("enough");
    for (const source of [path, deep, `${address}/deep.png`])
      await assert.rejects(imageFrom(source, { signal: AbortSignal.abort(reason) }), (error) => error === reason);
    const control = new AbortController();
    const pending = imageFrom(`${address}/deep.png`, { signal: control.signal });
    control.abort(reason);
    await assert.rejects(pending, (error) => error === reason);
  });
});

/** The page prints for each source its size, first pixels, and type of array, or the error. */
const PAGE = `
import { imageFrom } from "bimodal-stereo/files";
const say = async (name, source, options) => {
  try {
    const { width, height, data } = await imageFrom(await source(), options);
    console.log(name, width + "x" + height, data.constructor.name, ...data.subarray(0, 8));
  } catch ({ name: kind, code, message }) { console.log(name, kind, code, message); }
};
const address = new URL("deep.png", location.href);
const blob = await (await fetch(address)).blob();
const element = (src) => Object.assign(new Image(), { crossOrigin: null, src });
const canvas = (canvas) => {
  const context = Object.assign(canvas, { width: 3, height: 2 }).getContext("2d");
  context.fillStyle = "rgb(200, 100, 50)";
  context.fillRect(0, 0, 3, 2);
  return canvas;
};
await say("address", () => address);
await say("relative", () => "deep.png");
await say("blob", () => blob);
await say("element", () => element(address));
await say("bitmap", () => createImageBitmap(blob));
await say("canvas", () => canvas(document.createElement("canvas")));
await say("offscreen", () => canvas(new OffscreenCanvas(1, 1)));
await say("frame", () => new VideoFrame(canvas(new OffscreenCanvas(1, 1)), { timestamp: 0 }));
await say("data", () => canvas(new OffscreenCanvas(1, 1)).getContext("2d").getImageData(0, 0, 3, 2));
const p3 = new OffscreenCanvas(3, 2).getContext("2d", { colorSpace: "display-p3" });
p3.fillStyle = "rgb(200, 100, 50)";
p3.fillRect(0, 0, 3, 2);
await say("p3", () => p3.getImageData(0, 0, 3, 2));
await say("jpeg", () => "turned.jpg");
const gif = Uint8Array.from(atob("R0lGODdhAQABAIABAP8AAAAAACwAAAAAAQABAAACAkQBADs="), (c) => c.charCodeAt(0));
await say("gif", () => gif);
await say("video", () => document.createElement("video"));
await say("nothing", () => new Uint8Array([1, 2, 3]));
await say("missing", () => "missing.png");
await say("text", () => new File(["no picture"], "text.png"));
await say("number", () => 5);
const foreign = new URL(location.search.slice(1));
await say("tainted", async () => { const image = element(foreign); await image.decode(); return image; });
await say("forbidden", () => foreign);
console.log("end");
`;

describe("on a page", () => {
  let lines;
  before(async () => {
    const project = freshProject();
    const files = "./node_modules/bimodal-stereo/files.js";
    const map = `<script type="importmap">{ "imports": { "bimodal-stereo/files": "${files}" } }</script>`;
    write(project, { "page.html": html(`${map}<script type="module">${PAGE}</script>`), "deep.png": deep });
    copyFileSync(join(FIXTURES, "colour.jpg"), join(project, "turned.jpg"));
    const other = folder();
    write(other, { "deep.png": deep });
    const seen = await visit(`${await served(project)}page.html?${await served(other)}deep.png`);
    lines = new Map(seen.lines.map((line) => [line.split(" ")[0], line.slice(line.indexOf(" ") + 1)]));
    assert.ok(lines.has("end"), seen.lines.join("\n"));
  });

  test("files keep their 16 bits", () => {
    const { data } = decodeColour(deep);
    const expected = `3x2 Uint16Array ${data.subarray(0, 8).join(" ")}`;
    for (const name of ["address", "relative", "blob"]) assert.equal(lines.get(name), expected, name);
  });

  test("what a page shows has 8 bits", () => {
    for (const name of ["element", "bitmap"])
      assert.match(lines.get(name), /^3x2 Uint8ClampedArray 0 1[12] 23 255 3[45] /, name);
    for (const name of ["canvas", "offscreen", "data"])
      assert.equal(lines.get(name), "3x2 Uint8ClampedArray 200 100 50 255 200 100 50 255", name);
    // A video frame may be stored as luma and chroma.
    assert.match(lines.get("frame"), /^3x2 Uint8ClampedArray (19\d|20\d) (9\d|10\d) (4\d|5\d) 255 /);
    // The same colour has other values in display-p3 than in sRGB.
    assert.match(lines.get("p3"), /^3x2 Uint8ClampedArray (19[89]|20[0-2]) (99|10[01]) (49|5[0-2]) 255 /);
    assert.match(lines.get("jpeg"), /^\d+x\d+ Uint8/);
    assert.match(lines.get("gif"), /^1x1 Uint8ClampedArray 255 0 0 255/);
  });

  test("what has no picture says so", () => {
    for (const name of ["video", "nothing", "missing"]) assert.match(lines.get(name), /^BimodalError file /, name);
    assert.match(lines.get("text"), /^BimodalError file text\.png: the browser cannot decode it/);
    assert.match(lines.get("missing"), /^BimodalError file missing\.png: /);
    assert.match(lines.get("number"), /^BimodalError type source: must be an image/);
    assert.match(lines.get("tainted"), /^BimodalError unsupported source: .*crossOrigin/);
    assert.match(lines.get("forbidden"), /^BimodalError file .*CORS/);
  });
});
