// Draws docs/conrod.png: the connecting rod of the start and of the optimum, deformed and coloured by stress, at the
// instant of the largest stress.
//
//   ./pleuel optimize problems/conrod/conrod.json --allow-programs -o runs/conrod && (cd report && npm ci --ignore-scripts)
//   node docs/draw_solid.mjs runs/conrod docs/conrod.png
import { writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(resolve(here, "../report/package.json"))("playwright-core");
const [run, picture] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const tab = await browser.newPage({ viewport: { width: 1280, height: 940 }, reducedMotion: "reduce" });
await tab.goto(`file://${resolve(run)}/report.html`);
await tab.waitForSelector("footer");
const image = await tab.evaluate(() => {
  const instant = 0.00046; // of the largest stress [s]
  const [width, height] = [740, 300]; // the middle of a larger drawing
  const { stage, goTo } = window.pleuelPlayer;
  stage.setRotatable(true);
  const both = document.createElement("canvas");
  [both.width, both.height] = [width, 2 * height];
  const paint = both.getContext("2d");
  paint.fillStyle = "white";
  paint.fillRect(0, 0, width, 2 * height);
  stage.motions.forEach((_, i) => {
    stage.setVisible(stage.motions.map((_, k) => k === i));
    goTo(instant);
    paint.drawImage(stage.dots(1800, 660), 660, 205, width, height, 0, i * height, width, height);
  });
  return both.toDataURL("image/png");
});
writeFileSync(picture, Buffer.from(image.split(",")[1], "base64"));
await browser.close();
