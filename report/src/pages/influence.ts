// What the variables change of the responses: a matrix, and derivatives over time.
import { type Chart, lineChart } from "../charts";
import { curveOf, type Picture, type Shown, type Unit } from "../data";
import { choice, h, type PaintedCell, paintedMatrix, section } from "../dom";
import { inThousands, number, timeUnit, words } from "../format";
import type { Viewing } from "./viewing";

/** A row of the matrix: percent of a response per percent of each variable. */
interface Row {
  name: string;
  percents: (number | null)[];
}

interface Influence {
  variables: string[];
  ofRange: boolean[]; // the variable is nearly zero: percent of its range
  rows: Row[];
  constant: string[]; // responses that no variable changes
}

/** A variable nearer to zero than this part of its range has no percents of its own. */
const nearZero = 0.01;
const fallbackUnit: Unit = { si: "", name: "", factor: 1 };

/** By what a variable changes if it grows by one percent. */
function onePercent(picture: Picture, name: string, value: number): { change: number; isOfRange: boolean } {
  const { lower, upper } = picture.variables[name];
  const range = Math.abs(upper - lower);
  const isOfRange = Number.isFinite(range) && Math.abs(value) < nearZero * range;
  return { change: 0.01 * (isOfRange ? range : Math.abs(value)), isOfRange };
}

export function influenceOf(picture: Picture, x: number[], gradients: (name: string) => Record<string, number> | undefined, values: (name: string) => number): Influence | null {
  const variables = Object.keys(picture.variables);
  const steps = variables.map((name, j) => onePercent(picture, name, x[j]));
  const influence: Influence = { variables, ofRange: steps.map((one) => one.isOfRange), rows: [], constant: [] };
  for (const name of Object.keys(picture.responses)) {
    const gradient = gradients(name);
    if (!gradient) continue;
    const value = Math.abs(values(name));
    const percents = variables.map((variable, j) =>
      value > 0 ? (100 * gradient[variable] * steps[j].change) / value : null,
    );
    if (percents.every((one) => one === null || Math.abs(one) < 1e-6)) influence.constant.push(name);
    else influence.rows.push({ name, percents });
  }
  return influence.rows.length && variables.length ? influence : null;
}

/** "+1.00", "−0.035": what matters, aligned. */
function percentText(value: number | null): string {
  if (value === null) return "–";
  if (Math.abs(value) < 5e-4) return "0";
  return `${value > 0 ? "+" : "−"}${number(Math.abs(value), Math.abs(value) < 0.1 ? 2 : 3)}`;
}

/** Blue what grows smaller, orange what grows larger. */
function cellOf(value: number | null, largest: number): PaintedCell {
  const strength = Math.sqrt(Math.min(1, Math.abs(value ?? 0) / largest));
  return { content: percentText(value), tone: (value ?? 0) < 0 ? "accent" : "more", percent: strength > 0.02 ? Math.round(52 * strength) : 0 };
}

/** @param onPick  called with the response whose name is clicked */
export function influenceTable(influence: Influence, onPick?: (response: string) => void): HTMLElement {
  const sizes = influence.rows.flatMap((row) => row.percents.map((one) => Math.abs(one ?? 0))).sort((a, b) => a - b);
  // One response that cancels to nearly nothing does not pale all others.
  const largest = Math.max(sizes[Math.floor(0.95 * (sizes.length - 1))], 1e-9);
  const headOf = (name: string) => (onPick ? h("button.link", { onclick: () => onPick(name) }, words(name)) : words(name));
  return paintedMatrix(
    "percent of each response per percent of each variable",
    "response",
    influence.variables.map((name, j) => [words(name), influence.ofRange[j] ? " *" : ""]),
    influence.rows.map((row) => ({ head: headOf(row.name), cells: row.percents.map((one) => cellOf(one, largest)) })),
  );
}

