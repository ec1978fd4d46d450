// Line charts with limits, peaks and a cursor; each can be saved as SVG, PNG and CSV.
import { CustomChart, LineChart, ScatterChart } from "echarts/charts";
import {
  DataZoomInsideComponent,
  GridComponent,
  LegendComponent,
  MarkLineComponent,
  MarkPointComponent,
  TitleComponent,
  TooltipComponent,
} from "echarts/components";
import * as echarts from "echarts/core";
import { SVGRenderer } from "echarts/renderers";
import { download, h } from "./dom";
import { number } from "./format";
import { inLight, paperWidth, savePng, sizedSvg } from "./paper";
import { color, onTheme } from "./theme";

echarts.use([
  CustomChart,
  LineChart,
  ScatterChart,
  GridComponent,
  TooltipComponent,
  LegendComponent,
  MarkLineComponent,
  MarkPointComponent,
  DataZoomInsideComponent,
  TitleComponent,
  SVGRenderer,
]);

export interface Series {
  name: string;
  x: number[];
  y: (number | null)[];
  band?: number[]; // half-widths of an error band
  color: string; // name of a colour of the style sheet
  width?: number;
  dots?: boolean;
  line?: boolean;
  dashed?: boolean;
  silent?: boolean; // lets the mouse through to what lies below
  hollow?: boolean[]; // points that are drawn as rings
  labels?: string[]; // one a point, for the tooltip
}

export interface ChartOptions {
  title: string;
  series: Series[];
  xTitle: string;
  yTitle: string;
  limits?: { value: number; label: string }[];
  peaks?: { x: number; y: number; label: string; color: string }[];
  height?: number;
  logX?: boolean;
  logY?: boolean;
  legend?: boolean;
  wholeX?: boolean; // the axis counts
  startsAtZero?: boolean;
  onPick?: (series: number, index: number) => void;
  onHover?: (series: number, index: number) => void;
}

export interface Chart {
  element: HTMLElement;
  /** Shows a line at x; nothing hides it. */
  setCursor(x: number | null): void;
}

const mostEagerCharts = 40;
let charts = 0;

/** By its name: the place that labels need is measured with it. */
const fontFamily = () => getComputedStyle(document.documentElement).fontFamily;

/** @param range  of a vertical axis: its end has a number if that is a whole one of its steps */
function axis(options: ChartOptions, which: "x" | "y", range: AxisRange = {}) {
  const isLog = which === "x" ? options.logX : options.logY;
  const line = color("line");
  return {
    type: "value" as const,
    name: which === "x" ? options.xTitle : "",
    nameLocation: "middle" as const,
    nameGap: 26,
    nameTextStyle: { color: color("soft"), fontSize: 11 },
    scale: which === "y" ? !options.startsAtZero : true,
    min: which === "x" && !isLog && !options.onPick ? ("dataMin" as const) : undefined,
    max: which === "x" && !isLog && !options.onPick ? ("dataMax" as const) : undefined,
    minInterval: which === "x" && options.wholeX ? 1 : undefined,
    axisLine: { show: which === "x", onZero: false, lineStyle: { color: line } },
    axisTick: { show: false },
    axisLabel: {
      color: color("soft"),
      fontSize: 11,
      fontFamily: fontFamily(),
      hideOverlap: true,
      showMaxLabel: isLog || isWhole(range),
      formatter: (value: number) => number(isLog ? 10 ** value : value, isLog ? 1 : 6).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, ""),
    },
    splitNumber: 4,
    splitLine: { show: which === "y", lineStyle: { color: line, opacity: 0.6 } },
    minorSplitLine: { show: false },
  };
}

/** The lower one of two limits has its name below its line: they may stand on each other. */
function isLowest(limit: { value: number }, options: ChartOptions): boolean {
  return (options.limits ?? []).some((other) => other.value > limit.value);
}

