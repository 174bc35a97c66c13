/** Colours for the points of a surface, from the rasters that its pixels belong to. */

import type { Frame, Picture, Raster, Surface } from "../engine/protocol";
import { automaticRange, paintNormals, paintPicture, paintScalar } from "./colours";
import type { Drawn } from "./stage";

/** What the surfaces are coloured by; a view has its own colour where it has no such raster. */
export const textures = ["view", "picture", "normals", "residual"] as const;
export type Texture = (typeof textures)[number];

/** RGB bytes of every `step`-th pixel; what is clear there is grey. */
function sampled(image: ImageData, { width, height, step }: Surface): Uint8Array {
  const colours = new Uint8Array(3 * width * height).fill(128);
  for (let to = 0; to < width * height; to++) {
    const from = 4 * (Math.floor(to / width) * step * image.width + (to % width) * step);
    if (image.data[from + 3]) colours.set(image.data.subarray(from, from + 3), 3 * to);
  }
  return colours;
}

const residualOf = (raster: Raster): ImageData => paintScalar(raster, { min: 0, max: automaticRange(raster)?.max ?? 1 }, "magma");

export function textured(frame: Frame, picture: Picture, texture: Texture): { image: Drawn; depth: Drawn } {
  const { imageSurface, depthSurface } = frame;
  const dye = (surface: Surface, paint: (() => ImageData) | undefined): Drawn => ({ ...surface, colours: paint && surface.width > 0 ? sampled(paint(), surface) : null });
  const paints: Record<Texture, readonly [image?: () => ImageData, depth?: () => ImageData]> = {
    view: [],
    picture: [() => paintPicture(picture)],
    normals: [() => paintNormals(frame.imageNormals), () => paintNormals(frame.depthNormals)],
    residual: [() => residualOf(frame.residual)],
  };
  const [image, depth] = paints[texture];
  return { image: dye(imageSurface, image), depth: dye(depthSurface, depth) };
}
