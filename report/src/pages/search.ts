// How an optimization was searched: limits that contradict each other, several starts, several methods.
import type { Document, ReportData } from "../data";
import { h, section, table } from "../dom";
import { engineering, number, roundedOutward, withUnit, words } from "../format";
import { unitOf as unitOfResponse, unitOfLimit } from "./parts";

/** Of a problem that no design solves: what its limits would have to be. */
export function conflictSection(data: ReportData): HTMLElement | null {
  const least = data.result.least_violation;
  if (!least) return null;
  const names = Object.keys(least.limits ?? {});
  if (!names.length) return null;
  const hasAlone = names.some((name) => least.limits[name].alone !== undefined);
  const rows = names.map((name) => {
    const one: Document = least.limits[name];
    const unit = unitOfLimit(data.picture, name, one.unit);
    const isUpper = one.side === "upper";
    const sign = isUpper ? "≤" : "≥";
    const enough = (limit: number) => `${sign} ${withUnit(unit.factor * roundedOutward(limit / unit.factor, isUpper), unit)}`;
    const row: (Node | string)[] = [one.in_conflict ? h("b", {}, words(name)) : words(name), `${sign} ${withUnit(one.limit, unit)}`];
    if (hasAlone) row.push(one.alone === undefined ? "–" : enough(one.alone));
    row.push(enough(one.together));
    return row;
  });
  return section(
    "Limits in conflict",
    `${least.proven ? "No design nearby keeps all of them." : "No design that keeps all of them was found."} ` +
      "The design of this page breaks them least. One change of the column “alone” would do, or all of “together”.",
    table(
      [{ title: "limit", left: true }, { title: "asked for" }, ...(hasAlone ? [{ title: "alone" }] : []), { title: "together" }],
      rows,
    ),
  );
}

/** Distinct local optima of several starts. */
function optimaTable(data: ReportData, optima: Document[], runs: Document[]): HTMLElement {
  const { picture, result } = data;
  const objective = unitOfResponse(picture, result.objective.name, result.objective.unit);
  const variables = Object.keys(optima[0].variables);
  const unitOf = (name: string) => picture?.variables[name]?.unit ?? engineering(result.variables?.[name]?.unit ?? "1");
  return table(
    [
      { title: `${words(result.objective.name)} [${objective.name}]` },
      ...variables.map((name) => ({ title: `${words(name)} [${unitOf(name).name}]` })),
      { title: "found" },
      { title: "from starts", left: true },
    ],
    optima.map((one, k) => [
      k === 0 ? h("b", {}, number(one.objective / objective.factor, 6)) : number(one.objective / objective.factor, 6),
      ...variables.map((name) => number(one.variables[name] / unitOf(name).factor)),
      `${one.found} of ${runs.length}`,
      runs.flatMap((run, i) => (run.optimum === k ? [String(i + 1)] : [])).join(", "),
    ]),
  );
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