export function influenceNotes(influence: Influence): HTMLElement[] {
  const notes: HTMLElement[] = [];
  if (influence.ofRange.some(Boolean)) notes.push(h("p.note", {}, "* of a variable near zero: percent of its range."));
  if (influence.constant.length) notes.push(h("p.note", {}, `No variable changes ${influence.constant.map(words).join(", ")}.`));
  return notes;
}

const colors = ["accent", "more", "good", "drive", "limit", "soft", "load", "start"];

/** Derivatives over time of one response after another. */
class Slopes {
  readonly element: HTMLElement;
  private readonly list: HTMLElement;
  private readonly place = h("div", {});
  private chart: Chart | null = null;
  private now = 0;

  constructor(
    private readonly picture: Picture,
    private readonly x: number[],
    private readonly known: Shown[],
  ) {
    this.list = choice("response", known.map((one) => [one.name, words(one.name)]), known[0].name, (name) => this.show(name));
    this.list.classList.add("bordered");
    this.element = h("div.slopes", {}, h("h3", {}, "Over time: what one percent of each variable changes"), this.list, this.place);
    this.show(known[0].name);
  }

  has(name: string): boolean {
    return this.known.some((one) => one.name === name);
  }

  show(name: string): void {
    const response = this.known.find((one) => one.name === name);
    if (!response?.slopes) return;
    this.list.querySelector("select")!.value = name;
    const time = timeUnit(this.picture.scene.end_time);
    const names = Object.keys(this.picture.variables);
    const raw = Object.entries(response.slopes).map(([variable, packed]) => {
      const step = onePercent(this.picture, variable, this.x[names.indexOf(variable)]).change;
      return { variable, step, packed };
    });
    const meaning = this.picture.responses[name];
    const meant = meaning?.history_unit ?? meaning?.unit ?? fallbackUnit;
    const unit = inThousands(meant, 0);
    const chart = lineChart({
      title: `change of ${words(name)}`,
      yTitle: `${unit.name} per percent`,
      xTitle: `time [${time.name}]`,
      height: 240,
      legend: true,
      series: raw.map(({ variable, step, packed }, i) => ({
        name: words(variable),
        color: colors[i % colors.length],
        ...curveOf(packed, time.factor, unit.factor / step),
      })),
    });
    chart.setCursor(this.now / time.factor);
    this.chart = chart;
    this.place.replaceChildren(chart.element);
  }

  setTime(time: number): void {
    this.now = time;
    this.chart?.setCursor(time / timeUnit(this.picture.scene.end_time).factor);
  }
}

/** Of an optimum: the matrix, and beside it derivatives over time where they are known. */
export function influenceSection(picture: Picture | null, main: number, shown: Viewing | null): HTMLElement | null {
  const design = picture?.designs[main];
  if (!picture || !design?.responses) return null;
  const of = (name: string) => design.responses!.find((one) => one.name === name);
  const influence = influenceOf(picture, design.variables, (name) => of(name)?.gradients, (name) => of(name)?.value ?? 0);
  if (!influence) return null;
  const sloped = design.responses.filter((one) => one.slopes && influence.rows.some((row) => row.name === one.name));
  const slopes = sloped.length ? new Slopes(picture, design.variables, sloped) : null;
  if (slopes && shown) {
    shown.player.onTime((time) => slopes.setTime(time));
    shown.onBody((body) => {
      const own = sloped.find((one) => picture.responses[one.name].bodies.includes(body));
      if (own) slopes.show(own.name);
    });
  }
  const pick = slopes
    ? (name: string) => {
        slopes.show(name);
        if (slopes.has(name)) slopes.element.scrollIntoView({ behavior: "smooth", block: "nearest" });
      }
    : undefined;
  return section(
    "What each variable changes",
    `Percent of a response per percent of a variable, at the ${words(design.name)}: blue makes it smaller, orange larger.${slopes ? " The name of a response shows it over time." : ""}`,
    influenceTable(influence, pick),
    ...influenceNotes(influence),
    slopes?.element,
  );
}
