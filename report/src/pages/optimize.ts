// Of an optimization: what was won, whether to believe it, how it moves, where its limits bite.
import { lineChart } from "../charts";
import { type Companion, type Document, type Picture, parseCsv, type ReportData, type Shown, type Unit } from "../data";
import { h, section, table } from "../dom";
import { engineering, errorText, number, pair, percent, placeText, seconds, sentence, share, withUnit, words } from "../format";
import { influenceSection } from "./influence";
import { addMarks, type Mark } from "../mechanism/marks";
import { change, effectsSection, endName, fact, filesSection, monitorsText, responsesTable, unitOf, unitOfLimit, verdict } from "./parts";
import { conflictSection, partsNote, startsSection } from "./search";
import { type Viewing, viewing } from "./viewing";
import { warningsBox } from "./warnings";

/** Shows another load case; of a limit also its instant. */
type ChooseCase = (name: string, limit?: string) => void;

/** Of several load cases one is shown at a time: a choice changes all that is of a case. */
export function optimizePage(data: ReportData): HTMLElement[] {
  const pictures = [data.picture, ...(data.picture?.other_cases ?? [])];
  if (pictures.length === 1) return contentsOf(data).elements;
  const units = data.picture!.units;
  const page = h("div.contents", {});
  let shown: Viewing | null = null;
  const show: ChooseCase = (name, limit) => {
    const picture = pictures.find((one) => one!.case === name)!;
    const ofCase = { ...data, picture: { ...picture, units } };
    shown?.player.dispose();
    const contents = contentsOf(ofCase, choose);
    shown = contents.shown;
    page.replaceChildren(...contents.elements);
    const row = limitRows(ofCase).find((one) => one.name === limit);
    if (row && shown) goToLimit(shown, row, ofCase.picture);
  };
  const choose: ChooseCase = (name, limit) => {
    const place = () => page.querySelector(".case-choice")!.getBoundingClientRect().top;
    const before = place();
    show(name, limit);
    window.scrollBy(0, place() - before);
    page.querySelector<HTMLSelectElement>(".case-choice select")!.focus({ preventScroll: true });
  };
  show(data.picture!.case!);
  return [page];
}

function contentsOf(data: ReportData, chooseCase?: ChooseCase): { elements: HTMLElement[]; shown: Viewing | null } {
  const { picture } = data;
  const parts: (HTMLElement | null)[] = [headline(data), conflictSection(data)];
  let shown: Viewing | null = null;
  if (picture && picture.designs.length) {
    const main = picture.designs.length - 1;
    shown = viewing(picture, main);
    if (chooseCase) parts.push(caseChoice(data, chooseCase));
    parts.push(shown.element);
    markLimits(data, shown);
    shown.pickBody(mostUsedBody(data));
  }
  parts.push(
    h(
      "div.columns",
      {},
      h("div.stack", {}, limitsSection(data, shown, chooseCase), pricesSection(data)),
      h("div.stack", {}, variablesSection(data), savingsSection(data)),
    ),
    startsSection(data),
    influenceSection(picture, (picture?.designs.length ?? 0) - 1, shown),
    convergenceSection(data),
    evidenceSection(data),
    effectsSection(data),
    filesSection(data),
  );
  return { elements: parts.filter((part): part is HTMLElement => !!part), shown };
}

/** Shares and multipliers below this are round-off. */
const leastShare = 1e-3;

/** Cases that an objective over cases, or a limit that costs something or is broken, makes decide. */
function decidingCases(result: Document): string[] {
  const constraints = Object.values(result.constraints ?? {}) as Document[];
  return (result.cases.names as string[]).filter(
    (name) =>
      (result.cases.shares?.[name] ?? 0) > leastShare ||
      constraints.some((one) => one.case === name && ((one.multiplier ?? 0) !== 0 || one.utilisation > 1 + leastShare)),
  );
}

function caseChoice(data: ReportData, choose: ChooseCase): HTMLElement {
  const { cases } = data.result;
  const names = cases.names as string[];
  const deciding = decidingCases(data.result);
  const select = h(
    "select",
    { "aria-label": "load case" },
    names.map((name) => h("option", { value: name, selected: name === data.picture!.case }, words(name), deciding.includes(name) ? " (decides)" : "")),
  ) as HTMLSelectElement;
  select.addEventListener("change", () => choose(select.value));
  const sentence =
    deciding.length === 1
      ? `The case ${words(deciding[0])} decides it.`
      : deciding.length
        ? `The cases ${deciding.slice(0, -1).map(words).join(", ")} and ${words(deciding[deciding.length - 1])} decide it together.`
        : "";
  return h(
    "div.case-choice",
    {},
    h("label.choice.bordered", {}, h("span.soft", {}, "load case"), select),
    h("p.note", {}, `One design for ${names.length} load cases. ${sentence} Motion, histories and numbers in the drawing are those of the case that is chosen.`),
  );
}

