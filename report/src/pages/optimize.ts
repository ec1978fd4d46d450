// Of an optimization: what was won, what to build, whether to believe it, how it moves, where its limits bite.
import type { Document, ReportData } from "../data";
import { choice, h, type Page, section, tableOf } from "../dom";
import { engineering, listed, number, seconds, sentence, withUnit, words } from "../format";
import { buildSection } from "./build_table";
import { convergenceSection } from "./convergence";
import { hasDesign, headline } from "./headline";
import { influenceSection } from "./influence";
import { type ChooseCase, goToLimit, leastShare, limitRows, limitsSection, markLimits, mostUsedBody, pricesSection } from "./limits";
import { effectsSection, endName, filesSection, monitorsText, responsesTable } from "./parts";
import { savingsSection } from "./savings";
import { conflictSection, partsNote, startsSection } from "./search";
import { type Viewing, viewing } from "./viewing";

/** Of several load cases one is shown at a time: a choice changes all that is of a case. */
export function optimizePage(data: ReportData): Page {
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
  const parts: Page = [headline(data), conflictSection(data), buildSection(data)];
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
      "div.columns.has-limits",
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
  const nameOf = (name: string) => `${words(name)}${deciding.includes(name) ? " (decides)" : ""}`;
  const list = choice("load case", names.map((name) => [name, nameOf(name)]), data.picture!.case!, choose);
  list.classList.add("bordered");
  const sentence =
    deciding.length === 1
      ? `The case ${words(deciding[0])} decides it.`
      : deciding.length
        ? `The cases ${listed(deciding.map(words))} decide it together.`
        : "";
  return h(
    "div.case-choice",
    {},
    list,
    h("p.note", {}, `One design for ${names.length} load cases. ${sentence} Motion, histories and numbers in the drawing are those of the case that is chosen.`),
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

function evidenceTitle(result: Document): string {
  if (result.status === "verified") return "Why to believe it";
  return hasDesign(result) ? "How far to believe it" : "What was tried";
}

function evidenceSection(data: ReportData): HTMLElement | null {
  const { result } = data;
  const rows: { what: string; value: string; meaning: string }[] = [];
  const isVerified = result.status === "verified";
  const add = (what: string, value: string, meaning: string) => rows.push({ what, value, meaning });
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
    isVerified && result.message ? h("p.audit", {}, sentence(result.message)) : null,
    result.checked ? h("p.audit", {}, h("b", {}, "In plain words: "), `${result.checked}.`) : null,
    tableOf(rows, [
      { title: "evidence", left: true, cell: (one) => one.what },
      { title: "", cell: (one) => one.value },
      { title: "what it says", left: true, cell: (one) => h("span.soft", {}, one.meaning) },
    ]),
    ...(responses ? [h("h3", {}, "All responses"), responses] : []),
    result.failed_evaluations ? h("p.note", {}, "The last design that could not be simulated is failed_design.json in the run folder.") : null,
    stages.length > 1
      ? h("p.note", {}, `In ${stages.length} stages, each with the steps and elements that its accuracy needs: ${stages.map((stage) => `${seconds(stage.step ?? 0)} steps, ${stage.elements ?? "–"} elements`).join("; ")}.`)
      : null,
    partsNote(result),
  );
}
