// How far each limit is used, where and when; numbered in the drawing; what it costs.
import type { Document, Picture, ReportData, Shown, Unit } from "../data";
import { bar, h, section } from "../dom";
import { percent, placeText, seconds, share, withUnit, words } from "../format";
import { addMarks, type Mark } from "../mechanism/marks";
import { unitOfLimit } from "./parts";
import type { Viewing } from "./viewing";

/** Shares and multipliers below this are round-off. */
export const leastShare = 1e-3;

/** Shows another load case; of a limit also its instant. */
export type ChooseCase = (name: string, limit?: string) => void;

export interface LimitRow {
  name: string;
  one: Document;
  unit: Unit;
  response?: Shown;
  before?: number;
  used?: number;
  isActive: boolean;
  mark?: number; // its number in the drawing
  usedOf(value: number): number;
}

/** Of all limits, those that bite first; they are numbered. */
export function limitRows(data: ReportData): LimitRow[] {
  const constraints: Record<string, Document> = data.result.constraints ?? {};
  const { picture } = data;
  const optimum = picture?.designs[picture.designs.length - 1];
  const start = picture?.designs[0];
  const rows = Object.keys(constraints).map((name): LimitRow => {
    const one = constraints[name];
    // The picture shows one load case: limits of others have no place in it.
    const isShown = one.case === undefined || one.case === picture?.case;
    const limit = isShown ? picture?.limits[one.limit_name ?? name] : undefined;
    const unit = unitOfLimit(picture, name, one.unit);
    const response = limit?.response ? optimum?.responses?.find((r) => r.name === limit.response) : undefined;
    const before = limit?.response ? start?.responses?.find((r) => r.name === limit.response)?.value : undefined;
    const used: number | undefined = one.utilisation;
    const isActive = (one.multiplier ?? 0) !== 0 || (used !== undefined && used > 0.999);
    return { name, one, unit, response, before, used, isActive, usedOf: (value) => (one.side === "upper" ? value / one.limit : one.limit / value) };
  });
  rows.sort((a, b) => Number(b.isActive) - Number(a.isActive) || (b.used ?? 0) - (a.used ?? 0));
  let number = 0;
  for (const row of rows) {
    if (row.isActive && row.response && picture && placeOf(picture, row.response)) row.mark = ++number;
  }
  return rows;
}

/** The place in the drawing that a response looks at; null if it is of the whole mechanism. */
function placeOf(picture: Picture, response: Shown): Pick<Mark, "body" | "share" | "joint"> | null {
  const meaning = picture.responses[response.name];
  const joint = picture.scene.joints.findIndex((one) => one.name === meaning.joint);
  if (joint >= 0) return { joint };
  if (meaning.bodies.length !== 1 || meaning.type === "mass") return null;
  const body = picture.scene.bodies.findIndex((one) => one.name === meaning.bodies[0]);
  return body < 0 ? null : { body, share: response.peak_share ?? (picture.scene.bodies[body].type === "beam" ? meaning.at : undefined) };
}

export function goToLimit(shown: Viewing, row: LimitRow, picture: Picture): void {
  if (!row.response) return;
  shown.pickBody(picture.responses[row.response.name].bodies[0]);
  if (row.response.peak_time !== undefined) shown.player.goTo(row.response.peak_time);
}

export function markLimits(data: ReportData, shown: Viewing): void {
  const picture = data.picture!;
  const marks = limitRows(data)
    .filter((row) => row.mark !== undefined)
    .map((row): Mark => ({
      number: row.mark!,
      name: words(row.name),
      text: `${withUnit(row.one.value, row.unit)} ${row.one.side === "upper" ? "≤" : "≥"} ${withUnit(row.one.limit, row.unit)}`,
      time: row.response!.peak_time,
      ...placeOf(picture, row.response!)!,
      onClick: () => goToLimit(shown, row, picture),
    }));
  addMarks(shown.player, picture, marks);
}

