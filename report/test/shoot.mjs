// Pictures of a page in both schemes and widths: node shoot.mjs PAGE.html NAME [DIR]
import { chromium } from "playwright-core";
const [page, name, dir = "/tmp/fix3/shots"] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
for (const [width, height, scheme] of [[1280, 900, "light"], [1280, 900, "dark"], [390, 844, "light"], [390, 844, "dark"]]) {
  if (process.env.ONLY && !process.env.ONLY.split(",").includes(`${width}-${scheme}`)) continue;
  const tab = await browser.newPage({ viewport: { width, height }, colorScheme: scheme, reducedMotion: "reduce" });
  tab.on("console", (m) => ["error", "warning"].includes(m.type()) && console.log(m.type(), m.text()));
  tab.on("pageerror", (e) => console.log("PAGE ERROR", e.stack));
  const begin = Date.now();
  await tab.goto(`file://${page}`);
  await tab.waitForSelector("footer");
  console.log(width, scheme, "opened in", Date.now() - begin, "ms; scroll width", await tab.evaluate(() => document.documentElement.scrollWidth));
  await tab.evaluate(() => { const s = document.querySelector('input[type=range]'); if (s) { s.value = 640; s.dispatchEvent(new Event("input")); } });
  await tab.waitForTimeout(500);
  await tab.screenshot({ path: `${dir}/${name}-${width}-${scheme}.png` });
  await tab.screenshot({ path: `${dir}/${name}-${width}-${scheme}-full.png`, fullPage: true });
  await tab.close();
}
await browser.close();
