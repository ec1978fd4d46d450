// Two runs beside each other: which to build, how both move, what differs.
import { type Design, type Document, type Picture, type ReportData } from "../data";
import { h, heroOf, type Page, section, tableOf } from "../dom";
import { count, engineering, errorText, number, percent, withUnit, words } from "../format";
import { makePlayer } from "../mechanism/player";
import { buildSection } from "./build_table";
import { historyChart } from "./history";
import { filesSection, unitOf, unitOfLimit, verdict } from "./parts";
import { type Viewing, viewing } from "./viewing";

const last = (picture: Picture): Design => picture.designs[picture.designs.length - 1];

/** Whether both have the same members and joints, so that one drawing has room for both. */
function isAlike(a: Picture, b: Picture): boolean {
  const shape = ({ scene }: Picture) => JSON.stringify([scene.bodies.map((one) => [one.name, one.type]), scene.joints.map((one) => [one.name, one.type, one.bodies])]);
  return shape(a) === shape(b);
}

/** The second with the first as its ghost. */
function overlaid(a: Picture, b: Picture): Picture {
  return { ...b, scene: { ...b.scene, end_time: Math.max(a.scene.end_time, b.scene.end_time) }, designs: [{ ...last(a), name: "first" }, { ...last(b), name: "second" }] };
}

export function comparePage(data: ReportData): Page {
  const { picture, result } = data;
  const other = picture?.compared;
  const both = picture && other && isAlike(picture, other) ? overlaid(picture, other) : null;
  const parts: Page = [headline(data)];
  if (both) {
    const shown = viewing(both, 1);
    shown.pickBody(both.scene.bodies[0]?.name);
    parts.push(shown.element, buildSection({ ...data, picture: both }, "Members"), ...tables(data), historiesSection(both, shown));
  } else {
    if (picture && other) parts.push(sideBySide(picture, other));
    parts.push(...tables(data));
  }
  parts.push(inputSection(result), filesSection(data));
  return parts;
}

/** Whether only the search differs: its start, bounds of variables, optimizer, method. */
function isOneProblem(result: Document): boolean {
  return (result.input as Document[]).every(({ place }) => !/^\/(scene|constraints|responses|objective|simulation|effects|constants|cases)\b/.test(place));
}

/** Which of them to build: of two verified answers to one question the better one. */
function headline(data: ReportData): HTMLElement {
  const { result, picture } = data;
  const runs: Document[] = result.runs;
  const [a, b] = runs.map((run) => run.objective);
  const isOneQuestion = a?.value !== undefined && b?.value !== undefined && a.name === b.name && a.unit === b.unit;
  const verified = runs.map((run) => run.status === "verified");
  const unit = isOneQuestion ? unitOf(picture, a.name, a.unit) : null;
  const isMax = data.card.problem?.objective?.maximize !== undefined; // known where no picture can be made, too
  const better = isOneQuestion && a.value !== b.value ? (b.value < a.value !== isMax ? 1 : 0) : -1;
  const answer =
    verified[0] !== verified[1] ? `Only the ${verified[0] ? "first" : "second"} is verified` : better < 0 ? "Neither is better" : `The ${better ? "second" : "first"} is better${verified[0] ? "" : "; neither is verified"}`;
  return heroOf([
    h("p.eyebrow", {}, "two runs"),
    h("h1", {}, answer, isOneProblem(result) ? null : h("span.what", {}, " for another problem")),
    isOneQuestion
      ? h(
          "p.numbers",
          {},
          h("span.soft", {}, `${words(a.name)}: `),
          h(better === 0 ? "b" : "span", {}, withUnit(a.value, unit!)),
          h("span.soft", {}, ` ${errorText(a.error, unit!)} → `),
          h(better === 1 ? "b" : "span", {}, withUnit(b.value, unit!)),
          h("span.soft", {}, ` ${errorText(b.error, unit!)} (${percent(b.value / a.value - 1)})`),
        )
      : null,
    runs.map((run, i) => h("p.verdict", {}, h("b", {}, i ? "Second: " : "First: "), `${run.folder}, ${run.command} of ${run.problem} `, verdict(run.status))),
  ]);
}

