import { useEffect, useState } from "react";
import init, { type ColorImage, type DepthMap, Estimator, type Options, type StepReport } from "bimodal-stereo";

export interface Found {
  /** The report of the last step; undefined before the first. */
  report?: StepReport;
  error?: Error;
}

const NOTHING: Options = {};

async function find(
  image: ColorImage,
  depth: DepthMap,
  options: Options,
  signal: AbortSignal,
  onStep: (report: StepReport) => void,
): Promise<void> {
  await init();
  // Strict mode mounts everything twice; the first mount ends here.
  signal.throwIfAborted();
  const estimator = new Estimator(image, depth, options);
  try {
    await estimator.run({ signal, onStep });
  } finally {
    estimator.free();
  }
}

/**
 * The pose between two views, updated while it is being found. A new image, depth map or options object restarts the run, so keep the
 * objects between renderings (`useMemo`). A run in progress ends when the component unmounts.
 */
export function usePose(image: ColorImage, depth: DepthMap, options = NOTHING): Found {
  const [found, setFound] = useState<Found>({});
  useEffect(() => {
    const stop = new AbortController();
    const { signal } = stop;
    const show = (next: Found) => {
      if (!signal.aborted) setFound(next);
    };
    show({});
    find(image, depth, options, signal, (report) => show({ report })).catch((error: Error) => show({ error }));
    return () => stop.abort();
  }, [image, depth, options]);
  return found;
}
