// What speaks against the numbers of a result, the most serious first.
import { h } from "../dom";
import { sentence } from "../format";

export function warningsBox(list: string[] = []): HTMLElement | null {
  if (!list.length) return null;
  const all = list.map(sentence);
  const open = all.length > 2 ? all.slice(0, 1) : all;
  const rest = all.slice(open.length);
  return h(
    "div.warnings",
    { role: "note" },
    open.map((text) => h("p", {}, h("b", {}, "Warning: "), text)),
    rest.length ? h("details", {}, h("summary", {}, `${rest.length} more warnings`), h("ul", {}, rest.map((text) => h("li", {}, text)))) : null,
  );
}

/** Each warning of several runs once, with the runs that it is of. */
export function sharedWarnings<Run extends { warnings?: string[] }>(runs: Run[]): Map<string, Run[]> {
  const shared = new Map<string, Run[]>();
  for (const run of runs) {
    for (const text of run.warnings ?? []) shared.set(text, [...(shared.get(text) ?? []), run]);
  }
  return shared;
}
