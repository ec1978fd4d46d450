// The moving drawing with its controls, and the clock that charts follow.
import type { Design, Picture } from "../data";
import { choice, h } from "../dom";
import { number, seconds, words } from "../format";
import { onTheme, stressGradient } from "../theme";
import { saveDrawing } from "./drawing_file";
import { Stage } from "./stage";

export interface Pick {
  body: number | null;
  joint: number | null;
}

export interface PlayerOptions {
  picture: Picture;
  main: number;
  showsNames?: boolean;
  showsAxes?: boolean;
  unheld?: string[]; // names of bodies that nothing holds or moves
  onPick(pick: Pick): void;
}

export interface Player {
  element: HTMLElement;
  /** Shows an instant and stops there. */
  goTo(time: number): void;
  select(body: number | null): void;
  onTime(listener: (time: number) => void): void;
  /** Ends it: another one takes its place. */
  dispose(): void;
  state(): { time: number; isPlaying: boolean; scale: number };
  stage: Stage | null;
}

const scales = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const largestDefault = 100;
/** Of the mechanism, that deformation is enlarged to. */
const shownDeformation = 0.05;
const secondsOfLoop = 8;

/** Whether stress of a body, or of any, can be drawn. */
function hasStress(design: Design, body: number): boolean {
  const motion = design.motion?.bodies[body];
  return !!motion?.stress || (!!motion?.coordinates && !!design.geometry.bodies[body].surface);
}
const hasAnyStress = (design: Design) => design.geometry.bodies.some((_, i) => hasStress(design, i));

/** Largest stress that colours reach: the limit of the body, else its strength, else what it sees. */
function stressLimits(picture: Picture, main: number): (number | null)[] {
  return picture.scene.bodies.map((body, i) => {
    if (body.stress_limit) return body.stress_limit;
    if (!hasStress(picture.designs[main], i)) return null;
    if (body.strength) return body.strength;
    return null;
  });
}

