/** Made scenes with a known answer, for tests, pages and first steps. */
import { checkSample } from "./check.js";
import { across, bindings } from "./engine.js";
import type { Sample, SampleRequest } from "./types.js";

/** Renders a colour image and a depth map of a built-in (or your own) surface. */
export function sample(request: SampleRequest): Sample {
  checkSample(request);
  const { sample: render } = bindings();
  return across(() => render(request));
}

/** Names of the built-in surfaces. */
export const sampleSurfaces = (): string[] => bindings().sampleSurfaces();

/** Names of the built-in lights. */
export const sampleLights = (): string[] => bindings().sampleLights();