function seriesOption(options: ChartOptions, s: Series, i: number) {
  const paint = color(s.color);
  const isDots = s.line === false;
  // Names of limits stay clear of the numbers of peaks.
  const isPeakEarly = options.peaks?.some((peak) => placeAcross(options, peak.x) < 0.45);
  return {
    type: isDots ? ("scatter" as const) : ("line" as const),
    name: s.name,
    data: s.x.map((x, k) => (s.hollow?.[k] ? { value: pointOf(options, x, s.y[k]), itemStyle: { color: color("card"), borderColor: paint, borderWidth: 2 } } : pointOf(options, x, s.y[k]))),
    showSymbol: !!s.dots,
    symbol: "circle",
    silent: s.silent,
    symbolSize: isDots || (s.dots && options.onPick) ? 11 : s.dots ? 7 : 0,
    lineStyle: { color: paint, width: s.width ?? 1.6, type: s.dashed ? ("dashed" as const) : ("solid" as const) },
    itemStyle: { color: paint, borderColor: color("card"), borderWidth: s.dots ? 1 : 0 },
    emphasis: { disabled: !options.onPick && !s.dots },
    animation: false,
    z: 2 + i,
    markLine:
      i === 0 && options.limits?.length
        ? {
            silent: true,
            symbol: "none",
            animation: false,
            data: options.limits.map((limit) => ({
              yAxis: limit.value,
              label: {
                formatter: limit.label,
                position: `inside${isPeakEarly ? "End" : "Start"}${isLowest(limit, options) ? "Bottom" : "Top"}` as const,
                color: color("limit"),
                fontSize: 11,
                textBorderColor: color("card"), // readable where it lies on a curve
                textBorderWidth: 3,
              },
              lineStyle: { color: color("limit"), type: "dashed" as const, width: 1.2 },
            })),
          }
        : undefined,
    markPoint:
      i === 0 && options.peaks?.length
        ? {
            animation: false,
            symbol: "circle",
            symbolSize: 8,
            silent: true,
            data: options.peaks.map((peak) => ({
              coord: [peak.x, peak.y],
              itemStyle: { color: color("card"), borderColor: color(peak.color), borderWidth: 2 },
              label: {
                show: true,
                formatter: peak.label,
                position: isLow(options, peak.y) ? ("bottom" as const) : ("top" as const),
                align: placeAcross(options, peak.x) > 0.92 ? ("right" as const) : placeAcross(options, peak.x) < 0.08 ? ("left" as const) : ("center" as const),
                distance: 5,
                color: color("ink"),
                fontSize: 11,
                fontWeight: 600,
                textBorderColor: color("card"),
                textBorderWidth: 3,
              },
            })),
          }
        : undefined,
  };
}

/** The area between y − band and y + band, as one polygon. */
function bandOption(s: Series) {
  const side = (sign: number) => s.x.map((x, k) => [x, (s.y[k] ?? 0) + sign * s.band![k]]);
  const outline = [...side(1), ...side(-1).reverse()];
  return {
    type: "custom" as const,
    data: [outline[0]],
    silent: true,
    animation: false,
    clip: true,
    tooltip: { show: false },
    z: 1,
    // eslint-disable-next-line @typescript-eslint/no-explicit-any
    renderItem: (_: unknown, api: any) => ({
      type: "polygon" as const,
      shape: { points: outline.map((point) => api.coord(point)) },
      style: { fill: color(s.color), opacity: 0.25 },
    }),
  };
}

/** Where a value stands between the first and the last of all curves, 0 … 1. */
function placeAcross(options: ChartOptions, x: number): number {
  let [first, last] = [Infinity, -Infinity];
  for (const s of options.series) for (const one of s.x) [first, last] = [Math.min(first, one), Math.max(last, one)];
  return last > first ? (x - first) / (last - first) : 0.5;
}

/** Whether a mark is at the lower side of the curves. */
function isLow(options: ChartOptions, y: number): boolean {
  let [low, high] = [Infinity, -Infinity];
  for (const s of options.series) for (const one of s.y) if (one !== null) [low, high] = [Math.min(low, one), Math.max(high, one)];
  return y < low + 0.25 * (high - low);
}

/** 1, 2 or 5 times a power of ten. */
function niceStep(size: number): number {
  const power = 10 ** Math.floor(Math.log10(size));
  const digit = size / power;
  return (digit <= 1.2 ? 1 : digit <= 2.5 ? 2 : digit <= 6 ? 5 : 10) * power;
}

/** Logarithmic axes are drawn as linear ones of exponents: of these the library knows more. */
const exponent = (value: number) => Math.log10(value);
const isOnLog = (value: number | null | undefined): value is number => typeof value === "number" && value > 0 && Number.isFinite(value);
const mostDecadeLabels = 6;

