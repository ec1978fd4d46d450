// Whether a variable lies at a bound: by the rule of cli/reports/optimum.cpp.

interface Range {
  start: number; // of the problem file
  lower: number;
  upper: number;
}

/** The range says little where one bound is far away. */
function isAt(bound: number, { start, lower, upper }: Range, value: number): boolean {
  const range = upper - lower;
  const size = Math.abs(bound) + Math.abs(start);
  return Math.abs(value - bound) <= 1e-6 * (size > 0 ? Math.min(range, size) : range);
}

export function boundText(value: number, range: Range): string {
  if (range.lower === range.upper) return "fixed";
  if (isAt(range.lower, range, value)) return "at its lower bound";
  return isAt(range.upper, range, value) ? "at its upper bound" : "";
}
