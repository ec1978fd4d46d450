// How an optimization was searched: limits that contradict each other, several starts, several methods.
import type { Document, ReportData } from "../data";
import { h, section, tableOf } from "../dom";
import { engineering, number, roundedOutward, withUnit, words } from "../format";
import { unitOf as unitOfResponse, unitOfLimit } from "./parts";

/** Of a problem that no design solves: what its limits would have to be. */
export function conflictSection(data: ReportData): HTMLElement | null {
  const least = data.result.least_violation;
  if (!least) return null;
  const limits = Object.entries((least.limits ?? {}) as Record<string, Document>);
  if (!limits.length) return null;
  const allowed = (name: string, one: Document, limit = one.limit) => `${one.side === "upper" ? "≤" : "≥"} ${withUnit(limit, unitOfLimit(data.picture, name, one.unit))}`;
  const enough = (name: string, one: Document, limit: number) => {
    const { factor } = unitOfLimit(data.picture, name, one.unit);
    return allowed(name, one, factor * roundedOutward(limit / factor, one.side === "upper"));
  };
  return section(
    "Limits in conflict",
    `${least.proven ? "No design nearby keeps all of them." : "No design that keeps all of them was found."} ` +
      "The design of this page breaks them least. One change of the column “alone” would do, or all of “together”.",
    tableOf(limits, [
      { title: "limit", left: true, cell: ([name, one]) => (one.in_conflict ? h("b", {}, words(name)) : words(name)) },
      { title: "asked for", cell: ([name, one]) => allowed(name, one) },
      limits.some(([, one]) => one.alone !== undefined) && { title: "alone", cell: ([name, one]) => (one.alone === undefined ? "–" : enough(name, one, one.alone)) },
      { title: "together", cell: ([name, one]) => enough(name, one, one.together) },
    ]),
  );
}

/** Distinct local optima of several starts. */
function optimaTable(data: ReportData, optima: Document[], runs: Document[]): HTMLElement {
  const { picture, result } = data;
  const objective = unitOfResponse(picture, result.objective.name, result.objective.unit);
  const variables = Object.keys(optima[0].variables);
  const unitOf = (name: string) => picture?.variables[name]?.unit ?? engineering(result.variables?.[name]?.unit ?? "1");
  const objectiveText = (one: Document) => number(one.objective / objective.factor, 6);
  return tableOf(optima, [
    { title: `${words(result.objective.name)} [${objective.name}]`, cell: (one, k) => (k === 0 ? h("b", {}, objectiveText(one)) : objectiveText(one)) },
    ...variables.map((name) => ({ title: `${words(name)} [${unitOf(name).name}]`, cell: (one: Document) => number(one.variables[name] / unitOf(name).factor) })),
    { title: "found", cell: (one) => `${one.found} of ${runs.length}` },
    { title: "from starts", left: true, cell: (_, k) => runs.flatMap((run, i) => (run.optimum === k ? [String(i + 1)] : [])).join(", ") },
  ]);
}

export function startsSection(data: ReportData): HTMLElement | null {
  const optima: Document[] = data.result.starts?.optima ?? [];
  const runs: Document[] = data.result.starts?.runs ?? [];
  if (runs.length < 2) return null;
  const unproven = runs.flatMap((run, i) => (run.optimum === undefined ? [`${i + 1} (${run.status})`] : []));
  return section(
    "From several starts",
    optima.length > 1
      ? `${optima.length} local optima were found; this page shows the best.`
      : optima.length === 1
        ? "All starts that ended proven ended at one optimum."
        : "No start ended at a proven optimum; this page shows the best design.",
    optima.length ? optimaTable(data, optima, runs) : null,
    unproven.length ? h("p.note", {}, `Without a proven optimum: start ${unproven.join(", ")}.`) : null,
  );
}

/** What was tried, where that was more than one run of one backend. */
export function partsNote(result: Document): HTMLElement | null {
  const parts: Document[] = result.parts ?? [];
  if (parts.length < 2) return null;
  const text = parts.map((part) => `${part.method} (${part.evaluations} simulation${part.evaluations === 1 ? "" : "s"}: ${part.status})`).join(", then ");
  return h("p.note", {}, `Searched with ${text}.`);
}
