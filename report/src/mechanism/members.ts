// Bodies as meshes that follow their poses.
import {
  BufferAttribute,
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  Object3D,
  Quaternion,
  ShapeUtils,
  SphereGeometry,
  BoxGeometry,
  Vector2,
  Vector3,
} from "three";
import type { BodyGeometry, SceneBody, Segment } from "../data";
import { stressColor } from "../theme";
import { type Look, showLook } from "./look";
import { type BodyPose, type Motion, pointAlong, stressAlong } from "./pose";
import { SurfaceMember } from "./surface";

/** Something that stands where a pose says. */
export interface Member {
  object: Object3D;
  body: number;
  update(pose: BodyPose, limit: number | null): void;
  setLook(look: Look, isSelected: boolean): void;
  /** How far it leaves what the places do that joints hold [m]; of beams the motion tells. */
  deviation?(pose: BodyPose): number;
}

/** Stations at which a beam is drawn: those of the pose within a segment, and its ends. */
function rings(segment: Segment, stations: number[]): number[] {
  const inside = stations.filter((s) => s > segment.begin + 1e-6 && s < segment.end - 1e-6);
  return [segment.begin, ...inside, segment.end];
}

function triangles(outline: Vector2[], holes: Vector2[][]): number[][] {
  return ShapeUtils.triangulateShape(outline, holes);
}

/** One segment of a beam: its outline swept along the deformed axis. */
class SweptSegment {
  readonly mesh: Mesh;
  readonly edges: LineSegments;
  private readonly shares: number[];
  private readonly loops: [number, number][][];
  private readonly cap: { points: [number, number][]; faces: number[][] };
  private readonly sharpLoops: number[][]; // corners that are drawn as lines
  private readonly positions: Float32Array;
  private readonly colors: Float32Array;
  private readonly linePositions: Float32Array;

  constructor(segment: Segment, stations: number[]) {
    this.shares = rings(segment, stations);
    this.loops = segment.inner.length ? [segment.outer, segment.inner] : [segment.outer];
    const outline = segment.outer.map(([y, z]) => new Vector2(y, z));
    const holes = segment.inner.length ? [segment.inner.map(([y, z]) => new Vector2(y, z))] : [];
    this.cap = { points: this.loops.flat(), faces: triangles(outline, holes) };
    const isRound = segment.outer.length > 16;
    this.sharpLoops = this.loops.map((loop) => (isRound ? [0, 8, 16, 24] : loop.map((_, k) => k)));
    const vertexCount = this.verticesAround() * this.shares.length + 2 * this.cap.points.length;
    this.positions = new Float32Array(3 * vertexCount);
    this.colors = new Float32Array(3 * vertexCount).fill(0.7);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.positions, 3));
    geometry.setAttribute("color", new BufferAttribute(this.colors, 3));
    geometry.setIndex(this.faces());
    this.mesh = new Mesh(
      geometry,
      new MeshLambertMaterial({ vertexColors: true, flatShading: true, side: DoubleSide, transparent: true }),
    );
    const lineCount =
      this.sharpLoops.flat().length * (this.shares.length - 1) + 2 * this.cap.points.length;
    this.linePositions = new Float32Array(6 * lineCount);
    const lines = new BufferGeometry();
    lines.setAttribute("position", new BufferAttribute(this.linePositions, 3));
    this.edges = new LineSegments(lines, new LineBasicMaterial({ transparent: true }));
    this.mesh.frustumCulled = this.edges.frustumCulled = false;
  }

  update(pose: BodyPose, limit: number | null, plain: [number, number, number]): void {
    const around = this.verticesAround();
    const frame = new Frame();
    this.shares.forEach((share, i) => {
      frame.set(pose, share);
      const stress = limit ? stressAlong(pose, share) : null;
      const paint = stress === null || !limit ? plain : stressColor(stress / limit);
      let vertex = i * around;
      for (const loop of this.loops) for (const [y, z] of loop) this.put(vertex++, frame, y, z, paint);
      if (i === 0 || i === this.shares.length - 1) {
        let cap = around * this.shares.length + (i === 0 ? 0 : this.cap.points.length);
        for (const [y, z] of this.cap.points) this.put(cap++, frame, y, z, paint);
      }
    });
    this.updateLines();
    for (const name of ["position", "color"]) this.mesh.geometry.getAttribute(name).needsUpdate = true;
    this.edges.geometry.getAttribute("position").needsUpdate = true;
    this.mesh.geometry.boundingSphere = null;
  }

  private put(vertex: number, frame: Frame, y: number, z: number, paint: [number, number, number]): void {
    const v = 3 * vertex;
    this.positions[v] = frame.p.x + y * frame.y.x + z * frame.z.x;
    this.positions[v + 1] = frame.p.y + y * frame.y.y + z * frame.z.y;
    this.positions[v + 2] = frame.p.z + y * frame.y.z + z * frame.z.z;
    this.colors.set(paint, v);
  }

  private verticesAround(): number {
    return this.loops.reduce((sum, loop) => sum + loop.length, 0);
  }

  private faces(): number[] {
    const index: number[] = [];
    const around = this.verticesAround();
    for (let i = 0; i + 1 < this.shares.length; i++) {
      let offset = 0;
      for (const loop of this.loops) {
        loop.forEach((_, k) => {
          const [a, b] = [i * around + offset + k, i * around + offset + ((k + 1) % loop.length)];
          index.push(a, b, a + around, b, b + around, a + around);
        });
        offset += loop.length;
      }
    }
    for (const end of [0, 1]) {
      const base = around * this.shares.length + end * this.cap.points.length;
      for (const [a, b, c] of this.cap.faces) index.push(base + a, base + b, base + c);
    }
    return index;
  }

  private updateLines(): void {
    const around = this.verticesAround();
    let next = 0;
    const line = (a: number, b: number) => {
      this.linePositions.set(this.positions.subarray(3 * a, 3 * a + 3), next);
      this.linePositions.set(this.positions.subarray(3 * b, 3 * b + 3), next + 3);
      next += 6;
    };
    for (let i = 0; i + 1 < this.shares.length; i++) {
      let offset = 0;
      this.loops.forEach((loop, n) => {
        for (const k of this.sharpLoops[n]) line(i * around + offset + k, (i + 1) * around + offset + k);
        offset += loop.length;
      });
    }
    for (const ring of [0, this.shares.length - 1]) {
      let offset = ring * around;
      for (const loop of this.loops) {
        loop.forEach((_, k) => line(offset + k, offset + ((k + 1) % loop.length)));
        offset += loop.length;
      }
    }
  }
}

