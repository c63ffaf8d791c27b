import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vitest/config";

// Names carry no hash: the page is committed beside the server, which tells browsers to revalidate.
export default defineConfig({
  root: import.meta.dirname,
  base: "./",
  plugins: [svelte()],
  // else vitest takes the runtime that renders on a server
  ...(process.env.VITEST ? { resolve: { conditions: ["browser"] } } : {}),
  test: { include: ["tests/**/*.test.ts"] },
  build: {
    outDir: "../src/fdvv/studio/static",
    emptyOutDir: true,
    target: "es2022",
    license: { fileName: "licenses.md" },
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    rollupOptions: {
      output: {
        entryFileNames: "studio.js",
        chunkFileNames: "[name].js",
        assetFileNames: "[name][extname]",
        // what most pages use in one file: it compresses better than many small ones
        codeSplitting: { groups: [{ name: "shared", test: /src\//, minShareCount: 3 }] },
      },
    },
  },
});
