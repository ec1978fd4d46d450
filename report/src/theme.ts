import { h } from "./dom";

export type Scheme = "light" | "dark";

const listeners = new Set<() => void>();
const system = window.matchMedia("(prefers-color-scheme: dark)");
const printing = window.matchMedia("print");
let chosen: Scheme | null = null;

export function scheme(): Scheme {
  if (printing.matches) return "light";
  return chosen ?? (system.matches ? "dark" : "light");
}

/** A colour of the style sheet. */
export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Calls again whenever the colours change, until the returned function is called. */
export function onTheme(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

function apply(): void {
  document.documentElement.dataset.scheme = scheme();
  for (const listener of listeners) listener();
}

export function startTheme(): void {
  system.addEventListener("change", apply);
  printing.addEventListener("change", apply);
  apply();
}

export function themeButton(): HTMLElement {
  return h(
    "button.quiet",
    {
      "aria-label": "light or dark",
      title: "light or dark",
      onclick: () => {
        chosen = scheme() === "dark" ? "light" : "dark";
        apply();
      },
    },
    "◐",
  );
}

/** Stops of the colours of stress, from none to the limit; [r, g, b] of 0 … 1. */
const stops: [number, number, number][] = [
  [0.27, 0.46, 0.71],
  [0.43, 0.68, 0.77],
  [0.71, 0.83, 0.72],
  [0.96, 0.84, 0.47],
  [0.94, 0.55, 0.26],
  [0.76, 0.16, 0.18],
];

export function stressColor(share: number): [number, number, number] {
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(place), stops.length - 2);
  const f = place - i;
  return [0, 1, 2].map((k) => stops[i][k] + f * (stops[i + 1][k] - stops[i][k])) as [number, number, number];
}

export function stressStops(): string[] {
  return stops.map((s) => `rgb(${s.map((c) => Math.round(255 * c)).join(",")})`);
}

export function stressGradient(): string {
  return `linear-gradient(90deg, ${stressStops().join(", ")})`;
}