export function limitsSection(data: ReportData, shown: Viewing | null, chooseCase?: ChooseCase): HTMLElement | null {
  const { picture } = data;
  const rows = limitRows(data);
  if (!rows.length) return null;
  const part = section(
    "Where the limits bite",
    "How far each limit is used: the open mark is the start. Numbers stand in the drawing where a limit bites; the time leads to the instant.",
    h(
      "ul.limits",
      {},
      rows.map((row) => {
        const { name, one, unit, response, before, used, isActive, usedOf } = row;
        const place = placeText(response?.peak_place);
        return h(
          isActive ? "li.is-active" : "li",
          {},
          h(
            "div.limit-head",
            {},
            h("span.bar-name", {}, row.mark ? h("b.mark-number", { title: "its number in the drawing" }, String(row.mark)) : null, words(name)),
            h("span", {}, h("b", {}, withUnit(Math.abs(one.value) < 1e-9 * unit.factor ? 0 : one.value, unit)), h("span.soft", {}, ` ${one.side === "upper" ? "≤" : "≥"} ${withUnit(one.limit, unit)}`)),
          ),
          used !== undefined
            ? h(
                "div.gauge",
                { role: "img", "aria-label": `${share(used)} used` },
                h(isActive ? "span.gauge-fill.is-full" : "span.gauge-fill", { style: `width:${Math.min(100, used * 80)}%` }),
                before !== undefined && Number.isFinite(usedOf(before))
                  ? h("span.gauge-start", { title: `start: ${share(usedOf(before))}`, style: `left:${Math.min(98, Math.max(0, usedOf(before)) * 80)}%` })
                  : null,
                h("span.gauge-limit", { style: "left:80%" }),
                h("span.gauge-text", {}, share(used)),
              )
            : null,
          response && response.peak_time !== undefined
            ? h(
                "p.note",
                {},
                "at ",
                h(
                  "button.link",
                  {
                    onclick: () => {
                      if (shown) goToLimit(shown, row, picture!);
                      shown?.element.scrollIntoView({ behavior: "smooth", block: "nearest" });
                    },
                  },
                  seconds(response.peak_time),
                ),
                place ? `, ${place}` : "",
              )
            : chooseCase && one.case !== undefined && one.case !== picture?.case
            ? h("p.note", {}, "in the case ", h("button.link", { onclick: () => chooseCase(one.case, name) }, words(one.case)))
            : !used && isActive
              ? h("p.note", {}, "binds: a linear constraint of variables")
              : null,
        );
      }),
    ),
  );
  part.classList.add("limits-card");
  return part;
}

/** The body whose limit is used most, of the load case that is shown. */
export function mostUsedBody(data: ReportData): string | undefined {
  const picture = data.picture!;
  const rows = limitRows(data).filter((row) => row.response);
  let best: string | undefined;
  let most = -1;
  for (const limit of Object.values(picture.limits)) {  // of equal ones the first of the file
    const body = limit.response ? picture.responses[limit.response]?.bodies[0] : undefined;
    const used = Math.max(0, ...rows.filter((row) => row.response!.name === limit.response).map((row) => row.used ?? 0));
    if (body && used > most + 1e-4) [most, best] = [used, body];
  }
  return best ?? picture.scene.bodies[0]?.name;
}

export function pricesSection(data: ReportData): HTMLElement | null {
  const constraints: Record<string, Document> = data.result.constraints ?? {};
  const value = data.result.objective?.value;
  const prices = Object.entries(constraints)
    .filter(([, one]) => one.multiplier && one.limit)
    .map(([name, one]) => ({ name, gain: (-Math.abs(one.multiplier) * 0.01 * Math.abs(one.limit)) / Math.abs(value) }))
    .sort((a, b) => a.gain - b.gain);
  if (!prices.length) return null;
  const largest = Math.max(...prices.map((one) => Math.abs(one.gain)));
  return section(
    "What a limit costs",
    `What ${words(data.result.objective.name)} would gain by one percent more of a limit, the design optimal again.`,
    h("ul.bars", {}, prices.map((one) => bar(words(one.name), [], one.gain, largest, percent(one.gain, 2)))),
  );
}
