// What the optimum would gain by each number of the file.
import type { Document, ReportData, Unit } from "../data";
import { bar, h, type Page, section } from "../dom";
import { count, engineering, number, sentence, withUnit, words } from "../format";
import { filesSection, unitOf } from "./parts";
import { hero } from "./studies";

/** As many as in the terminal. */
const most = 25;

type Price = [pointer: string, price: Document];

function inBrackets(unit: string): string {
  return /[/ ]/.test(unit) ? `(${unit})` : unit;
}

function signedNumber(value: number, digits = 3): string {
  return `${value > 0 ? "+" : ""}${number(value, digits)}`;
}

/** "rod › to › x (+2) *" */
function nameOf([pointer, one]: Price): string {
  const name = words(pointer.replace(/^\/(scene\/)?/, "").replace(/\//g, " › "));
  const others = (one.with?.length ?? 1) - 1;
  return `${name}${others > 0 ? ` (+${others})` : ""}${one.next_limit ? " *" : ""}`;
}

function barOf(price: Price, goal: Unit, gain: number, largest: number): HTMLElement {
  const [, one] = price;
  const unit: Unit = one.shown_unit ? { si: one.unit, ...one.shown_unit } : engineering(one.unit);
  const perUnit = signedNumber((one.per_unit * unit.factor) / goal.factor);
  const numbers = [withUnit(one.value, unit), h("span.soft", {}, ` · ${perUnit} ${goal.name}/${inBrackets(unit.name)}`)];
  return bar(nameOf(price), numbers, gain, largest, one.value === 0 ? "–" : `${signedNumber(100 * gain, 2)} %`);
}

/** What decides beyond the prices with a star, what the brackets mean and what is not shown. */
function notes(priced: Price[], all: number): string[] {
  const nextLimits = [...new Set(priced.map(([, one]) => one.next_limit).filter(Boolean) as string[])].sort();
  const list: string[] = [];
  if (nextLimits.length) list.push(`* holds for less than 1 %: before that ${nextLimits.map(words).join(" or ")} begins to decide, too`);
  if (priced.some(([, one]) => one.with)) list.push("in brackets: how many numbers of the file move with it, as those of a shared point");
  if (priced.length > most) list.push(`${count(priced.length - most)} smaller ones stand in prices.csv`);
  if (all > priced.length) list.push(`without influence on the optimum: ${count(all - priced.length)} more`);
  return list.map(sentence);
}

/** With the verdict on the optimum that prices are of, unless they are prices of none. */
function withVerdict(data: ReportData): ReportData {
  const { result } = data;
  const [, status, message] = /^(\w+): (.*)$/s.exec(result.verdict ?? "") ?? [];
  if (!status) return data;
  return { ...data, result: { ...result, ...(result.status === "done" ? { status, message } : { message: result.verdict }) } };
}

export function pricesPage(data: ReportData): Page {
  const { result } = data;
  const value = result.objective?.value || 1;
  const goal = unitOf(data.picture, result.objective?.name ?? "", result.objective?.unit ?? "");
  const all = Object.entries((result.prices ?? {}) as Record<string, Document>);
  const priced = all.filter(([, one]) => one.per_unit !== 0);
  const gainOf = ([, one]: Price) => one.per_percent / Math.abs(value);
  const shown = priced.slice(0, most);
  const largest = Math.max(...shown.map((one) => Math.abs(gainOf(one))), 1e-12);
  return [
    hero(withVerdict(data), `What one percent more of each number changes of ${words(result.objective?.name ?? "")} (${withUnit(value, goal)}), the design optimal again; behind each number the price of one unit of it.`),
    section(
      "Prices",
      "",
      h("ul.bars", {}, shown.map((one) => barOf(one, goal, gainOf(one), largest))),
      notes(priced, all.length).map((text) => h("p.note", {}, text)),
    ),
    filesSection(data),
  ];
}