/** A search that failed at its start has none. */
function hasDesign(result: Document): boolean {
  return result.objective?.value !== undefined;
}

function headline(data: ReportData): HTMLElement {
  const { result, picture } = data;
  const objective = result.objective ?? {};
  const unit = unitOf(picture, objective.name, objective.unit);
  const isDesign = hasDesign(result);
  const gain = isDesign ? objective.value / objective.start - 1 : NaN;
  const time = result.seconds ?? 0;
  // A number that is won beyond the limits is no gain.
  const isBroken = isDesign && result.status !== "infeasible" && (result.max_violation ?? 0) > 1e-3;
  return h(
    "section.hero",
    {},
    h(
      "div",
      {},
      h("p.eyebrow", {}, picture?.name ?? data.card.problem?.name ?? ""),
      result.status === "infeasible"
        ? h("h1", {}, "No design keeps all limits")
        : isBroken
        ? h("h1", {}, "Limits are broken")
        : isDesign
        ? h("h1", {}, h("span.gain", {}, percent(gain)), h("span.what", {}, ` ${words(objective.name)}`))
        : h("h1", {}, "No design was found"),
      isDesign
        ? h(
            "p.numbers",
            {},
            isBroken ? h("span.soft", {}, `${words(objective.name)}, of a design that does not keep them: `) : null,
            result.status === "infeasible" ? h("span.soft", {}, `${words(objective.name)}, where they are broken least: `) : null,
            h("span.soft", {}, withUnit(objective.start, unit)),
            " → ",
            h("b", {}, withUnit(objective.value, unit)),
            objective.error?.total ? h("span.soft", {}, ` ${errorText(objective.error, unit)}`) : null,
          )
        : null,
      h("p.verdict", {}, verdict(result.status, result.choices), h("span", {}, ` ${sentence(result.message ?? "")}`)),
      result.checked ? h("p.verdict", {}, h("b", {}, "In plain words: "), `${result.checked}.`) : null,
      warningsBox(result.warnings),
    ),
    h(
      "div.facts",
      {},
      ...motorFacts(data),
      fact(String(result.evaluations ?? "–"), "simulations of designs"),
      fact(seconds(time), `with ${result.backend ?? ""}`),
    ),
  );
}

/** What the lighter machine asks of its drive. */
function motorFacts(data: ReportData): HTMLElement[] {
  return savings(data)
    .filter((one) => one.type === "drive-torque" || one.type === "drive-power" || one.type === "drive-force")
    .filter((one) => one.overTime === "max-abs" || one.overTime === "max")
    .slice(0, 2)
    .map((one) =>
      fact(percent(one.after / one.before - 1, 2), one.name, `${withUnit(one.before, one.unit)} → ${withUnit(one.after, one.unit)}`),
    );
}

interface Saving {
  name: string;
  type: string;
  overTime: string;
  before: number;
  after: number;
  unit: { si: string; name: string; factor: number };
}

