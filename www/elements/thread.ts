/** The thread of `<bimodal-stereo>`: reads the pair, and computes and draws a step for each request of the element. */

import "../engine/hold";
import init, { type ColorImageInput, type DepthMapInput, Estimator, sample, shadeNormals } from "../../pkg/index.js";
import { decodeDepth, decodeMask, imageFrom } from "../../pkg/files.js";
import { ballNormals } from "../engine/ball";
import { faultOf } from "../engine/fault";
import { Course } from "./course";
import type { Answer, Input, Order, Pictures } from "./protocol";

const BALL = 128;
/** Exponent of a screen (gamma), for pictures that are only shown. */
const GAMMA = 1 / 2.2;

let isLoaded = false;
let estimator: Estimator | undefined;
let normals: Float32Array | undefined;
const course = new Course();

const post = (answer: Answer, pictures: Pictures = {}): void =>
  self.postMessage(answer, { transfer: Object.values(pictures) });

/** The error names the attribute that has the address. */
class Unreachable extends Error {
  readonly field: string;
  constructor(field: string, reason: string) {
    super(`${field}: ${reason}`);
    this.field = field;
  }
}

async function bytesAt(field: string, address: string): Promise<ArrayBuffer> {
  let response: Response;
  try {
    response = await fetch(address);
  } catch {
    throw new Unreachable(
      field,
      `${address} cannot be reached, or its server does not permit other origins to read it`,
    );
  }
  if (!response.ok) throw new Unreachable(field, `the server answered with status ${response.status} at ${address}`);
  return response.arrayBuffer();
}

async function pairOf({
  image,
  depth,
  mask,
  unit,
  sample: request,
  pair,
}: Input): Promise<[ColorImageInput, DepthMapInput]> {
  if (pair) return [pair.image, pair.depth];
  if (request) {
    const made = sample(request);
    return [made.image, made.depth];
  }
  const [bytes, map, covered] = await Promise.all([
    bytesAt("image", image),
    bytesAt("depth", depth),
    mask === "" ? undefined : bytesAt("mask", mask),
  ]);
  return [
    await imageFrom(bytes),
    {
      ...decodeDepth(map),
      ...(unit === undefined ? {} : { unit }),
      ...(covered && { mask: decodeMask(covered).data }),
    },
  ];
}

/** Linear colours as a picture, in which the brightest colour is white. */
function pictured(width: number, height: number, colours: ArrayLike<number>): ImageBitmap {
  let most = 0;
  for (let i = 0; i < colours.length; i++) most = Math.max(most, colours[i] || 0);
  const pixels = new ImageData(width, height);
  for (let i = 0; i < width * height; i++) {
    if (Number.isNaN(colours[3 * i])) continue;
    for (let c = 0; c < 3; c++) pixels.data[4 * i + c] = 255 * ((colours[3 * i + c] ?? 0) / most) ** GAMMA;
    pixels.data[4 * i + 3] = 255;
  }
  return bitmapOf(width, height, (context) => context.putImageData(pixels, 0, 0));
}

function bitmapOf(
  width: number,
  height: number,
  draw: (context: OffscreenCanvasRenderingContext2D) => void,
): ImageBitmap {
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d");
  if (!context) throw new Error("there is no memory left for a canvas");
  draw(context);
  return canvas.transferToImageBitmap();
}

/** Integers are already encoded for a screen; rendered scenes are linear floats of three channels. */
function imagePicture({ width, height, data }: ColorImageInput): ImageBitmap {
  const channels = data.length / (width * height);
  const isLinear = data instanceof Float32Array;
  const least = data instanceof Uint16Array ? 1 / 257 : 1;
  if (isLinear && channels === 3) return pictured(width, height, data);
  const most = isLinear ? data.reduce((a, b) => Math.max(a, b), 0) : 1;
  const pixels = new ImageData(width, height);
  for (let i = 0; i < width * height; i++) {
    for (let c = 0; c < 3; c++) {
      const value = data[channels * i + (channels < 3 ? 0 : c)] ?? 0;
      pixels.data[4 * i + c] = isLinear ? 255 * (value / most) ** GAMMA : least * value;
    }
    pixels.data[4 * i + 3] = 255;
  }
  return bitmapOf(width, height, (context) => context.putImageData(pixels, 0, 0));
}

let size = { width: 1, height: 1 };

async function open({ input, options, wasm }: Extract<Order, { kind: "open" }>): Promise<void> {
  await init(wasm);
  isLoaded = true;
  const [image, depth] = await pairOf(input);
  estimator = new Estimator(image, depth, options);
  size = { width: image.width, height: image.height };
  const pictures = { image: imagePicture(image) };
  post({ kind: "opened", pictures }, pictures);
}

function step(withCharts: boolean): void {
  const from = estimator;
  if (!from) return;
  const report = from.step();
  course.take(report);
  normals ??= ballNormals(BALL, 0.98);
  const ball = shadeNormals(from.light(), normals).map(Math.exp);
  const pictures = {
    surface: bitmapOf(size.width, size.height, (context) => from.draw(context, "normals")),
    light: pictured(BALL, BALL, ball),
  };
  post({ kind: "stepped", report, pictures, panels: withCharts ? course.panels(from) : undefined }, pictures);
}

self.onmessage = async ({ data }: MessageEvent<Order>) => {
  try {
    if (data.kind === "open") await open(data);
    else step(data.withCharts);
  } catch (error) {
    const fault =
      error instanceof Unreachable
        ? { code: "file", field: error.field, message: error.message, fatal: false }
        : faultOf(error, isLoaded);
    post({ kind: "fault", fault });
  }
};
