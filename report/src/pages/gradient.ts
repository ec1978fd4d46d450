// Gradients of one design: what each variable changes, and what the methods cost.
import { lineChart, type Series } from "../charts";
import type { Document, Picture, ReportData } from "../data";
import { chosenView, type Column, h, type Page, section, tableOf } from "../dom";
import { number, seconds, words } from "../format";
import { influenceNotes, influenceOf, influenceTable } from "./influence";
import { viewing } from "./viewing";
import { fact, filesSection, unitOf } from "./parts";
import { csvCharts, hero } from "./studies";

interface Compared {
  method: string;
  step: number | null; // of differences, relative
  seconds: number;
  errors: Record<string, number>;
}

const colors: Record<string, string> = { direct: "accent", adjoint: "good", "central-difference": "more", "forward-difference": "drive" };
const smallest = 1e-17; // of what a logarithmic axis shows

function worst(one: Compared): { name: string; value: number } {
  const [name, value] = Object.entries(one.errors).reduce((a, b) => (b[1] > a[1] ? b : a), ["", 0]);
  return { name, value };
}

function bestOf(all: Compared[]): Compared[] {
  const methods = [...new Set(all.map((one) => one.method))];
  return methods.map((method) => all.filter((one) => one.method === method).reduce((a, b) => (worst(b).value < worst(a).value ? b : a)));
}

/** Effort against accuracy: each method at its best step. */
function effortSection(all: Compared[]): HTMLElement {
  const best = bestOf(all);
  const fastest = Math.min(...best.map((one) => one.seconds));
  return section(
    "Effort and accuracy of the methods",
    "The largest error of all responses, relative to the size of a gradient; of differences with the step that is best. The exact methods are measured against each other.",
    h(
      "div.columns",
      {},
      lineChart({
        title: "effort against accuracy",
        xTitle: "largest relative error",
        yTitle: "s",
        height: 260,
        logX: true,
        logY: true,
        legend: true,
        series: best.map((one) => ({ name: one.method, x: [Math.max(worst(one).value, smallest)], y: [one.seconds], color: colors[one.method] ?? "soft", dots: true, line: false, labels: [`error ${number(worst(one).value, 2)}, ${seconds(one.seconds)}`] })),
      }).element,
      tableOf(best, [
        { title: "method", left: true, cell: (one) => one.method },
        { title: "best step", cell: (one) => (one.step === null ? "–" : number(one.step, 1)) },
        { title: "time", cell: (one) => seconds(one.seconds) },
        { title: "times the fastest", cell: (one) => number(one.seconds / fastest, 2) },
        { title: "error", cell: (one) => number(worst(one).value, 2) },
        { title: "of", left: true, cell: (one) => h("span.soft", {}, words(worst(one).name)) },
      ]),
    ),
  );
}

/** Errors of differences over their steps: truncation to the right, round-off and Newton to the left. */
function stepsSection(all: Compared[], responses: string[]): HTMLElement {
  const differences = [...new Set(all.filter((one) => one.step !== null).map((one) => one.method))];
  const exact = all.find((one) => one.step === null);
  const draw = (name: string) => {
    const error = (one: Compared) => Math.max(name === "" ? worst(one).value : (one.errors[name] ?? 0), smallest);
    const series: Series[] = differences.map((method) => {
      const own = all.filter((one) => one.method === method).sort((a, b) => a.step! - b.step!);
      return { name: method, x: own.map((one) => one.step!), y: own.map(error), color: colors[method] ?? "soft", dots: true };
    });
    const steps = all.filter((one) => one.step !== null).map((one) => one.step!);
    if (exact) series.push({ name: "direct against adjoint", x: [Math.min(...steps), Math.max(...steps)], y: [error(exact), error(exact)], color: "accent", dashed: true });
    return [lineChart({ title: "error of differences over their step", xTitle: "relative step", yTitle: "relative error", height: 300, logX: true, logY: true, legend: true, series }).element];
  };
  return section(
    "Which step differences need",
    "To the right the curvature of the response is seen, to the left the noise of the simulation. The exact methods need no step.",
    chosenView("response", [["", "the worst of all"], ...responses.map((name) => [name, words(name)])], draw),
  );
}

export function gradientPage(data: ReportData): Page {
  const { result, picture } = data;
  const responses: Record<string, Document> = result.responses ?? {};
  const methods = [...new Set(Object.values(responses).flatMap((one) => Object.keys(one.gradients ?? {})))];
  const method = methods[0];
  const compared: Compared[] = result.comparison ?? [];
  const main = (picture?.designs.length ?? 0) - 1;
  const influence = picture?.designs.length && method
    ? influenceOf(picture, picture.designs[main].variables, (name) => responses[name]?.gradients?.[method], (name) => responses[name]?.value ?? 0)
    : null;
  const shown = picture?.designs[main]?.motion ? viewing(picture, main) : null;
  shown?.pickBody(undefined);
  const times = Object.entries((result.seconds ?? {}) as Record<string, number>).filter(([name]) => name !== "total");
  return [
    hero(data, result.choice ? `Method: ${result.choice.method} (${result.choice.reason}).` : "", times.map(([name, time]) => fact(seconds(time), name === "simulate" ? "simulation" : name))),
    shown?.element ?? null,
    influence
      ? section("What each variable changes", `Percent of a response per percent of a variable, by ${method}: blue makes it smaller, orange larger.`, influenceTable(influence), ...influenceNotes(influence))
      : null,
    compared.length ? effortSection(compared) : null,
    compared.some((one) => one.step !== null) ? stepsSection(compared, Object.keys(responses)) : null,
    ...csvCharts(data),
    gradientsTable(responses, methods, picture),
    filesSection(data),
  ];
}

/** In the units of the file. */
function gradientsTable(responses: Record<string, Document>, methods: string[], picture: Picture | null): HTMLElement | null {
  const variables = Object.entries(picture?.variables ?? {});
  if (!methods.length || !variables.length) return null;
  const rows = Object.entries(responses).flatMap(([name, one]) => {
    const unit = unitOf(picture, name, one.unit);
    return variables.map(([variable, { unit: by }], j) => ({ name, one, unit, variable, by, isFirst: j === 0 }));
  });
  const methodColumn = (method: string): Column<(typeof rows)[number]> => ({
    title: method,
    cell: ({ one, unit, variable, by }) => number((one.gradients?.[method]?.[variable] * by.factor) / unit.factor, 6),
  });
  return section(
    "All derivatives",
    "",
    tableOf(rows, [
      { title: "response", left: true, cell: ({ name, isFirst }) => (isFirst ? words(name) : "") },
      { title: "variable", left: true, cell: ({ variable }) => words(variable) },
      ...methods.map(methodColumn),
      { title: "unit", left: true, cell: ({ unit, by }) => (by.name === "1" ? unit.name : `${unit.name}/${by.name}`) },
    ]),
  );
}
