// Pictures for a paper: as wide as one column or two, on white, at 300 dots an inch.
import { choice, download } from "./dom";

const pixelsPerMillimetre = 96 / 25.4; // as style sheets count
const dotsPerPixel = 300 / 96;
let millimetres = 170;

/** Of pictures that are saved [px of a style sheet]. */
export function paperWidth(): number {
  return Math.round(millimetres * pixelsPerMillimetre);
}

export function paperChoice(): HTMLElement {
  const widths = [["170", "170 mm"], ["85", "85 mm"]];
  const hint = "width of saved pictures: two columns of a paper, or one";
  return choice("save pictures at", widths, "170", (value) => (millimetres = Number(value)), hint);
}

/** What is drawn meanwhile has the colours of paper. */
export function inLight<Result>(work: () => Result): Result {
  const { dataset } = document.documentElement;
  const before = dataset.scheme;
  dataset.scheme = "light";
  try {
    return work();
  } finally {
    dataset.scheme = before;
  }
}

/** A drawing in pixels as a file that says how large it is on paper. */
export function sizedSvg(svg: SVGElement, width: number, height: number): string {
  svg.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("width", `${(width / pixelsPerMillimetre).toFixed(1)}mm`);
  svg.setAttribute("height", `${(height / pixelsPerMillimetre).toFixed(1)}mm`);
  return new XMLSerializer().serializeToString(svg);
}

export function savePng(svg: string, width: number, height: number, name: string): void {
  const image = new Image();
  image.onload = () => {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [Math.round(dotsPerPixel * width), Math.round(dotsPerPixel * height)];
    canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob((blob) => blob && download(`${name}.png`, blob));
  };
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
}
