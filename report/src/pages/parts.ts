// Parts that several pages have: headline, evidence, effects, files.
import { curveOf, type Document, type ErrorBar, type Picture, type ReportData, type Unit } from "../data";
import { details, download, h, section, tableOf } from "../dom";
import { count, engineering, errorText, number, percent, seconds, sentence, withUnit, words } from "../format";

const verdicts: Record<string, { text: string; tone: string }> = {
  verified: { text: "Verified local optimum", tone: "good" },
  done: { text: "Done", tone: "good" },
  unresolved: { text: "Optimum of numbers that are not resolved", tone: "warn" },
  interrupted: { text: "Interrupted", tone: "warn" },
  partly: { text: "Not all points verified", tone: "warn" }, // of a front
};

/** A choice from lists is no local optimum: it is the best of those that were tried. */
function choiceText(choices: Document): string {
  return choices.exhaustive ? `Best of all ${count(choices.combinations)} choices` : `Best of ${count(choices.tried)} tried choices`;
}

export function verdict(status: string, choices?: Document): HTMLElement {
  let known = verdicts[status] ?? { text: `Not verified: ${status}`, tone: "warn" };
  if (status === "verified" && choices) known = { text: choiceText(choices), tone: "good" };
  return h(`span.badge.${known.tone}`, {}, known.tone === "good" ? "✓ " : "! ", known.text);
}

/** What the last design of an optimization is called. */
export function endName(result: Document): string {
  return result.status === "verified" ? "optimum" : "end";
}

/** Units of responses; those that no picture tells, by their SI unit. */
export function unitOf(picture: Picture | null, name: string, si: string): Unit {
  return picture?.units?.responses[name] ?? picture?.responses[name]?.unit ?? engineering(si);
}

/** Units of limits, likewise. */
export function unitOfLimit(picture: Picture | null, name: string, si: string): Unit {
  return picture?.units?.limits[name] ?? picture?.limits[name]?.unit ?? engineering(si);
}

const roundOff = 1e-14;

/** A number that is round-off of its history, or a length that is round-off of the mechanism, is 0. */
export function withoutRoundOff(picture: Picture | null, name: string, value: number, si: string): number {
  const meaning = picture?.responses[name];
  if (si === "m" && meaning && Math.abs(value) < roundOff * (picture?.size ?? 0)) return 0;
  if (!meaning || meaning.over_time === "integral") return value;
  const histories = picture!.designs.flatMap((design) => design.responses?.find((one) => one.name === name)?.history ?? []);
  const largest = Math.max(0, ...histories.flatMap((history) => curveOf(history).y.map(Math.abs)));
  return Math.abs(value) < roundOff * largest ? 0 : value;
}

/** All responses with values and what their numbers are known to. */
export function responsesTable(data: ReportData): HTMLElement | null {
  const responses: Record<string, Document> = data.result.responses ?? {};
  const rows = Object.entries(responses).map(([name, one]) => {
    const [start, value] = [one.start, one.value].map((raw) => withoutRoundOff(data.picture, name, raw, one.unit));
    return { name, one, start, value, unit: unitOf(data.picture, name, one.unit) };
  });
  if (!rows.length) return null;
  const hasStart = rows.some(({ one }) => one.start !== undefined);
  const hasErrors = rows.some(({ one }) => one.error);
  const changeOf = (name: string, start: number, value: number) => (name === data.result.objective?.name ? change(start, value) : start ? percent(value / start - 1) : "");
  return tableOf(rows, [
    { title: "response", left: true, cell: ({ name }) => words(name) },
    hasStart && { title: "start", cell: ({ start, unit }) => number(start / unit.factor) },
    { title: hasStart ? endName(data.result) : "value", cell: ({ value, unit }) => number(value / unit.factor) },
    hasStart && { title: "change", cell: ({ name, start, value }) => changeOf(name, start, value) },
    { title: "unit", left: true, cell: ({ unit }) => unit.name },
    hasErrors && { title: "known to", cell: ({ one, unit }) => knownTo(one.error, unit) },
    hasErrors && { title: "", cell: ({ one }) => (one.error?.total ? `${number((100 * one.error.total) / Math.abs(one.value || 1), 2)} %` : "") },
  ]);
}

function knownTo(error: ErrorBar | null | undefined, unit: Unit): HTMLElement | string {
  if (!error) return "–";
  if (error.total === null) return h("span.bad", {}, error.is_modelled === false ? "not modelled" : "not resolved");
  return error.total === 0 ? "exact" : errorText(error, { ...unit, name: "1" });
}