/** Mechanisms that differ move together, each in a drawing of its own. */
function sideBySide(a: Picture, b: Picture): HTMLElement {
  const players = [a, b].map((one) => makePlayer({ picture: { ...one, designs: [last(one)] }, main: 0, onPick: () => undefined }));
  players[0].onTime((time) => players[1].goTo(time));
  return section("Both in motion", "", h("div.columns", {}, players.map((player, i) => h("div", {}, h("h3", {}, i ? "second" : "first"), player.element))));
}

const roundOff = 1e-9; // of a unit that people see, as in the terminal
const groups: [string, string][] = [["variables", "Dimensions"], ["constraints", "Limits"], ["responses", "Responses"], ["prices", "Prices"], ["points", "Points of the front"], ["effort", "Effort"]];

function tables(data: ReportData): HTMLElement[] {
  const { result, picture } = data;
  return groups.flatMap(([group, title]) => {
    const rows = (result.outcome as Document[]).filter((one) => one.group === group);
    if (!rows.length) return [];
    const unit = (one: Document) =>
      group === "variables" ? picture?.variables[one.name]?.unit ?? engineering(one.unit) : group === "constraints" ? unitOfLimit(picture, one.name, one.unit) : unitOf(picture, one.name, one.unit);
    const clean = (value: number | null, one: Document) => (value !== null && Math.abs(value) < roundOff * unit(one).factor ? 0 : value);
    const shown = (value: number | null, one: Document) => (value === null ? "–" : Number.isInteger(value) && group === "effort" ? count(value) : number(clean(value, one)! / unit(one).factor, 6));
    const change = (one: Document) => {
      const [before, after] = [clean(one.first, one), clean(one.second, one)];
      return before === after ? "same" : before && after !== null && !isResidual(one) ? percent(after / before - 1) : "";
    };
    const isResidual = (one: Document) => one.name === "kkt_residual" || one.name === "max_violation";
    return [
      section(
        title,
        "",
        tableOf(rows, [
          { title: "", left: true, cell: (one) => words(one.of ? `${one.name}, ${one.of}` : one.name) },
          { title: "first", cell: (one) => shown(one.first, one) },
          { title: "second", cell: (one) => shown(one.second, one) },
          { title: "unit", left: true, cell: (one) => (unit(one).name === "1" ? "" : unit(one).name) },
          { title: "change", cell: change },
        ]),
      ),
    ];
  });
}

function historiesSection(both: Picture, shown: Viewing): HTMLElement | null {
  const [a, b] = both.designs;
  const charts = (b.responses ?? []).flatMap((one) => {
    const before = a.responses?.find((response) => response.name === one.name);
    if (!one.history || !before?.history) return [];
    const curves = [
      { name: "first", color: "start", shown: before },
      { name: "second", color: "accent", shown: one },
    ];
    const chart = historyChart({ picture: both, name: one.name, meaning: both.responses[one.name], curves, height: 180 });
    shown.player.onTime(chart.setTime);
    return [chart.element];
  });
  return charts.length ? section("Histories", "Limits are those of the second.", h("div.grid", {}, charts)) : null;
}

function inputSection(result: Document): HTMLElement {
  const rows: Document[] = result.input;
  const text = (value: unknown) => (value === null ? "–" : typeof value === "string" ? value : JSON.stringify(value));
  return section(
    "What went in",
    rows.length ? "Where the inputs differ." : "The inputs are the same.",
    rows.length
      ? tableOf(rows, [
          { title: "place", left: true, cell: (one) => h("code", {}, one.place) },
          { title: "first", left: true, cell: (one) => text(one.first) },
          { title: "second", left: true, cell: (one) => text(one.second) },
        ])
      : null,
  );
}
