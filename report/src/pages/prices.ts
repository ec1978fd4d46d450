// What the optimum would gain by each number of the file.
import type { Document, ReportData } from "../data";
import { h, section } from "../dom";
import { engineering, percent, withUnit, words } from "../format";
import { filesSection } from "./parts";
import { hero } from "./studies";

const most = 30;

export function pricesPage(data: ReportData): HTMLElement[] {
  const { result } = data;
  const value = result.objective?.value || 1;
  const prices = Object.entries((result.prices ?? {}) as Record<string, Document>)
    .map(([pointer, one]) => ({ pointer, one, gain: one.per_percent / Math.abs(value) }))
    .filter(({ gain }) => Math.abs(gain) > 5e-5)
    .slice(0, most);
  const largest = Math.max(...prices.map(({ gain }) => Math.abs(gain)), 1e-12);
  const bars = prices.map(({ pointer, one, gain }) => {
    const width = `width:${(100 * Math.abs(gain)) / largest}%`;
    return h(
      "li",
      { title: one.next_limit ? `holds until ${words(String(one.next_limit))} decides, too` : "" },
      h("span.bar-name", {}, words(pointer.replace(/^\//, "").replace(/\//g, " › "))),
      h("span.bar-numbers", {}, withUnit(one.value, engineering(one.unit))),
      h("span.bar-track", {}, h(gain < 0 ? "span.bar.is-less" : "span.bar.is-more", { style: width })),
      h("span.bar-value", {}, percent(gain, 2)),
    );
  });
  return [
    hero(data, `What one percent more of each number changes of ${words(result.objective?.name ?? "")}, the design optimal again.`),
    section(
      "Prices",
      prices.length === most ? "The thirty dearest; all of them are in prices.csv." : "",
      h("ul.bars", {}, bars),
    ),
    filesSection(data),
  ];
}
