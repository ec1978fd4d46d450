// What is known of the member or joint that was clicked: its histories with limits and peaks.
import type { Companion, Meaning, Picture, Shown } from "../data";
import { h } from "../dom";
import { number, percent, placeText, seconds, withUnit, words } from "../format";
import type { Pick } from "../mechanism/player";
import { type HistoryChart, historyChart, limitsOn } from "./history";

export interface Inspector {
  element: HTMLElement;
  show(pick: Pick): void;
  setTime(time: number): void;
}

interface Quantity {
  name: string;
  meaning: Meaning;
  shown: { design: string; isMain: boolean; value: Shown }[];
}

/** @param onChoose  hears what is chosen from the list, which does what a click into the drawing does */
export function makeInspector(picture: Picture, main: number, goTo: (time: number) => void, onChoose: (pick: Pick) => void): Inspector {
  const known = h("div", { "aria-live": "polite" });
  const chooser = makeChooser(picture, onChoose);
  const element = h("aside.inspector", { "aria-label": "one member or joint" }, chooser.element, known);
  let charts: HistoryChart[] = [];
  let now = 0;

  const chartOf = (quantity: Quantity): HTMLElement => {
    const peak = (quantity.shown.find((one) => one.isMain) ?? quantity.shown[0]).value;
    const curves = quantity.shown.map(({ design, isMain, value }) => ({
      name: design,
      color: isMain ? "accent" : "start",
      width: isMain ? 1.8 : 1.2,
      shown: value,
    }));
    const chart = historyChart({ picture, name: quantity.name, meaning: quantity.meaning, curves, peak, height: 150 });
    chart.setTime(now);
    charts.push(chart);
    chart.element.append(peakLine(quantity, peak, goTo));
    return chart.element;
  };

  const show = (pick: Pick) => {
    charts = [];
    const drawn = quantitiesOf(picture, pick, main).map(chartOf);
    chooser.set(pick);
    known.replaceChildren(...heading(picture, pick, main), ...drawn.slice(0, 3));
    if (drawn.length > 3) {
      known.append(h("details", {}, h("summary.note", {}, `${drawn.length - 3} more`), ...drawn.slice(3)));
    }
    const isMoving = picture.designs.some((design) => design.responses);
    if (!charts.length && isMoving) known.append(h("p.note", {}, "No history belongs to it. Click another member or joint."));
  };
  return {
    element,
    show,
    setTime(time) {
      now = time;
      for (const chart of charts) chart.setTime(time);
    },
  };
}

/** The list of members and joints, for the keyboard and for readers of screens. */
function makeChooser(picture: Picture, onChoose: (pick: Pick) => void): { element: HTMLElement; set(pick: Pick): void } {
  const option = (value: string, name: string) => h("option", { value }, words(name));
  const select = h(
    "select",
    { "aria-label": "member or joint" },
    option("", "the whole mechanism"),
    h("optgroup", { label: "members" }, picture.scene.bodies.map((body, i) => option(`body ${i}`, body.name))),
    h("optgroup", { label: "joints" }, picture.scene.joints.map((joint, i) => option(`joint ${i}`, joint.name))),
  ) as HTMLSelectElement;
  select.addEventListener("change", () => {
    const [kind, index] = select.value.split(" ");
    onChoose({ body: kind === "body" ? Number(index) : null, joint: kind === "joint" ? Number(index) : null });
  });
  return {
    element: h("label.choice.chooser", {}, h("span.soft", {}, "shown"), select),
    set(pick) {
      select.value = pick.joint !== null ? `joint ${pick.joint}` : pick.body !== null ? `body ${pick.body}` : "";
    },
  };
}

function peakLine(quantity: Quantity, peak: Shown, goTo: (time: number) => void): HTMLElement {
  const several = quantity.shown.length > 1;
  const parts = quantity.shown.map((one) => `${several ? `${one.design} ` : ""}${withUnit(one.value.value, quantity.meaning.unit)}`);
  const line = h("p.note.peak", {}, parts.join(" → "));
  if (peak.peak_time !== undefined) {
    line.append(
      " · peak at ",
      h("button.link", { onclick: () => goTo(peak.peak_time!) }, seconds(peak.peak_time)),
      placeText(peak.peak_place) ? `, ${placeText(peak.peak_place)}` : "",
    );
  }
  return line;
}

