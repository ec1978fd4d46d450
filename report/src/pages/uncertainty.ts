// Deviations and bounds of the responses, and which parameters they come from.
import type { Document, ReportData } from "../data";
import { h, type Page, section, tableOf } from "../dom";
import { count, engineering, number, share, withUnit, words } from "../format";
import { fact, filesSection, unitOfLimit } from "./parts";
import { csvCharts, hero } from "./studies";

/** With so many digits that the width of the range is seen. */
function boundsText(low: number, high: number): string {
  const size = Math.max(Math.abs(low), Math.abs(high));
  const digits = high > low ? Math.ceil(Math.log10(size / (high - low))) + 2 : 4;
  return [low, high].map((one) => number(one, Math.min(Math.max(digits, 4), 9))).join(" … ");
}

export function uncertaintyPage(data: ReportData): Page {
  const { result, picture } = data;
  const rows = Object.entries((result.responses ?? {}) as Record<string, Document>).map(([name, one]) => {
    const unit = picture?.responses[name]?.unit ?? engineering(one.unit);
    return { name, one, unit, shown: (value: number, digits = 4) => number(value / unit.factor, digits) };
  });
  return [
    hero(data, `What scatters: ${Object.keys(result.parameters ?? {}).map(words).join(", ")}.`, [
      fact(count(result.samples), "samples"),
      fact(count(result.failures), "of them failed"),
    ]),
    limitsSection(data),
    section(
      "Responses",
      "First order from the gradients; beside it what the samples saw.",
      tableOf(rows, [
        { title: "response", left: true, cell: ({ name }) => words(name) },
        { title: "value", cell: ({ one, shown }) => shown(one.value) },
        { title: "deviation", cell: ({ one, shown }) => shown(one.deviation, 3) },
        { title: "by samples", cell: ({ one, shown }) => (one.sampled ? shown(one.sampled.deviation, 3) : "–") },
        { title: "bounds", cell: ({ one, unit }) => (one.bounds ? boundsText(one.bounds[0] / unit.factor, one.bounds[1] / unit.factor) : "–") },
        { title: "unit", left: true, cell: ({ unit }) => unit.name },
        { title: "mostly because of", left: true, cell: ({ one }) => causes(one) },
      ]),
    ),
    sharesSection(result),
    ...csvCharts(data),
    filesSection(data),
  ];
}

/** Of the largest two shares those that count. */
function causes(one: Document): string {
  const counted = sharesOf(one).filter(({ part }, i) => i === 0 || part >= 0.005);
  return counted.slice(0, 2).map(({ who, part }) => `${words(who)} ${(100 * part).toFixed(0)} %`).join(", ");
}

/** Does it still hold? A row a limit, the nearest first. */
function limitsSection(data: ReportData): HTMLElement | null {
  const { result, picture } = data;
  const limits = [...((result.limits ?? []) as Document[])].sort((a, b) => (a.distance ?? Infinity) - (b.distance ?? Infinity));
  if (!limits.length) return null;
  const isSampled = !!result.samples;
  const shown = (one: Document, value: number) => withUnit(value, unitOfLimit(picture, one.name, one.unit));
  const isBeyond = (one: Document) => (one.side === "upper" ? one.worst > one.limit : one.worst < one.limit);
  const marked = (isBad: boolean, text: string) => h(isBad ? "span.bad" : "span", {}, text);
  return section(
    "Does it still hold?",
    `Distance: from the value to the limit, in deviations.${isSampled ? ` Broken in: of the ${count(result.samples)} samples.` : ""} At worst: all parameters at their worst at once, to first order.`,
    tableOf(limits, [
      { title: "limit", left: true, cell: (one) => words(one.name) },
      { title: "value", cell: (one) => shown(one, one.value) },
      { title: "allowed", cell: (one) => `${one.side === "upper" ? "≤" : "≥"} ${shown(one, one.limit)}` },
      { title: "distance", cell: (one) => (one.distance === undefined ? "–" : marked(one.distance < 3, `${number(one.distance, 3)} σ`)) },
      { title: "at worst", cell: (one) => marked(isBeyond(one), shown(one, one.worst)) },
      isSampled && { title: "broken in", cell: (one) => marked(one.broken > 0, share(one.broken / result.samples)) },
    ]),
  );
}

interface Share {
  who: string;
  part: number; // of the variance
}

function sharesOf(one: Document): Share[] {
  return Object.entries((one.shares ?? {}) as Record<string, number>)
    .map(([who, part]) => ({ who, part }))
    .sort((a, b) => b.part - a.part);
}

const colors = ["accent", "more", "good", "drive", "limit", "soft", "load", "start"];
const smallestShare = 0.004;

/** A bar for each response: whose scatter its variance is made of. */
function sharesSection(result: Document): HTMLElement | null {
  const responses = Object.entries((result.responses ?? {}) as Record<string, Document>).filter(([, one]) => sharesOf(one).some(({ part }) => part > smallestShare));
  if (!responses.length) return null;
  const parameters = Object.keys(result.parameters ?? {});
  const colorOf = (who: string) => `var(--${colors[Math.max(0, parameters.indexOf(who)) % colors.length]})`;
  return section(
    "Where the scatter comes from",
    "Shares of the variance of each response.",
    h("p.key", {}, parameters.map((who) => h("span", {}, h("span.dot", { style: `background:${colorOf(who)}` }), words(who)))),
    h(
      "ul.bars.shares",
      {},
      responses.map(([name, one]) =>
        h(
          "li",
          {},
          h("span.bar-name", {}, words(name)),
          h(
            "span.bar-track",
            { role: "img", "aria-label": sharesOf(one).map(({ who, part }) => `${words(who)} ${(100 * part).toFixed(0)} %`).join(", ") },
            sharesOf(one)
              .filter(({ part }) => part > smallestShare)
              .map(({ who, part }) => h("span.share", { style: `width:${100 * part}%;background:${colorOf(who)}`, title: `${words(who)} ${(100 * part).toFixed(1)} %` }, part > 0.12 ? `${(100 * part).toFixed(0)} %` : "")),
          ),
        ),
      ),
    ),
  );
}
