// Joints, drives, supports and loads as symbols: of a size that does not depend on the mechanism's.
import {
  BufferAttribute,
  BufferGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  Object3D,
  Quaternion,
  RingGeometry,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from "three";
import { valueAt } from "../data";
import { color } from "../theme";
import { placeBetween } from "./members";
import { type BodyPose, type Motion, turnTo } from "./pose";

export interface View {
  size: number; // of the mechanism [m]
  symbolSize: number; // of a mechanism that symbols are made for: smaller where joints are close [m]
  normal: Vector3; // of what is looked at: the plane of motion, or from the side
  up: Vector3;
  isPlanar: boolean;
}

export interface Symbol3 {
  object: Object3D;
  update(time: number, poses: BodyPose[]): void;
}

const zAxis = new Vector3(0, 0, 1);

function paint(name: string, opacity = 1): MeshBasicMaterial {
  const material = new MeshBasicMaterial({ color: new Color(color(name)), transparent: true, opacity });
  material.depthTest = false;
  material.userData.color = name;
  return material;
}

function lines(points: number[], name: string): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  const material = new LineBasicMaterial({ color: new Color(color(name)), depthTest: false, transparent: true });
  material.userData.color = name;
  const object = new LineSegments(geometry, material);
  object.renderOrder = 9;
  object.frustumCulled = false;
  return object;
}

/** Gives symbols the colours of the scheme. */
export function repaint(root: Object3D): void {
  root.traverse((part) => {
    const material = (part as Mesh).material as MeshBasicMaterial | undefined;
    const name = material?.userData?.color as string | undefined;
    if (material && name) material.color.set(color(name));
  });
}

/** A disk with a rim, seen along its axis. */
function pin(radius: number, isDriven: boolean): Group {
  const group = new Group();
  const disk = new Mesh(new CircleGeometry(radius, 32), paint("card"));
  const rim = new Mesh(new RingGeometry(0.72 * radius, radius, 32), paint(isDriven ? "drive" : "ink"));
  const dot = new Mesh(new CircleGeometry(0.25 * radius, 16), paint(isDriven ? "drive" : "ink"));
  disk.renderOrder = 10;
  rim.renderOrder = dot.renderOrder = 11;
  group.add(disk, rim, dot);
  return group;
}

/** An arc with a head: a drive that turns. */
function turnArrow(radius: number): Group {
  const group = new Group();
  const arc = new Mesh(new TorusGeometry(radius, 0.06 * radius, 8, 40, 1.5 * Math.PI), paint("drive"));
  const head = new Mesh(new ConeGeometry(0.22 * radius, 0.5 * radius, 16), paint("drive"));
  head.position.set(0, -radius, 0);
  head.rotation.z = -Math.PI / 2;
  arc.renderOrder = head.renderOrder = 12;
  group.add(arc, head);
  return group;
}

/** Where something is held by the ground: hatched line below a small triangle. */
function support(r: number): LineSegments {
  const points: number[] = [-1.6, -2, 0, 1.6, -2, 0, 0, -0.9, 0, -1.1, -2, 0, 0, -0.9, 0, 1.1, -2, 0];
  for (let i = 0; i < 5; i++) {
    const x = -1.4 + 0.7 * i;
    points.push(x, -2, 0, x - 0.45, -2.5, 0);
  }
  return lines(points.map((p) => p * r), "ink");
}

/** Two hatched rails along x. */
function rails(r: number, from: number, to: number): LineSegments {
  const points: number[] = [];
  for (const side of [-1, 1]) {
    const y = 1.9 * r * side;
    points.push(from, y, 0, to, y, 0);
    for (let x = from; x < to; x += 0.9 * r) points.push(x, y, 0, x - 0.45 * r, y + 0.5 * r * side, 0);
  }
  return lines(points, "soft");
}

/** Turns local z into an axis and local y upwards, as far as it can. */
function facing(axis: Vector3, upwards: Vector3): Quaternion {
  const z = axis.clone().normalize();
  const y = upwards.clone().addScaledVector(z, -upwards.dot(z));
  if (y.length() < 1e-6) return new Quaternion().setFromUnitVectors(zAxis, z);
  y.normalize();
  return turnTo(new Vector3().crossVectors(y, z), y, z);
}

/** How far a sliding joint travels along its axis from where it starts [m]. */
function travel(motion: Motion, j: number, axis: Vector3): [number, number] {
  const place = motion.design.geometry.joints[j].places[1];
  const from = new Vector3(...place.at);
  let [low, high] = [0, 0];
  const stride = Math.max(1, Math.floor(motion.time.length / 80));
  for (let i = 0; i < motion.time.length; i += stride) {
    const along = motion.place(place, motion.poses(motion.time[i], 1)).sub(from).dot(axis);
    [low, high] = [Math.min(low, along), Math.max(high, along)];
  }
  return [low, high];
}

