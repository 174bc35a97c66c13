/**
 * One import for all callers: browsers may answer two imports of one module in the other order, and files that are read at the same time would
 * be done in another order than they came in. An import that failed may be repeated.
 */
export function once<T>(load: () => Promise<T>): () => Promise<T> {
  let loading: Promise<T> | undefined;
  return () =>
    (loading ??= load().catch((error: unknown) => {
      loading = undefined;
      throw error;
    }));
}