/** Axes of a section on the deformed axis: x the tangent, y from the body frame. */
class Frame {
  p = new Vector3();
  y = new Vector3();
  z = new Vector3();
  private x = new Vector3();

  set(pose: BodyPose, share: number): void {
    this.p.copy(pointAlong(pose, share));
    const step = 0.02;
    const before = pointAlong(pose, Math.max(0, share - step));
    const after = pointAlong(pose, Math.min(1, share + step));
    this.x.subVectors(after, before).normalize();
    let k = 0;
    while (k < pose.stations.length - 1 && pose.stations[k] < share - 1e-9) k++;
    this.y.set(0, 1, 0).applyQuaternion(pose.frames[k]);
    this.y.addScaledVector(this.x, -this.y.dot(this.x)).normalize();
    this.z.crossVectors(this.x, this.y);
  }
}

export class BeamMember implements Member {
  readonly object = new Group();
  private readonly segments: SweptSegment[];
  private look: Look = { color: [0.7, 0.7, 0.7], edge: "#000", opacity: 1, isGhost: false };

  constructor(
    readonly body: number,
    segments: Segment[],
    stations: number[],
  ) {
    this.segments = segments.map((segment) => new SweptSegment(segment, stations));
    for (const segment of this.segments) {
      segment.mesh.userData.body = body;
      this.object.add(segment.mesh, segment.edges);
    }
  }

  update(pose: BodyPose, limit: number | null): void {
    const shownLimit = this.look.isGhost ? null : limit;
    for (const segment of this.segments) segment.update(pose, shownLimit, this.look.color);
  }

  setLook(look: Look, isSelected: boolean): void {
    this.look = look;
    for (const segment of this.segments) showLook(segment.mesh, segment.edges, look, isSelected, 0.55);
  }
}

/** In the frame of a body: where joints and loads hold it. */
function heldPoints(motion: Motion, body: number): Vector3[] {
  const { joints, loads } = motion.design.geometry;
  const places = [...joints, ...loads].flatMap((one) => one.places).filter((place) => place.body === body);
  return places.map((place) => new Vector3(...(place.point ?? [0, 0, 0])));
}

/** In the frame of a body: where joints hold it, along its x axis. */
function heldByJoints(motion: Motion, body: number): Vector3[] {
  const places = motion.design.geometry.joints.flatMap((joint) => joint.places).filter((place) => place.body === body);
  return places.map((place) => new Vector3(...(place.point ?? [0, 0, 0]))).sort((a, b) => a.x - b.x);
}

