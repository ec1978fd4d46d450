// What accuracy costs: the cheapest setting for each error, and all that was tried.
import type { Document, ReportData } from "../data";
import { h, section, table } from "../dom";
import { count, number, percent, seconds, words } from "../format";
import { filesSection } from "./parts";
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

const errorCell = (largest: Largest | null) => (largest ? `${number(100 * largest.value, 2)} %` : "–");
const nameCell = (largest: Largest | null) => h("span.soft", {}, largest ? words(largest.name) : "");

function settingText(values: Document): string {
  return `a step of ${seconds(values.step)}${values.elements ? ` and ${values.elements} elements a segment` : ""}`;
}

function diagrams(files: Record<string, string>): HTMLElement | null {
  const figures = ["accuracy.svg", "accuracy-gradients.svg"]
    .filter((name) => files[name])
    .map((name) =>
      h(
        "figure",
        {},
        h("img.figure", {
          src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(files[name])}`,
          alt: name.includes("gradients") ? "work–precision diagram of gradients" : "work–precision diagram",
        }),
      ),
    );
  const note = "Each mark is a setting: its processor time against its largest error that counts.";
  return figures.length ? section("Work and precision", note, h("div.columns", {}, figures)) : null;
}

function pricesOfAccuracy(result: Document): HTMLElement | null {
  const known: Document[] = (result.recommendations ?? []).filter((one: Document) => one.values);
  if (!known.length) return null;
  return section(
    "What an accuracy costs",
    "The cheapest setting for each; gradients may need finer steps than values.",
    table(
      [
        { title: "accuracy" },
        { title: "values by", left: true },
        { title: "time" },
        { title: "with gradients by", left: true },
        { title: "time" },
      ],
      known.map((one) => [
        `${number(100 * one.error, 2)} %`,
        settingText(one.values),
        seconds(one.values.seconds),
        one.gradients ? settingText(one.gradients) : "–",
        one.gradients ? seconds(one.gradients.seconds) : "–",
      ]),
    ),
  );
}

function allRuns(result: Document, counted: string[]): HTMLElement {
  const best = result.recommended;
  const isBest = (settings: Document) => best && settings.step === best.step && settings.elements === best.elements;
  return section(
    "All runs",
    "Errors against the reference: the largest of those that count, and whose it is.",
    table(
      [
        { title: "step" },
        { title: "elements" },
        { title: "simulation" },
        { title: "gradients" },
        { title: "error" },
        { title: "of", left: true },
        { title: "error of gradients" },
        { title: "of", left: true },
      ],
      (result.runs ?? []).map((run: Document) => {
        const [value, gradient] = [largestError(run.errors, counted), largestError(run.gradient_errors, counted)];
        const step = seconds(run.settings.step);
        return [
          isBest(run.settings) ? h("b", {}, `✓ ${step}`) : step,
          count(run.settings.elements),
          seconds(run.simulation_seconds ?? run.seconds),
          run.gradient_seconds ? seconds(run.gradient_seconds) : "–",
          errorCell(value),
          nameCell(value),
          errorCell(gradient),
          nameCell(gradient),
        ];
      }),
    ),
  );
}

function knobs(result: Document, counted: string[]): HTMLElement | null {
  if (!(result.knobs ?? []).length) return null;
  return section(
    "Other knobs",
    "At the setting that is recommended.",
    table(
      [
        { title: "knob", left: true },
        { title: "value", left: true },
        { title: "time" },
        { title: "error" },
        { title: "of", left: true },
      ],
      result.knobs.map((knob: Document) => {
        const largest = largestError(knob.errors, counted);
        return [
          words(knob.knob),
          String(knob.value),
          knob.seconds ? seconds(knob.seconds) : "–",
          errorCell(largest),
          nameCell(largest),
        ];
      }),
    ),
  );
}

function savedEffects(result: Document): HTMLElement | null {
  if (!(result.effects ?? []).length) return null;
  return section(
    "What leaving an effect out saves",
    "",
    table(
      [{ title: "effect", left: true }, { title: "set to", left: true }, { title: "time" }, { title: "change of time" }],
      result.effects.map((one: Document) => [
        words(one.effect),
        String(one.value),
        one.seconds ? seconds(one.seconds) : "–",
        Number.isFinite(one.time_change) ? percent(one.time_change, 2) : "–",
      ]),
    ),
  );
}

export function accuracyPage(data: ReportData): HTMLElement[] {
  const { result, files } = data;
  const counted: string[] = result.counted ?? [];
  const wanted = `${number(100 * (result.error ?? 0.01), 3)} %`;
  const lead = result.recommended
    ? `For ${wanted}: ${settingText(result.recommended)}, ${seconds(result.recommended.seconds)} a simulation.`
    : `No setting that was tried keeps ${wanted}.`;
  return [
    hero(data, lead),
    diagrams(files),
    pricesOfAccuracy(result),
    allRuns(result, counted),
    knobs(result, counted),
    savedEffects(result),
    filesSection(data),
  ].filter((part): part is HTMLElement => !!part);
}
