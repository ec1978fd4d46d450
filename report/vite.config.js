import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One page with everything in it. Where it goes: PLEUEL_REPORT_OUT, by default beside the release
// build, where the program looks for it.
export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: {
    outDir: process.env.PLEUEL_REPORT_OUT ?? "../build/release/report",
    emptyOutDir: false,
    target: "es2021",
    chunkSizeWarningLimit: 4000,
    rollupOptions: { input: "report.html" },
  },
});