/** In the frame of a body: where the joint that it slides in holds it, turned along that. */
function guideOf(motion: Motion, body: number): { point: Vector3; turn: Quaternion } | null {
  const { joints } = motion.design.geometry;
  for (const [j, joint] of motion.scene.joints.entries()) {
    const place = joints[j].places.find((one) => one.body === body);
    if (!place || !joint.slides) continue;
    const axis = new Vector3(...joint.axis).normalize().applyQuaternion(motion.startFrame(body).invert());
    return { point: new Vector3(...(place.point ?? [0, 0, 0])), turn: new Quaternion().setFromUnitVectors(new Vector3(1, 0, 0), axis) };
  }
  return null;
}

/** A rigid body or a point mass: struts from its centre of mass to where it is held, a block where it slides. */
export class LumpMember implements Member {
  readonly object = new Group();
  private readonly edges: LineSegments | null = null;
  private readonly material = new MeshLambertMaterial({ transparent: true });

  constructor(
    readonly body: number,
    motion: Motion,
    size: number,
  ) {
    const r = 0.028 * size;
    const points = heldPoints(motion, body).filter((point) => point.length() > 0.1 * r);
    const guide = guideOf(motion, body);
    const isBlock = guide !== null || (motion.scene.bodies[body].type === "rigid" && !points.length);
    if (isBlock) {
      const box = new BoxGeometry(2.4 * r, 1.7 * r, 1.7 * r);
      const block = new Mesh(box, this.material);
      this.edges = new LineSegments(new EdgesGeometry(box), new LineBasicMaterial({ transparent: true }));
      block.add(this.edges);
      if (guide) {
        block.position.copy(guide.point);
        block.quaternion.copy(guide.turn);
      }
      this.object.add(block);
    }
    if (!isBlock || points.length) {
      this.object.add(new Mesh(new SphereGeometry(points.length ? 0.6 * r : 1.1 * r, 24, 16), this.material));
    }
    for (const point of points) {
      const strut = new Mesh(new CylinderGeometry(0.3 * r, 0.3 * r, 1, 12), this.material);
      placeBetween(strut, new Vector3(), point);
      this.object.add(strut);
    }
    this.object.traverse((part) => (part.userData.body = body));
  }

  update(pose: BodyPose): void {
    this.object.position.copy(pose.origin);
    this.object.quaternion.copy(pose.frames[0]);
  }

  setLook(look: Look, isSelected: boolean): void {
    this.material.color.setRGB(...look.color);
    this.material.opacity = look.opacity;
    this.material.depthWrite = !look.isGhost;
    if (this.edges) {
      const line = this.edges.material as LineBasicMaterial;
      line.color.set(look.edge);
      line.opacity = look.isGhost ? 0.4 : isSelected ? 1 : 0.6;
    }
  }
}

const up = new Vector3(0, 1, 0);

/** A cylinder of length one along its y axis, between two points. */
export function placeBetween(mesh: Object3D, a: Vector3, b: Vector3): void {
  const along = new Vector3().subVectors(b, a);
  const length = along.length();
  mesh.position.copy(a).addScaledVector(along, 0.5);
  mesh.scale.set(1, length || 1e-9, 1);
  mesh.quaternion.copy(new Quaternion().setFromUnitVectors(up, along.divideScalar(length || 1)));
}

/** Outline of a body without sections: of one that another code made. */
function plainSegment(size: number): Segment {
  const r = 0.012 * size;
  return {
    begin: 0,
    end: 1,
    text: "",
    elements: 1,
    outer: [
      [r, -r],
      [r, r],
      [-r, r],
      [-r, -r],
    ],
    inner: [],
  };
}

export function makeMember(
  body: number,
  description: SceneBody,
  geometry: BodyGeometry,
  motion: Motion,
  size: number,
): Member {
  const stations = motion.bodies[body].stations;
  if (geometry.surface) return new SurfaceMember(body, geometry.surface, heldByJoints(motion, body));
  if (geometry.segments) return new BeamMember(body, geometry.segments, stations);
  if (description.type === "invariants" && stations.length > 1) {
    // Places along local x, as shares of their range.
    const [first, last] = [stations[0], stations[stations.length - 1]];
    const range = last - first || 1;
    const member = new BeamMember(body, [plainSegment(size)], stations.map((s) => (s - first) / range));
    const update = member.update.bind(member);
    member.update = (pose, limit) =>
      update({ ...pose, stations: pose.stations.map((s) => (s - first) / range) }, limit);
    return member;
  }
  return new LumpMember(body, motion, size);
}
