// Where everything is at an instant: positions of stations, frames, places; with deformation scaled.
import { Quaternion, Vector3 } from "three";
import { type Design, type Place, type Scene, unpack } from "../data";

/** One body at an instant. */
export interface BodyPose {
  stations: number[]; // of a beam: shares of the length
  points: Vector3[]; // of the stations, with scaled deformation
  frames: Quaternion[]; // one a station
  origin: Vector3; // of the first frame
  stress: number[] | null; // at the stations [Pa]
  /** Of a body with a surface: its frame's origin, and by how much deformation is enlarged. */
  elastic: { coordinates: number[]; origin: Vector3; scale: number } | null;
}

interface MovingBody {
  stations: number[];
  parts: number[];
  positions: Float32Array;
  rotations: Float32Array;
  frameCount: number;
  stress: Float32Array | null;
  elastic: { coordinates: Float32Array; origins: Float32Array; size: number } | null;
}

/** Motion of a design that can be asked for any instant. */
export class Motion {
  readonly time: Float32Array;
  readonly bodies: MovingBody[];
  private readonly held: number[][]; // shares of the length at which joints hold a beam

  constructor(
    readonly scene: Scene,
    readonly design: Design,
  ) {
    const motion = design.motion;
    this.time = motion ? unpack(motion.time) : new Float32Array([0]);
    this.bodies = scene.bodies.map((_, i) => (motion ? movingBody(motion.bodies[i]) : this.standing(i)));
    this.held = scene.bodies.map((_, i) => this.heldShares(i));
  }

  poses(time: number, scale: number): BodyPose[] {
    const { index, part } = this.find(time);
    return this.bodies.map((_, i) => this.pose(i, index, part, scale));
  }

  /** The place of a joint or load at an instant. */
  place(place: Place, poses: BodyPose[]): Vector3 {
    if (place.body < 0) return new Vector3(...(place.point ?? place.at));
    const pose = poses[place.body];
    if (place.share !== undefined) return pointAlong(pose, place.share);
    const type = this.scene.bodies[place.body].type;
    if (type === "invariants") return nearest(pose, place, this.bodies[place.body]);
    const point = new Vector3(...(place.point ?? [0, 0, 0]));
    return point.applyQuaternion(pose.frames[0]).add(pose.origin);
  }

  /** How the frame of a body stands at the start. */
  startFrame(body: number): Quaternion {
    const [x, y, z, w] = this.bodies[body].rotations;
    return new Quaternion(x, y, z, w);
  }

  /** The largest deviation of a member from its straight line over all instants [m]. */
  largestDeviation(): number {
    let largest = 0;
    const stride = Math.max(1, Math.floor(this.time.length / 60));
    for (let index = 0; index < this.time.length; index += stride) {
      this.bodies.forEach((body, i) => {
        if (!this.scaled(i)) return;
        const plain = this.rawPoints(body, index, 0);
        const straight = this.straight(i, plain, body.stations);
        plain.forEach((p, k) => (largest = Math.max(largest, p.distanceTo(straight[k]))));
      });
    }
    return largest;
  }

