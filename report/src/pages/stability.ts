// Formulations and schemes side by side: a heat map of what they drift, lose and cost.
import type { Document, ReportData } from "../data";
import { chosenView, type Column, h, type Page, type PaintedCell, paintedMatrix, section, tableOf } from "../dom";
import { count, number, seconds, sentenceCase } from "../format";
import { fact, filesSection } from "./parts";
import { hero } from "./studies";
import { sharedWarnings } from "./warnings";

interface Measure {
  key: string;
  name: string;
  note: string;
  text(value: number): string;
}

const measures: Measure[] = [
  { key: "position_drift", name: "position drift", note: "largest violation of a joint [m or rad]", text: (v) => number(v, 2) },
  { key: "velocity_drift", name: "velocity drift", note: "largest violation of the rate of a joint [m/s or rad/s]", text: (v) => number(v, 2) },
  { key: "energy_error", name: "energy error", note: "part of the largest energy that is lost or made", text: (v) => number(v, 2) },
  { key: "iterations", name: "Newton iterations a step", note: "", text: (v) => number(v, 3) },
  { key: "condition", name: "condition", note: "of the matrix of a step, scaled", text: (v) => number(v, 2) },
  { key: "seconds", name: "time", note: "of one simulation", text: (v) => seconds(v) },
];

function valueOf(run: Document | undefined, key: string): number | null {
  if (!run || run.failure) return null;
  const value = key === "iterations" ? run.work.newton_iterations / run.work.steps : run[key];
  return typeof value === "number" ? value : null;
}

function textOf(run: Document | undefined, measure: Measure): string {
  const value = valueOf(run, measure.key);
  return value === null ? "–" : measure.text(value);
}

const nameOf = (file: string) => file.replace(/^.*\//, "").replace(/\.json$/, "");

/** Colours by the logarithm: between the smallest and the largest of the measure. */
function heatMap(runs: Document[], files: string[], formulations: string[], measure: Measure): HTMLElement {
  const of = (file: string, formulation: string) => runs.find((run) => run.file === file && run.formulation === formulation);
  const known = runs.map((run) => valueOf(run, measure.key)).filter((v): v is number => v !== null && v > 0);
  const [low, high] = [Math.log10(Math.min(...known)), Math.log10(Math.max(...known))];
  const shareOf = (value: number | null) => (value === null || !(value > 0) ? 0 : Math.max(0, (Math.log10(value) - low) / Math.max(high - low, 0.3)));
  const cellOf = (file: string, formulation: string): PaintedCell => {
    const run = of(file, formulation);
    const content = run?.failure ? h("span.bad", {}, "failed") : textOf(run, measure);
    return { content, title: run?.failure, tone: "more", percent: Math.round(42 * shareOf(valueOf(run, measure.key))) };
  };
  return paintedMatrix(
    measure.name,
    "formulation",
    files.map((file) => [nameOf(file)]),
    formulations.map((formulation) => ({ head: formulation, cells: files.map((file) => cellOf(file, formulation)) })),
  );
}

/** "four bar: augmented, minimal; slider crank: all formulations" */
function whose(concerned: Document[], runs: Document[], files: string[]): string {
  const parts = files.flatMap((file) => {
    const own = concerned.filter((run) => run.file === file);
    if (!own.length) return [];
    const isOfAll = own.length === runs.filter((run) => run.file === file && !run.failure).length;
    const names = isOfAll ? "all formulations" : own.map((run) => run.formulation).join(", ");
    return [files.length > 1 ? `${nameOf(file)}: ${names}` : names];
  });
  return parts.join("; ");
}

export function stabilityPage(data: ReportData): Page {
  const { result } = data;
  const runs: Document[] = result.runs ?? [];
  const files = [...new Set(runs.map((run) => String(run.file)))];
  const formulations = [...new Set([...(result.formulations ?? []), ...runs.map((run) => String(run.formulation))])].filter((name) => runs.some((run) => run.formulation === name));
  const failed = runs.filter((run) => run.failure);
  const shown = measures.filter((measure) => runs.some((run) => valueOf(run, measure.key) !== null));
  const ofRun: Column<Document>[] = [
    { title: "file", left: true, cell: (run) => nameOf(run.file) },
    { title: "formulation", left: true, cell: (run) => run.formulation },
  ];
  const draw = (key: string) => {
    const measure = shown.find((one) => one.key === key)!;
    const note = `${measure.note ? `${sentenceCase(measure.note)}. ` : ""}The darker, the larger: colours follow the logarithm.`;
    return [h("p.note", {}, note), heatMap(runs, files, formulations, measure)];
  };
  return [
    hero(data, failed.length ? `${failed.length} of ${runs.length} runs failed.` : `All ${runs.length} runs came to their ends.`, [
      fact(count(files.length), files.length === 1 ? "file" : "files"),
      fact(count(formulations.length), "formulations and schemes"),
    ], [...sharedWarnings(runs)].map(([text, of]) => `${text} (${whose(of, runs, files)})`)),
    section("Formulations side by side", "", shown.length ? chosenView("measure", shown.map((one) => [one.key, one.name]), draw) : null),
    failed.length
      ? section("What failed", "", tableOf(failed, [...ofRun, { title: "because", left: true, cell: (run) => run.failure }]))
      : null,
    section(
      "All numbers",
      "",
      tableOf(runs, [
        ...ofRun,
        ...shown.map((one) => ({ title: one.name, cell: (run: Document) => textOf(run, one) })),
        { title: "steps", cell: (run) => (run.work ? count(run.work.steps) : "–") },
      ]),
    ),
    filesSection(data),
  ];
}
