// Summarises samples for the JSON: quantiles, ratios, growth, and aims with their verdicts.
import { FIRST_PAINT_BUDGET, WASM_BUDGET } from "../sizes.mjs";
import { FOUND_WITHIN, isFound } from "../../protocols/counts.mjs";
import { median, quantile } from "../../protocols/numbers.mjs";
import { sidesOf } from "./scenes.mjs";

export const quantiles = (times) => ({ median: median(times), p10: quantile(times, 0.1), p90: quantile(times, 0.9) });

export const pixelsOf = (size) => sidesOf(size).reduce((width, height) => width * height);

/** Smallest view for the growth of time, pixels, because in smaller ones the fixed cost of a step dominates. */
const GROWTH_FROM = 64 * 64;

/** Slope of a least-squares line through the points. */
function slope(points) {
  const middle = [0, 1].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
  const moment = (axis) =>
    points.reduce((sum, point) => sum + (point[0] - middle[0]) * (point[axis] - middle[axis]), 0);
  return moment(1) / moment(0);
}

/** Exponent of the time of a stage against the number of pixels; null where fewer than two sizes were timed. */
function growth(rows, where, stage) {
  const points = rows
    .filter(
      (row) =>
        row.where === where && row.stage === stage && pixelsOf(row.size) >= GROWTH_FROM && row.milliseconds.median > 0,
    )
    .map(({ size, milliseconds }) => [Math.log(pixelsOf(size)), Math.log(milliseconds.median)]);
  return points.length < 2 ? null : slope(points);
}

function growths(rows) {
  const of = (where) =>
    Object.fromEntries(
      [...new Set(rows.map(({ stage }) => stage))].map((stage) => [stage, growth(rows, where, stage)]),
    );
  const places = new Set(rows.map(({ where }) => where));
  const main = of(places.has("browser") ? "browser" : "native");
  return { ...main, ...(places.has("native") ? { native: of("native") } : {}) };
}

const wasmAgainstNative = (rows) =>
  rows.flatMap(({ where, size, stage, milliseconds }) => {
    const native = rows.find((row) => row.where === "native" && row.size === size && row.stage === stage);
    return where === "browser" && native
      ? [{ size, stage, ratio: milliseconds.median / native.milliseconds.median }]
      : [];
  });

/** One row for each place and size of searches through several scenes. */
function searchRows(searches) {
  const keys = [...new Set(searches.map(({ where, size }) => `${where} ${size}`))];
  return keys.map((key) => {
    const members = searches.filter(({ where, size }) => `${where} ${size}` === key);
    const [{ where, size }] = members;
    return {
      where,
      size,
      scenes: members.length,
      milliseconds: quantiles(members.map(({ milliseconds }) => milliseconds)),
      searching: quantiles(members.map(({ search }) => search)),
      longestSlice: Math.max(...members.map(({ longestSlice }) => longestSlice)),
      foundRate: members.filter(isFound).length / members.length,
      foundWithin: FOUND_WITHIN,
      medianDegrees: median(members.map(({ degrees }) => degrees)),
      each: members.map(({ scene, milliseconds, degrees, status }) => ({ scene, milliseconds, degrees, status })),
    };
  });
}

/** The contents of the JSON; a value that was not measured is null. */
export function summary({
  samples,
  ends,
  converged,
  searches,
  startUp,
  transfer,
  drawing,
  playing,
  memory,
  sizes,
  about,
}) {
  const rows = samples.map(({ where, size, stage, times }) => ({
    where,
    size,
    stage,
    samples: times.length,
    milliseconds: quantiles(times),
  }));
  const timesOf = (found) =>
    found &&
    Object.fromEntries(
      Object.entries(found).map(([key, value]) => [key, Array.isArray(value) ? quantiles(value) : value]),
    );
  const noSizes = { wasmBytes: null, wasmGzipBytes: null, scalarBytes: null, scalarGzipBytes: null, jsGzipBytes: null };
  const { scripts, ...bytes } = sizes ?? noSizes;
  return {
    rows,
    ...bytes,
    bytesPerPixel: memory?.bytesPerPixel ?? null,
    growth: growths(rows),
    timeToConverged: [...converged, ...ends],
    search: searchRows(searches),
    wasmAgainstNative: wasmAgainstNative(rows),
    startUp: startUp ? { size: startUp.size, milliseconds: quantiles(startUp.times) } : null,
    transfer: timesOf(transfer) ?? null,
    drawing: timesOf(drawing) ?? null,
    playing: playing ?? null,
    memory: memory ?? null,
    firstScripts: scripts ?? null,
    ...about,
  };
}

