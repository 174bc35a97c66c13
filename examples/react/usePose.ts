import { useEffect, useState } from "react";
import init, { type ColorImage, type DepthMap, Estimator, type Options, type StepReport } from "bimodal-stereo";

export interface Found {
  /** The last step's; nothing before the first. */
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
  // Strict mode mounts everything twice: the first time ends here.
  signal.throwIfAborted();
  const estimator = new Estimator(image, depth, options);
  try {
    await estimator.run({ signal, onStep });
  } finally {
    estimator.free();
  }
}

/**
 * The pose between two views while it is being found. Another image, depth map or options object begins anew, so keep them from one
 * rendering to the next (`useMemo`); what is under way ends when the component goes.
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
