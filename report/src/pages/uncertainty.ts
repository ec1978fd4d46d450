// Deviations and bounds of the responses, and which parameters they come from.
import type { Document, ReportData } from "../data";
import { h, section, table } from "../dom";
import { count, engineering, number, words } from "../format";
import { fact, filesSection } from "./parts";
import { csvCharts, hero } from "./studies";

export function uncertaintyPage(data: ReportData): HTMLElement[] {
  const { result, picture } = data;
  const rows = Object.entries((result.responses ?? {}) as Record<string, Document>).map(([name, one]) => {
    const unit = picture?.responses[name]?.unit ?? engineering(one.unit);
    const shown = (value: number, digits = 4) => number(value / unit.factor, digits);
    const shares = Object.entries((one.shares ?? {}) as Record<string, number>)
      .sort((a, b) => b[1] - a[1])
      .map(([who, part]) => `${words(who)} ${(100 * part).toFixed(0)} %`);
    return [
      words(name),
      shown(one.value),
      shown(one.deviation, 3),
      one.sampled ? shown(one.sampled.deviation, 3) : "–",
      one.bounds ? `${shown(one.bounds[0])} … ${shown(one.bounds[1])}` : "–",
      unit.name,
      h("span", { title: shares.join(", ") }, shares.slice(0, 2).join(", ")),
    ];
  });
  return [
    hero(data, `What scatters: ${Object.keys(result.parameters ?? {}).map(words).join(", ")}.`, [
      fact(count(result.samples), "samples"),
      fact(count(result.failures), "of them failed"),
    ]),
    section(
      "Responses",
      "First order from the gradients; beside it what the samples saw.",
      table(
        [
          { title: "response", left: true },
          { title: "value" },
          { title: "deviation" },
          { title: "by samples" },
          { title: "bounds" },
          { title: "unit", left: true },
          { title: "mostly because of", left: true },
        ],
        rows,
      ),
    ),
    ...csvCharts(data),
    filesSection(data),
  ];
}
