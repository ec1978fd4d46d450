export type Child = Node | string | number | null | undefined | false;

/** An element: h("button.primary", {onclick}, "text"). */
export function h(
  tag: string,
  attributes: Record<string, unknown> = {},
  ...children: (Child | Child[])[]
): HTMLElement {
  const [name, ...classes] = tag.split(".");
  const element = document.createElement(name || "div");
  if (classes.length) element.className = classes.join(" ");
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value as EventListener);
    else if (key === "style") element.setAttribute("style", String(value));
    else element.setAttribute(key, value === true ? "" : String(value));
  }
  for (const child of children.flat()) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child instanceof Node ? child : String(child));
  }
  return element;
}

/** A part of the page with a heading. */
export function section(title: string, note: string, ...children: (Child | Child[])[]): HTMLElement {
  const id = title.toLowerCase().replace(/[^a-z0-9]+/g, "-");
  return h(
    "section.card",
    { "aria-labelledby": id },
    h("header", {}, h("h2", { id }, title), note ? h("p.note", {}, note) : null),
    ...children,
  );
}

/** What a page begins with: what it is of and its verdict, and some numbers beside that. */
export function heroOf(story: (Child | Child[])[], facts: Child[] = []): HTMLElement {
  return h("section.hero", {}, h("div", {}, ...story), facts.length ? h("div.facts", {}, facts) : null);
}

/** A row of a list of changes: blue what grows smaller, orange what grows larger. */
export function bar(name: string, numbers: Child[], change: number, largest: number, value: Child): HTMLElement {
  const width = (100 * Math.min(Math.abs(change), largest)) / largest;
  return h(
    "li",
    {},
    h("span.bar-name", {}, name),
    h("span.bar-numbers", {}, numbers),
    h("span.bar-track", {}, change === 0 ? null : h(change < 0 ? "span.bar.is-less" : "span.bar.is-more", { style: `width:${width}%` })),
    h("span.bar-value", {}, value),
  );
}

/** Parts of a page; those of which a run knows nothing are null. */
export type Page = (HTMLElement | null)[];

export interface Column<Row> {
  title: string;
  cell(row: Row, index: number): Child | Child[];
  left?: boolean;
  short?: boolean; // a word or two: no broader than that on a narrow page
}

/** @param columns  those that are false are left out */
export function tableOf<Row>(rows: Row[], columns: (Column<Row> | false)[]): HTMLElement {
  const shown = columns.filter((column) => column !== false);
  const tag = (name: string, { left, short }: Column<Row>) => `${name}${left ? ".left" : ""}${short ? ".short" : ""}`;
  return h(
    "div.scroll",
    { tabindex: 0 },
    h(
      "table",
      {},
      h("thead", {}, h("tr", {}, shown.map((column) => h(tag("th", column), {}, column.title)))),
      h("tbody", {}, rows.map((row, i) => h("tr", {}, shown.map((column) => h(tag("td", column), {}, column.cell(row, i)))))),
    ),
  );
}

/**
 * A list to choose from, behind its name.
 * @param options  of each its value and what people read
 * @param hint  where the name alone does not say what is chosen
 */
export function choice(label: string, options: string[][], chosen: string, onChange: (value: string) => void, hint = label): HTMLElement {
  const select = h(
    "select",
    { "aria-label": hint, title: hint },
    options.map(([value, text]) => h("option", { value, selected: value === chosen }, text)),
  ) as HTMLSelectElement;
  select.addEventListener("change", () => onChange(select.value));
  return h("label.choice", {}, h("span.soft", {}, label), select);
}

/** A list, and what is drawn of the value that is chosen: at first of the first one. */
export function chosenView(label: string, options: string[][], draw: (value: string) => HTMLElement[]): HTMLElement[] {
  const place = h("div", {});
  const show = (value: string) => place.replaceChildren(...draw(value));
  const first = options[0][0];
  const list = choice(label, options, first, show);
  list.classList.add("bordered");
  show(first);
  return [list, place];
}

/**
 * A table of cells whose colours say how large they are.
 * @param label  what it is, for readers of screens
 * @param corner  what the names of the rows are
 */
export function paintedMatrix(label: string, corner: string, columns: Child[][], rows: PaintedRow[]): HTMLElement {
  const paint = ({ tone, percent }: PaintedCell) => percent > 0 && `background:color-mix(in srgb, var(--${tone}) ${percent}%, transparent)`;
  const cellOf = (cell: PaintedCell) => h("td", { title: cell.title, style: paint(cell) }, cell.content);
  return h(
    "div.scroll",
    { tabindex: 0, role: "region", "aria-label": label },
    h(
      "table.matrix",
      {},
      h("thead", {}, h("tr", {}, h("th.left", { scope: "col" }, corner), columns.map((title) => h("th", { scope: "col" }, title)))),
      h("tbody", {}, rows.map(({ head, cells }) => h("tr", {}, h("th.left", { scope: "row" }, head), cells.map(cellOf)))),
    ),
  );
}

export interface PaintedCell {
  content: Child;
  tone: string; // name of a colour of the style sheet
  percent: number; // of that colour
  title?: string;
}

export interface PaintedRow {
  head: Child;
  cells: PaintedCell[];
}

export function details(title: string, ...children: (Child | Child[])[]): HTMLElement {
  return h("details.card", {}, h("summary", {}, title), ...children);
}

export function download(name: string, content: Blob | string, type = "text/plain"): void {
  const blob = typeof content === "string" ? new Blob([content], { type }) : content;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 2000);
}
