// Parts that several pages have: headline, evidence, effects, files.
import { curveOf, type Document, type Picture, type ReportData, type Unit } from "../data";
import { details, download, h, section, table } from "../dom";
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
  const names = Object.keys(responses);
  if (!names.length) return null;
  const hasStart = names.some((name) => responses[name].start !== undefined);
  const hasErrors = names.some((name) => responses[name].error);
  const rows = names.map((name) => {
    const one = responses[name];
    const unit = unitOf(data.picture, name, one.unit);
    const total = one.error?.total;
    const row: (Node | string)[] = [words(name)];
    const [start, value] = [one.start, one.value].map((raw) => withoutRoundOff(data.picture, name, raw, one.unit));
    if (hasStart) row.push(number(start / unit.factor));
    row.push(number(value / unit.factor));
    if (hasStart) row.push(name === data.result.objective?.name ? change(start, value) : start ? percent(value / start - 1) : "");
    row.push(unit.name);
    if (hasErrors) {
      row.push(
        one.error === null || one.error === undefined
          ? "–"
          : total === null
            ? h("span.bad", {}, one.error.is_modelled === false ? "not modelled" : "not resolved")
            : total === 0
              ? "exact"
              : errorText(one.error, { ...unit, name: "1" }),
        total ? `${number((100 * total) / Math.abs(one.value || 1), 2)} %` : "",
      );
    }
    return row;
  });
  return table(
    [
      { title: "response", left: true },
      ...(hasStart ? [{ title: "start" }] : []),
      { title: hasStart ? endName(data.result) : "value" },
      ...(hasStart ? [{ title: "change" }] : []),
      { title: "unit", left: true },
      ...(hasErrors ? [{ title: "known to" }, { title: "" }] : []),
    ],
    rows,
  );
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
  const rowOf = (effect: Document) => [
    effect.name.replace(/[-_]/g, " "),
    effect.body ? words(effect.body) : "all",
    ...(hasCases ? [effect.cases as string] : []),
    effect.built ? h("span.good-text", {}, "built") : h("span.soft", {}, "left out"),
    ...(hasInfluence ? [effect.influence ? most(effect.influence) : "–"] : []),
    ...(hasWorth
      ? [effect.influence && worth(effect.influence) !== null ? smallMass(worth(effect.influence)!, objectiveUnit!) : "–"]
      : []),
    ...(hasTimes ? [timeChange(effect.time)] : []),
    h("span.soft", {}, effect.reason ?? ""),
  ];
  const tableOf = (shown: Document[]) =>
    table(
      [
        { title: "effect", left: true },
        { title: "of", left: true, short: true },
        ...(hasCases ? [{ title: "in", left: true }] : []),
        { title: "", left: true, short: true },
        ...(hasInfluence ? [{ title: "changes most", left: true }] : []),
        ...(hasWorth ? [{ title: "worth" }] : []),
        ...(hasTimes ? [{ title: "time" }] : []),
        { title: "because", left: true },
      ],
      shown.map(rowOf),
    );
  // Older documents do not say what matters.
  const isMarked = effects.some((effect) => effect.matters !== undefined);
  const doesMatter = (effect: Document) => (isMarked ? effect.matters : effect.influence && largestChange(effect.influence, data.result.responses ?? {}) > 1e-3);
  const important = hasInfluence ? effects.filter(doesMatter) : effects.filter((effect) => effect.decision !== "exact");
  const rest = restText(effects, important, data.result.responses ?? {});
  return section(
    "What is simulated",
    hasInfluence ? `Effects that matter: how the numbers${hasTimes ? " and the time of a simulation" : ""} change without each.` : "What is built for this scene, and why.",
    important.length ? tableOf(important) : null,
    hasInfluence || important.length ? h("p.note", {}, rest) : null,
    h("details.inner", { open: data.card.command === "show" }, h("summary", {}, `All ${effects.length} effects, and why`), tableOf(effects)),
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
      known.length ? table([{ title: "", left: true }, { title: "", left: true }], known) : null,
    ),
    details(
      "Problem file",
      h("button.quiet", { onclick: () => download("problem.json", problem, "application/json") }, "save"),
      h("pre", {}, problem),
    ),
    details("Result document", h("pre", {}, JSON.stringify(data.result, null, 2))),
  );
}
