// Of one simulation, and of a mechanism that is only drawn.
import { lineChart } from "../charts";
import { curveOf, type Document, type Packed, type Picture, type ReportData, type SceneBody, type SceneLoad } from "../data";
import { h, heroOf, type Page, section, tableOf } from "../dom";
import { count, engineering, number, seconds, share, timeUnit, withUnit, words } from "../format";
import { historyChart } from "./history";
import { profiles } from "./inspector";
import { type Viewing, viewing } from "./viewing";
import { effectsSection, fact, filesSection, monitorsText, responsesTable, unitOfLimit, withoutRoundOff } from "./parts";
import { warningsBox } from "./warnings";

export function simulatePage(data: ReportData): Page {
  const { picture, result } = data;
  const parts: Page = [
    heroOf(
      [h("p.eyebrow", {}, "simulation"), h("h1", {}, picture?.name ?? ""), h("p.lead", {}, picture?.description ?? ""), limitsSentence(result), warningsBox(result.warnings)],
      [
        fact(seconds(picture?.scene.end_time ?? 0), "simulated time"),
        fact(count(result.steps), "steps"),
        fact(count(result.coordinates), "coordinates"),
        fact(seconds(result.seconds), "to simulate"),
      ],
    ),
  ];
  let shown: Viewing | null = null;
  if (picture?.designs.length) {
    shown = viewing(picture, 0);
    shown.pickBody(undefined);
    parts.push(shown.element);
  }
  parts.push(section("Numbers", monitorsText(result), responsesTable(data), limitsTable(data)));
  if (picture?.designs[0]?.responses) parts.push(historiesSection(picture, shown));
  parts.push(effectsSection(data), filesSection(data));
  return parts;
}

function limitsSentence(result: Document): HTMLElement | null {
  const limits = Object.entries((result.constraints ?? {}) as Record<string, Document>);
  if (!limits.length) return null;
  const broken = limits.filter(([, one]) => !one.kept);
  const of = limits.length === 1 ? "the limit is" : `${broken.length} of ${limits.length} limits`;
  const named = ([name, one]: [string, Document]) => words(name) + (one.within_error ? " (within its error)" : "");
  return broken.length
    ? h("p.verdict", {}, h("span.badge.warn", {}, `! ${of} broken`), ` ${broken.map(named).join(", ")}`)
    : h("p.verdict", {}, h("span.badge.good", {}, limits.length === 1 ? "✓ the limit holds" : `✓ all ${limits.length} limits hold`));
}

function limitsTable(data: ReportData): HTMLElement | null {
  const limits = Object.entries((data.result.constraints ?? {}) as Record<string, Document>);
  if (!limits.length) return null;
  const { picture } = data;
  const unit = (name: string, one: Document) => unitOfLimit(picture, name, one.unit);
  const shown = (name: string, one: Document) => withoutRoundOff(picture, picture?.limits[name]?.response ?? "", one.value, one.unit);
  const used = (one: Document) => (one.utilisation !== undefined ? share(one.utilisation) : one.kept ? "–" : "broken");
  return h(
    "div",
    {},
    h("h3", {}, "Limits"),
    tableOf(limits, [
      { title: "limit", left: true, cell: ([name]) => words(name) },
      { title: "value", cell: ([name, one]) => withUnit(shown(name, one), unit(name, one)) },
      { title: "limit", cell: ([name, one]) => `${one.side === "lower" ? "≥" : "≤"} ${withUnit(one.limit, unit(name, one))}` },
      { title: "used", cell: ([, one]) => h(one.kept ? "span" : "span.bad", {}, used(one)) },
    ]),
  );
}

/** Of mechanisms with many joints the forces in them are shown one by one. */
const mostCharts = 24;

export function historiesSection(picture: Picture, shown: Viewing | null): HTMLElement | null {
  const design = picture.designs[0];
  const all = [
    ...(design.responses ?? []).map((one) => ({ one, meaning: picture.responses[one.name] })),
    ...(design.companions ?? []).map((one) => ({ one, meaning: one })),
  ].filter(({ one }) => one.history);
  if (!all.length) return null;
  const hasMany = all.length > mostCharts;
  const drawn = hasMany ? all.filter(({ meaning }) => meaning.type !== "reaction-force") : all;
  const charts = drawn.map(({ one, meaning }) => {
    const curves = [{ name: words(one.name), color: "accent", shown: one }];
    const chart = historyChart({ picture, name: one.name, meaning, curves, peak: one, height: 180 });
    shown?.player.onTime(chart.setTime);
    return chart.element;
  });
  const note = hasMany
    ? "Responses of the file, then drives and energies. Click a joint in the drawing for the force in it."
    : "Responses of the file, then what else is known: drives, joints, energies.";
  return section("Histories", note, h("div.grid", {}, charts));
}

