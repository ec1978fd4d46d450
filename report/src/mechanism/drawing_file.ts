// The drawing as a file for a paper: with a title that says what is seen, and the colours of stress.
import { download } from "../dom";
import { inLight, paperWidth, savePng, sizedSvg } from "../paper";
import { color, stressStops } from "../theme";
import type { Stage } from "./stage";

const namespace = "http://www.w3.org/2000/svg";
const head = 26; // room for the title [px]
const foot = 26; // and for the colours
const ratio = 0.4;

function element(name: string, attributes: Record<string, string | number>, ...children: (SVGElement | string)[]): SVGElement {
  const made = document.createElementNS(namespace, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.append(...children);
  return made;
}

/** What the colours of stress mean, from none to `text`. */
function legend(text: string, y: number): SVGElement[] {
  const stops = stressStops().map((stop, i, all) => element("stop", { offset: i / (all.length - 1), "stop-color": stop }));
  const label = (x: number, words: string) => element("text", { x, y, "font-size": 11, fill: color("ink") }, words);
  return [
    element("defs", {}, element("linearGradient", { id: "stress" }, ...stops)),
    label(6, "0"),
    element("rect", { x: 18, y: y - 8, width: 110, height: 8, rx: 4, fill: "url(#stress)" }),
    label(134, text),
  ];
}

export function saveDrawing(stage: Stage, kind: "svg" | "png", file: string, title: string, colours: string | null): void {
  const width = paperWidth();
  const middle = Math.round(ratio * width);
  const height = head + middle + (colours ? foot : 0);
  const drawing = stage.svgPicture(width, middle);
  drawing.setAttribute("y", String(head));
  const font = getComputedStyle(document.documentElement).fontFamily.replace(/"/g, "'");
  const whole = inLight(() =>
    element(
      "svg",
      { "font-family": font },
      element("rect", { width, height, fill: color("card") }),
      element("text", { x: 6, y: 17, "font-size": 13, "font-weight": 600, fill: color("ink") }, title),
      drawing,
      ...(colours ? legend(colours, height - 9) : []),
    ),
  );
  const svg = sizedSvg(whole, width, height);
  if (kind === "svg") download(`${file}.svg`, svg, "image/svg+xml");
  else savePng(svg, width, height, file);
}
