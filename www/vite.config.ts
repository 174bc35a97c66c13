import { fileURLToPath } from "node:url";

import { defineConfig } from "vite";

/** Absolute, because the build and the development server disagree on what a page is relative to. */
const page = (name: string): string => fileURLToPath(new URL(name, import.meta.url));

export default defineConfig({
  // Relative addresses, so that the built page works under any path of a web server.
  base: "./",
  worker: { format: "es" },
  // The package lies beside this folder, where the development server would not look.
  server: { fs: { allow: [".."] } },
  // three.js is one such chunk, and loads only when the clouds come into view.
  build: { outDir: "../site", emptyOutDir: true, target: "es2023", chunkSizeWarningLimit: 600, rollupOptions: { input: [page("index.html"), page("shortest.html")] } },
});
