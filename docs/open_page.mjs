// Opens a page for the pictures of the documentation.
import { createRequire } from "node:module";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(resolve(here, "../report/package.json"))("playwright-core");

/** @returns the browser and its tab with a page that is drawn */
export async function openPage(file) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  const tab = await browser.newPage({ viewport: { width: 1280, height: 940 }, reducedMotion: "reduce" });
  tab.setDefaultTimeout(120000);
  await tab.goto(`file://${resolve(file)}`);
  await tab.waitForSelector("footer");
  return { browser, tab };
}
