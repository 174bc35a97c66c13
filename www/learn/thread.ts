/** Starts the thread of the lessons. The custom elements have another file in its place (www/elements/threads.ts). */

export const startThread = (): Worker => new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