  private find(time: number): { index: number; part: number } {
    let low = 0;
    let high = this.time.length - 1;
    if (high === 0 || time <= this.time[0]) return { index: 0, part: 0 };
    if (time >= this.time[high]) return { index: high, part: 0 };
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.time[middle] <= time) low = middle;
      else high = middle;
    }
    return { index: low, part: (time - this.time[low]) / (this.time[high] - this.time[low] || 1) };
  }

  private rawPoints(body: MovingBody, index: number, part: number): Vector3[] {
    const rows = 3 * body.stations.length;
    const next = part > 0 ? index + 1 : index;
    return body.stations.map((_, k) => {
      const [a, b] = [index * rows + 3 * k, next * rows + 3 * k];
      const p = body.positions;
      return new Vector3(
        p[a] + part * (p[b] - p[a]),
        p[a + 1] + part * (p[b + 1] - p[a + 1]),
        p[a + 2] + part * (p[b + 2] - p[a + 2]),
      );
    });
  }

  private pose(i: number, index: number, part: number, scale: number): BodyPose {
    const body = this.bodies[i];
    const next = part > 0 ? index + 1 : index;
    const frame = (f: number) => {
      const [a, b] = [4 * (index * body.frameCount + f), 4 * (next * body.frameCount + f)];
      const r = body.rotations;
      const q = new Quaternion(r[a], r[a + 1], r[a + 2], r[a + 3]);
      return part > 0 ? q.slerp(new Quaternion(r[b], r[b + 1], r[b + 2], r[b + 3]), part) : q;
    };
    const frames = Array.from({ length: body.frameCount }, (_, f) => frame(f));
    const raw = this.rawPoints(body, index, part);
    const points = scale === 1 || !this.scaled(i) ? raw : scaledFrom(this.straight(i, raw, body.stations), raw, scale);
    const rows = body.stations.length;
    return {
      stations: body.stations,
      points,
      frames: body.parts.map((f) => frames[f]),
      origin: points[0].clone(),
      stress: body.stress
        ? body.stations.map((_, k) => {
            const [a, b] = [body.stress![index * rows + k], body.stress![next * rows + k]];
            return a + part * (b - a);
          })
        : null,
      elastic: elasticPose(body, index, next, part, scale),
    };
  }

  private scaled(i: number): boolean {
    const body = this.scene.bodies[i];
    return body.type === "beam" && !body.is_rigid && this.bodies[i].stations.length > 2;
  }

  /** The line that deformation is seen against: through the outermost places that joints hold, or
   * the tangent at the only one: so that joints stay together when deformation is enlarged. */
  private straight(i: number, points: Vector3[], stations: number[]): Vector3[] {
    const held = this.held[i];
    const pose = { stations, points } as BodyPose;
    const first = held[0] ?? 0;
    const last = held.length > 1 ? held[held.length - 1] : held.length === 1 ? null : 1;
    const from = pointAlong(pose, first);
    const slope =
      last === null
        ? tangentAt(pose, first)
        : pointAlong(pose, last).sub(from).divideScalar(last - first);
    return stations.map((s) => from.clone().addScaledVector(slope, s - first));
  }

  private heldShares(i: number): number[] {
    const shares = new Set<number>();
    for (const joint of this.design.geometry.joints) {
      for (const place of joint.places) if (place.body === i && place.share !== undefined) shares.add(place.share);
    }
    const sorted = [...shares].sort((a, b) => a - b);
    return sorted.filter((s, k) => k === 0 || s - sorted[k - 1] > 1e-3);
  }

  /** A body as the file places it, where nothing was simulated. */
  private standing(i: number): MovingBody {
    const geometry = this.design.geometry.bodies[i];
    const axes = geometry.axes;
    const q = quaternionOf(axes);
    const isLong = geometry.length !== undefined;
    const stations = isLong ? [0, 0.25, 0.5, 0.75, 1] : [0];
    const positions = stations.flatMap((s) =>
      geometry.origin.map((o, k) => o + s * (geometry.length ?? 0) * axes[0][k]),
    );
    return {
      stations,
      parts: stations.map(() => 0),
      positions: new Float32Array(positions),
      rotations: new Float32Array([q.x, q.y, q.z, q.w]),
      frameCount: 1,
      stress: null,
      elastic: null,
    };
  }
}

function movingBody(body: NonNullable<Design["motion"]>["bodies"][number]): MovingBody {
  return {
    stations: body.stations,
    parts: body.parts,
    positions: unpack(body.positions),
    rotations: unpack(body.rotations),
    frameCount: body.rotations.rows / 4,
    stress: body.stress ? unpack(body.stress) : null,
    elastic:
      body.coordinates && body.origins
        ? { coordinates: unpack(body.coordinates), origins: unpack(body.origins), size: body.coordinates.rows }
        : null,
  };
}