function heading(picture: Picture, pick: Pick, main: number): HTMLElement[] {
  const { scene } = picture;
  if (pick.joint !== null) {
    const joint = scene.joints[pick.joint];
    return [
      h("h3", {}, words(joint.name)),
      h("p.note", {}, `${joint.type} joint of ${words(joint.bodies[0])} and ${words(joint.bodies[1])}: the second ${joint.freedom}`),
      ...(joint.drive ? [h("p.note", {}, h("span.dot", { style: "background:var(--drive)" }), `driven: its ${joint.drive} is prescribed`)] : []),
    ];
  }
  if (pick.body === null) {
    return [h("h3", {}, "The whole mechanism"), h("p.note", {}, "Click a member or a joint of the drawing to see what is known of it.")];
  }
  const body = scene.bodies[pick.body];
  const facts: (string | HTMLElement)[] = [];
  const masses = picture.designs.map((design) => design.masses?.[body.name]);
  const own = masses[main];
  if (own !== undefined) {
    const other = picture.designs.length === 2 ? masses[1 - main] : undefined;
    facts.push(
      other !== undefined && Math.abs(other - own) > 1e-9 * other
        ? `mass ${number(other)} → ${number(own)} kg (${percent(own / other - 1)})`
        : `mass ${number(own)} kg`,
    );
  }
  if (body.material) facts.push(body.material);
  const profile = profiles(picture, pick.body, main);
  return [
    h("h3", {}, words(body.name), h("span.soft", {}, body.type === "beam" ? (body.is_rigid ? " rigid beam" : " elastic beam") : ` ${body.type}`)),
    h("p.note", {}, facts.join(" · ")),
    ...(profile ? [profile] : []),
  ];
}

/** Sections of both designs to scale, one drawing a segment; none of a body without sections. */
export function profileSvgs(picture: Picture, body: number, main: number): SVGElement[] {
  const shown = picture.designs
    .map((design, i) => ({ segments: design.geometry.bodies[body].segments, isMain: i === main }))
    .filter((one) => one.segments);
  if (!shown.length || picture.designs.length > 2) return [];
  return shown[0].segments!.map((_, s) => {
    const size = Math.max(...shown.flatMap((one) => one.segments![s].outer.flat().map(Math.abs)));
    const scale = 30 / size;
    const path = (points: [number, number][]) =>
      points.length ? `M${points.map(([y, z]) => `${(z * scale).toFixed(2)},${(-y * scale).toFixed(2)}`).join("L")}Z` : "";
    const box = h("div", {});
    box.innerHTML = `<svg viewBox="-34 -34 68 68" width="72" height="72" role="img" aria-label="section">${shown
      .map(
        (one) =>
          `<path class="${one.isMain ? "profile-main" : "profile-start"}" fill-rule="evenodd" d="${path(one.segments![s].outer)}${path(one.segments![s].inner)}"/>`,
      )
      .join("")}</svg>`;
    return box.firstElementChild as SVGElement;
  });
}

/** The drawings with the sizes of the main design. */
export function profiles(picture: Picture, body: number, main: number): HTMLElement | null {
  const drawings = profileSvgs(picture, body, main);
  if (!drawings.length) return null;
  const segments = picture.designs[main].geometry.bodies[body].segments!;
  return h("div.profiles", {}, drawings.map((drawing, s) => h("div.profile", {}, drawing, h("span.note", {}, segments[s].text))));
}

function quantitiesOf(picture: Picture, pick: Pick, main: number): Quantity[] {
  const found = new Map<string, Quantity>();
  const body = pick.body === null ? null : picture.scene.bodies[pick.body].name;
  const joint = pick.joint === null ? null : picture.scene.joints[pick.joint].name;
  const belongs = (meaning: Meaning) => {
    if (joint !== null) return meaning.joint === joint;
    if (body !== null) return meaning.bodies.includes(body) || jointOf(picture, meaning.joint, body);
    return !meaning.joint && meaning.type !== "stress";
  };
  picture.designs.forEach((design, i) => {
    const add = (value: Shown, meaning: Meaning) => {
      if (!belongs(meaning) || !value.history) return;
      const known = found.get(value.name) ?? { name: value.name, meaning, shown: [] };
      known.shown.push({ design: design.name, isMain: i === main, value });
      found.set(value.name, known);
    };
    for (const response of design.responses ?? []) add(response, picture.responses[response.name]);
    for (const companion of design.companions ?? []) add(companion, companion as Companion);
  });
  const rank = (quantity: Quantity) => (limitsOn(picture, quantity.name).length ? 0 : quantity.meaning.joint ? 2 : 1);
  return [...found.values()].sort((a, b) => rank(a) - rank(b)).slice(0, 9);
}

/** Of a body also what its drive needs. */
function jointOf(picture: Picture, joint: string | undefined, body: string): boolean {
  if (!joint) return false;
  const found = picture.scene.joints.find((one) => one.name === joint);
  return !!found && !!found.drive && found.bodies.includes(body);
}
