/** The gallery: rendered pairs as cards, each of which becomes files like a visitor's own. Loaded on demand; no picture is downloaded. */

import type { PairKind, PairSample, Pinhole } from "../../pkg/index.js";
import { GALLERY as cards } from "../../protocols/gallery.mjs";
import { make } from "../dom";
import { renderedPair } from "./look";
import { keepTruth } from "./truths";
import { writePng } from "./write";

interface Card {
  kind: PairKind;
  name: string;
  shows: string;
  level: "easy" | "medium" | "hard" | "fails";
  ends: { status: string; degrees: number; millimetres: number };
}
const GALLERY = cards as readonly Card[];

/** Each pair is rendered once. */
const rendered = new Map<PairKind, Promise<PairSample>>();

function pairOf(kind: PairKind): Promise<PairSample> {
  const known = rendered.get(kind) ?? renderedPair(kind);
  rendered.set(kind, known);
  known.catch(() => rendered.delete(kind));
  return known;
}

const LEVELS = { easy: "Easy", medium: "Medium", hard: "Hard", fails: "Fails" } as const;

const endsInWords = ({ ends: { status, degrees, millimetres } }: Card): string =>
  `Ends "${status}", ${degrees}° and ${millimetres} mm off.`;

async function png(name: string, raster: Parameters<typeof writePng>[0]): Promise<File> {
  return new File([(await writePng(raster)) as Uint8Array<ArrayBuffer>], name, { type: "image/png" });
}

function cameraFile(name: string, { width, height }: { width: number; height: number }, camera: Pinhole): File {
  const { fx, fy, cx, cy } = camera;
  return new File([JSON.stringify({ width, height, fx, fy, cx, cy })], name, { type: "application/json" });
}

/** The pair as files, as a camera would write them. */
export async function filesOf(kind: PairKind): Promise<File[]> {
  const { image, depth, pose } = await pairOf(kind);
  const mask = (of: { width: number; height: number; mask?: Uint8Array }, name: string) =>
    png(name, { width: of.width, height: of.height, channels: 1, data: of.mask ?? new Uint8Array() });
  const bytes = image.data as Uint8Array;
  const [colour, map] = await Promise.all([
    png(`render ${kind} colour.png`, { width: image.width, height: image.height, channels: 4, data: bytes }),
    png(`render ${kind} depth.png`, {
      ...{ width: depth.width, height: depth.height, channels: 1 },
      data: depth.data as Uint16Array,
    }),
  ]);
  keepTruth({ colour, depth: map }, pose);
  const cameras = [
    ...(image.camera ? [cameraFile(`render ${kind} colour camera.json`, image, image.camera as Pinhole)] : []),
    ...(depth.camera ? [cameraFile(`render ${kind} depth camera.json`, depth, depth.camera as Pinhole)] : []),
  ];
  return [
    colour,
    map,
    ...(await Promise.all([
      mask(image, `render ${kind} colour mask.png`),
      mask(depth, `render ${kind} depth mask.png`),
    ])),
    ...cameras,
  ];
}

function draw(canvas: HTMLCanvasElement, { image: { width, height, data } }: PairSample): void {
  canvas.width = width;
  canvas.height = height;
  const pixels = new ImageData(new Uint8ClampedArray(data as Uint8Array), width, height);
  canvas.getContext("2d")?.putImageData(pixels, 0, 0);
}

const reasonOf = (error: unknown): string =>
  `It could not be rendered: ${error instanceof Error ? error.message : String(error)}`;

/** The cards; pictures appear as they are rendered. */
export async function showGallery(parent: HTMLElement, take: (files: File[]) => void): Promise<void> {
  const shown = GALLERY.map((card) => {
    const canvas = make("canvas", { width: 1, height: 1, role: "img", "aria-label": `Render: ${card.name}` });
    const button = make(
      "button",
      { type: "button", class: "render" },
      canvas,
      make("strong", {}, card.name),
      make("span", { class: `level ${card.level}` }, LEVELS[card.level]),
      make("span", { class: "soft" }, card.shows),
      make("span", { class: "ends" }, endsInWords(card)),
    );
    button.addEventListener("click", () => {
      button.disabled = true;
      void filesOf(card.kind)
        .then(take)
        .finally(() => (button.disabled = false));
    });
    return { card, canvas, button };
  });
  parent.replaceChildren(...shown.map(({ button }) => button));
  for (const { card, canvas, button } of shown) {
    await pairOf(card.kind).then(
      (pair) => draw(canvas, pair),
      (error: unknown) => button.append(make("span", { class: "ends", role: "alert" }, reasonOf(error))),
    );
  }
}
