import { defineConfig } from "vite";

export default defineConfig({
  // Relative addresses, so that the built page works under any path of a web server.
  base: "./",
  worker: { format: "es" },
  // The package lies beside this folder, where the development server would not look.
  server: { fs: { allow: [".."] } },
  // three.js is one such chunk, and loads only when the clouds come into view.
  build: { target: "es2023", chunkSizeWarningLimit: 600, rollupOptions: { input: ["www/index.html", "www/shortest.html"] } },
});
