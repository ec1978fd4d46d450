// Of a check: what will be built, whether the derivatives can be trusted, how long things take.
import { lineChart } from "../charts";
import type { Document, ReportData } from "../data";
import { chosenView, h, type Page, section, tableOf } from "../dom";
import { count, number, seconds, withUnit, words } from "../format";
import { influenceSection } from "./influence";
import { viewing } from "./viewing";
import { effectsSection, fact, filesSection, unitOf } from "./parts";
import { bodiesSection, variablesTable } from "./simulate";
import { hero } from "./studies";

const verdictNames: Record<string, string> = {
  agrees: "agrees",
  noise: "differences drown in noise",
  kink: "at a kink",
  differs: "differs",
};

function verdictCell(derivatives: Document | undefined): HTMLElement | string {
  if (!derivatives) return "–";
  const tone = derivatives.verdict === "agrees" ? "span.good-text" : derivatives.verdict === "differs" ? "span.bad" : "span.more";
  return h(tone, {}, verdictNames[derivatives.verdict] ?? derivatives.verdict);
}

function responsesSection(data: ReportData): HTMLElement | null {
  const responses = Object.entries((data.result.responses ?? {}) as Record<string, Document>);
  if (!responses.length) return null;
  const hasDerivatives = responses.some(([, one]) => one.derivatives);
  return section(
    "Responses and their derivatives",
    hasDerivatives ? "Direct differentiation against central differences and against the adjoint; digits that an optimizer may expect of value and gradient." : "",
    tableOf(responses, [
      { title: "response", left: true, cell: ([name]) => words(name) },
      { title: "value", cell: ([name, one]) => withUnit(one.value, unitOf(data.picture, name, one.unit)) },
      hasDerivatives && { title: "derivatives", left: true, cell: ([, one]) => verdictCell(one.derivatives) },
      hasDerivatives && { title: "to", cell: ([, one]) => number(one.derivatives?.error, 2) },
      hasDerivatives && { title: "adjoint", cell: ([, one]) => number(one.derivatives?.adjoint_error, 2) },
      hasDerivatives && { title: "noise", cell: ([, one]) => number(one.derivatives?.noise, 2) },
      hasDerivatives && { title: "digits", cell: ([, one]) => digitsText(one.derivatives) },
    ]),
  );
}

/** Of value and gradient. */
function digitsText(derivatives: Document | undefined): string {
  return derivatives ? `${derivatives.digits.value} / ${derivatives.digits.gradient}` : "–";
}

/** "rod_width", or "rod_width and 3 others" */
function variablesOf(data: ReportData, direction: number): string {
  const [first, ...others] = Object.keys(data.result.directions[direction]).map(words);
  return others.length ? `${first} and ${others.length} other${others.length > 1 ? "s" : ""}` : first;
}

const colors = ["accent", "more", "good", "drive", "limit", "soft", "load", "start"];
const smallest = 1e-17;

/** Error of central differences over their step, a curve a direction. */
function curvesSection(data: ReportData): HTMLElement | null {
  const responses = Object.entries((data.result.responses ?? {}) as Record<string, Document>).filter(([, one]) => one.derivatives?.directions);
  const withCurves = responses.filter(([, one]) => (one.derivatives.directions as Document[]).some((v) => v.curve?.length > 1));
  if (!withCurves.length) return null;
  const draw = (name: string) => {
    const directions = (withCurves.find(([one]) => one === name)![1].derivatives.directions as Document[]).slice(0, colors.length);
    const chart = lineChart({
      title: `differences of ${words(name)}`,
      xTitle: "relative step",
      yTitle: "relative error",
      height: 280,
      logX: true,
      logY: true,
      legend: true,
      series: directions.map((one, i) => {
        const curve = [...one.curve].sort((a: Document, b: Document) => a.step - b.step);
        return { name: variablesOf(data, i), x: curve.map((p: Document) => p.step), y: curve.map((p: Document) => Math.max(p.error, smallest)), color: colors[i], dots: true };
      }),
    });
    return [chart.element];
  };
  return section(
    "Differences over their step",
    "Where differences agree with the gradient at some step, the gradient is right: to the right of it curvature is seen, to the left noise.",
    chosenView("response", withCurves.map(([name]) => [name, words(name)]), draw),
  );
}

export function checkPage(data: ReportData): Page {
  const { result, picture } = data;
  const derivatives = Object.values((result.responses ?? {}) as Record<string, Document>).map((one) => one.derivatives).filter(Boolean);
  const differs = derivatives.filter((one) => one.verdict === "differs").length;
  const free: number = result.rigid_motion?.free ?? 0;
  const blocked: number = result.rigid_motion?.blocked_drives ?? 0;
  const lead = [
    blocked > 0 ? "No rigid motion follows the drives." : result.rigid_motion ? (free > 0 ? `${free} freedom${free > 1 ? "s are" : " is"} left to the forces.` : "The drives prescribe the rigid motion.") : "",
    derivatives.length ? (differs ? `The derivatives of ${differs} responses differ.` : "No derivative differs.") : "",
  ].join(" ");
  const times = result.seconds ?? {};
  const shown = picture?.designs.length ? viewing(picture, 0, true, true) : null;
  shown?.pickBody(undefined);
  return [
    hero(data, lead, [
      fact(count(result.steps), "steps"),
      fact(count(result.coordinates), "coordinates"),
      ...(times.simulate !== undefined ? [fact(seconds(times.simulate), "one simulation")] : []),
      ...(times.direct !== undefined ? [fact(seconds(times.direct), "its gradients")] : []),
    ]),
    shown?.element ?? null,
    responsesSection(data),
    influenceSection(picture, 0, shown),
    curvesSection(data),
    picture ? bodiesSection(picture, result, []) : null,
    picture ? variablesTable(picture) : null,
    effectsSection(data),
    filesSection(data),
  ];
}
