// The answer of an optimization in one view: what was won, whether it holds, what decides.
import type { Document, ReportData } from "../data";
import { h, heroOf } from "../dom";
import { errorText, listed, number, percent, seconds, sentence, share, withUnit, words } from "../format";
import { leastShare, limitRows } from "./limits";
import { fact, unitOf, verdict } from "./parts";
import { savings } from "./savings";
import { warningsBox } from "./warnings";

/** A search that failed at its start has none. */
export function hasDesign(result: Document): boolean {
  return result.objective?.value !== undefined;
}

export function headline(data: ReportData): HTMLElement {
  const { result, picture } = data;
  const isVerified = result.status === "verified";
  return heroOf(
    [
      h("p.eyebrow", {}, picture?.name ?? data.card.problem?.name ?? ""),
      title(data),
      numbersLine(data),
      h("p.verdict", {}, verdict(result.status, result.choices), isVerified ? plainWords(data) : h("span", {}, ` ${sentence(result.message ?? "")}`)),
      startLine(data),
      warningsBox(result.warnings),
    ],
    [
      ...motorFacts(data),
      fact(String(result.evaluations ?? "–"), "simulations of designs"),
      fact(seconds(data.card.seconds?.total ?? result.seconds ?? 0), `the whole run, with ${result.backend ?? ""}`),
    ],
  );
}

/** A number that is won beyond the limits is no gain. */
function isBroken(result: Document): boolean {
  return hasDesign(result) && result.status !== "infeasible" && (result.max_violation ?? 0) > leastShare;
}

function title(data: ReportData): HTMLElement {
  const { result, picture } = data;
  if (result.status === "infeasible") return h("h1", {}, "No design keeps all limits");
  if (!hasDesign(result)) return h("h1", {}, "No design was found");
  if (isBroken(result)) return h("h1", {}, "Limits are broken");
  const { objective } = result;
  const value = withUnit(objective.value, unitOf(picture, objective.name, objective.unit));
  const what = gainText(objective, picture?.responses[objective.name]?.type === "mass");
  return h("h1", {}, h("span.gain", {}, value), h("span.what", {}, ` ${what}`));
}

/** "77.4 % lighter", "torque peak, −57.1 %". */
function gainText(objective: Document, isMass: boolean): string {
  if (objective.value === objective.start) return `${words(objective.name)}, as at the start`;
  const gain = objective.value / objective.start - 1;
  if (!isMass) return `${words(objective.name)}, ${percent(gain)}`;
  return `${percent(gain).replace(/^[−+]/, "")} ${gain < 0 ? "lighter" : "heavier"}`;
}

function numbersLine(data: ReportData): HTMLElement | null {
  const { result, picture } = data;
  if (!hasDesign(result)) return null;
  const { objective } = result;
  const unit = unitOf(picture, objective.name, objective.unit);
  const remark = isBroken(result) ? ", of a design that does not keep them" : result.status === "infeasible" ? ", where they are broken least" : "";
  return h(
    "p.numbers",
    {},
    h("span.soft", {}, `${words(objective.name)}${remark}: ${withUnit(objective.start, unit)}`),
    " → ",
    h("b", {}, withUnit(objective.value, unit)),
    objective.error?.total ? h("span.soft", {}, ` ${errorText(objective.error, unit)}`) : null,
  );
}

/** What was verified, for people: the audit itself stands under "Why to believe it". */
function plainWords(data: ReportData): HTMLElement {
  const parts = String(data.result.checked ?? "").split("; ");
  const deciding = limitRows(data).filter((row) => Math.abs(row.one.multiplier ?? 0) > 0);
  const decides = deciding.length ? `; ${listed(deciding.map((row) => words(row.name)))} ${deciding.length === 1 ? "decides" : "decide"}` : "";
  return h("span", {}, ` ${sentence(parts[0] + decides)} ${parts[1] ? sentence(parts[1]) : ""}`);
}

/** A start that broke its limits is no measure of what was won. */
function startLine(data: ReportData): HTMLElement | null {
  const broken = limitRows(data)
    .map((row) => ({ row, excess: row.before === undefined ? 0 : row.usedOf(row.before) - 1 }))
    .filter(({ excess }) => excess > leastShare && Number.isFinite(excess))
    .sort((a, b) => b.excess - a.excess);
  if (!broken.length || !hasDesign(data.result)) return null;
  const texts = broken.map(({ row, excess }) => `${words(row.name)} by ${excess > 10 ? `a factor of ${number(1 + excess, 2)}` : share(excess)}`);
  return h("p.verdict", {}, h("b", {}, "The start "), `breaks ${listed(texts)}.`);
}

/** What the lighter machine asks of its drive; power tells what torque does where the speed is prescribed. */
function motorFacts(data: ReportData): HTMLElement[] {
  const told = new Set<string>();
  return savings(data)
    .filter((one) => one.type === "drive-torque" || one.type === "drive-power" || one.type === "drive-force")
    .filter((one) => one.overTime === "max-abs" || one.overTime === "max")
    .flatMap((one) => {
      const change = percent(one.after / one.before - 1, 2);
      if (told.has(change)) return [];
      told.add(change);
      return [fact(change, one.name, `${withUnit(one.before, one.unit)} → ${withUnit(one.after, one.unit)}`)];
    })
    .slice(0, 2);
}
