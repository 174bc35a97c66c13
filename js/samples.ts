/** Rendered scenes with a known answer, for tests, pages and first steps. */
import { across } from "./border.js";
import { bindings } from "./engine.js";
import { checkAngles, checkLight, checkLightIsKnown, checkNormals, checkSample } from "./inputs.js";
import type { Pose, Sample, SampleRequest } from "./types/index.js";

/** Renders a colour image and a depth map of a built-in surface or of a given height map. */
export function sample(request: SampleRequest): Sample {
  checkSample(request);
  const { sample: render } = bindings();
  return across(() => render(request));
}

/**
 * The Cramer-Rao bound of the rotation in that scene, one sigma, degrees: no unbiased estimator has a smaller error. `null` without noise
 * and for scenes that do not determine the rotation.
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

/** The 27 coefficients of a light, built in or given, rotated by angles: the light that illuminated a normal n illuminates R n. */
export function turnLight(light: SampleRequest["light"], angles: Partial<Pose["angles"]> = {}): Float64Array {
  checkLight(light);
  checkAngles(angles);
  const { turnLight: turn } = bindings();
  return across(() => turn(light, angles));
}

/** log S of unit normals under a light: for each x, y, z the three values R, G, B. */
export function shadeNormals(light: SampleRequest["light"], normals: Float32Array): Float32Array {
  checkLight(light);
  checkNormals(normals);
  const { shadeNormals: shade } = bindings();
  return across(() => shade(light, normals));
}