export function change(before: number, after: number): HTMLElement | string {
  if (!Number.isFinite(before) || !before) return "";
  const share = after / before - 1;
  return h(share < -5e-4 ? "span.less" : share > 5e-4 ? "span.more" : "span.soft", {}, percent(share));
}

/** Effects that several load cases decide alike, once, with the cases in words. */
function effectsOfCases(all: Document[]): Document[] {
  const cases = new Set(all.map((effect) => effect.case as string | undefined).filter(Boolean));
  const groups = new Map<string, Document[]>();
  for (const effect of all) {
    const key = JSON.stringify([effect.name, effect.body, effect.built, effect.reason]);
    groups.set(key, [...(groups.get(key) ?? []), effect]);
  }
  return [...groups.values()].map((group) => ({
    ...group[0],
    cases: group.length === cases.size ? "all" : group.map((effect) => words(effect.case ?? "")).join(", "),
  }));
}

export function effectsSection(data: ReportData): HTMLElement | null {
  const hasCases = (data.result.effects ?? []).some((effect: Document) => effect.case);
  const effects: Document[] = hasCases ? effectsOfCases(data.result.effects) : (data.result.effects ?? []);
  if (!effects.length) return null;
  const { picture } = data;
  const objective = picture?.objective;
  const hasInfluence = effects.some((effect) => effect.influence);
  const hasTimes = effects.some((effect) => effect.time);
  const objectiveUnit = objective ? unitOf(picture, objective, "kg") : null;
  const constraints: Record<string, Document> = data.result.constraints ?? {};
  /** Δf + Σ μ Δc: what leaving the effect out makes of the optimum. */
  const worth = (influence: Record<string, number>): number | null => {
    if (!objective || influence[objective] === undefined) return null;
    let sum = influence[objective];
    for (const [name, limit] of Object.entries(picture!.limits)) {
      const multiplier = constraints[name]?.multiplier;
      if (!limit.response || multiplier === undefined) continue;
      sum += multiplier * (influence[limit.response] ?? 0);
    }
    return sum;
  };
  const most = (influence: Record<string, number>): string => {
    let text = "nothing";
    let largest = 1e-8;
    for (const [name, delta] of Object.entries(influence)) {
      const value = data.result.responses?.[name]?.value;
      const relative = Math.abs(delta / value);
      if (!(relative > largest)) continue;
      largest = relative;
      text = `${words(name)} ${percent(delta / Math.abs(value), 2)}`;
    }
    return text;
  };
  const hasWorth = hasInfluence && effects.some((e) => e.influence && worth(e.influence) !== null) && data.card.command === "optimize";
  const worthText = (influence?: Record<string, number>) => {
    const value = influence ? worth(influence) : null;
    return value === null ? "–" : smallMass(value, objectiveUnit!);
  };
  const effectsTable = (shown: Document[]) =>
    tableOf(shown, [
      { title: "effect", left: true, cell: (effect) => effect.name.replace(/[-_]/g, " ") },
      { title: "of", left: true, short: true, cell: (effect) => (effect.body ? words(effect.body) : "all") },
      hasCases && { title: "in", left: true, cell: (effect) => effect.cases },
      { title: "", left: true, short: true, cell: (effect) => (effect.built ? h("span.good-text", {}, "built") : h("span.soft", {}, "left out")) },
      hasInfluence && { title: "changes most", left: true, cell: (effect) => (effect.influence ? most(effect.influence) : "–") },
      hasWorth && { title: "worth", cell: (effect) => worthText(effect.influence) },
      hasTimes && { title: "time", cell: (effect) => timeChange(effect.time) },
      { title: "because", left: true, cell: (effect) => h("span.soft", {}, effect.reason ?? "") },
    ]);
  // Older documents do not say what matters.
  const isMarked = effects.some((effect) => effect.matters !== undefined);
  const doesMatter = (effect: Document) => (isMarked ? effect.matters : effect.influence && largestChange(effect.influence, data.result.responses ?? {}) > 1e-3);
  const important = hasInfluence ? effects.filter(doesMatter) : effects.filter((effect) => effect.decision !== "exact");
  const rest = restText(effects, important, data.result.responses ?? {});
  return section(
    "What is simulated",
    hasInfluence ? `Effects that matter: how the numbers${hasTimes ? " and the time of a simulation" : ""} change without each.` : "What is built for this scene, and why.",
    important.length ? effectsTable(important) : null,
    hasInfluence || important.length ? h("p.note", {}, rest) : null,
    h("details.inner", { open: data.card.command === "show" }, h("summary", {}, `All ${effects.length} effects, and why`), effectsTable(effects)),
  );
}

