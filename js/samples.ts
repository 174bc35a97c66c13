/** Made scenes with a known answer, for tests, pages and first steps. */
import { across } from "./border.js";
import { bindings } from "./engine.js";
import { checkLightIsKnown, checkSample } from "./inputs.js";
import type { Sample, SampleRequest } from "./types.js";

/** Renders a colour image and a depth map of a built-in (or your own) surface. */
export function sample(request: SampleRequest): Sample {
  checkSample(request);
  const { sample: render } = bindings();
  return across(() => render(request));
}

/**
 * The least error of the rotation that any estimator can have on that scene: its Cramer-Rao bound, one sigma, degrees. `null`
 * where there is none: without noise, and where the scene determines no rotation.
 */
export function sampleBound(request: SampleRequest, lightIsKnown: boolean): number | null {
  checkSample(request);
  checkLightIsKnown(lightIsKnown);
  const { sampleBound: bound } = bindings();
  return across(() => bound(request, lightIsKnown) ?? null);
}

/** Names of the built-in surfaces. */
export const sampleSurfaces = (): string[] => bindings().sampleSurfaces();

/** Names of the built-in lights. */
export const sampleLights = (): string[] => bindings().sampleLights();
