// What the optimum would gain by each number of the file.
import type { Document, ReportData, Unit } from "../data";
import { h, section } from "../dom";
import { engineering, number, percent, withUnit, words } from "../format";
import { filesSection, unitOf } from "./parts";
import { hero } from "./studies";

const most = 30;

function inBrackets(unit: string): string {
  return /[/ ]/.test(unit) ? `(${unit})` : unit;
}

function signedNumber(value: number): string {
  return `${value > 0 ? "+" : ""}${number(value, 3)}`;
}

export function pricesPage(data: ReportData): HTMLElement[] {
  const { result } = data;
  const value = result.objective?.value || 1;
  const goal = unitOf(data.picture, result.objective?.name ?? "", result.objective?.unit ?? "");
  const prices = Object.entries((result.prices ?? {}) as Record<string, Document>)
    .map(([pointer, one]) => ({ pointer, one, gain: one.per_percent / Math.abs(value) }))
    .filter(({ gain }) => Math.abs(gain) > 5e-5)
    .slice(0, most);
  const largest = Math.max(...prices.map(({ gain }) => Math.abs(gain)), 1e-12);
  const bars = prices.map(({ pointer, one, gain }) => {
    const unit: Unit = one.shown_unit ? { si: one.unit, ...one.shown_unit } : engineering(one.unit);
    const width = `width:${(100 * Math.abs(gain)) / largest}%`;
    return h(
      "li",
      { title: one.next_limit ? `holds until ${words(String(one.next_limit))} decides, too` : "" },
      h("span.bar-name", {}, words(pointer.replace(/^\//, "").replace(/\//g, " › "))),
      h("span.bar-numbers", {}, withUnit(one.value, unit), h("span.soft", {}, ` · ${signedNumber((one.per_unit * unit.factor) / goal.factor)} ${goal.name}/${inBrackets(unit.name)}`)),
      h("span.bar-track", {}, h(gain < 0 ? "span.bar.is-less" : "span.bar.is-more", { style: width })),
      h("span.bar-value", {}, percent(gain, 2)),
    );
  });
  return [
    hero(data, `What one percent more of each number changes of ${words(result.objective?.name ?? "")} (${withUnit(value, goal)}), the design optimal again; behind each number the price of one unit of it.`),
    section(
      "Prices",
      prices.length === most ? "The thirty dearest; all of them are in prices.csv." : "",
      h("ul.bars", {}, bars),
    ),
    filesSection(data),
  ];
}
