// What accuracy costs: the cheapest setting for each error, and all that was tried.
import type { Document, ReportData } from "../data";
import { lineChart } from "../charts";
import { h, type Page, section, tableOf } from "../dom";
import { count, number, percent, seconds, words } from "../format";
import { filesSection, timeChange } from "./parts";
import { hero } from "./studies";

interface Largest {
  value: number;
  name: string;
}

/** The error that decides, of the responses that count. */
function largestError(errors: Record<string, number | null> | undefined, counted: string[]): Largest | null {
  let largest: Largest | null = null;
  for (const [name, value] of Object.entries(errors ?? {})) {
    if (value === null || (counted.length && !counted.includes(name))) continue;
    if (!largest || Math.abs(value) > largest.value) largest = { value: Math.abs(value), name };
  }
  return largest;
}

/** @param least  errors of the reference: no run is known better */
const errorCell = (largest: Largest | null, least: Record<string, number | null> = {}) =>
  largest ? `${largest.value > 0 && largest.value <= (least[largest.name] ?? 0) ? "≤ " : ""}${number(100 * largest.value, 2)} %` : "–";
const nameCell = (largest: Largest | null) => h("span.soft", {}, largest ? words(largest.name) : "");

function countedText(result: Document, counted: string[]): string {
  if (counted.length === Object.keys(result.reference?.values ?? {}).length) return "all responses";
  return `what is minimized or limited (${counted.map(words).join(", ")})`;
}

function settingText(values: Document): string {
  return `a step of ${seconds(values.step)}, ${divisionText(values)}`;
}

const colors = ["accent", "more", "good", "drive", "limit", "soft"];

interface Setting {
  division: string;
  label: string;
  error: number; // [%]
  seconds: number;
}

function divisionText(settings: Document): string {
  if (settings.elements) return `${settings.elements} element${settings.elements === 1 ? "" : "s"} a segment`;
  return settings.element_factor === 1 || settings.element_factor === undefined ? "elements of the file" : `${number(settings.element_factor, 3)} times the elements`;
}

/** Those than which no other is both faster and more accurate, the fastest first. */
function frontOf(settings: Setting[]): Setting[] {
  const front: Setting[] = [];
  for (const one of [...settings].sort((a, b) => a.seconds - b.seconds || a.error - b.error)) {
    if (!front.length || one.error < front[front.length - 1].error) front.push(one);
  }
  return front;
}

/** @param best  what is recommended for the error that is wanted */
function workPrecision(title: string, settings: Setting[], wanted: number, best: Document | null): HTMLElement | null {
  if (settings.length < 2) return null;
  const divisions = [...new Set(settings.map((one) => one.division))];
  const front = frontOf(settings);
  const curve = (all: Setting[]) => ({ x: all.map((one) => one.error), y: all.map((one) => one.seconds), labels: all.map((one) => `${one.label}: ${number(one.error, 2)} %, ${seconds(one.seconds)}`) });
  return h(
    "div",
    {},
    lineChart({
      title,
      xTitle: "largest error that counts [%]",
      yTitle: "s",
      height: 300,
      logX: true,
      logY: true,
      legend: true,
      series: [
        { name: "front", ...curve([...front].reverse()), color: "start", width: 5 },
        ...divisions.map((division, i) => ({ name: division, ...curve(settings.filter((one) => one.division === division)), color: colors[i % colors.length], dots: true, width: 1.2 })),
      ],
    }).element,
    best ? h("p.note", {}, `For ${number(wanted, 3)} %: ${settingText(best)}, ${seconds(best.seconds)}.`) : h("p.note", {}, `No setting that was tried keeps ${number(wanted, 3)} %.`),
  );
}

function diagrams(result: Document, counted: string[]): HTMLElement | null {
  const wanted = 100 * (result.error ?? 0.01);
  const settings = (errors: string, time: (run: Document) => number): Setting[] =>
    ((result.runs ?? []) as Document[]).flatMap((run) => {
      const largest = largestError(run[errors], counted);
      const spent = time(run);
      if (run.failure || !largest || !(largest.value > 0) || !(spent > 0)) return [];
      return [{ division: divisionText(run.settings), label: `a step of ${seconds(run.settings.step)}`, error: 100 * largest.value, seconds: spent }];
    });
  const charts = [
    workPrecision("a simulation", settings("errors", (run) => run.simulation_seconds), wanted, result.recommended),
    workPrecision("a simulation with gradients", settings("gradient_errors", (run) => run.seconds), wanted, result.recommended_for_gradients),
  ].filter((one): one is HTMLElement => !!one);
  if (!charts.length) return null;
  return section("Work and precision", "Each mark is a setting: its processor time against its largest error that counts. On the broad line nothing else is both faster and more accurate.", h("div.columns", {}, charts));
}

function pricesOfAccuracy(result: Document): HTMLElement | null {
  const known: Document[] = (result.recommendations ?? []).filter((one: Document) => one.values);
  if (!known.length) return null;
  return section(
    "What an accuracy costs",
    "The cheapest setting for each; gradients may need finer steps than values.",
    tableOf(known, [
      { title: "accuracy", cell: (one) => `${number(100 * one.error, 2)} %` },
      { title: "values by", left: true, cell: (one) => settingText(one.values) },
      { title: "time", cell: (one) => seconds(one.values.seconds) },
      { title: "with gradients by", left: true, cell: (one) => (one.gradients ? settingText(one.gradients) : "–") },
      { title: "time", cell: (one) => (one.gradients ? seconds(one.gradients.seconds) : "–") },
    ]),
  );
}