/** Exponents of the powers of ten that hold all values. */
function logRange(values: (number | null)[]): { min: number; max: number; interval: number } {
  const known = values.filter(isOnLog).map(exponent);
  let [low, high] = [0, 1];
  if (known.length) [low, high] = known.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [known[0], known[0]]);
  const min = Math.floor(low - 0.03);
  const max = Math.max(Math.ceil(high + 0.03), min + 1);
  return { min, max, interval: Math.ceil((max - min) / mostDecadeLabels) };
}

/** A point as the axes have it; what a logarithmic axis cannot show is a gap. */
function pointOf(options: ChartOptions, x: number, y: number | null): [number | null, number | null] {
  const along = (value: number | null, isLog?: boolean) => (!isLog ? value : isOnLog(value) ? exponent(value) : null);
  return [along(x, options.logX), along(y, options.logY)];
}

interface AxisRange {
  min?: number;
  max?: number;
  interval?: number;
}

function isWhole({ max, interval }: AxisRange): boolean {
  if (max === undefined || !interval) return false;
  return Math.abs(max / interval - Math.round(max / interval)) < 1e-6;
}

function rangeOf(options: ChartOptions): AxisRange {
  // A limit that nothing comes near would flatten the curves: it is drawn within twice their range.
  if (options.logY) return logRange(options.series.flatMap((s) => s.y));
  let [low, high] = [Infinity, -Infinity];
  for (const s of options.series) {
    for (const y of s.y) {
      if (y === null || !Number.isFinite(y)) continue;
      low = Math.min(low, y);
      high = Math.max(high, y);
    }
  }
  if (!(high >= low)) return {};
  const range = high - low || Math.abs(high) || 1;
  let hasLimit = false;
  for (const limit of options.limits ?? []) {
    if (limit.value > high && limit.value < high + 2 * range) [high, hasLimit] = [limit.value, true];
    if (limit.value < low && limit.value > low - 2 * range) [low, hasLimit] = [limit.value, true];
  }
  const margin = (high - low || Math.abs(high) || 1) * (options.peaks?.length || hasLimit ? 0.16 : 0.04);
  const hasLow = options.peaks?.some((peak) => isLow(options, peak.y));
  const [from, to] = [low >= 0 && low < 0.4 * high ? 0 : low - (hasLow ? 1 : 0.25) * margin, high + margin];
  const step = niceStep((to - from) / 4);
  return { min: Math.floor(from / step) * step, max: Math.ceil((to / step) * 2 - 1e-9) * (step / 2), interval: step };
}

function tooltip(options: ChartOptions) {
  return {
    trigger: options.onPick || options.onHover ? ("item" as const) : ("axis" as const),
    backgroundColor: color("card"),
    borderColor: color("line"),
    padding: [6, 10],
    confine: true,
    textStyle: { color: color("ink"), fontSize: 12 },
    axisPointer: { lineStyle: { color: color("soft"), type: "dotted" as const } },
    // eslint-disable-next-line @typescript-eslint/no-explicit-any
    formatter: (shown: any) => {
      const items = Array.isArray(shown) ? shown : [shown];
      const box = h("div", {});
      items.forEach((item, k) => {
        const s = options.series[item.seriesIndex];
        if (!s || !Array.isArray(item.value)) return;
        if (k === 0) box.append(h("div.soft", {}, s.labels?.[item.dataIndex] ?? `${options.xTitle}: ${number(s.x[item.dataIndex], 5)}`));
        box.append(
          h("div", {}, h("span.dot", { style: `background:${color(s.color)}` }), `${s.name}: `, h("b", {}, number(s.y[item.dataIndex], 5))),
        );
      });
      return box;
    },
  };
}

const legendHeight = 30; // of its first row
const legendRowHeight = 26;
const legendPadding = 5;
const legendStyle = { left: 0, padding: legendPadding, itemWidth: 16, itemHeight: 8, itemGap: 14, icon: "roundRect" };
const axisHeight = 42;

function hasLegend(options: ChartOptions): boolean {
  return options.legend ?? options.series.length > 1;
}

const legendRoom = (width: number) => width - 2 * legendPadding;