/** [name, value, unit, limit] of each aim; a value is null if this run did not measure it. */
export function aims({
  rows,
  search,
  growth,
  wasmAgainstNative,
  playing,
  bytesPerPixel,
  wasmGzipBytes,
  scalarGzipBytes,
  jsGzipBytes,
}) {
  const step = (size, stage = "step", where = "browser") =>
    rows.find((row) => row.where === where && row.size === size && row.stage === stage)?.milliseconds.median ?? null;
  const searched = (size, where) => search.find((row) => row.where === where && row.size === size);
  const ratios = wasmAgainstNative.filter(({ stage }) => stage === "step").map(({ ratio }) => ratio);
  const slices = search.filter(({ where }) => where === "browser").map(({ longestSlice }) => longestSlice);
  const most = (values) => (values.length === 0 ? null : Math.max(...values));
  const kilo = (bytes) => (bytes === null ? null : bytes / 1000);
  const seconds = (size, where = "browser") => kilo(searched(size, where)?.milliseconds.median ?? null);
  return [
    ["whole step at 32x32", step("32x32"), "ms", 0.4],
    ["whole step at 128x128", step("128x128"), "ms", 3],
    ["whole step at 640x480", step("640x480"), "ms", 33],
    ["standing step at 32x32", step("32x32", "standing step"), "ms", 0.4],
    ["standing step at 128x128", step("128x128", "standing step"), "ms", 5],
    ["standing step at 640x480", step("640x480", "standing step"), "ms", 60],
    ["the same with two workers", step("640x480", "standing step", "browser, 2 workers"), "ms", 22],
    ["last step at 128x128", step("128x128", "last step"), "ms", 3],
    ["last step at 640x480", step("640x480", "last step"), "ms", 33],
    ["search to converged at 64x64", seconds("64x64"), "s", 1.5],
    ["search to converged at 128x128", seconds("128x128"), "s", 3],
    ["the same with two workers, 64x64", seconds("64x64", "browser, 2 workers"), "s", 1.5],
    ["the same with two workers, 128x128", seconds("128x128", "browser, 2 workers"), "s", 3],
    ["longest slice of a search", most(slices), "ms", 8],
    ["wasm against native, worst step", most(ratios), "x", 1.8],
    ["exponent of a step's time against the pixels", growth.step, "", 1.1],
    ["page playing 640x480: tasks over 50 ms", playing?.longTasks.length ?? null, "", 0],
    // The aim is at least 55 frames a second.
    ["page playing 640x480: mean frame", playing ? 1000 / playing.framesPerSecond : null, "ms", 1000 / 55],
    ["memory after a run at 640x480", bytesPerPixel, "B/px", 220],
    ["wasm, gzipped", kilo(wasmGzipBytes), "kB", WASM_BUDGET / 1000],
    ["wasm without SIMD, gzipped", kilo(scalarGzipBytes), "kB", WASM_BUDGET / 1000],
    // The size must stay below the budget, not reach it.
    ["first scripts of the page, gzipped", kilo(jsGzipBytes), "kB", (FIRST_PAINT_BUDGET - 1) / 1000],
  ].map(([what, value, unit, limit]) => ({ what, value, unit, limit, met: value === null ? null : value <= limit }));
}
