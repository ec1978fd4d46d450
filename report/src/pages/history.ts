// One history over time: of one design or of two, with limits, the peak and a cursor.
import { lineChart } from "../charts";
import { curveOf, type Meaning, type Packed, type Picture, type Shown, type Unit, valueAt } from "../data";
import { inThousands, number, timeUnit, withUnit, words } from "../format";

interface HistoryOptions {
  picture: Picture;
  name: string;
  meaning: Meaning;
  curves: { name: string; color: string; width?: number; shown: Shown }[];
  peak?: Shown; // whose peak is marked
  height: number;
}

export interface HistoryChart {
  element: HTMLElement;
  setTime(time: number): void;
}

export function historyChart({ picture, name, meaning, curves, peak, height }: HistoryOptions): HistoryChart {
  const time = timeUnit(picture.scene.end_time);
  const unit = curveUnit(meaning, Math.max(...curves.map((curve) => Math.abs(curve.shown.value))));
  const chart = lineChart({
    title: words(name),
    yTitle: unit.name,
    xTitle: `time [${time.name}]`,
    height,
    series: curves.map(({ shown, ...look }) => ({ ...look, ...curveOf(shown.history!, time.factor, unit.factor) })),
    limits: limitsOn(picture, name).map((limit) => ({ value: limit.value / unit.factor, label: `${limit.side} ${withUnit(limit.value, unit, 3)}` })),
    peaks: peak?.peak_time === undefined || meaning.limits_history === false ? [] : [peakMark(peak, peak.history!, peak.peak_time, time, unit)],
  });
  return { element: chart.element, setTime: (now) => chart.setCursor(now / time.factor) };
}

/** What a history shows: in the unit of its instants, not in that of the number made from it. */
function curveUnit(meaning: Meaning, largest: number): Unit {
  const unit = meaning.history_unit ?? meaning.unit;
  // What cycles are counted in, whatever they add up to.
  if (meaning.type.startsWith("fatigue")) return { ...unit, name: "stress / strength" };
  return inThousands(unit, largest / unit.factor);
}

/** The result with the sign that the curve has there: magnitudes have none. */
function peakMark(peak: Shown, history: Packed, at: number, time: Unit, unit: Unit) {
  const there = valueAt(history, at);
  const value = there < 0 ? -Math.abs(peak.value) : peak.value;
  return { x: at / time.factor, y: there / unit.factor, label: number(value / unit.factor), color: "accent" };
}

export function limitsOn(picture: Picture, response: string): { value: number; side: string }[] {
  const limits: { value: number; side: string }[] = [];
  if (picture.responses[response]?.limits_history === false) return limits;
  for (const limit of Object.values(picture.limits)) {
    if (limit.response !== response) continue;
    if (limit.upper !== undefined) {
      limits.push({ value: limit.upper, side: "≤" });
      const meaning = picture.responses[response];
      const hasSign = meaning.over_time === "max-abs" && meaning.type !== "stress";
      if (hasSign) limits.push({ value: -limit.upper, side: "≥" });
    }
    if (limit.lower !== undefined) limits.push({ value: limit.lower, side: "≥" });
  }
  return limits;
}
