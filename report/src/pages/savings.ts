// What changed beside the objective and the limits.
import type { Companion, ReportData } from "../data";
import { bar, h, section } from "../dom";
import { pair, words } from "../format";
import { change, endName } from "./parts";

interface Saving {
  name: string;
  type: string;
  overTime: string;
  before: number;
  after: number;
  unit: { si: string; name: string; factor: number };
}

/** Everything that was neither minimized nor limited, at both designs. */
export function savings(data: ReportData): Saving[] {
  const { picture } = data;
  if (!picture || picture.designs.length < 2) return [];
  const [start, optimum] = [picture.designs[0], picture.designs[picture.designs.length - 1]];
  const limited = new Set(Object.values(picture.limits).map((limit) => limit.response));
  const list: Saving[] = [];
  for (const response of optimum.responses ?? []) {
    const before = start.responses?.find((one) => one.name === response.name);
    const meaning = picture.responses[response.name];
    if (!before || !meaning || limited.has(response.name) || response.name === picture.objective) continue;
    if (["position", "constraint-drift", "energy-balance", "final"].includes(meaning.type)) continue;
    list.push({ name: words(response.name), type: meaning.type, overTime: meaning.over_time, before: before.value, after: response.value, unit: meaning.unit });
  }
  for (const companion of (optimum.companions ?? []) as Companion[]) {
    const before = start.companions?.find((one) => one.name === companion.name);
    if (!before) continue;
    list.push({ name: words(companion.name), type: companion.type, overTime: companion.over_time, before: before.value, after: companion.value, unit: companion.unit });
  }
  return list.filter((one) => Math.abs(one.before) > 0);
}

export function savingsSection(data: ReportData): HTMLElement | null {
  const all = savings(data);
  if (!all.length) return null;
  const largest = Math.max(...all.map((one) => Math.min(Math.abs(one.after / one.before - 1), 2)), 0.01);
  return section(
    "What else changed",
    `Nobody asked for it: the largest values over time, start → ${endName(data.result)}${data.result.cases ? `, in the load case ${words(data.picture!.case ?? "")}` : ""}.`,
    h("ul.bars", {}, all.map((one) => bar(one.name, [pair(one.before, one.after, one.unit)], one.after / one.before - 1, largest, change(one.before, one.after)))),
  );
}
