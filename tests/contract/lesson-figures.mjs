// The figures of the lessons outside the browser: the same modules that the page's worker runs, bundled for Node.
import { readFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { degreesBetween } from "../../protocols/rotations.mjs";
import { Estimator, init, sample } from "./support.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url));
const file = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));

const NAMES = [
  ...["normal", "lambert", "relief", "strips", "orders", "pixel", "grey", "colours"],
  ...["surface", "prior", "pose", "loop", "sensor", "paint", "failure"],
];
const ENTRY = [
  ...NAMES.map((name) => `export { ${name} } from "./www/learn/compute/${name}.ts";`),
  'export { chapters, lessons } from "./www/learn/lessons/index.ts";',
  'export { contour } from "./www/draw/contours.ts";',
  'export { normalColour } from "./www/draw/colours.ts";',
  'export { taskOf } from "./www/learn/tries.ts";',
  'export { exercises } from "./www/learn/exercises.ts";',
  'export { computed, valuesFrom } from "./www/learn/lesson.ts";',
  'export { READ, SAME_UNITS, nameOf, placeOf, wordsOf } from "./www/learn/translation.ts";',
  'export { FRAMES } from "./www/learn/frames.ts";',
  'export { SYMBOLS } from "./www/learn/maths.ts";',
  'export { STATUSES } from "./www/learn/compute/status.ts";',
  'export { runOptions, sampleRequest, fromLink } from "./www/lab/settings.ts";',
].join("\n");

/** Here the lessons create no elements. The package is not bundled, since it loads files from its own folder. */
const outside = {
  name: "outside",
  setup({ onLoad, onResolve }) {
    onResolve({ filter: /\/dom$/ }, () => ({ path: "dom", namespace: "none" }));
    onLoad({ filter: /.*/, namespace: "none" }, () => ({
      contents: "export const make = () => ({}); export const freshId = () => '';",
    }));
    onResolve({ filter: /pkg\/\w+\.js$/ }, ({ path }) => ({
      path: new URL(`../../pkg/${path.split("pkg/")[1]}`, import.meta.url).href,
      external: true,
    }));
  },
};

async function load() {
  // Node has no ImageData. The drawings need only its size and bytes.
  globalThis.ImageData ??= class {
    constructor(width, height) {
      Object.assign(this, { width, height, data: new Uint8ClampedArray(4 * width * height) });
    }
  };
  const bundle = await build({
    stdin: { contents: ENTRY, resolveDir: root, loader: "ts" },
    bundle: true,
    format: "esm",
    write: false,
    plugins: [outside],
  });
  return import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].contents).toString("base64")}`);
}

await init();
export const learn = await load();
export const { chapters, contour, lessons, exercises, normalColour, taskOf } = learn;

const kept = new Map();

/**
 * The numbers and words of a figure in the state that an address names, such as "surface&step=8&robust=0". The curves of "prior" and "pose"
 * cost ten times as much as their numbers, which the first drawing has already.
 */
export function figure(state) {
  const known = kept.get(state);
  if (known) return known;
  const [id, ...settings] = state.split("&");
  const lesson = lessons.find((each) => each.id === id);
  const values = learn.computed(lesson, learn.valuesFrom(lesson, new URLSearchParams(settings.join("&"))));
  const drawings = learn[id](values);
  let last = drawings.next().value;
  if (id === "pose" && values.run === "hold") drawings.return();
  else if (id === "prior") drawings.return();
  else for (const drawing of drawings) last = drawing;
  const numbers = { ...last.numbers, ...last.words };
  kept.set(state, numbers);
  return numbers;
}

/** A run of the Lab in the state that an exercise's link opens, with some settings changed. */
export function labRun(changed) {
  const name = JSON.stringify(changed);
  const known = kept.get(name);
  if (known) return known;
  const [link] = exercises
    .flatMap(({ links }) => links.map(([address]) => address))
    .filter((a) => !a.includes("learn"));
  const settings = { ...learn.fromLink(link), ...changed };
  const { image, depth, pose } = sample(learn.sampleRequest(settings));
  const { light, ...options } = learn.runOptions(settings, "sample");
  if (light !== "estimate") throw new Error(`This run takes an unknown light, not ${light}`);
  const estimator = new Estimator(image, depth, options);
  while (estimator.report.status === "running") estimator.step();
  const { report } = estimator;
  const found = {
    status: report.status,
    error: degreesBetween(report.pose.rotation, pose.rotation),
    sigma: report.uncertainty ? Math.max(...report.uncertainty.rotationDegrees) : NaN,
  };
  estimator.free();
  kept.set(name, found);
  return found;
}

export const source = (path) => readFile(file(path), "utf8");