/** Between two frames of the motion. */
function elasticPose(body: MovingBody, index: number, next: number, part: number, scale: number): BodyPose["elastic"] {
  if (!body.elastic) return null;
  const { coordinates, origins, size } = body.elastic;
  const between = (all: Float32Array, rows: number) =>
    Array.from({ length: rows }, (_, k) => all[index * rows + k] + part * (all[next * rows + k] - all[index * rows + k]));
  const [x, y, z] = between(origins, 3);
  return { coordinates: between(coordinates, size), origin: new Vector3(x, y, z), scale };
}

function quaternionOf(axes: [number, number, number][]): Quaternion {
  const [x, y, z] = axes;
  // The matrix has the axes as columns.
  const trace = x[0] + y[1] + z[2];
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    return new Quaternion((y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, s / 4).normalize();
  }
  if (x[0] > y[1] && x[0] > z[2]) {
    const s = 2 * Math.sqrt(1 + x[0] - y[1] - z[2]);
    return new Quaternion(s / 4, (y[0] + x[1]) / s, (z[0] + x[2]) / s, (y[2] - z[1]) / s).normalize();
  }
  if (y[1] > z[2]) {
    const s = 2 * Math.sqrt(1 + y[1] - x[0] - z[2]);
    return new Quaternion((y[0] + x[1]) / s, s / 4, (z[1] + y[2]) / s, (z[0] - x[2]) / s).normalize();
  }
  const s = 2 * Math.sqrt(1 + z[2] - x[0] - y[1]);
  return new Quaternion((z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4, (x[1] - y[0]) / s).normalize();
}

function scaledFrom(straight: Vector3[], points: Vector3[], scale: number): Vector3[] {
  return points.map((p, k) => straight[k].clone().lerp(p, scale));
}

function bracket(stations: number[], share: number): { k: number; f: number } {
  let k = 0;
  while (k < stations.length - 2 && stations[k + 1] < share) k++;
  const width = stations[k + 1] - stations[k] || 1;
  return { k, f: (share - stations[k]) / width };
}

export function pointAlong(pose: BodyPose, share: number): Vector3 {
  if (pose.points.length === 1) return pose.points[0].clone();
  const { k, f } = bracket(pose.stations, share);
  return pose.points[k].clone().lerp(pose.points[k + 1], f);
}

export function stressAlong(pose: BodyPose, share: number): number | null {
  if (!pose.stress || pose.points.length === 1) return null;
  const { k, f } = bracket(pose.stations, share);
  return pose.stress[k] + f * (pose.stress[k + 1] - pose.stress[k]);
}

/** dx/ds by three points: exact for a parabola. */
function tangentAt(pose: BodyPose, share: number): Vector3 {
  const n = pose.stations.length;
  const nearestStation = pose.stations.reduce(
    (best, s, k) => (Math.abs(s - share) < Math.abs(pose.stations[best] - share) ? k : best),
    0,
  );
  const m = Math.min(Math.max(nearestStation, 1), n - 2);
  const [s0, s1, s2] = [pose.stations[m - 1], pose.stations[m], pose.stations[m + 1]];
  const w0 = (2 * share - s1 - s2) / ((s0 - s1) * (s0 - s2));
  const w1 = (2 * share - s0 - s2) / ((s1 - s0) * (s1 - s2));
  const w2 = (2 * share - s0 - s1) / ((s2 - s0) * (s2 - s1));
  return new Vector3()
    .addScaledVector(pose.points[m - 1], w0)
    .addScaledVector(pose.points[m], w1)
    .addScaledVector(pose.points[m + 1], w2);
}

/** Of an imported body the place of its file that lies there. */
function nearest(pose: BodyPose, place: Place, body: MovingBody): Vector3 {
  const x = place.point ? place.point[0] : 0;
  let best = 0;
  body.stations.forEach((s, k) => {
    if (Math.abs(s - x) < Math.abs(body.stations[best] - x)) best = k;
  });
  return pose.points[best].clone();
}
