// The drawing: camera, light, members and symbols of some designs at an instant.
import {
  AmbientLight,
  AxesHelper,
  Color,
  DirectionalLight,
  Group,
  Light,
  OrthographicCamera,
  Raycaster,
  Scene as Space,
  Vector2,
  Vector3,
  WebGLRenderer,
  Mesh,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { SVGRenderer } from "three/examples/jsm/renderers/SVGRenderer.js";
import type { Design, Scene } from "../data";
import { inLight } from "../paper";
import { color, onTheme, scheme } from "../theme";
import type { Look } from "./look";
import { makeMember, type Member } from "./members";
import { type BodyPose, Motion } from "./pose";
import { boxCorners } from "./surface";
import { jointSymbol, loadSymbol, repaint, type Symbol3, type View } from "./symbols";

interface Actor {
  motion: Motion;
  isGhost: boolean;
  group: Group;
  members: Member[];
  symbols: Symbol3[];
}

export interface StageOptions {
  scene: Scene;
  designs: Design[];
  main: number; // index of the design that is coloured; others are ghosts
  limits: (number | null)[]; // stress that has the last colour, by body [Pa]
  showsAxes: boolean;
  unheld: number[]; // bodies that are drawn red: nothing holds or moves them
  onPick(body: number | null, joint: number | null): void;
}

interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

const numberWidth = 18; // of a mark [px]

/** Where a label goes that wants to be at x, y: inside the free area, to the left of its place where there is no room to the
 * right, beside those placed before. */
function clearOf(taken: Box[], x: number, y: number, element: HTMLElement, free: Box): [number, number] {
  const own = { width: element.offsetWidth, height: element.offsetHeight };
  const turns = x + own.width + 10 > free.width;
  element.classList.toggle("is-left", turns);
  const left = Math.max(4, turns ? Math.min(x, free.width - 10) + numberWidth - own.width : x);
  let top = Math.max(free.y + 4, Math.min(y, free.y + free.height - own.height - 4));
  const meets = (box: Box) => left < box.x + box.width && box.x < left + own.width && top < box.y + box.height && box.y < top + own.height;
  for (let tries = 0; tries < 12; tries++) {
    const box = taken.find(meets);
    if (!box) break;
    top = box.y + box.height + 3;
  }
  taken.push({ x: left, y: top, ...own });
  return [left, top];
}

interface Label {
  element: HTMLElement;
  at: () => Vector3 | null;
  avoids: boolean; // stays inside and clear of the others that do
}

export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly motions: Motion[];
  readonly view: View;
  private readonly renderer: WebGLRenderer;
  private readonly space = new Space();
  private readonly camera = new OrthographicCamera();
  private readonly controls: OrbitControls;
  private readonly actors: Actor[];
  private readonly labels: Label[] = [];
  private readonly center: Vector3;
  private readonly extent: Vector3[];
  private poses: BodyPose[][] = [];
  private selected: number | null = null;
  private visible: boolean[];
  private toolbar: HTMLElement | null = null;
  private isStressShown = true;
  private isDue = false;
  private isDisposed = false;
  private copy: HTMLCanvasElement | null = null; // while the page is printed
  private readonly sizes = new ResizeObserver(() => this.resize());
  private readonly stopTheme: () => void;

  constructor(
    private readonly host: HTMLElement,
    private readonly options: StageOptions,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.canvas = this.renderer.domElement;
    this.motions = options.designs.map((design) => new Motion(options.scene, design));
    this.extent = this.corners();
    const low = this.extent[0].clone();
    const high = this.extent[0].clone();
    for (const p of this.extent) {
      low.min(p);
      high.max(p);
    }
    this.center = low.clone().add(high).multiplyScalar(0.5);
    this.view = this.makeView(low.distanceTo(high) || 1);
    this.visible = options.designs.map(() => true);
    this.actors = this.motions.map((motion, i) => this.makeActor(motion, i !== options.main));
    this.addLights();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableRotate = !this.view.isPlanar;
    this.controls.enableZoom = true;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.render());
    // The page scrolls unless a modifier is held; two fingers pan and zoom.
    this.canvas.addEventListener("wheel", (event) => { if (!event.ctrlKey && !event.metaKey) event.stopImmediatePropagation(); }, { capture: true });
    this.canvas.style.touchAction = "pan-y";
    host.append(this.canvas);
    this.listenForPicks();
    this.resetCamera();
    this.sizes.observe(host);
    this.stopTheme = onTheme(() => {
      repaint(this.space);
      this.relook();
    });
    this.relook();
    window.addEventListener("beforeprint", this.toPaper);
    window.addEventListener("afterprint", this.toWindow);
  }

  /** Gives the graphics card back: browsers have few contexts. */
  dispose(): void {
    this.isDisposed = true;
    this.sizes.disconnect();
    this.stopTheme();
    window.removeEventListener("beforeprint", this.toPaper);
    window.removeEventListener("afterprint", this.toWindow);
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  show(time: number, scale: number): void {
    this.poses = this.motions.map((motion) => motion.poses(time, scale));
    this.actors.forEach((actor, i) => {
      if (!this.visible[i]) return;
      for (const member of actor.members) {
        const limit = this.isStressShown ? this.options.limits[member.body] : null;
        member.update(this.poses[i][member.body], limit);
      }
      for (const symbol of actor.symbols) symbol.update(time, this.poses[i]);
    });
    this.render();
  }

  setVisible(visible: boolean[]): void {
    this.visible = visible;
    this.actors.forEach((actor, i) => (actor.group.visible = visible[i]));
    this.relook();
  }

  setStressShown(isShown: boolean): void {
    this.isStressShown = isShown;
  }

  setRotatable(isRotatable: boolean): void {
    this.controls.enableRotate = isRotatable;
    if (!isRotatable) this.resetCamera();
    else if (this.view.isPlanar) {
      const side = new Vector3().crossVectors(this.view.up, this.view.normal);
      const eye = this.view.normal.clone().addScaledVector(side, 0.55).addScaledVector(this.view.up, 0.4);
      this.look(eye);
    }
  }

  select(body: number | null): void {
    this.selected = body;
    this.relook();
  }

  /** Buttons along the upper edge: the mechanism is drawn below them. */
  setToolbar(element: HTMLElement): void {
    this.toolbar = element;
    this.host.append(element);
    this.sizes.observe(element);
    this.resize();
  }

  /** An HTML element that stays at a place of the drawing. */
  addLabel(element: HTMLElement, at: () => Vector3 | null, avoids = false): void {
    element.classList.add("pin-label");
    this.host.append(element);
    this.labels.push({ element, at, avoids });
    this.render();
  }

  /** Poses of the design that is coloured, or of the first that is seen. */
  mainPoses(): { motion: Motion; poses: BodyPose[] } {
    const main = this.visible[this.options.main] ? this.options.main : this.visible.indexOf(true);
    return { motion: this.motions[main], poses: this.poses[main] };
  }

  /** Where the middle of a body is drawn [px of the page]: for tests. */
  screenPoint(body: number): { x: number; y: number } {
    const { poses } = this.mainPoses();
    const { points } = poses[body];
    const middle = points.length > 1 ? points[Math.floor(points.length / 2)] : points[0];
    const p = middle.clone().project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + ((p.x + 1) / 2) * box.width, y: box.top + ((1 - p.y) / 2) * box.height };
  }

  /** Of all members from their undeformed shape, over all instants [m]. */
  largestDeviation(): number {
    let largest = Math.max(...this.motions.map((motion) => motion.largestDeviation()));
    for (const { motion, members } of this.actors) {
      const stride = Math.max(1, Math.floor(motion.time.length / 30));
      const surfaces = members.filter((member) => member.deviation);
      for (let i = 0; surfaces.length && i < motion.time.length; i += stride) {
        const poses = motion.poses(motion.time[i], 1);
        for (const member of surfaces) largest = Math.max(largest, member.deviation!(poses[member.body]));
      }
    }
    return largest;
  }

  resetCamera(): void {
    const side = new Vector3().crossVectors(this.view.up, this.view.normal);
    const eye = this.view.isPlanar
      ? this.view.normal.clone()
      : this.view.normal.clone().addScaledVector(side, 0.75).addScaledVector(this.view.up, 0.55);
    this.look(eye);
  }

  /** Draws with the next frame of the browser, once whatever has changed. */
  render(): void {
    if (this.isDue || this.isDisposed) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      if (!this.isDisposed) this.draw();
    });
  }

  private draw(): void {
    this.renderer.render(this.space, this.camera);
    this.placeLabels(this.freeArea());
  }

  private placeLabels(free: Box): void {
    const { width } = free;
    const height = free.y + free.height;
    const taken: Box[] = [];
    for (const label of this.labels) {
      const at = label.at();
      label.element.hidden = !at;
      if (!at) continue;
      const p = at.clone().project(this.camera);
      let x = Math.round(((p.x + 1) / 2) * width);
      let y = Math.round(((1 - p.y) / 2) * height);
      if (label.avoids) [x, y] = clearOf(taken, x, y, label.element, free);
      label.element.style.transform = `translate(${x}px, ${y}px)`;
    }
  }

  private look(eye: Vector3): void {
    this.camera.up.copy(this.view.up);
    this.camera.position.copy(this.center).addScaledVector(eye.normalize(), 4 * this.view.size);
    this.controls.target.copy(this.center);
    this.camera.zoom = 1;
    this.camera.lookAt(this.center);
    this.controls.update();
    this.resize();
  }

  private makeView(size: number): View {
    const gravity = new Vector3(...this.options.scene.gravity);
    const plane = this.options.scene.plane_normal;
    const normal = plane ? new Vector3(...plane).normalize() : new Vector3(0, -1, 0);
    if (plane) {
      // So that the axes point right and up, or down and left of neither.
      const largest = [normal.x, normal.y, normal.z].reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
      const wanted = Math.abs(normal.y) > 0.9 ? -1 : 1;
      if (Math.sign(largest) !== wanted) normal.negate();
    }
    let up = gravity.length() > 0 ? gravity.clone().normalize().negate() : new Vector3(0, 0, 1);
    if (Math.abs(up.dot(normal)) > 0.95) up = Math.abs(normal.y) > 0.9 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0);
    if (plane) up.addScaledVector(normal, -up.dot(normal)).normalize();
    else if (gravity.length() > 0 && Math.abs(normal.dot(up)) > 0.5) normal.set(0, 0, 1);
    return { size, symbolSize: Math.min(size, 14 * this.closestJoints()), normal, up, isPlanar: !!plane };
  }

  /** Of the places of joints that are apart, the typical distance to the next one [m]. */
  private closestJoints(): number {
    const places = this.motions[0].design.geometry.joints.map((joint) => new Vector3(...joint.places[0].at));
    const distances = places.map((p) => Math.min(...places.map((q) => p.distanceTo(q)).filter((d) => d > 1e-9)));
    const known = distances.filter(Number.isFinite).sort((a, b) => a - b);
    return known.length ? known[Math.floor(known.length / 2)] : Infinity;
  }

  /** Places that all motions reach. */
  private corners(): Vector3[] {
    const points: Vector3[] = [];
    for (const motion of this.motions) {
      const stride = Math.max(1, Math.floor(motion.time.length / 50));
      const boxes = motion.design.geometry.bodies.map(({ surface }) => (surface ? boxCorners(surface) : []));
      for (let i = 0; i < motion.time.length; i += stride) {
        motion.poses(motion.time[i], 1).forEach((pose, k) => {
          points.push(pose.points[0], pose.points[pose.points.length - 1]);
          const origin = pose.elastic?.origin ?? pose.origin;
          for (const corner of boxes[k]) points.push(corner.clone().applyQuaternion(pose.frames[0]).add(origin));
        });
      }
      for (const joint of motion.design.geometry.joints) {
        for (const place of joint.places) if (place.body < 0) points.push(new Vector3(...place.at));
      }
      for (const load of motion.design.geometry.loads) {
        for (const place of load.places) points.push(new Vector3(...place.at));
      }
    }
    return points;
  }

  private makeActor(motion: Motion, isGhost: boolean): Actor {
    const { scene } = this.options;
    const group = new Group();
    const size = this.view.symbolSize;
    const members = scene.bodies.map((body, i) =>
      makeMember(i, body, motion.design.geometry.bodies[i], motion, size),
    );
    const symbols: Symbol3[] = [];
    if (!isGhost) {
      scene.joints.forEach((_, j) => symbols.push(jointSymbol(motion, j, this.view)));
      scene.loads.forEach((_, l) => {
        const symbol = loadSymbol(motion, l, this.view);
        if (symbol) symbols.push(symbol);
      });
      if (this.options.showsAxes) members.forEach((_, i) => symbols.push(this.axesOf(i)));
    }
    group.add(...members.map((member) => member.object), ...symbols.map((symbol) => symbol.object));
    this.space.add(group);
    return { motion, isGhost, group, members, symbols };
  }

  private axesOf(body: number): Symbol3 {
    const object = new AxesHelper(0.09 * this.view.size);
    object.setColors(new Color("#e5484d"), new Color("#30a46c"), new Color("#2f7ef0"));
    object.renderOrder = 20;
    (object.material as unknown as { depthTest: boolean }).depthTest = false;
    return {
      object,
      update: (_time, poses) => {
        object.position.copy(poses[body].origin);
        object.quaternion.copy(poses[body].frames[0]);
      },
    };
  }

  private addLights(): void {
    this.space.add(new AmbientLight(0xffffff, 2.1));
    const sun = new DirectionalLight(0xffffff, 1.6);
    const side = new Vector3().crossVectors(this.view.up, this.view.normal);
    sun.position.copy(this.view.normal).addScaledVector(this.view.up, 0.8).addScaledVector(side, -0.5);
    this.space.add(sun);
  }

  private relook(): void {
    this.actors.forEach((actor, i) => {
      const isGhost = actor.isGhost && this.visible.filter(Boolean).length > 1;
      const steel = new Color(color("steel"));
      const ghost = new Color(color("start"));
      for (const member of actor.members) {
        const isUnheld = this.options.unheld.includes(member.body);
        const paint = isGhost ? ghost : isUnheld ? new Color(color("limit")) : steel;
        const look: Look = {
          color: [paint.r, paint.g, paint.b],
          edge: color(isGhost ? "start" : "ink"),
          opacity: isGhost ? (scheme() === "dark" ? 0.22 : 0.26) : 1,
          isGhost,
        };
        if (!isGhost && this.selected === member.body) look.edge = color("accent");
        member.setLook(look, this.selected === member.body);
      }
      if (this.poses[i]) for (const member of actor.members) {
        member.update(this.poses[i][member.body], this.isStressShown ? this.options.limits[member.body] : null);
      }
    });
    this.render();
  }

  private listenForPicks(): void {
    const caster = new Raycaster();
    let down: [number, number] | null = null;
    this.canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    this.canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      // Slim members are hard to hit: what lies within some pixels counts, the middle first.
      for (const [dx, dy] of [[0, 0], [7, 0], [-7, 0], [0, 7], [0, -7], [5, 5], [-5, 5], [5, -5], [-5, -5]]) {
        const point = new Vector2(
          (2 * (event.clientX + dx - box.left)) / box.width - 1,
          1 - (2 * (event.clientY + dy - box.top)) / box.height,
        );
        caster.setFromCamera(point, this.camera);
        const found = caster
          .intersectObjects(this.space.children, true)
          .filter((hit) => hit.object instanceof Mesh && isShown(hit.object));
        const joint = found.find((hit) => hit.object.userData.joint !== undefined);
        if (joint) return this.options.onPick(null, joint.object.userData.joint as number);
        const body = found.find((hit) => hit.object.userData.body !== undefined);
        if (body) return this.options.onPick(body.object.userData.body as number, null);
      }
      this.options.onPick(null, null);
    });
  }

  /** Of the host, what no button lies over [px]. */
  private freeArea(): Box {
    const { clientWidth: width, clientHeight: height } = this.host;
    const top = this.toolbar ? this.toolbar.offsetTop + this.toolbar.offsetHeight : 0;
    return { x: 0, y: top, width, height: Math.max(height - top, 1) };
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height || this.copy) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    this.fit(width, this.freeArea());
    this.render();
  }

  /** What all motions reach fills the free area, with a margin for symbols and names. */
  private fit(width: number, free: Box): void {
    this.camera.updateMatrixWorld();
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const upwards = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const low = [Infinity, Infinity];
    const high = [-Infinity, -Infinity];
    for (const p of this.extent) {
      const d = p.clone().sub(this.center);
      [right, upwards].forEach((axis, i) => {
        low[i] = Math.min(low[i], d.dot(axis));
        high[i] = Math.max(high[i], d.dot(axis));
      });
    }
    const margin = (this.options.showsAxes ? 0.16 : 0.085) * this.view.size;
    const [middleX, middleY] = [0, 1].map((i) => (low[i] + high[i]) / 2);
    const perPixel = Math.max(((high[1] - low[1]) + 2 * margin) / free.height, ((high[0] - low[0]) + 2 * margin) / width);
    this.camera.top = middleY + perPixel * (free.height / 2 + free.y);
    this.camera.bottom = middleY - (perPixel * free.height) / 2;
    this.camera.right = middleX + (perPixel * width) / 2;
    this.camera.left = middleX - (perPixel * width) / 2;
    this.camera.near = 0.01 * this.view.size;
    this.camera.far = 12 * this.view.size;
    this.camera.updateProjectionMatrix();
  }

  /** Paper is narrower than the window, needs no buttons, and shows no frames that come later. */
  private readonly toPaper = () => {
    const { width, height } = paperStage;
    Object.assign(this.host.style, { width: `${width}px`, height: `${height}px` });
    this.copy = this.dots(3 * width, 3 * height);
    this.copy.className = "paper-drawing";
    this.host.append(this.copy);
    const all = { x: 0, y: 0, width, height };
    this.fit(width, all);
    this.placeLabels(all);
  };
  private readonly toWindow = () => {
    this.copy?.remove();
    this.copy = null;
    Object.assign(this.host.style, { width: "", height: "" });
    this.resize();
  };

  /** The drawing as the camera sees it, of lines and areas, without buttons, in the colours of paper. */
  svgPicture(width: number, height: number): SVGElement {
    const painter = new SVGRenderer();
    painter.setSize(width, height);
    // It takes for the light of a surface what falls onto it: without the 1/π of surfaces that scatter evenly.
    const lights = this.space.children.filter((one): one is Light => one instanceof Light);
    for (const light of lights) light.intensity /= Math.PI;
    this.forPaper(width, height, () => painter.render(this.space, this.camera));
    for (const light of lights) light.intensity *= Math.PI;
    return painter.domElement;
  }

  /** The same of dots. */
  dots(width: number, height: number): HTMLCanvasElement {
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [width, height];
    this.forPaper(width, height, () => {
      this.renderer.setPixelRatio(1);
      this.renderer.setSize(width, height, false);
      this.renderer.render(this.space, this.camera);
      copy.getContext("2d")!.drawImage(this.canvas, 0, 0);
    });
    return copy;
  }

  private forPaper(width: number, height: number, work: () => void): void {
    inLight(() => {
      repaint(this.space);
      this.relook();
      this.fit(width, { x: 0, y: 0, width, height });
      work();
    });
    repaint(this.space);
    this.relook();
    this.resize();
  }
}

/** Of the drawing on paper [px]. */
const paperStage = { width: 690, height: 200 };

function isShown(object: { visible: boolean; parent: unknown }): boolean {
  for (let one: { visible: boolean; parent: unknown } | null = object; one; one = one.parent as typeof one) {
    if (!one.visible) return false;
  }
  return true;
}
