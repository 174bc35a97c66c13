// Frames by time stamps that stand beside counters, sizes and dates in names, where one set has lost frames.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readRigFolder } from "../../pkg/rig.js";
import { png } from "./support.mjs";

const words = (...values) => values.flatMap((value) => [value >> 8, value & 255]);
const depth = (value) =>
  png({ width: 2, height: 1, depth: 16, colourType: 0, rows: [words(1000 + value, 1000 + value)] });
const colour = (value) => png({ width: 2, height: 1, depth: 8, colourType: 2, rows: [[value, 2, 3, value, 2, 3]] });

/** Frames of a simulated recording by their numbers; `counts` numbers the files of each set, and `time` is in microseconds. */
function recording(name, { frames = [0, 1, 2, 3], lost = [1], period = 33_333, offset = 4_000 } = {}) {
  const kept = frames.filter((frame) => !lost.includes(frame));
  const files = (kind, set, make, delay) =>
    set.map((frame, count) => ({ name: name(kind, count, frame * period + delay), bytes: make(frame) }));
  return [...files("color", frames, colour, 0), ...files("depth", kept, depth, offset)];
}
/** The numbers of the frames whose colour image and depth map were paired. */
const paired = ({ frames }) => frames.map(({ image, depth: { data } }) => [image.data[0], data[0] - 1000]);
const padded = (value, digits) => String(value).padStart(digits, "0");
const EPOCH = 1_700_000_000_000_000;
const date = (time) => new Date((EPOCH + time) / 1000).toISOString();

const NAMES = {
  "counter and seconds": (kind, count, time) => `${kind}/${padded(count, 6)}_${((EPOCH + time) / 1e6).toFixed(6)}.png`,
  "seconds and nanoseconds": (kind, _, time) =>
    `${kind}/${Math.floor((EPOCH + time) / 1e6)}_${padded(1000 * ((EPOCH + time) % 1e6), 9)}.png`,
  "counter and nanoseconds": (kind, count, time) => `${kind}_${count}_${EPOCH + time}000.png`,
  "size, counter and milliseconds": (kind, count, time) =>
    `${kind}_${kind === "color" ? "1280x720" : "640x576"}_${count}_${1000 + Math.round(time / 1000)}ms.png`,
  "date with dashes": (kind, _, time) => `${kind}_${date(time).replace(/[T:.]/g, "-").replace("Z", "")}.png`,
  "date in a run": (kind, _, time) =>
    `${kind}/${date(time).slice(0, 19).replace(/[-:]/g, "").replace("T", "_")}_${padded((EPOCH + time) % 1e6, 6)}.png`,
  "counter and time since the start": (kind, count, time) => `${kind}/${padded(count, 7)}-${padded(time, 12)}.png`,
};

for (const [form, name] of Object.entries(NAMES))
  test(`${form}: the frames that are left are paired by their stamps`, async () => {
    for (const given of [
      {},
      { lost: [0, 3], frames: [0, 1, 2, 3, 4, 5] },
      { period: 1_000_000, offset: -9_000 + 18_000, lost: [2] },
    ]) {
      const { frames = [0, 1, 2, 3], lost = [1] } = given;
      const found = await readRigFolder(recording(name, given));
      const kept = frames.filter((frame) => !lost.includes(frame));
      assert.deepEqual(
        paired(found),
        kept.map((frame) => [frame, frame]),
      );
      assert.ok(found.warnings.some(({ code }) => code === "file-alone"));
    }
  });

test("frames farther apart than half a frame's distance are never paired by their stamps", async () => {
  for (const name of Object.values(NAMES))
    for (const period of [10_000, 33_333])
      await assert.rejects(
        readRigFolder(
          recording(name, { frames: [0, 1, 2, 3, 4, 5], lost: [2, 3], period, offset: 0.52 * period }),
        ).then((found) => {
          const wrong = paired(found).filter(([one, other]) => one !== other && other + 0.52 - one > 0.5);
          assert.deepEqual(wrong, []);
          throw Object.assign(new Error("nothing wrong"), { code: "file" });
        }),
        ({ code }) => code === "file",
      );
});

test("whole seconds do not tell frames apart that are a second apart", async () => {
  const name = (kind, _, time) => `${kind}_${date(time).slice(0, 19).replace(/\D/g, "-")}.png`;
  const files = recording(name, { period: 1_000_000, offset: 700_000 }).map((file) => ({ ...file }));
  const found = await readRigFolder(files).catch((error) => error);
  // Equal names may be paired, but not by their stamps.
  if (found.frames) assert.ok(!/time stamps/.test(found.says));
  else assert.equal(found.code, "file");
});

test("the left images of a stereo camera are its depth maps' colour images, whichever set is shorter", async () => {
  const set = (kind, make, frames) => frames.map((at) => ({ name: `${kind}${padded(at, 6)}.png`, bytes: make(at) }));
  const right = [0, 1, 2, 3].map((at) => ({ name: `right${padded(at, 6)}.png`, bytes: colour(100 + at) }));
  for (const [lefts, depths] of [
    [
      [0, 1, 2, 3],
      [0, 2, 3],
    ],
    [
      [0, 1, 3],
      [0, 1, 2, 3],
    ],
    [
      [0, 1, 2, 3],
      [0, 1, 2, 3],
    ],
  ])
    for (const others of [[], right]) {
      const files = [...set("left", colour, lefts), ...set("depth", depth, depths), ...others];
      const both = lefts.filter((at) => depths.includes(at));
      assert.deepEqual(
        paired(await readRigFolder(files)),
        both.map((at) => [at, at]),
      );
    }
});
