// Of fronts, accuracy and the other studies.
import { lineChart, type Series } from "../charts";
import { type Document, parseCsv, type Picture, type ReportData, type Unit } from "../data";
import { h, heroOf, type Page, section, tableOf } from "../dom";
import { engineering, number, sentence, timeUnit, withUnit, words } from "../format";
import { makePlayer } from "../mechanism/player";
import { filesSection, verdict } from "./parts";
import { profiles } from "./inspector";
import { sharedWarnings, warningsBox } from "./warnings";

/**
 * What a study is of, its verdict and some facts.
 * @param warnings  of the result, unless it has them run by run
 */
export function hero(data: ReportData, lead: string, facts: HTMLElement[] = [], warnings: string[] = data.result.warnings): HTMLElement {
  const { result, card, picture } = data;
  return heroOf(
    [
      h("p.eyebrow", {}, card.command),
      h("h1", {}, picture?.name ?? filesOf(card.inputs ?? [])),
      lead ? h("p.lead", {}, lead) : null,
      result.status ? h("p.verdict", {}, verdict(result.status), ` ${sentence(result.message ?? "")}`) : null,
      warningsBox(warnings),
    ],
    facts,
  );
}

/** "3 files", or the name of the only one. */
function filesOf(inputs: Document[]): string {
  if (inputs.length === 1) return words(String(inputs[0].file).replace(/^.*\//, "").replace(/\.json$/, ""));
  return inputs.length ? `${inputs.length} files` : "";
}

export function paretoPage(data: ReportData): Page {
  const { result, picture } = data;
  const points: Document[] = result.points ?? [];
  const [objective, limited] = Object.keys(result.units ?? {});
  const unit = (name: string): Unit =>
    picture?.responses[name]?.unit ?? picture?.limits[name]?.unit ?? engineering(result.units[name]);
  // Between two responses no limit of the file is varied: the search allows the second one so much.
  const isOfResponses = !!data.card.problem?.pareto?.responses;
  const limitTitle = isOfResponses ? `${words(limited ?? "")} allowed` : "limit";
  const bounds = (point: Document) => boundsReached(picture, point.variables ?? {});
  const marks = (point: Document) => [point.status, point.dominated ? "dominated" : "", point.knee ? "knee" : "", ...bounds(point)].filter(Boolean).join(", ");
  const known = points.map((point, i) => ({ point, number: i + 1 })).filter(({ point }) => point.objectives?.[objective] !== undefined);
  const verified = points.filter((point) => point.status === "verified").length;
  const slopeOf = (point: Document) => -point.multiplier * (unit(limited).factor / unit(objective).factor);
  const drawing = h("div.front-drawing", {});
  const players = new Map<number, HTMLElement>();
  const show = (index: number) => {
    const chosen = known[index];
    if (!chosen || !picture) return;
    const design = picture.designs.find((one) => one.name === String(chosen.number));
    if (design && !players.has(index)) {
      const one: Picture = { ...picture, designs: [{ ...design }] };
      players.set(index, h("div", {}, makePlayer({ picture: one, main: 0, onPick: () => undefined }).element, sectionsOf(one)));
    }
    drawing.replaceChildren(
      h("h3", {}, `Point ${chosen.number}${chosen.point.knee ? ", the knee" : ""}: `, withUnit(chosen.point.objectives[objective], unit(objective)), h("span.soft", {}, ` at ${withUnit(chosen.point.objectives[limited], unit(limited))}`)),
      h("p.note", {}, sentence(chosen.point.message ?? "")),
      ...(players.has(index) ? [players.get(index)!] : []),
    );
    players.get(index)?.dispatchEvent(new Event("shown"));
  };
  const x = known.map(({ point }) => point.objectives[limited] / unit(limited).factor);
  const y = known.map(({ point }) => point.objectives[objective] / unit(objective).factor);
  const knee = known.findIndex(({ point }) => point.knee);
  const front = lineChart({
    title: `${words(objective)} against ${words(limited)}`,
    xTitle: `${words(limited)} [${unit(limited).name}]`,
    yTitle: unit(objective).name,
    height: 430,
    series: [
      {
        name: "front",
        x,
        y,
        color: "accent",
        dots: true,
        hollow: known.map(({ point }) => bounds(point).length > 0),
        labels: known.map(({ point, number: n }) => `point ${n}: ${marks(point)}`),
      },
      ...(knee >= 0 ? [{ name: "knee", x: [x[knee]], y: [y[knee]], color: "good", dots: true, silent: true }] : []),
      ...slopesOf(known.map(({ point }) => slopeOf(point)), x, y),
    ],
    legend: known.some(({ point }) => Number.isFinite(point.multiplier)),
    onPick: (series, index) => series === 0 && show(index),
    onHover: (series, index) => series === 0 && show(index),
  });
  show(knee >= 0 ? knee : Math.floor(known.length / 2));
  const isPartly = result.status === "done" && verified < points.length;
  return [
    hero({ ...data, result: { ...result, status: isPartly ? "partly" : result.status } }, `${words(objective ?? "")} against ${isOfResponses ? words(limited ?? "") : `the limit of ${words(result.constraint ?? "")}`}: ${verified} of ${points.length} points verified.`, [], pointWarnings(points)),
    h("section.card.front", { "aria-label": "front" }, h("div", {}, h("p.note", {}, "Point at a mark to see its mechanism.", known.some(({ point }) => bounds(point).length) ? " Rings: a variable is at its bound." : "", knee >= 0 ? ` The knee is point ${known[knee].number}: a further gain of either goal costs more of the other.` : ""), front.element), drawing),
    section(
      "Points",
      "",
      tableOf(points, [
        { title: "", cell: (_, i) => String(i + 1) },
        { title: `${limitTitle} [${unit(limited).name}]`, cell: (point) => number(point.limit / unit(limited).factor) },
        isOfResponses && { title: `${words(limited)} [${unit(limited).name}]`, cell: (point) => number(point.objectives?.[limited] / unit(limited).factor) },
        { title: `${words(objective)} [${unit(objective).name}]`, cell: (point) => number(point.objectives?.[objective] / unit(objective).factor) },
        { title: "±", cell: (point) => (point.error?.total ? number(point.error.total / unit(objective).factor, 2) : "–") },
        { title: `slope [${unit(objective).name}/${unit(limited).name}]`, cell: (point) => (point.multiplier !== undefined ? number(slopeOf(point), 3) : "–") },
        ...Object.entries(picture?.variables ?? {}).map(([name, { unit }]) => ({
          title: `${words(name)} [${unit.name}]`,
          cell: (point: Document) => number(point.variables[name] / unit.factor),
        })),
        { title: "status", left: true, cell: marks },
      ]),
      unverifiedNotes(points),
    ),
    filesSection(data),
  ];
}

/** "rod width at its lower bound" */
function boundsReached(picture: Picture | null, values: Record<string, number>): string[] {
  const nearly = 1e-6; // of the range, or of sizes where bounds are far away, as the terminal has it
  return Object.entries(picture?.variables ?? {}).flatMap(([name, { start, lower, upper }]) => {
    const at = (bound: number) => Math.abs(values[name] - bound) <= nearly * Math.min(upper - lower, Math.abs(bound) + Math.abs(start) || Infinity);
    return upper > lower && (at(lower) || at(upper)) ? [`${words(name)} at its ${at(lower) ? "lower" : "upper"} bound`] : [];
  });
}

/** Why points are not verified. */
function unverifiedNotes(points: Document[]): HTMLElement[] {
  return points.flatMap((point, i) => (point.status === "verified" ? [] : [h("p.note", {}, h("b", {}, `Point ${i + 1}, ${point.status}: `), sentence(point.message ?? ""))]));
}

function pointWarnings(points: Document[]): string[] {
  return [...sharedWarnings(points)].map(([text, of]) => {
    const numbers = of.map((point) => points.indexOf(point) + 1);
    return `${text} (${numbers.length === 1 ? "point" : "points"} ${numbers.join(", ")})`;
  });
}

/** A short line through each point: what the objective gains by more of the limit. */
function slopesOf(slopes: number[], x: number[], y: number[]): Series[] {
  if (x.length < 2) return [];
  const order = x.map((_, i) => i).sort((a, b) => x[a] - x[b]);
  const half = 0.3 * Math.min(...order.slice(1).map((i, k) => x[i] - x[order[k]]).filter((gap) => gap > 0));
  const series: Series = { name: "slope", x: [], y: [], color: "more", width: 2.2, silent: true };
  for (const i of order) {
    if (!Number.isFinite(slopes[i]) || !Number.isFinite(half)) continue;
    series.x.push(x[i] - half, x[i] + half, x[i] + half);
    series.y.push(y[i] - half * slopes[i], y[i] + half * slopes[i], null);
  }
  return series.x.length ? [series] : [];
}

function sectionsOf(picture: Picture): HTMLElement {
  return h(
    "div.sections",
    {},
    picture.scene.bodies.map((body, i) => {
      const drawn = profiles(picture, i, 0);
      return drawn ? h("div", {}, h("b", {}, words(body.name)), drawn) : null;
    }),
  );
}

/** Histories with bands, derivatives over time: a chart for each column of a CSV file. */
export function csvCharts(data: ReportData): HTMLElement[] {
  const { files, picture } = data;
  const sections: HTMLElement[] = [];
  for (const name of ["uncertainty.csv", "gradients.csv"]) {
    if (!files[name]) continue;
    const { header, rows } = parseCsv(files[name]);
    const stride = Math.max(1, Math.floor(rows.length / 700));
    const kept = rows.filter((_, i) => i % stride === 0 || i === rows.length - 1);
    const unit = timeUnit(Number(rows[rows.length - 1]?.[0] ?? 1));
    const time = kept.map((row) => Number(row[0]) / unit.factor);
    const column = (title: string, factor = 1) => kept.map((row) => Number(row[header.indexOf(title)]) / factor);
    const own = header.filter((title) => title !== "time" && !title.includes(":"));
    const charts = own.flatMap((title) => {
      const shown = picture?.responses[title]?.unit ?? engineering("");
      const values = column(title, shown.factor);
      if (name === "uncertainty.csv") {
        const deviation = header.includes(`${title}:deviation`) ? column(`${title}:deviation`, shown.factor) : null;
        const band = deviation ? { band: deviation.map((d) => 2 * d) } : {};
        const common = { yTitle: shown.name, xTitle: `time [${unit.name}]` };
        const history = lineChart({ ...common, title: words(title), series: [{ name: words(title), x: time, y: values, color: "accent", ...band }] }).element;
        if (!deviation) return [history];
        const sampled = header.includes(`${title}:sampled_deviation`) ? [{ name: "by samples", x: time, y: column(`${title}:sampled_deviation`, shown.factor), color: "more", dashed: true }] : [];
        const series = [{ name: "first order", x: time, y: deviation, color: "accent" }, ...sampled];
        return [history, lineChart({ ...common, title: `deviation of ${words(title)}`, startsAtZero: true, series }).element];
      }
      const variables = header.filter((one) => one.startsWith(`${title}:`));
      const colors = ["accent", "more", "good", "drive", "limit", "soft"];
      return [
        lineChart({
          title: words(title),
          yTitle: shown.name,
          xTitle: `time [${unit.name}]`,
          series: variables.slice(0, 6).map((one, i) => {
            const variable = one.slice(title.length + 1);
            const size = picture?.variables[variable]?.start ?? 1;
            return { name: words(variable), x: time, y: column(one, shown.factor).map((d) => 0.01 * size * d), color: colors[i] };
          }),
        }).element,
      ];
    });
    if (charts.length) {
      sections.push(
        section(name === "uncertainty.csv" ? "Histories with their scatter" : "Sensitivities over time", name === "uncertainty.csv" ? "Two standard deviations on either side." : "What a response changes by if a variable grows by one percent.", h("div.grid", {}, charts)),
      );
    }
  }
  return sections;
}

