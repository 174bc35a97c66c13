/**
 * Shares one import among all callers. Browsers may resolve two imports of one module in either order, so that files read at the same time
 * could be handled in the wrong order. An import that failed can be repeated.
 */
export function once<T>(load: () => Promise<T>): () => Promise<T> {
  let loading: Promise<T> | undefined;
  return () =>
    (loading ??= load().catch((error: unknown) => {
      loading = undefined;
      throw error;
    }));
}
