/**
 * Shares one import among all callers. Browsers may resolve two imports of one module in the other order, so that files that are read at
 * the same time would be handled in a different order. An import that failed can be repeated.
 */
export function once<T>(load: () => Promise<T>): () => Promise<T> {
  let loading: Promise<T> | undefined;
  return () =>
    (loading ??= load().catch((error: unknown) => {
      loading = undefined;
      throw error;
    }));
}
