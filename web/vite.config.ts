import { svelte } from "@sveltejs/vite-plugin-svelte";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";

/** Licences, by their file in the package, that its package.json leaves out. */
const LICENCES: Readonly<Record<string, string>> = { "svelte-toolbelt": "MIT" };

/** Every bundled package is listed with the name of its licence. */
const nameLicences: Plugin = {
  name: "name-licences",
  generateBundle: {
    order: "post",
    handler(_options, bundle) {
      const list = bundle["licenses.md"];
      if (list?.type !== "asset") return this.error("licenses.md is missing");
      list.source = String(list.source).replace(/^## (\S+) - \S+$/gm, (line, name: string) => {
        if (!LICENCES[name]) this.error(`${name} names no licence`);
        return `${line} (${LICENCES[name]})`;
      });
    },
  },
};

// Names carry no hash: the page is committed beside the server, which tells browsers to revalidate.
export default defineConfig({
  root: import.meta.dirname,
  base: "./",
  plugins: [svelte({ configFile: false }), nameLicences],
  // else vitest takes the runtime that renders on a server
  ...(process.env.VITEST ? { resolve: { conditions: ["browser"] } } : {}),
  test: { include: ["tests/**/*.test.ts"] },
  build: {
    outDir: "../packages/fdvv-studio/src/fdvv_studio/studio/static",
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