/** The body of a joint that its axis turns with; −1 if that stands. */
function axisBody(motion: Motion, j: number): number {
  return motion.design.geometry.joints[j].places[0].body;
}

export function jointSymbol(motion: Motion, j: number, view: View): Symbol3 {
  const joint = motion.scene.joints[j];
  const places = motion.design.geometry.joints[j].places;
  const object = new Group();
  const r = 0.02 * view.symbolSize;
  const axis = new Vector3(...joint.axis).normalize();
  const isGrounded = joint.bodies.includes("ground");
  const slidesAlong = joint.slides === "along";
  const isSeenAlongAxis = view.isPlanar && Math.abs(axis.dot(view.normal)) > 0.99;
  const front = new Group();
  let second: Object3D | null = null;
  object.add(front);

  if (slidesAlong && isGrounded) {
    const [low, high] = travel(motion, j, axis);
    const side = Math.abs(axis.dot(view.normal)) > 0.95 ? view.up : view.normal;
    const track = rails(r, low - 3 * r, high + 3 * r);
    track.position.set(...places[1].at);
    const y = new Vector3().crossVectors(side, axis).normalize();
    track.quaternion.copy(turnTo(axis, y, new Vector3().crossVectors(axis, y)));
    object.add(track);
    if (joint.is_guide) {
      front.add(square(0.8 * r, !!joint.drive));
      front.quaternion.copy(track.quaternion);
    }
  } else if (joint.type === "fixed") {
    front.add(square(0.75 * r, false));
    front.quaternion.copy(facing(view.normal, view.up));
  } else if (joint.type === "distance") {
    second = pin(0.6 * r, !!joint.drive);
    front.add(pin(0.6 * r, !!joint.drive));
    const rod = new Mesh(new CylinderGeometry(0.2 * r, 0.2 * r, 1, 10), paint("soft"));
    rod.renderOrder = 8;
    rod.name = "rod";
    object.add(second, rod);
  } else if (joint.type === "spherical") {
    const ball = new Mesh(new SphereGeometry(0.75 * r, 20, 14), paint("ink"));
    ball.renderOrder = 10;
    front.add(ball);
  } else if (isSeenAlongAxis || joint.type === "universal") {
    front.add(pin(r, !!joint.drive));
    front.quaternion.copy(facing(view.isPlanar ? view.normal : axis, view.up));
  } else {
    const bolt = new Mesh(new CylinderGeometry(0.7 * r, 0.7 * r, 2.6 * r, 20), paint(joint.drive ? "drive" : "ink", 0.9));
    bolt.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), axis);
    bolt.renderOrder = 10;
    front.add(bolt);
  }
  if (joint.drive === "angle") {
    const arrow = turnArrow(2.1 * r);
    arrow.quaternion.copy(front.quaternion).invert().multiply(facing(axis, view.up));
    front.add(arrow);
  }
  if (joint.drive === "displacement") {
    const arrow = straightArrow("drive", r);
    arrow.set(axis.clone().multiplyScalar(-2.2 * r), axis.clone().multiplyScalar(2.2 * r));
    object.add(arrow.object);
    arrow.object.name = "arrow";
  }
  if (isGrounded && !slidesAlong) {
    const foot = support(r);
    foot.quaternion.copy(facing(view.normal, view.up));
    foot.position.set(...places[joint.bodies[0] === "ground" ? 0 : 1].at);
    object.add(foot);
  }
  object.traverse((part) => (part.userData.joint = j));

  const turned = new Quaternion();
  const own = front.quaternion.clone();
  return {
    object,
    update(_time, poses) {
      const at = motion.place(places[1].body >= 0 ? places[1] : places[0], poses);
      const first = motion.place(places[0].body >= 0 ? places[0] : places[1], poses);
      const isSlider = !!joint.slides || joint.type === "distance";
      front.position.copy(isSlider ? at : first);
      const carrier = axisBody(motion, j);
      if (carrier >= 0 && !view.isPlanar) {
        turned.copy(poses[carrier].frames[0]).multiply(motion.startFrame(carrier).invert());
        front.quaternion.copy(turned).multiply(own);
      }
      if (second) {
        const [a, b] = places.map((place) => motion.place(place, poses));
        front.position.copy(a);
        second.position.copy(b);
        front.quaternion.copy(facing(view.normal, view.up));
        second.quaternion.copy(front.quaternion);
        const rod = object.getObjectByName("rod");
        if (rod) placeBetween(rod, a, b);
      }
      const arrow = object.getObjectByName("arrow");
      if (arrow) arrow.position.copy(front.position);
    },
  };
}

