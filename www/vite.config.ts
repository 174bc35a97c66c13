import { fileURLToPath } from "node:url";

import { defineConfig, type Plugin } from "vite";

/** Absolute, because the build and the development server disagree on what a page is relative to. */
const page = (name: string): string => fileURLToPath(new URL(name, import.meta.url));

/**
 * What uPlot asks the browser for as it is evaluated, and what is put in its place: how its language writes numbers, and its time zone. Who asks first waits
 * for 15 to 30 ms in one task, for tables that this page has no use for: its numbers are plain, and none is a time.
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

/** Files of the package that the readers of a rig's files and those of its recordings share; `npm test -- sizes` tells where one is missing. */
const READERS = /pkg[\\/](?:check|errors|half|limits|matrices|numbers|png|scale)\d*\.js$/;

export default defineConfig({
  plugins: [withoutLanguage],
  // Relative addresses, so that the built page works under any path of a web server.
  base: "./",
  worker: {
    format: "es",
    rolldownOptions: {
      output: {
        // The readers that a worker shares with what it loads later, recordings for example, are one file: in pieces they compress worse.
        codeSplitting: { groups: [{ name: "readers", minShareCount: 2, test: READERS }] },
      },
    },
  },
  // The package lies beside this folder, where the development server would not look.
  server: { fs: { allow: [".."] } },
  // three.js is one such chunk, and loads only when the clouds come into view.
  build: {
    outDir: "../site",
    emptyOutDir: true,
    target: "es2023",
    chunkSizeWarningLimit: 600,
    rollupOptions: { input: [page("index.html"), page("shortest.html")] },
  },
});