/** What the names of curves need beyond their first row. */
function furtherRows(options: ChartOptions, width: number): number {
  if (!hasLegend(options)) return 0;
  const { itemWidth, itemGap } = legendStyle;
  const beforeName = 5; // as the library has it
  let [rows, used] = [0, 0];
  for (const s of options.series) {
    const own = itemWidth + beforeName + echarts.format.getTextRect(s.name, `11px ${fontFamily()}`).width;
    if (used > 0 && used + own > legendRoom(width)) [rows, used] = [rows + 1, 0];
    used += own + itemGap;
  }
  return rows * legendRowHeight;
}

/** Above the curves: the legend, or some room for numbers. */
function topOf(options: ChartOptions, width: number): number {
  return hasLegend(options) ? legendHeight + furtherRows(options, width) : 12;
}

function optionOf(options: ChartOptions, width: number): echarts.EChartsCoreOption {
  const range = rangeOf(options);
  return {
    animation: false,
    textStyle: { fontFamily: fontFamily() },
    aria: { enabled: true },
    grid: { left: 6, right: 14, top: topOf(options, width), bottom: 26, containLabel: true },
    legend: hasLegend(options)
      ? {
          ...legendStyle,
          top: 0,
          width: legendRoom(width),
          textStyle: { color: color("soft"), fontSize: 11 },
          data: options.series.map((s) => s.name),
        }
      : undefined,
    tooltip: tooltip(options),
    xAxis: { ...axis(options, "x"), ...(options.logX ? logRange(options.series.flatMap((s) => s.x)) : {}) },
    yAxis: { ...axis(options, "y", range), ...range },
    dataZoom: [{ type: "inside", zoomOnMouseWheel: "ctrl", moveOnMouseMove: false }],
    series: [
      ...options.series.map((s, i) => seriesOption(options, s, i)),
      ...options.series.flatMap((s) => (s.band ? [bandOption(s)] : [])),
    ],
  };
}

function csvOf(options: ChartOptions): string {
  const quote = (text: string) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  const unit = options.yTitle ? ` [${options.yTitle}]` : "";
  const hasBand = options.series.some((s) => s.band);
  const lines = [["series", options.xTitle, options.title + unit, ...(hasBand ? [`error${unit}`] : [])].map(quote).join(",")];
  for (const s of options.series) {
    s.x.forEach((x, i) => lines.push(`${quote(s.name)},${x},${s.y[i] ?? ""}${hasBand ? `,${s.band?.[i] ?? ""}` : ""}`));
  }
  return lines.join("\n") + "\n";
}

const paperTitle = 34; // room for a title and the unit of the axis [px]
const paperRatio = 0.42;

/** The chart as a file of its own: with title, axes and units, at the width that papers have. */
function paperSvg(options: ChartOptions): { svg: string; width: number; height: number } {
  const width = paperWidth();
  const height = Math.round(Math.max(options.height ?? 0, paperRatio * width)) + paperTitle + furtherRows(options, width);
  const box = h("div", { style: `position:absolute;left:-9999px;width:${width}px;height:${height}px` });
  document.body.append(box);
  const chart = echarts.init(box, undefined, { renderer: "svg", width, height });
  inLight(() => {
    const text = { fontFamily: fontFamily(), color: color("ink") };
    const option = optionOf(options, width);
    const shift = (part: object, key: string) => ({ ...part, [key]: ((part as Record<string, number>)[key] ?? 0) + paperTitle });
    chart.setOption({
      ...option,
      backgroundColor: color("card"),
      title: {
        text: options.title,
        subtext: options.yTitle ? `[${options.yTitle}]` : "",
        itemGap: 2,
        padding: [4, 6],
        textStyle: { ...text, fontSize: 13, fontWeight: 600 },
        subtextStyle: { ...text, fontSize: 11 },
      },
      grid: shift(option.grid as object, "top"),
      legend: option.legend && shift(option.legend as object, "top"),
    });
    chart.getZr().flush();
  });
  const svg = sizedSvg(box.querySelector("svg")!.cloneNode(true) as SVGElement, width, height);
  chart.dispose();
  box.remove();
  return { svg, width, height };
}

function savePaperPng(options: ChartOptions, file: string): void {
  const { svg, width, height } = paperSvg(options);
  savePng(svg, width, height, file);
}