/** `pleuel show`: as the file places it. */
export function showPage(data: ReportData): Page {
  const { picture, result } = data;
  if (!picture) return [];
  const { scene } = picture;
  const unheld: string[] = result.unheld_bodies ?? [];
  const shown = viewing(picture, 0, true, true, unheld);
  const time: number | undefined = result.seconds?.simulate;
  const parts: Page = [
    heroOf(
      [
        h("p.eyebrow", {}, "drawn before anything is simulated"),
        h("h1", {}, picture.name),
        h("p.lead", {}, picture.description),
        goalSentence(picture),
        result.failure ? h("p.verdict", {}, h("span.badge.warn", {}, "! cannot be assembled")) : null,
        result.lock
          ? h("p.verdict", {}, h("span.badge.warn", {}, `locks at ${seconds(result.lock.time)}`), " Rigid bodies follow the drives as far as that; the drawing stops there.")
          : freedomSentence(result),
        warningsBox(result.warnings),
      ],
      [
        fact(String(scene.bodies.length), "bodies"),
        fact(String(scene.joints.length), "joints"),
        fact(count(result.steps), "steps"),
        fact(count(result.coordinates), "coordinates"),
        time !== undefined ? fact(`≈ ${roughly(time)}`, "a simulation will take", "measured with its first steps") : null,
      ],
    ),
    shown.element,
    h("div.columns", {}, asked(picture), variablesTable(picture)),
    bodiesSection(picture, result, unheld),
    section(
      "Joints",
      "",
      tableOf(scene.joints, [
        { title: "joint", left: true, cell: (joint) => words(joint.name) },
        { title: "kind", left: true, cell: (joint) => joint.type },
        { title: "of", left: true, cell: (joint) => bodyPair(joint.bodies, unheld) },
        { title: "free in space", left: true, cell: (joint) => (joint.freedoms === undefined ? "" : `${joint.freedoms} of 6`) },
        { title: "the second body", left: true, cell: (joint) => joint.freedom },
        { title: "drive", left: true, cell: (joint) => (joint.drive ? h("span.drive-text", {}, `${joint.drive} prescribed`) : "–") },
      ]),
    ),
    loadsTable(picture),
    lawsSection(picture),
    effectsSection(data),
    filesSection(data),
  ];
  shown.pickBody(undefined);
  return parts;
}

/** Whether the drives prescribe the motion. */
function freedomSentence(result: Document): HTMLElement | null {
  if (result.rigid_motion?.free === undefined) return null;
  const { free, coordinates, constraints, drives, blocked_drives: blocked = 0 } = result.rigid_motion;
  const badge = blocked > 0 ? "blocked" : free > 0 ? `${free} free` : "no freedom left";
  const meaning =
    blocked > 0
      ? "no rigid motion follows the drives."
      : free > 0
        ? `${free} freedom${free > 1 ? "s are" : " is"} left to the forces. Is that meant?`
        : drives > 0
          ? "the drives prescribe the motion."
          : "nothing can move.";
  return h(
    "p.verdict",
    {},
    h(`span.badge.${free > 0 || blocked > 0 ? "warn" : "good"}`, {}, badge),
    ` ${coordinates} coordinates of rigid motion, ${constraints} independent constraints, ${drives} of them of drives: ${meaning}`,
  );
}

/** What the file asks for, in a sentence. */
function goalSentence(picture: Picture): HTMLElement | null {
  if (!picture.objective) return null;
  const counted = (size: number, name: string) => `${size} ${name}${size === 1 ? "" : "s"}`;
  const limits = Object.keys(picture.limits).length;
  return h(
    "p.numbers",
    {},
    `${picture.maximizes ? "Maximize" : "Minimize"} `,
    h("b", {}, words(picture.objective)),
    ` by ${counted(Object.keys(picture.variables).length, "variable")}${limits ? ` under ${counted(limits, "limit")}` : ""}.`,
  );
}

/** The limits of the file. */
function asked(picture: Picture): HTMLElement | null {
  const limits = Object.entries(picture.limits);
  if (!limits.length) return null;
  const allowed = ({ lower, upper, unit }: Picture["limits"][string]) => [lower === undefined ? "" : `≥ ${withUnit(lower, unit)}`, upper === undefined ? "" : `≤ ${withUnit(upper, unit)}`];
  return section(
    "Limits",
    "",
    tableOf(limits, [
      { title: "limit", left: true, cell: ([name]) => words(name) },
      { title: "of", left: true, cell: ([, { response }]) => (response ? words(response) : "variables") },
      { title: "allowed", cell: ([, limit]) => allowed(limit).filter(Boolean).join(", ") },
    ]),
  );
}

/** Two digits: more is not known before. */
function roughly(time: number): string {
  if (time < 1) return `${Number((1000 * time).toPrecision(2))} ms`;
  return time < 120 ? `${Number(time.toPrecision(2))} s` : `${Number((time / 60).toPrecision(2))} min`;
}

function bodyPair(bodies: string[], unheld: string[]): HTMLElement {
  return h("span", {}, bodies.flatMap((body, i) => [i ? " – " : "", unheld.includes(body) ? h("span.bad", {}, words(body)) : words(body)]));
}

