/** All drawings of one experiment: its pictures and its surfaces. Runs in the worker. */

import type { ColorImage, DepthMap, Estimator, Layer, Pose, Sample } from "../../pkg/index.js";
import { automaticRange, paintLog, paintPicture, paintScalar, type MapName } from "../draw/colours";
import { ViewCanvas } from "./canvas";
import { Errors, type ErrorName } from "./errors";
import type { Numbers } from "./numbers";
import {
  SCALES,
  VIEWS,
  type Look,
  type Painted,
  type Range,
  type Raster,
  type ScaleName,
  type Side,
  type Drawings,
  type Surface,
  type Texture,
  type ViewName,
} from "./protocol";
import { cutOfDepth, cutOfImage, depthAt, measured, picture, raster, surface, whiteOf, type Cut } from "./rasters";

/** The range for a view without values. */
const NOTHING: Range = { min: 0, max: 1 };
/** Whether a scale shows errors, which cannot be negative and should be zero. */
const isError = (scale: ScaleName): boolean => scale === "residual" || scale.endsWith("Error");
const mapOf = (scale: ScaleName): MapName => (isError(scale) ? "magma" : "viridis");

/** The range, widened if it has no width. */
const wide = ({ min, max }: Range): Range => (max > min ? { min, max } : { min: min - 0.5, max: min + 0.5 });

/** The picture that colours each surface. */
const TEXTURE_OF: Record<Texture, Partial<Record<Side, ViewName>>> = {
  view: {},
  picture: { image: "picture" },
  normals: { image: "imageNormals", depth: "depthNormals" },
  residual: { image: "residual" },
};

/** The input of a run and its results. */
export interface Run {
  image: ColorImage;
  depth: DepthMap;
  estimator: Estimator;
  numbers: Numbers;
  painter: ViewPainter;
}

export class ViewPainter {
  readonly #cuts: Record<Side, Cut>;
  readonly #canvases: Record<Side, ViewCanvas>;
  readonly #picture: ImageData;
  readonly #errors: Errors | undefined;
  /** The views that were drawn last. */
  errors: Partial<Record<ErrorName, Raster>> = {};
  /** The last drawing of the given depth, which is valid until its range changes. */
  #given: Range | undefined;

  /** `truth` is the ground truth of a sample. */
  constructor({ image, depth }: Pick<Run, "image" | "depth">, truth?: Sample["truth"]) {
    this.#cuts = { image: cutOfImage(image), depth: cutOfDepth(depth) };
    this.#canvases = { image: new ViewCanvas(this.#cuts.image), depth: new ViewCanvas(this.#cuts.depth) };
    this.#errors = truth && new Errors(truth, this.#cuts);
    this.#picture = paintPicture(picture(image, this.#cuts.image));
  }

  /** The colour image as supplied. */
  given(): Painted {
    return this.#canvases.image.picture(this.#picture).take();
  }

  /** Draws everything except views that have not changed; with `anew`, these as well. */
  show(run: Run, look: Look, poses: { points: Pose; seen: Pose }, anew: boolean): Drawings {
    const { estimator, numbers, depth } = run;
    const [imageDepth, refined] = [numbers.of("imageDepth"), numbers.of("refinedDepth")];
    const surfaces: Record<Side, Surface> = {
      image: { ...surface(numbers.points("image"), imageDepth, this.#cuts.image), colours: null },
      depth: { ...surface(numbers.points("depth"), refined, this.#cuts.depth), colours: null },
    };
    const ranges = Object.fromEntries(SCALES.map((scale) => [scale, wide(look.ranges[scale] ?? NOTHING)])) as Record<
      ScaleName,
      Range
    >;
    const fit = (scale: ScaleName, data: () => Float32Array): Range => {
      const found = look.ranges[scale] ? undefined : automaticRange({ data: data() });
      if (found) ranges[scale] = wide(isError(scale) ? { min: 0, max: found.max } : found);
      return ranges[scale];
    };
    const views: Drawings["views"] = {};
    const show = (name: ViewName, paint: (canvas: ViewCanvas) => ViewCanvas): void => {
      const side = VIEWS[name];
      const canvas = paint(this.#canvases[side]);
      if (TEXTURE_OF[look.texture][side] === name) surfaces[side].colours = canvas.colours(surfaces[side]);
      views[name] = canvas.take();
    };
    const layer = (name: ViewName, layer: Layer, scale?: ScaleName): void => {
      const options = scale && { range: [ranges[scale].min, ranges[scale].max] as const, map: mapOf(scale) };
      show(name, (canvas) => canvas.layer(estimator, layer, options));
    };
    fit("imageDepth", () => imageDepth);
    fit("refinedDepth", () => refined);
    fit("residual", () => numbers.of("residual"));

    if (anew || look.texture === "picture") show("picture", (canvas) => canvas.picture(this.#picture));
    layer("imageNormals", "normals");
    layer("imageDepth", "depth", "imageDepth");
    layer("residual", "residual", "residual");
    layer("refinedDepth", "refined", "refinedDepth");
    layer("depthNormals", "refinedNormals");
    for (const name of ["albedo", "shading"] as const) {
      const log = raster(numbers.of(name), 3, this.#cuts.image);
      show(name, (canvas) => canvas.picture(paintLog(log, whiteOf(log))));
    }
    // The range is that of the refined depth, from which flying pixels are trimmed, because they would widen the range.
    const range = ranges.refinedDepth;
    if (anew || range.min !== this.#given?.min || range.max !== this.#given.max) {
      this.#given = range;
      const at = measured(this.#cuts.depth, depthAt(depth));
      show("given", (canvas) => canvas.picture(paintScalar(at, range, mapOf("refinedDepth"))));
    }
    if (this.#errors) {
      this.errors = this.#errors.of(numbers);
      for (const [name, error] of Object.entries(this.errors) as [ErrorName, Raster][]) {
        show(name, (canvas) =>
          canvas.picture(
            paintScalar(
              error,
              fit(name, () => error.data),
              mapOf(name),
            ),
          ),
        );
      }
    }
    return { views, ranges, surfaces, poses };
  }
}