export function lineChart(options: ChartOptions): Chart {
  const height = options.height ?? 190;
  const plot = h("div.plot", { style: `height:${height}px` });
  // Between the legend and the numbers of the axis.
  const cursor = h("div.cursor", { hidden: true, style: `bottom:${axisHeight}px` });
  const file = options.title.replace(/[^A-Za-z0-9]+/g, "-").toLowerCase();
  const element = h(
    "figure.chart",
    { "data-title": options.title },
    h(
      "figcaption",
      {},
      h("span", {}, h("span.chart-title", {}, options.title), h("span.soft", {}, options.yTitle ? ` [${options.yTitle}]` : "")),
      h(
        "span.saves",
        {},
        h("button.quiet", { onclick: () => download(`${file}.svg`, paperSvg(options).svg, "image/svg+xml") }, "SVG"),
        h("button.quiet", { onclick: () => savePaperPng(options, file) }, "PNG"),
        h("button.quiet", { onclick: () => download(`${file}.csv`, csvOf(options), "text/csv") }, "CSV"),
      ),
    ),
    h("div.plot-box", { role: "img", "aria-label": describe(options) }, plot, cursor),
  );
  let chart: echarts.ECharts | null = null;
  let cursorAt: number | null = null;
  const placeCursor = () => {
    if (!chart || cursorAt === null) {
      cursor.hidden = true;
      return;
    }
    const pixel = chart.convertToPixel({ xAxisIndex: 0 }, cursorAt);
    cursor.hidden = !Number.isFinite(pixel);
    cursor.style.transform = `translateX(${pixel}px)`;
  };
  /** Paper is narrower than the window: the style sheet scales what has a box. */
  const scaleOnPaper = () => {
    const svg = plot.querySelector("svg");
    svg?.setAttribute("viewBox", `0 0 ${svg.getAttribute("width")} ${svg.getAttribute("height")}`);
  };
  let width = 0;
  const draw = () => chart?.setOption(optionOf(options, width), true);
  /** Names of curves that need more rows make the chart higher. */
  const fit = () => {
    width = plot.clientWidth;
    plot.style.height = `${height + furtherRows(options, width)}px`;
    cursor.style.top = `${topOf(options, width)}px`;
  };
  const begin = () => {
    if (chart || !plot.clientWidth) return;
    fit();
    chart = echarts.init(plot, undefined, { renderer: "svg" });
    chart.on("finished", scaleOnPaper);
    draw();
    // eslint-disable-next-line @typescript-eslint/no-explicit-any
    chart.on("click", (event: any) => options.onPick?.(event.seriesIndex, event.dataIndex));
    // eslint-disable-next-line @typescript-eslint/no-explicit-any
    chart.on("mouseover", (event: any) => options.onHover?.(event.seriesIndex, event.dataIndex));
    chart.on("datazoom", placeCursor);
    placeCursor();
  };
  // Charts measure their place: they begin when they have one, and where there are many when they
  // come into sight.
  const isEager = ++charts <= mostEagerCharts;
  new ResizeObserver(() => {
    if (!plot.clientWidth) return;
    if (!chart && isEager) begin();
    else if (chart && width !== plot.clientWidth) {
      fit();
      chart.resize();
      draw();
    }
    placeCursor();
  }).observe(plot);
  if (!isEager) {
    new IntersectionObserver((entries) => entries[0].isIntersecting && begin(), { rootMargin: "300px" }).observe(plot);
    window.addEventListener("beforeprint", begin);
  }
  onTheme(draw);
  return {
    element,
    setCursor(x) {
      cursorAt = x;
      placeCursor();
    },
  };
}

/** What a screen reader says. */
function describe(options: ChartOptions): string {
  const parts = options.series.map((s) => {
    const known = s.y.filter((y): y is number => y !== null && Number.isFinite(y));
    if (!known.length) return s.name;
    let [low, high] = [known[0], known[0]];
    for (const y of known) [low, high] = [Math.min(low, y), Math.max(high, y)];
    return `${s.name} from ${number(low, 3)} to ${number(high, 3)}`;
  });
  return `${options.title} [${options.yTitle}] over ${options.xTitle}: ${parts.join("; ")}`;
}
