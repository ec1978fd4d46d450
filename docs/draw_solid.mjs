// Draws docs/conrod.png: the connecting rod of the start and of the optimum, deformed and coloured by stress, at the
// instant of the largest stress.
//
//   ./pleuel optimize problems/conrod/conrod.json --allow-programs -o runs/conrod && (cd report && npm ci --ignore-scripts)
//   node docs/draw_solid.mjs runs/conrod docs/conrod.png
import { writeFileSync } from "node:fs";
import { openPage } from "./open_page.mjs";

const [run, picture] = process.argv.slice(2);
const { browser, tab } = await openPage(`${run}/report.html`);
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
