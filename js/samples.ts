/** Made scenes with a known answer, for tests, pages and first steps. */
import { across } from "./border.js";
import { bindings } from "./engine.js";
import { checkAngles, checkLight, checkLightIsKnown, checkNormals, checkSample } from "./inputs.js";
import type { Pose, Sample, SampleRequest } from "./types/index.js";

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

/** The 27 coefficients of a light, built in or given, turned by angles: what fell on a normal n falls on R n. */
export function turnLight(light: SampleRequest["light"], angles: Partial<Pose["angles"]> = {}): Float64Array {
  checkLight(light);
  checkAngles(angles);
  const { turnLight: turn } = bindings();
  return across(() => turn(light, angles));
}

/** log S of each of some unit normals under a light: three numbers for three, R, G, B for x, y, z. */
export function shadeNormals(light: SampleRequest["light"], normals: Float32Array): Float32Array {
  checkLight(light);
  checkNormals(normals);
  const { shadeNormals: shade } = bindings();
  return across(() => shade(light, normals));
}
