// How long pages take to open in Debian's Chromium, until they stand drawn:
//
//   node report/test/opening.mjs DIR/report.html …
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { chromium } from "playwright-core";

const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const args = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const times = 5;

async function opening(browser, page) {
  const tab = await browser.newPage({ viewport: { width: 1280, height: 900 }, reducedMotion: "reduce" });
  tab.setDefaultTimeout(120000);
  await tab.goto(`file://${resolve(page)}`);
  await tab.waitForSelector("footer");
  // Since the beginning of the navigation, with the frame after the next one.
  const spent = await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now())))));
  await tab.close();
  return spent / 1000;
}

const browser = await chromium.launch({ executablePath, args });
for (const page of process.argv.slice(2)) {
  const spent = [];
  for (let i = 0; i < times; i++) spent.push(await opening(browser, page));
  spent.sort((a, b) => a - b);
  const size = (statSync(page).size / 1e6).toFixed(1);
  console.log(`${page}: ${size} MB, ${spent[Math.floor(times / 2)].toFixed(2)} s (${spent[0].toFixed(2)} to ${spent[times - 1].toFixed(2)} s in ${times} openings)`);
}
await browser.close();