export function makePlayer(options: PlayerOptions): Player {
  const { picture } = options;
  const end = picture.scene.end_time;
  const isMoving = picture.designs.some((design) => design.motion);
  const isColoured = picture.designs.some(hasAnyStress);
  const listeners: ((time: number) => void)[] = [];
  const host = h("div.stage", {
    tabindex: 0,
    role: "group",
    "aria-label": `The mechanism ${picture.name}${isMoving ? " in motion; space plays, arrows go from frame to frame" : ""}`,
  });
  let stage: Stage | null = null;
  try {
    stage = new Stage(host, {
      scene: picture.scene,
      designs: picture.designs,
      main: options.main,
      limits: stressLimits(picture, options.main),
      showsAxes: !!options.showsAxes,
      unheld: (options.unheld ?? []).map((name) => picture.scene.bodies.findIndex((body) => body.name === name)),
      onPick: (body, joint) => options.onPick({ body, joint }),
    });
  } catch {
    host.append(h("p.no-drawing", {}, "No drawing: this browser has no WebGL, or it is switched off. Everything else on this page works."));
  }
  let time = 0;
  let isPlaying = false;
  let speed = 1;
  let scale = isMoving && stage ? usefulScale(stage) : 1;
  let isVisible = true;
  let last = 0;

  const clock = h("output.clock", { "aria-live": "off" });
  const slider = h("input", {
    type: "range", min: 0, max: 1000, step: 1, value: 0, "aria-label": "time",
  }) as HTMLInputElement;
  const factor = h("p.note.on-paper", {}); // where there is no list to choose it from
  const playButton = h("button.play", { "aria-label": "play or stop (space)", title: "play or stop (space)" }, "▶");

  const show = () => {
    stage?.show(time, scale);
    slider.value = String(Math.round((1000 * time) / end));
    factor.textContent = `deformation × ${scale}`;
    clock.textContent = `${seconds(time)} / ${seconds(end)}`;
    for (const listener of listeners) listener(time);
  };
  const setPlaying = (value: boolean) => {
    if (value === isPlaying) return;
    isPlaying = value;
    playButton.textContent = value ? "❚❚" : "▶";
    playButton.classList.toggle("is-playing", value);
    last = 0;
    if (value) requestAnimationFrame(tick);
  };
  const tick = (now: number) => {
    if (!isPlaying) return;
    const passed = last ? Math.min(now - last, 200) / 1000 : 0;
    last = now;
    if (isVisible) {
      time = (time + (passed * speed * end) / secondsOfLoop) % end;
      show();
    }
    requestAnimationFrame(tick);
  };
  const goTo = (instant: number) => {
    setPlaying(false);
    time = Math.min(Math.max(instant, 0), end);
    show();
  };
  playButton.addEventListener("click", () => setPlaying(!isPlaying));
  slider.addEventListener("input", () => goTo((Number(slider.value) / 1000) * end));
  new IntersectionObserver((entries) => (isVisible = entries[0].isIntersecting)).observe(host);

  const life = new AbortController();
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (!isMoving || /^(INPUT|SELECT|TEXTAREA|SUMMARY)$/.test(target.tagName)) return;
    if (target.tagName === "BUTTON" && event.key === " ") return;
    const step = (event.shiftKey ? 20 : 1) * (end / 400);
    if (event.key === " ") setPlaying(!isPlaying);
    else if (event.key === "ArrowRight") goTo(time + step);
    else if (event.key === "ArrowLeft") goTo(time - step);
    else if (event.key === "Home") goTo(0);
    else return;
    event.preventDefault();
  }, { signal: life.signal });

  const element = h("div.player", {}, host);
  if (stage) {
    stage.setToolbar(toolbar(stage));
    if (options.showsNames !== undefined) addNames(stage, options.showsNames);
  }
  if (isMoving) {
    element.append(
      h(
        "div.controls",
        {},
        playButton,
        slider,
        clock,
        choice("speed", speeds(end), "1", (value) => (speed = Number(value))),
        isColoured && choice(
          "deformation",
          scales.map((s) => [String(s), `× ${s}`]),
          String(scale),
          (value) => {
            scale = Number(value);
            show();
          },
        ),
      ),
    );
  }

  /** Buttons that lie over the drawing. */
  function toolbar(shown: Stage): HTMLElement {
    const corner = h("div.corner", {});
    if (picture.designs.length === 2 && isMoving) {
      const names = picture.designs.map((design) => design.name);
      corner.append(
        choice("show", [["both", "both designs"], ["1", `${names[1]} only`], ["0", `${names[0]} only`]], "both", (value) => {
          shown.setVisible(value === "both" ? [true, true] : [value === "0", value === "1"]);
          show();
        }),
      );
    }
    if (isColoured) {
      corner.append(
        choice("colour", [["stress", "stress"], ["plain", "plain"]], "stress", (value) => {
          shown.setStressShown(value === "stress");
          show();
        }),
      );
    }
    if (shown.view.isPlanar) {
      let isTurned = false;
      corner.append(
        h("button.quiet", {
          title: "turn freely, or back into the plane",
          onclick: (event: Event) => {
            isTurned = !isTurned;
            shown.setRotatable(isTurned);
            (event.target as HTMLElement).setAttribute("aria-pressed", String(isTurned));
          },
        }, "3D"),
      );
    }
    corner.append(h("button.quiet", { title: "the whole mechanism again", onclick: () => shown.resetCamera() }, "⌂"));
    corner.append(drawingButton(shown, "svg"), drawingButton(shown, "png"));
    if (isMoving && "MediaRecorder" in window) corner.append(recordButton(shown));
    return corner;
  }

  function drawingButton(shown: Stage, kind: "svg" | "png"): HTMLElement {
    const save = () => {
      const what = isMoving ? `${words(picture.name)} at ${seconds(time)}${isColoured ? `, deformation × ${scale}` : ""}` : words(picture.name);
      const colours = legendText(picture, options.main);
      saveDrawing(shown, kind, picture.name.replace(/[^A-Za-z0-9]+/g, "-"), what, colours && colours.join(" "));
    };
    const name = kind.toUpperCase();
    return h("button.quiet", { title: `save the drawing as ${name}`, onclick: save }, name);
  }

  /** One loop as WebM. */
  function recordButton(shown: Stage): HTMLElement {
    const button = h("button.quiet", { title: "save one loop as a video (WebM)" }, "● WebM") as HTMLButtonElement;
    button.addEventListener("click", () => {
      const recorder = new MediaRecorder(shown.canvas.captureStream(30), { mimeType: "video/webm" });
      const parts: Blob[] = [];
      recorder.ondataavailable = (event) => parts.push(event.data);
      recorder.onstop = () => {
        button.disabled = false;
        const link = document.createElement("a");
        link.href = URL.createObjectURL(new Blob(parts, { type: "video/webm" }));
        link.download = `${picture.name}.webm`;
        link.click();
      };
      button.disabled = true;
      time = 0;
      setPlaying(true);
      recorder.start();
      setTimeout(() => recorder.stop(), (1000 * secondsOfLoop) / speed);
    });
    return button;
  }

  function addNames(shown: Stage, areShown: boolean): void {
    if (!areShown) return;
    const main = () => shown.mainPoses();
    picture.scene.bodies.forEach((body, i) => {
      const label = h(options.unheld?.includes(body.name) ? "span.name.bad" : "span.name", {}, words(body.name));
      shown.addLabel(label, () => {
        const { poses } = main();
        if (!poses) return null;
        const points = poses[i].points;
        const middle = points[Math.floor(points.length / 2)];
        return points.length > 1 ? middle.clone() : middle.clone().addScaledVector(shown.view.up, 0.05 * shown.view.size);
      }, true);
    });
    picture.scene.joints.forEach((joint, j) => {
      const label = h("span.name.of-joint", {}, words(joint.name));
      shown.addLabel(label, () => {
        const { motion, poses } = main();
        if (!poses) return null;
        const places = motion.design.geometry.joints[j].places;
        const place = places[1].body >= 0 ? places[1] : places[0];
        return motion.place(place, poses).addScaledVector(shown.view.up, -0.055 * shown.view.size);
      }, true);
    });
    picture.scene.loads.forEach((load, l) => {
      const places = picture.designs[options.main].geometry.loads[l].places;
      if (!places.length) return;
      const label = h("span.name.of-load", {}, words(load.name));
      shown.addLabel(label, () => {
        const { motion, poses } = main();
        return poses ? motion.place(places[0], poses).addScaledVector(shown.view.up, 0.085 * shown.view.size) : null;
      }, true);
    });
  }

  const legend = legendOf(picture, options.main);
  if (legend && stage) element.append(legend);
  if (isColoured && stage) element.append(factor);
  show();
  if (isMoving && stage && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) setPlaying(true);
  const stopTheme = onTheme(() => stage?.show(time, scale));
  return {
    element,
    goTo,
    stage,
    select: (body) => stage?.select(body),
    onTime: (listener) => {
      listeners.push(listener);
      listener(time);
    },
    dispose() {
      setPlaying(false);
      life.abort();
      stopTheme();
      stage?.dispose();
    },
    state: () => ({ time, isPlaying, scale }),
  };
}

