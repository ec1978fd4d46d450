type Child = Node | string | number | null | undefined | false;

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

export interface Column {
  title: string;
  left?: boolean;
  short?: boolean; // a word or two: no broader than that on a narrow page
}

export function table(columns: Column[], rows: (Child | Child[])[][]): HTMLElement {
  const cell = (tag: string, i: number, ...content: (Child | Child[])[]) =>
    h(`${tag}${columns[i].left ? ".left" : ""}${columns[i].short ? ".short" : ""}`, {}, ...content);
  return h(
    "div.scroll",
    { tabindex: 0 },
    h(
      "table",
      {},
      h("thead", {}, h("tr", {}, columns.map((c, i) => cell("th", i, c.title)))),
      h("tbody", {}, rows.map((row) => h("tr", {}, row.map((content, i) => cell("td", i, content))))),
    ),
  );
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
