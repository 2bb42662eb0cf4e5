import { readFileSync } from "node:fs";
import { defineConfig, type BuildEnvironmentOptions } from "vite";

/** The package's version is the page's: they ship together. */
const version = /^__version__ = "(.+)"$/m.exec(
  readFileSync(new URL("../__init__.py", import.meta.url), "utf8"),
)?.[1];
if (version === undefined) throw new Error("agent_server/__init__.py has no __version__");

/** Where `npm run dev` finds a running server. */
const server = process.env["AGENT_SERVER_URL"] ?? "http://127.0.0.1:8765";

const page: BuildEnvironmentOptions = {
  // An inlined image would need `data:` in the server's content security policy.
  assetsInlineLimit: 0,
  chunkSizeWarningLimit: 800,
  license: { fileName: "licenses.md" },
  rolldownOptions: { input: ["index.html", "label.html"] },
};

/** One file beside the page, for pages of others; it shares nothing with the page's own bundle. */
const client: BuildEnvironmentOptions = {
  lib: { entry: "src/client.ts", formats: ["es"], fileName: () => "client.js" },
  emptyOutDir: false,
  copyPublicDir: false,
};

export default defineConfig(({ mode }) => ({
  // Relative addresses, so that the page works under any path prefix.
  base: "./",
  define: { __PAGE_VERSION__: JSON.stringify(version) },
  build: { target: "es2023", ...(mode === "client" ? client : page) },
  worker: { format: "es" },
  server: { proxy: { "/v1": { target: server, ws: true } } },
}));