/** "1/70 of real time". */
function speeds(end: number): string[][] {
  const name = (factor: number) => {
    const real = (factor * end) / secondsOfLoop;
    if (real > 0.95 && real < 1.05) return "real time";
    return real >= 1 ? `${number(real, 2)} × real` : `1/${number(1 / real, 2)} of real`;
  };
  return [0.1, 0.25, 0.5, 1, 2].map((factor) => [String(factor), name(factor)]);
}

/** So that the largest deformation is seen and stands in proportion to the mechanism. */
function usefulScale(stage: Stage): number {
  const largest = stage.largestDeviation();
  if (!(largest > 0)) return 1;
  const wanted = Math.min((shownDeformation * stage.view.size) / largest, largestDefault);
  return scales.filter((s) => s <= wanted).pop() ?? 1;
}

/** What the last colour is, and of what; null if stress has no colours. */
function legendText(picture: Picture, main: number): [string, string] | null {
  const limits = stressLimits(picture, main);
  const known = [...new Set(limits.filter((limit): limit is number => limit !== null))];
  if (!hasAnyStress(picture.designs[main]) || !known.length) return null;
  const isLimit = picture.scene.bodies.some((body, i) => limits[i] !== null && body.stress_limit);
  return [
    known.length === 1 ? `${number(known[0] / 1e6, 3)} MPa` : "100 %",
    isLimit ? "von Mises stress, up to its limit" : "von Mises stress, up to the strength of the material",
  ];
}

function legendOf(picture: Picture, main: number): HTMLElement | null {
  const text = legendText(picture, main);
  if (!text) return null;
  const [last, what] = text;
  return h(
    "div.legend",
    {},
    h("span", {}, "0"),
    h("span.gradient", { style: `background:${stressGradient()}` }),
    h("span", {}, last),
    h("span.soft", {}, what),
    picture.designs.length === 2 ? h("span.soft", {}, h("span.dot.ghost"), ` ${picture.designs[1 - main].name}`) : null,
  );
}

