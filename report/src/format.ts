import type { ErrorBar, Unit } from "./data";

/** "0.3194", "199.1", "1.2e−5": so many significant digits, with a true minus sign. */
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  let text: string;
  if (size >= 1e6 || size < 1e-4) {
    text = value.toExponential(Math.max(0, digits - 1)).replace(/\.?0+e/, "e").replace("e+", "e");
  } else {
    text = value.toPrecision(digits);
    if (text.includes("e")) text = String(Math.round(value));
  }
  return text.replace(/-/g, "−");
}

/** The next number of so many digits above an upper limit, or below a lower one: what is shown suffices. */
export function roundedOutward(value: number, isUpper: boolean, digits = 4): number {
  if (value === 0 || !Number.isFinite(value)) return value;
  const unit = 10 ** (Math.floor(Math.log10(Math.abs(value))) - digits + 1);
  const slack = 1e-4; // of a unit: 0.5 is not to become 0.5001 by rounding errors
  return unit * (isUpper ? Math.ceil(value / unit - slack) : Math.floor(value / unit + slack));
}

/** Of things that are counted. */
export function count(value: number | null | undefined): string {
  return value === null || value === undefined ? "–" : value.toLocaleString("en").replace(/,/g, "\u202f");
}

export function withUnit(value: number | null | undefined, unit: Unit, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  return `${number(value / unit.factor, digits)}${unit.name === "1" ? "" : ` ${unit.name}`}`;
}

/** "−77.4 %". */
export function percent(share: number, digits = 3): string {
  if (!Number.isFinite(share)) return "–";
  const value = 100 * share;
  if (Math.abs(value) < 0.005) return "0 %";
  const places = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(value))));
  return `${value > 0 ? "+" : "−"}${Math.abs(value).toFixed(Math.min(places, 2))} %`;
}

/** A share without sign: "48.5 %". */
export function share(value: number): string {
  if (value >= 1e4) return `${number(100 * value, 2)} %`;
  return `${(100 * value).toFixed(value < 0.0995 ? 2 : 1)} %`;
}

export function seconds(value: number): string {
  const size = Math.abs(value);
  if (size === 0) return "0 s";
  if (size < 1e-3) return `${number(value * 1e6, 3)} µs`;
  if (size < 1) return `${number(value * 1e3, 4)} ms`;
  if (size < 120) return `${number(value, 4)} s`;
  return `${number(value / 60, 3)} min`;
}

/** The unit of a time axis up to `end`. */
export function timeUnit(end: number): Unit {
  return end < 1 ? { si: "s", name: "ms", factor: 1e-3 } : { si: "s", name: "s", factor: 1 };
}

export function sentenceCase(text: string): string {
  return text ? text[0].toUpperCase() + text.slice(1) : text;
}

/** An end of a sentence, also before a remark in brackets. */
const sentenceEnd = /[.!?…]( \([^()]*\))?$/;

/** With a capital, and a full stop unless it has an end already. */
export function sentence(text: string): string {
  return sentenceCase(text) + (!text || sentenceEnd.test(text) ? "" : ".");
}

/** Names of the file as words: "rod_bow" → "rod bow". */
export function words(name: string): string {
  return name.replace(/_/g, " ");
}

export function errorText(error: ErrorBar | null | undefined, unit: Unit): string {
  if (!error || error.total === null || error.total === undefined) return "";
  if (error.total === 0) return "";
  const leftOut = Object.entries(error.left_out ?? {}).filter(([, change]) => Math.abs(change) > error.total!);
  const changes = leftOut.map(([name, change]) => `; with ${words(name)} ${change > 0 ? "+" : "−"}${withUnit(Math.abs(change), unit, 2)}`);
  return `± ${withUnit(error.total, unit, 2)}${changes.join("")}`;
}

/** As people see SI units: m → mm, Pa → MPa. */
export function engineering(si: string): Unit {
  const known: Record<string, [string, number]> = { m: ["mm", 1e-3], Pa: ["MPa", 1e6], "rad/s": ["rad/s", 1] };
  const [name, factor] = known[si] ?? [si, 1];
  return { si, name, factor };
}

/** Forces, powers and energies of machines in thousands. */
export function inThousands(unit: Unit, size: number): Unit {
  const grows = ["N", "N m", "W", "J"].includes(unit.name);
  return grows && size >= 1e4 ? { ...unit, name: `k${unit.name}`, factor: 1000 * unit.factor } : unit;
}

/** "464 → 199 N m". */
export function pair(before: number, after: number, unit: Unit): string {
  const shown = inThousands(unit, Math.max(Math.abs(before), Math.abs(after)) / unit.factor);
  return `${number(before / shown.factor, 3)} → ${withUnit(after, shown, 3)}`;
}

/** Where on a body a peak is, lengths in millimetres: "node 0, y = −11.57 mm". */
export function placeText(place: string | undefined): string {
  if (!place || place === "reference point" || place === "drive") return "";
  return place
    .replace(/^at ([\d.]+) of the length/, (_, at: string) => `at ${number(100 * Number(at), 3)} % of the length`)
    .replace(/(-?[\d.]+(?:e-?\d+)?) m(?=$|,)/g, (_, metres: string) => `${number(1000 * Number(metres), 4)} mm`);
}

/** "a", "a and b", "a, b and c". */
export function listed(texts: string[]): string {
  return texts.length < 2 ? texts.join("") : `${texts.slice(0, -1).join(", ")} and ${texts[texts.length - 1]}`;
}