const loadKinds: Record<string, string> = { force: "force", torque: "torque", spring: "spring", "joint-force": "in a joint" };

function loadsTable(picture: Picture): HTMLElement | null {
  const { scene, designs } = picture;
  if (!scene.loads.length) return null;
  const range = (law: Packed, unit: string) => {
    const { y } = curveOf(law);
    const [low, high] = [Math.min(...y), Math.max(...y)];
    const text = low === high ? number(high) : `${number(low)} … ${number(high)}`;
    return `${text} ${unit}`;
  };
  const size = (load: SceneLoad, l: number) => {
    const { value, text } = designs[0].geometry.loads[l];
    return [text ?? "", value ? range(value, load.unit ?? "") : ""].filter(Boolean).join(", ");
  };
  return section(
    "Loads",
    "",
    tableOf(scene.loads, [
      { title: "load", left: true, cell: (load) => words(load.name) },
      { title: "kind", left: true, cell: (load) => `${loadKinds[load.type]}${load.follows_body ? ", turns with the body" : ""}` },
      { title: "on", left: true, cell: (load) => (load.joint ? `the joint ${words(load.joint)}` : (load.bodies ?? []).map(words).join(" – ")) },
      { title: "from the start to the end", left: true, cell: (load, l) => size(load, l) || "–" },
    ]),
  );
}

function lawsSection(picture: Picture): HTMLElement | null {
  const unit = timeUnit(picture.scene.end_time);
  const { geometry } = picture.designs[0];
  const charts: HTMLElement[] = [];
  const add = (title: string, yTitle: string, color: string, curve: { x: number[]; y: number[] }) =>
    charts.push(lineChart({ title, yTitle, xTitle: `time [${unit.name}]`, height: 160, series: [{ name: title, color, ...curve }] }).element);
  picture.scene.joints.forEach((joint, j) => {
    const law = geometry.joints[j].drive;
    if (!law) return;
    const isAngle = joint.drive === "angle";
    add(`drive of ${words(joint.name)}`, isAngle ? "°" : "mm", "drive", curveOf(law, unit.factor, isAngle ? Math.PI / 180 : 1e-3));
  });
  picture.scene.loads.forEach((load, l) => {
    const law = geometry.loads[l].value;
    if (law) add(words(load.name), load.unit ?? "", "load", curveOf(law, unit.factor));
  });
  return charts.length ? section("Drives and loads over time", "", h("div.grid", {}, charts)) : null;
}

/** How an elastic body starts that does not start straight and at rest; it is drawn straight. */
function startText(body: SceneBody): string {
  const start = body.starts_bent;
  if (!start) return "";
  const bent = start.displacement ? [`bent by ${withUnit(start.displacement, engineering("m"), 3)}`] : [];
  const moving = start.rate ? [`moving at ${withUnit(start.rate, engineering("m/s"), 3)}`] : [];
  return [...bent, ...moving].length ? `; starts ${[...bent, ...moving].join(", ")}` : "";
}

export function bodiesSection(picture: Picture, result: Document, unheld: string[]): HTMLElement {
  const { scene } = picture;
  const known = (body: SceneBody) => (result.bodies ?? []).find((one: Document) => one.name === body.name) ?? {};
  return section(
    "Bodies",
    "Axes in the drawing: x red along the beam, y green, z blue. Sections are drawn with y up and z to the right." +
      (scene.bodies.some((body) => startText(body)) ? " What starts bent is drawn straight: a simulation shows its start." : ""),
    tableOf(scene.bodies, [
      { title: "body", left: true, cell: ({ name }) => (unheld.includes(name) ? h("span.bad", { title: "nothing holds or moves it" }, `${words(name)}: free`) : words(name)) },
      { title: "kind", left: true, cell: (body) => `${body.is_rigid ? "rigid " : ""}${body.type}${body.material ? `, ${body.material}` : ""}${startText(body)}` },
      { title: "section", left: true, cell: (_, i) => profiles(picture, i, 0) ?? "–" },
      { title: "mass [kg]", cell: (body) => number(known(body).mass) },
      { title: "coordinates", cell: (body) => count(known(body).coordinates) },
    ]),
  );
}

export function variablesTable(picture: Picture): HTMLElement | null {
  const variables = Object.entries(picture.variables);
  if (!variables.length) return null;
  return section(
    "Design variables",
    "",
    tableOf(variables, [
      { title: "variable", left: true, cell: ([name]) => words(name) },
      { title: "start", cell: ([, { start, unit }]) => number(start / unit.factor) },
      { title: "lower", cell: ([, { lower, unit }]) => number(lower / unit.factor) },
      { title: "upper", cell: ([, { upper, unit }]) => number(upper / unit.factor) },
      { title: "unit", left: true, cell: ([, { unit }]) => unit.name },
    ]),
  );
}