/** Everything that was neither minimized nor limited, at both designs. */
function savings(data: ReportData): Saving[] {
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

function savingsSection(data: ReportData): HTMLElement | null {
  const all = savings(data);
  if (!all.length) return null;
  const largest = Math.max(...all.map((one) => Math.min(Math.abs(one.after / one.before - 1), 2)), 0.01);
  return section(
    "What else changed",
    `Nobody asked for it: the largest values over time, start → ${endName(data.result)}${data.result.cases ? `, in the load case ${words(data.picture!.case ?? "")}` : ""}.`,
    h(
      "ul.bars",
      {},
      all.map((one) => {
        const gain = one.after / one.before - 1;
        const width = (100 * Math.min(Math.abs(gain), largest)) / largest;
        return h(
          "li",
          {},
          h("span.bar-name", {}, one.name),
          h("span.bar-numbers", {}, pair(one.before, one.after, one.unit)),
          h("span.bar-track", {}, h(gain <= 0 ? "span.bar.is-less" : "span.bar.is-more", { style: `width:${width}%` })),
          h("span.bar-value", {}, change(one.before, one.after)),
        );
      }),
    ),
  );
}

/** The body whose limit is used most, of the load case that is shown. */
function mostUsedBody(data: ReportData): string | undefined {
  const picture = data.picture!;
  const rows = limitRows(data).filter((row) => row.response);
  let best: string | undefined;
  let most = -1;
  for (const limit of Object.values(picture.limits)) {  // of equal ones the first of the file
    const body = limit.response ? picture.responses[limit.response]?.bodies[0] : undefined;
    const used = Math.max(0, ...rows.filter((row) => row.response!.name === limit.response).map((row) => row.used ?? 0));
    if (body && used > most + 1e-4) [most, best] = [used, body];
  }
  return best ?? picture.scene.bodies[0]?.name;
}

interface LimitRow {
  name: string;
  one: Document;
  unit: Unit;
  response?: Shown;
  before?: number;
  used?: number;
  isActive: boolean;
  mark?: number; // its number in the drawing
  usedOf(value: number): number;
}

/** Of all limits, those that bite first; they are numbered. */
function limitRows(data: ReportData): LimitRow[] {
  const constraints: Record<string, Document> = data.result.constraints ?? {};
  const { picture } = data;
  const optimum = picture?.designs[picture.designs.length - 1];
  const start = picture?.designs[0];
  const rows = Object.keys(constraints).map((name): LimitRow => {
    const one = constraints[name];
    // The picture shows one load case: limits of others have no place in it.
    const isShown = one.case === undefined || one.case === picture?.case;
    const limit = isShown ? picture?.limits[one.limit_name ?? name] : undefined;
    const unit = unitOfLimit(picture, name, one.unit);
    const response = limit?.response ? optimum?.responses?.find((r) => r.name === limit.response) : undefined;
    const before = limit?.response ? start?.responses?.find((r) => r.name === limit.response)?.value : undefined;
    const used: number | undefined = one.utilisation;
    const isActive = (one.multiplier ?? 0) !== 0 || (used !== undefined && used > 0.999);
    return { name, one, unit, response, before, used, isActive, usedOf: (value) => (one.side === "upper" ? value / one.limit : one.limit / value) };
  });
  rows.sort((a, b) => Number(b.isActive) - Number(a.isActive) || (b.used ?? 0) - (a.used ?? 0));
  let number = 0;
  for (const row of rows) {
    if (row.isActive && row.response && picture && placeOf(picture, row.response)) row.mark = ++number;
  }
  return rows;
}

/** The place in the drawing that a response looks at; null if it is of the whole mechanism. */
function placeOf(picture: Picture, response: Shown): Pick<Mark, "body" | "share" | "joint"> | null {
  const meaning = picture.responses[response.name];
  const joint = picture.scene.joints.findIndex((one) => one.name === meaning.joint);
  if (joint >= 0) return { joint };
  if (meaning.bodies.length !== 1 || meaning.type === "mass") return null;
  const body = picture.scene.bodies.findIndex((one) => one.name === meaning.bodies[0]);
  return body < 0 ? null : { body, share: response.peak_share ?? (picture.scene.bodies[body].type === "beam" ? meaning.at : undefined) };
}

function goToLimit(shown: Viewing, row: LimitRow, picture: Picture): void {
  if (!row.response) return;
  shown.pickBody(picture.responses[row.response.name].bodies[0]);
  if (row.response.peak_time !== undefined) shown.player.goTo(row.response.peak_time);
}

function markLimits(data: ReportData, shown: Viewing): void {
  const picture = data.picture!;
  const marks = limitRows(data)
    .filter((row) => row.mark !== undefined)
    .map((row): Mark => ({
      number: row.mark!,
      name: words(row.name),
      text: `${withUnit(row.one.value, row.unit)} ${row.one.side === "upper" ? "≤" : "≥"} ${withUnit(row.one.limit, row.unit)}`,
      time: row.response!.peak_time,
      ...placeOf(picture, row.response!)!,
      onClick: () => goToLimit(shown, row, picture),
    }));
  addMarks(shown.player, picture, marks);
}

function limitsSection(data: ReportData, shown: Viewing | null, chooseCase?: ChooseCase): HTMLElement | null {
  const { picture } = data;
  const rows = limitRows(data);
  if (!rows.length) return null;
  return section(
    "Where the limits bite",
    "How far each limit is used: the open mark is the start. Numbers stand in the drawing where a limit bites; the time leads to the instant.",
    h(
      "ul.limits",
      {},
      rows.map((row) => {
        const { name, one, unit, response, before, used, isActive, usedOf } = row;
        const place = placeText(response?.peak_place);
        return h(
          isActive ? "li.is-active" : "li",
          {},
          h(
            "div.limit-head",
            {},
            h("span.bar-name", {}, row.mark ? h("b.mark-number", { title: "its number in the drawing" }, String(row.mark)) : null, words(name)),
            h("span", {}, h("b", {}, withUnit(Math.abs(one.value) < 1e-9 * unit.factor ? 0 : one.value, unit)), h("span.soft", {}, ` ${one.side === "upper" ? "≤" : "≥"} ${withUnit(one.limit, unit)}`)),
          ),
          used !== undefined
            ? h(
                "div.gauge",
                { role: "img", "aria-label": `${share(used)} used` },
                h(isActive ? "span.gauge-fill.is-full" : "span.gauge-fill", { style: `width:${Math.min(100, used * 80)}%` }),
                before !== undefined && Number.isFinite(usedOf(before))
                  ? h("span.gauge-start", { title: `start: ${share(usedOf(before))}`, style: `left:${Math.min(98, Math.max(0, usedOf(before)) * 80)}%` })
                  : null,
                h("span.gauge-limit", { style: "left:80%" }),
                h("span.gauge-text", {}, share(used)),
              )
            : null,
          response && response.peak_time !== undefined
            ? h(
                "p.note",
                {},
                "at ",
                h(
                  "button.link",
                  {
                    onclick: () => {
                      if (shown) goToLimit(shown, row, picture!);
                      shown?.element.scrollIntoView({ behavior: "smooth", block: "nearest" });
                    },
                  },
                  seconds(response.peak_time),
                ),
                place ? `, ${place}` : "",
              )
            : chooseCase && one.case !== undefined && one.case !== picture?.case
            ? h("p.note", {}, "in the case ", h("button.link", { onclick: () => chooseCase(one.case, name) }, words(one.case)))
            : !used && isActive
              ? h("p.note", {}, "binds: a linear constraint of variables")
              : null,
        );
      }),
    ),
  );
}

function pricesSection(data: ReportData): HTMLElement | null {
  const constraints: Record<string, Document> = data.result.constraints ?? {};
  const value = data.result.objective?.value;
  const prices = Object.entries(constraints)
    .filter(([, one]) => one.multiplier && one.limit)
    .map(([name, one]) => ({ name, gain: (-Math.abs(one.multiplier) * 0.01 * Math.abs(one.limit)) / Math.abs(value) }))
    .sort((a, b) => a.gain - b.gain);
  if (!prices.length) return null;
  const largest = Math.max(...prices.map((one) => Math.abs(one.gain)));
  return section(
    "What a limit costs",
    `What ${words(data.result.objective.name)} would gain by one percent more of a limit, the design optimal again.`,
    h(
      "ul.bars",
      {},
      prices.map((one) =>
        h(
          "li",
          {},
          h("span.bar-name", {}, words(one.name)),
          h("span.bar-numbers", {}),
          h("span.bar-track", {}, h("span.bar.is-less", { style: `width:${(100 * Math.abs(one.gain)) / largest}%` })),
          h("span.bar-value", {}, percent(one.gain, 2)),
        ),
      ),
    ),
  );
}

function variablesSection(data: ReportData): HTMLElement | null {
  const variables: Record<string, Document> = data.result.variables ?? {};
  const names = Object.keys(variables);
  if (!names.length) return null;
  const isDesign = hasDesign(data.result);
  return section(
    "Variables between their bounds",
    isDesign ? `The open mark is the start, the full one the ${endName(data.result)}.` : "The mark is the start.",
    h(
      "ul.variables",
      {},
      names.map((name) => {
        const one = variables[name];
        const unit = data.picture?.variables[name]?.unit ?? engineering(one.unit);
        const range = one.upper - one.lower || 1;
        const at = (x: number) => (100 * (x - one.lower)) / range;
        const [from, to] = [at(one.start), at(one.value)];
        const bound = one.choice ? "" : boundText(one.at_bound);
        return h(
          "li",
          {},
          h(
            "div.limit-head",
            {},
            h("span.bar-name", {}, words(name)),
            h("span", {}, isDesign ? h("span.soft", {}, `${number(one.start / unit.factor)} → `) : null, h("b", {}, one.choice ?? withUnit(one.value, unit))),
          ),
          h(
            "div.range",
            { role: "img", "aria-label": `between ${withUnit(one.lower, unit)} and ${withUnit(one.upper, unit)}` },
            h("span.range-path", { style: `left:${Math.min(from, to)}%;width:${Math.abs(to - from)}%` }),
            h("span.range-start", { style: `left:${from}%` }),
            h("span.range-end", { style: `left:${to}%` }),
          ),
          h("div.range-ends", {}, h("span", {}, withUnit(one.lower, unit, 3)), bound ? h("span.bad", {}, bound) : null, h("span", {}, withUnit(one.upper, unit, 3))),
        );
      }),
    ),
  );
}

function boundText(reached: "lower" | "upper" | "both" | undefined): string {
  if (!reached) return "";
  return reached === "both" ? "fixed" : `at its ${reached} bound`;
}

function convergenceSection(data: ReportData): HTMLElement | null {
  const text = data.files["history.csv"];
  if (!text) return null;
  const { header, rows } = parseCsv(text);
  const column = (name: string) => header.indexOf(name);
  const search = rows.filter((row) => row[column("request")] === "gradients" && row[column("purpose")] !== "audit" && row[column("objective")] !== "");
  if (search.length < 2) return null;
  const objective = data.result.objective;
  const unit = unitOf(data.picture, objective.name, objective.unit);
  const x = search.map((_, i) => i + 1);
  const numbers = (name: string, factor = 1) => search.map((row) => Number(row[column(name)]) / factor);
  const violation = numbers("max_violation").map((v) => (v > 1e-12 ? 100 * v : null));
  const labels = search.map((row, i) => `iteration ${i + 1}, ${seconds(Number(row[column("seconds")]))}`);
  return section(
    "How it converged",
    "",
    h(
      "div.columns",
      {},
      lineChart({
        title: words(objective.name),
        yTitle: unit.name,
        xTitle: "iteration",
        wholeX: true,
        height: 210,
        series: [{ name: words(objective.name), x, y: numbers("objective", unit.factor), color: "accent", dots: true, labels }],
      }).element,
      violation.some((v) => v !== null)
        ? lineChart({
            title: "largest violation of a limit",
            yTitle: "% of the limit",
            xTitle: "iteration",
            wholeX: true,
            logY: true,
            height: 210,
            series: [{ name: "violation", x, y: violation, color: "limit", dots: true, labels }],
          }).element
        : h("p.note", {}, "No design on the way exceeded a limit."),
    ),
  );
}

function evidenceTitle(result: Document): string {
  if (result.status === "verified") return "Why to believe it";
  return hasDesign(result) ? "How far to believe it" : "What was tried";
}

function evidenceSection(data: ReportData): HTMLElement | null {
  const { result } = data;
  const rows: (string | HTMLElement)[][] = [];
  const add = (what: string, value: string, meaning: string) => rows.push([what, value, h("span.soft", {}, meaning)]);
  if (hasDesign(result) && result.kkt_residual !== undefined) add("KKT residual", number(result.kkt_residual, 2), "how far the optimality conditions are off, relative: below 1e−3 counts");
  if (hasDesign(result) && result.max_violation !== undefined) add("violation", number(result.max_violation, 2), "of the true limits, relative");
  if (result.gradients) add("gradients", result.gradients.method, `because of ${result.gradients.reason}`);
  if (result.evaluations !== undefined) {
    add("simulations", String(result.evaluations), `${result.gradient_evaluations} of them with gradients, ${result.failed_evaluations} failed, ${result.restarts} restart${result.restarts === 1 ? "" : "s"}`);
  }
  if (result.polished_with) add("polished with", result.polished_with, "refined the answer of the backend");
  const stages: Document[] = result.stages ?? [];
  const responses = responsesTable(data);
  return section(
    evidenceTitle(result),
    monitorsText(result),
    table([{ title: "evidence", left: true }, { title: "" }, { title: "what it says", left: true }], rows),
    ...(responses ? [h("h3", {}, "All responses"), responses] : []),
    result.failed_evaluations ? h("p.note", {}, "The last design that could not be simulated is failed_design.json in the run folder.") : null,
    stages.length > 1
      ? h("p.note", {}, `In ${stages.length} stages, each with the steps and elements that its accuracy needs: ${stages.map((stage) => `${seconds(stage.step ?? 0)} steps, ${stage.elements ?? "–"} elements`).join("; ")}.`)
      : null,
    partsNote(result),
  );
}