/** Of a response, relative. */
function largestChange(influence: Record<string, number>, responses: Record<string, Document>): number {
  let most = 0;
  for (const [name, delta] of Object.entries(influence)) {
    const value = responses[name]?.value;
    if (value) most = Math.max(most, Math.abs(delta / value));
  }
  return most;
}

/** What a table of effects leaves out, in a sentence. */
function restText(effects: Document[], important: Document[], responses: Record<string, Document>): string {
  const others = effects.filter((effect) => !important.includes(effect));
  const measured = others.filter((effect) => effect.influence);
  let most = 0;
  for (const effect of measured) most = Math.max(most, largestChange(effect.influence, responses));
  const parts: string[] = [];
  const left = others.filter((effect) => !effect.influence && !effect.built).length;
  const built = others.length - measured.length - left;
  if (measured.length) parts.push(`${measured.length} further ${measured.length === 1 ? "effect changes" : "effects change"} nothing by more than ${number(100 * most, 2)} %`);
  if (built) parts.push(`${built} ${built === 1 ? "is" : "are"} built without question`);
  if (left) parts.push(`${left} ${left === 1 ? "is" : "are"} left out because ${left === 1 ? "it" : "they"} would change nothing`);
  return sentence(parts.join("; "));
}

/** Grams say more than thousandths of a kilogram. */
function smallMass(value: number, unit: Unit): string {
  if (value === 0) return "0";
  const sign = value < 0 ? "−" : "+";
  const size = Math.abs(value);
  if (unit.si === "kg" && size < 0.1) return `${sign}${number(1000 * size, 2)} g`;
  return `${sign}${withUnit(size, unit, 2)}`;
}

/** "−15 ± 3 %", relative to the time of the same simulation without the change. */
export function timeChange(time: Document): string {
  if (!time) return "–";
  if (time.change === 0 && time.spread === 0) return "the same";
  if (!time.is_measurable) return "not measurable";
  const spread = time.spread ? ` ± ${Math.ceil(100 * time.spread)}` : "";
  return `${time.change < 0 ? "−" : "+"}${Math.abs(100 * time.change).toFixed(0)}${spread} %`;
}

/** A chip with a number and what it is. */
export function fact(value: string, name: string, title = ""): HTMLElement {
  return h("div.fact", { title }, h("b", {}, value), h("span.soft", {}, name));
}

export function monitorsText(result: Document): string {
  const monitors = result.monitors ?? {};
  const parts: string[] = [];
  if (monitors.energy_error !== undefined) parts.push(`energy is balanced to ${number(monitors.energy_error, 2)}`);
  if (monitors.position_drift !== undefined) parts.push(`joints are kept to ${number(monitors.position_drift, 2)} m or rad`);
  if (monitors.elastic_rotation !== undefined) {
    parts.push(`elastic rotations are at most ${number((180 / Math.PI) * monitors.elastic_rotation, 2)}°`);
  }
  return sentence(parts.join("; "));
}

export function filesSection(data: ReportData): HTMLElement {
  const { card } = data;
  const phases = Object.entries(card.seconds ?? {}) as [string, number][];
  const known: string[][] = [
    ...Object.entries(card.versions ?? {}).map(([name, version]) => [name, String(version)]),
    ...(card.input?.hash ? [["input", card.input.hash as string]] : []),
    ...phases.map(([name, time]) => [`time: ${name}`, seconds(time)]),
  ];
  const problem = JSON.stringify(card.problem ?? card.problems ?? {}, null, 2);
  return h(
    "div.stack",
    {},
    data.left_out?.length
      ? h("p.note", {}, `Too large for this page, and therefore not drawn: ${data.left_out.join(", ")}, in the run folder.`)
      : null,
    details(
      "Run card",
      h("p.note", {}, h("code", {}, `pleuel ${(card.arguments ?? []).join(" ")}`)),
      known.length ? tableOf(known, [{ title: "", left: true, cell: ([name]) => name }, { title: "", left: true, cell: ([, value]) => value }]) : null,
    ),
    details(
      "Problem file",
      h("button.quiet", { onclick: () => download("problem.json", problem, "application/json") }, "save"),
      h("pre", {}, problem),
    ),
    details("Result document", h("pre", {}, JSON.stringify(data.result, null, 2))),
  );
}
