// What to build: all members with sections, sizes, masses; to copy, and as a design file.
import type { Document, ReportData } from "../data";
import { download, h, section, tableOf } from "../dom";
import { engineering, number, percent, withUnit, words } from "../format";
import { hasDesign } from "./headline";
import { profileSvgs } from "./inspector";
import { endName } from "./parts";

interface Member {
  name: string;
  index: number;
  sizes: { before: string; after: string }[]; // of each segment
  bounds: string[];
  length?: number;
  mass?: { before: number; after: number };
  material?: string;
}

/** Names of the variables that a part of the problem file asks for, alone or in formulas. */
function variablesIn(part: unknown, names: string[]): string[] {
  const text = JSON.stringify(part ?? null);
  return names.filter((name) => new RegExp(`(^|[^A-Za-z0-9_])${name.replace(/[^A-Za-z0-9_]/g, "\\$&")}([^A-Za-z0-9_]|$)`).test(text));
}

function members(data: ReportData): Member[] {
  const { picture, result, card } = data;
  if (!picture?.designs.length) return [];
  const [start, end] = [picture.designs[0], picture.designs[picture.designs.length - 1]];
  const variables: Record<string, Document> = result.variables ?? {};
  return picture.scene.bodies.flatMap((body, index): Member[] => {
    const [before, after] = [start, end].map((design) => design.geometry.bodies[index]);
    const own = variablesIn(card.problem?.scene?.bodies?.[body.name], Object.keys(variables));
    if (!after.segments && !own.length) return [];
    const mass = { before: start.masses?.[body.name], after: end.masses?.[body.name] };
    const chosen = own.flatMap((name) => (variables[name].choice ? [String(variables[name].choice)] : []));
    const sizes = (after.segments ?? []).map((segment, s) => ({ before: before.segments?.[s]?.text ?? "", after: segment.text }));
    return [
      {
        name: body.name,
        index,
        sizes: chosen.length ? [{ before: sizes.map((one) => one.before).join("; "), after: chosen.join(", ") }] : sizes,
        bounds: own.flatMap((name) => (variables[name].at_bound && !variables[name].choice ? [`${words(name)} at its ${variables[name].at_bound} bound`] : [])),
        length: after.length,
        mass: mass.before !== undefined && mass.after !== undefined ? { before: mass.before, after: mass.after } : undefined,
        material: body.material,
      },
    ];
  });
}

const metres = engineering("m");
const lengthText = (length: number | undefined) => (length === undefined ? "–" : withUnit(length, metres));

/** What other programs read from the clipboard: columns between tabs. */
function copied(all: Member[]): string {
  const rows = all.map((one) => [words(one.name), one.sizes.map((size) => size.after).join("; "), one.length === undefined ? "" : number(one.length / metres.factor), one.mass ? number(one.mass.after) : "", one.material ?? ""]);
  return [["member", "size", `length [${metres.name}]`, "mass [kg]", "material"], ...rows].map((row) => row.join("\t")).join("\n") + "\n";
}

/** As `--design` reads it. */
function designFile(result: Document): string {
  const variables = Object.entries(result.variables as Record<string, Document>).map(([name, one]) => [name, one.choice ?? { value: one.value, unit: one.unit }]);
  return JSON.stringify({ variables: Object.fromEntries(variables) }, null, 2) + "\n";
}

function massText(mass: Member["mass"], was: string): (HTMLElement | string)[] {
  if (!mass) return ["–"];
  if (Math.abs(mass.after - mass.before) <= 1e-9 * mass.before) return [`${number(mass.after)} kg`];
  return [h("b", {}, `${number(mass.after)} kg`), h("div.was", {}, `${was} ${number(mass.before)}, ${percent(mass.after / mass.before - 1)}`)];
}

/** @param title  of a comparison, which has no design to save */
export function buildSection(data: ReportData, title?: string): HTMLElement | null {
  const all = members(data);
  if (!all.length || (!title && !hasDesign(data.result))) return null;
  const { picture, result } = data;
  const was = title ? "first:" : "was";
  const isSize = (one: Member) => one.sizes.some((size) => size.after !== size.before);
  const copy = h("button.quiet.bordered", {}, "Copy") as HTMLButtonElement;
  copy.addEventListener("click", async () => {
    await navigator.clipboard?.writeText(copied(all));
    copy.textContent = "Copied";
  });
  const sizeText = (size: Member["sizes"][number], isNew: boolean) =>
    h("div", {}, isNew ? h("b", {}, size.after) : size.after, size.after !== size.before && size.before ? h("div.was", {}, `${was} ${size.before}`) : null);
  const part = section(
    title ?? (result.status === "verified" ? "Build this" : "The design"),
    title ? "The filled outline is the second, the grey one the first." : `All members of the ${endName(result)}; the filled outline is it, the grey one the start.`,
    tableOf(all, [
      { title: "section", left: true, short: true, cell: (one) => h("div.sketch", {}, profileSvgs(picture!, one.index, picture!.designs.length - 1)) },
      { title: "member", left: true, short: true, cell: (one) => h("b", {}, words(one.name)) },
      { title: "size", left: true, cell: (one) => (one.sizes.length ? one.sizes.map((size) => sizeText(size, isSize(one))) : "–") },
      all.some((one) => one.bounds.length) && { title: "", left: true, cell: (one) => one.bounds.length > 0 && h("span.bad", {}, one.bounds.join(", ")) },
      { title: "length", cell: (one) => lengthText(one.length) },
      { title: "mass", cell: (one) => massText(one.mass, was) },
      { title: "material", left: true, short: true, cell: (one) => one.material ?? "–" },
    ]),
    h("p.buttons.saves-design", {}, copy, title ? null : h("button.quiet.bordered", { title: "for pleuel simulate … --design design.json", onclick: () => download("design.json", designFile(result), "application/json") }, "Download design.json")),
  );
  part.classList.add("build");
  return part;
}
