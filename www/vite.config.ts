import { fileURLToPath } from "node:url";

import { defineConfig, type Plugin } from "vite";

/** An absolute path, because the build and the development server resolve relative paths differently. */
const page = (name: string): string => fileURLToPath(new URL(name, import.meta.url));

/**
 * Queries that uPlot makes when it is loaded, and their replacements: the number format of the browser's language, and its time zone. The
 * first such query takes 15 to 30 ms in one task and loads tables that this page does not need, because its numbers are plain and none is a
 * time.
 */
const ASKED = {
  "new Intl.NumberFormat(domEnv ? nav.language : 'en-US')": "({ format: String })",
  "new Intl.DateTimeFormat().resolvedOptions().timeZone": '"UTC"',
};
const withoutLanguage: Plugin = {
  name: "without-language",
  transform(code, id) {
    if (!id.endsWith("uPlot.esm.js")) return;
    for (const [asked, instead] of Object.entries(ASKED)) {
      if (!code.includes(asked)) throw new Error(`uPlot has no "${asked}" any more: see www/vite.config.ts`);
      code = code.replace(asked, instead);
    }
    return { code, map: null };
  },
};

/** Files of the package that the readers of rig files and those of recordings share; `npm test -- sizes` reports a missing one. */
const READERS = /pkg[\\/](?:check|errors|half|limits|matrices|numbers|png|scale)\d*\.js$/;

export default defineConfig({
  plugins: [withoutLanguage],
  // Relative addresses, so that the built page works under any path of a web server.
  base: "./",
  worker: {
    format: "es",
    rolldownOptions: {
      output: {
        // The readers that a worker shares with modules that it loads later, such as recordings, are one file, because several files
        // compress worse.
        codeSplitting: { groups: [{ name: "readers", minShareCount: 2, test: READERS }] },
      },
    },
  },
  // The package is outside this folder, to which the development server is otherwise restricted.
  server: { fs: { allow: [".."] } },
  // three.js is such a chunk, and loads only when the clouds become visible.
  build: {
    outDir: "../site",
    emptyOutDir: true,
    target: "es2023",
    chunkSizeWarningLimit: 600,
    rollupOptions: { input: [page("index.html"), page("shortest.html")] },
  },
});