function square(half: number, isDriven: boolean): Group {
  const group = new Group();
  const rim = new Mesh(new CircleGeometry(1.414 * half, 4, Math.PI / 4), paint(isDriven ? "drive" : "ink"));
  const inside = new Mesh(new CircleGeometry(1.0 * half, 4, Math.PI / 4), paint("card"));
  rim.renderOrder = 10;
  inside.renderOrder = 11;
  group.add(rim, inside);
  return group;
}

interface Arrow {
  object: Group;
  set(tail: Vector3, tip: Vector3): void;
}

function straightArrow(name: string, r: number): Arrow {
  const object = new Group();
  const shaft = new Mesh(new CylinderGeometry(0.16 * r, 0.16 * r, 1, 10), paint(name));
  const head = new Mesh(new ConeGeometry(0.5 * r, 1.3 * r, 18), paint(name));
  shaft.renderOrder = head.renderOrder = 12;
  object.add(shaft, head);
  return {
    object,
    set(tail, tip) {
      const along = new Vector3().subVectors(tip, tail);
      const length = along.length();
      object.visible = length > 0.05 * r;
      if (!object.visible) return;
      along.divideScalar(length);
      const neck = tip.clone().addScaledVector(along, -Math.min(1.3 * r, length));
      placeBetween(shaft, tail, neck);
      head.position.copy(tip).addScaledVector(along, -0.65 * r);
      head.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along);
    },
  };
}

export function loadSymbol(motion: Motion, l: number, view: View): Symbol3 | null {
  const load = motion.scene.loads[l];
  const geometry = motion.design.geometry.loads[l];
  const r = 0.02 * view.symbolSize;
  const value = geometry.value;
  if (load.type === "spring") return springSymbol(motion, l, r);
  if ((load.type !== "force" && load.type !== "torque") || !load.direction) return null;
  let largest = 0;
  if (value) for (let k = 0; k <= 200; k++) largest = Math.max(largest, Math.abs(valueAt(value, (motion.scene.end_time * k) / 200)));
  // What is a function of the motion is drawn at one size.
  const shareAt = (time: number) => (!value ? 0.7 : largest > 0 ? valueAt(value, time) / largest : 0);
  const direction = new Vector3(...load.direction);
  const place = geometry.places[0];
  const along = (poses: BodyPose[]) => {
    const d = direction.clone();
    if (load.follows_body && place.body >= 0) {
      d.applyQuaternion(motion.startFrame(place.body).invert()).applyQuaternion(poses[place.body].frames[0]);
    }
    return d;
  };
  if (load.type === "force") {
    const arrow = straightArrow("load", 1.2 * r);
    return {
      object: arrow.object,
      update(time, poses) {
        const share = shareAt(time);
        const tip = motion.place(place, poses);
        const length = 0.16 * view.size * share;
        // An arrow that pushes on the point.
        arrow.set(tip.clone().addScaledVector(along(poses), -length), tip);
      },
    };
  }
  const object = turnArrow(2.6 * r);
  object.traverse((part) => {
    const material = (part as Mesh).material as MeshBasicMaterial | undefined;
    if (material) {
      material.userData.color = "load";
      material.color.set(color("load"));
    }
  });
  return {
    object,
    update(time, poses) {
      const share = shareAt(time);
      object.visible = Math.abs(share) > 1e-3;
      object.position.copy(motion.place(place, poses));
      object.quaternion.copy(facing(along(poses).multiplyScalar(Math.sign(share) || 1), view.up));
      object.scale.setScalar(0.5 + 0.5 * Math.abs(share));
    },
  };
}

/** A zigzag between two places. */
function springSymbol(motion: Motion, l: number, r: number): Symbol3 {
  const places = motion.design.geometry.loads[l].places;
  const turns = 9;
  const object = lines(new Array(6 * (turns + 2)).fill(0), "load");
  const attribute = object.geometry.getAttribute("position") as BufferAttribute;
  return {
    object,
    update(_time, poses) {
      const [a, b] = places.map((place) => motion.place(place, poses));
      const along = new Vector3().subVectors(b, a);
      const side = new Vector3().crossVectors(along, Math.abs(along.z) < 0.9 * along.length() ? zAxis : new Vector3(1, 0, 0));
      side.setLength(0.8 * r);
      const corner = (k: number) => {
        if (k <= 0) return a.clone();
        if (k >= turns + 2) return b.clone();
        const point = a.clone().addScaledVector(along, 0.12 + (0.76 * (k - 1)) / turns);
        return k === 1 || k === turns + 1 ? point : point.addScaledVector(side, k % 2 ? 1 : -1);
      };
      for (let k = 0; k < turns + 2; k++) {
        const [p, q] = [corner(k), corner(k + 1)];
        attribute.setXYZ(2 * k, p.x, p.y, p.z);
        attribute.setXYZ(2 * k + 1, q.x, q.y, q.z);
      }
      attribute.needsUpdate = true;
    },
  };
}
