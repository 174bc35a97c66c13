/**
 * Both elements as widgets of notebooks (anywidget); python/bimodal_stereo/widget.py is the other side. A notebook loads this script from a
 * blob, beside which there are no files, so the kernel sends the threads and the .wasm, once for each page.
 */

import type { BimodalFigureElement, BimodalStereoElement, StereoPair } from "../../pkg/elements.js";
import type { StepReport } from "../../pkg/index.js";
import { configure } from "./index";

interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(name: string, listener: (...values: unknown[]) => void): void;
  off(name: string, listener: (...values: unknown[]) => void): void;
  send(content: unknown): void;
}

interface Given {
  model: Model;
  el: HTMLElement;
}

/** The files of the page, shared by all copies of this script: each widget loads one, and the first defines the elements. */
interface Page {
  isReady: boolean;
  take(files: Record<string, DataView>): void;
  ready: Promise<void>;
}

const PAGE = Symbol.for("bimodal-stereo widget");

function pageOf(): Page {
  const all = globalThis as { [PAGE]?: Page };
  all[PAGE] ??= (() => {
    let take: Page["take"] = () => {};
    const files = new Promise<Record<string, DataView>>((resolve) => (take = resolve));
    const made: Page = { isReady: false, take, ready: files.then(place).then(() => void (made.isReady = true)) };
    return made;
  })();
  return all[PAGE];
}

/** Set at once, so that the copy that defines the elements also receives the addresses of their files. */
const page = pageOf();

async function place(files: Record<string, DataView>): Promise<void> {
  const bytesOf = (name: string) => files[name] as DataView<ArrayBuffer>;
  const script = (name: string) => URL.createObjectURL(new Blob([bytesOf(name)], { type: "text/javascript" }));
  const packed = new Blob([bytesOf("wasm")]).stream().pipeThrough(new DecompressionStream("gzip"));
  const wasm = await WebAssembly.compile(await new Response(packed).arrayBuffer());
  configure({ wasm, stereoThread: script("stereo-thread"), figureThread: script("figure-thread") });
}

/** Asks the kernel of this widget, because the kernel of another one may have ended before it answered. */
async function files(model: Model): Promise<void> {
  if (page.isReady) return;
  const listen = (content: unknown, buffers: unknown) => {
    const { files: names } = content as { files?: string[] };
    if (!names) return;
    page.take(Object.fromEntries(names.map((name, at) => [name, (buffers as DataView[])[at] as DataView])));
  };
  model.on("msg:custom", listen);
  model.send({ wants: "files" });
  await page.ready;
  model.off("msg:custom", listen);
}

const KINDS = { uint8: Uint8Array, uint16: Uint16Array, float32: Float32Array };
interface Packed {
  type: keyof typeof KINDS;
  bytes: DataView;
}

/** Arrays of the kernel, wherever they are in an object. A copy, because a view's place need not be a multiple of a number's size. */
function unpacked(value: unknown): unknown {
  if (typeof value !== "object" || value === null || Array.isArray(value)) return value;
  if (!("bytes" in value)) return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, unpacked(each)]));
  const { type, bytes } = value as Packed;
  return new KINDS[type](bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer);
}

/** Least time between two reports to the kernel, milliseconds; a step takes less, and a kernel that computes reads none of them. */
const REPORT_EVERY = 200;

type Bound = { end(): void };

/** Copies these members from the kernel to the element at each change. The element ignores a value equal to its own. */
function follow(model: Model, element: object, names: Record<string, (value: unknown) => unknown>): Bound {
  const ends = Object.entries(names).map(([name, convert]) => {
    const own = name.replace(/^_/, "");
    const listener = () => Reflect.set(element, own, convert(model.get(name)));
    listener();
    model.on(`change:${name}`, listener);
    return () => model.off(`change:${name}`, listener);
  });
  return { end: () => ends.forEach((end) => void end()) };
}

function tell(model: Model, values: Record<string, unknown>): void {
  for (const [name, value] of Object.entries(values)) model.set(name, value);
  model.save_changes();
}

const same = (value: unknown) => value;

function figureOf(model: Model): [BimodalFigureElement, Bound] {
  const element = document.createElement("bimodal-figure");
  element.addEventListener("status", ({ detail }) => tell(model, { state: detail.state }));
  element.addEventListener("done", ({ detail }) => tell(model, { result: detail, error: {} }));
  element.addEventListener("error", ({ detail }) => tell(model, { error: detail }));
  return [element, follow(model, element, { lesson: same, state: same })];
}

function labOf(model: Model): [BimodalStereoElement, Bound] {
  const element = document.createElement("bimodal-stereo");
  let last = -Infinity;
  const report = (detail: StepReport) => {
    last = performance.now();
    tell(model, { _report: detail, status: detail.status, error: {} });
  };
  element.addEventListener("step", ({ detail }) => {
    if (performance.now() - last > REPORT_EVERY) report(detail);
  });
  element.addEventListener("done", ({ detail }) => report(detail));
  element.addEventListener("error", ({ detail }) => tell(model, { error: detail }));
  const paused = new MutationObserver(() => tell(model, { paused: element.paused }));
  paused.observe(element, { attributeFilter: ["paused"] });
  const pair = (value: unknown) => unpacked(value) as StereoPair;
  const members = { _pair: pair, _options: same, charts: same, paused: same };
  const bound = follow(model, element, members);
  return [
    element,
    {
      end: () => {
        paused.disconnect();
        bound.end();
      },
    },
  ];
}

async function render({ model, el }: Given): Promise<() => void> {
  await files(model);
  const [element, bound] = model.get("_tag") === "bimodal-figure" ? figureOf(model) : labOf(model);
  // Otherwise JupyterLab would handle the arrow keys of a slider.
  element.dataset.lmSuppressShortcuts = "true";
  el.append(element);
  return () => {
    bound.end();
    element.remove();
  };
}

export default { render };
