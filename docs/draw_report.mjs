// Draws docs/report.png, the picture of a report in the README, and writes beside it the words that it shows:
// a test of the pages compares them with those of today (report/test/browser_test.mjs).
//
//   ./pleuel optimize problems/slider_crank.json -o runs/picture && (cd report && npm ci --ignore-scripts)
//   node docs/draw_report.mjs runs/picture/report.html docs/report.png
import { writeFileSync } from "node:fs";
import { openPage } from "./open_page.mjs";

const [page, picture] = process.argv.slice(2);
const { browser, tab } = await openPage(page);
await tab.evaluate(() => window.pleuelPlayer.goTo(0.0805));
await tab.waitForTimeout(2000);
await tab.screenshot({ path: picture });
const words = await tab.evaluate(() => [...document.querySelectorAll(".hero > :first-child > *, .build header, .build table")].map((part) => part.innerText.replace(/\s+/g, " ")));
writeFileSync(picture.replace(/png$/, "txt"), words.join("\n") + "\n");
await browser.close();