function allRuns(result: Document, counted: string[]): HTMLElement {
  const best = result.recommended;
  const isBest = (settings: Document) => best && settings.step === best.step && settings.elements === best.elements && settings.element_factor === best.element_factor;
  return section(
    "All runs",
    `Errors of ${countedText(result, counted)}, against the reference: the largest, and whose it is (≤: below the error of the reference).`,
    tableOf((result.runs ?? []) as Document[], [
      { title: "step", cell: (run) => (isBest(run.settings) ? h("b", {}, `✓ ${seconds(run.settings.step)}`) : seconds(run.settings.step)) },
      { title: "elements", cell: (run) => (run.settings.elements ? count(run.settings.elements) : `× ${number(run.settings.element_factor ?? 1, 2).replace(/\.0$/, "")}`) },
      { title: "simulation", cell: (run) => seconds(run.simulation_seconds ?? run.seconds) },
      { title: "gradients", cell: (run) => (run.gradient_seconds ? seconds(run.gradient_seconds) : "–") },
      { title: "error", cell: (run) => errorCell(largestError(run.errors, counted), result.reference?.errors) },
      { title: "of", left: true, cell: (run) => nameCell(largestError(run.errors, counted)) },
      { title: "error of gradients", cell: (run) => errorCell(largestError(run.gradient_errors, counted), result.reference?.gradient_errors) },
      { title: "of", left: true, cell: (run) => nameCell(largestError(run.gradient_errors, counted)) },
    ]),
  );
}

function knobs(result: Document, counted: string[]): HTMLElement | null {
  if (!(result.knobs ?? []).length) return null;
  return section(
    "Other knobs",
    "At the setting that is recommended: a simulation, its time against one without the change beside it.",
    tableOf(result.knobs as Document[], [
      { title: "knob", left: true, cell: (knob) => words(knob.knob) },
      { title: "value", left: true, cell: (knob) => String(knob.value) },
      { title: "time", cell: (knob) => (knob.simulation_seconds ? seconds(knob.simulation_seconds) : "–") },
      { title: "change of time", cell: (knob) => timeChange(knob.time) },
      { title: "error", cell: (knob) => errorCell(largestError(knob.errors, counted), result.reference?.errors) },
      { title: "of", left: true, cell: (knob) => nameCell(largestError(knob.errors, counted)) },
    ]),
  );
}

/** What leaving an effect out makes of the response that counts and changes most. */
function effectChange(one: Document, values: Record<string, number>, counted: string[]): string {
  let text = "no change";
  let most = 1e-9;
  for (const [name, change] of Object.entries((one.influence ?? {}) as Record<string, number>)) {
    const share = change / Math.abs(values[name]);
    if (!counted.includes(name) || !(Math.abs(share) > most)) continue;
    most = Math.abs(share);
    text = `${words(name)} ${percent(share, 2)}`;
  }
  return text;
}

function savedEffects(result: Document, counted: string[]): HTMLElement | null {
  if (!(result.effects ?? []).length) return null;
  const values: Record<string, number> = result.reference?.values ?? {};
  return section(
    "What leaving an effect out saves",
    "The time of a simulation, and what changes most of the responses that count.",
    tableOf(result.effects as Document[], [
      { title: "effect", left: true, cell: (one) => words(one.effect) },
      { title: "set to", left: true, cell: (one) => String(one.value) },
      { title: "time", cell: (one) => (one.seconds ? seconds(one.seconds) : "–") },
      { title: "change of time", cell: (one) => timeChange(one.time) },
      { title: "changes most", left: true, cell: (one) => (one.failure ? "the simulation fails" : effectChange(one, values, counted)) },
    ]),
  );
}

function wholeOptimizations(data: ReportData): HTMLElement | null {
  const { result, picture } = data;
  const runs: Document[] = result.optimum ?? [];
  if (!runs.length) return null;
  const unit = (picture?.objective && picture.responses[picture.objective]?.unit) || { si: "", name: "", factor: 1 };
  const floor = result.optimum_reference?.relative_error ?? 0;
  return section(
    "Whole optimizations",
    `Against the optimum with ${settingText(result.optimum_reference.settings)}${result.optimum_reference.objective === undefined ? "" : `, ${number(result.optimum_reference.objective / unit.factor, 6)} ${unit.name}`}.`,
    tableOf(runs, [
      { title: "setting", left: true, cell: (run) => settingText(run.settings) },
      { title: `objective [${unit.name}]`, cell: (run) => (run.objective === undefined ? "–" : number(run.objective / unit.factor, 6)) },
      { title: "error", cell: (run) => (run.relative_error === undefined ? "–" : `${run.relative_error <= floor ? "≤ " : ""}${number(100 * run.relative_error, 2)} %`) },
      { title: "time", cell: (run) => seconds(run.seconds) },
      { title: "simulations", cell: (run) => count(run.evaluations) },
      { title: "status", left: true, cell: (run) => run.status },
    ]),
  );
}

export function accuracyPage(data: ReportData): Page {
  const { result } = data;
  const counted: string[] = result.counted ?? [];
  const wanted = `${number(100 * (result.error ?? 0.01), 3)} %`;
  const lead = result.recommended
    ? `For ${wanted}: ${settingText(result.recommended)}, ${seconds(result.recommended.seconds)} a simulation.`
    : `No setting that was tried keeps ${wanted}.`;
  return [
    hero(data, lead),
    diagrams(result, counted),
    pricesOfAccuracy(result),
    allRuns(result, counted),
    knobs(result, counted),
    savedEffects(result, counted),
    wholeOptimizations(data),
    filesSection(data),
  ];
}
