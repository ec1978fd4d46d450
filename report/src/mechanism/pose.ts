// Where everything is at an instant: positions of stations, frames, places; with deformation scaled.
import { Matrix4, Quaternion, Vector3 } from "three";
import { type Design, intervalOf, type Place, type Scene, unpack } from "../data";

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
    const { index, part } = intervalOf(time, this.time);
    return this.bodies.map((_, i) => this.pose(i, index, part, scale));
  }

  /** The place of a joint or load at an instant. */
  place(place: Place, poses: BodyPose[]): Vector3 {
    if (place.body < 0) return new Vector3(...(place.point ?? place.at));
    const pose = poses[place.body];
    if (place.share !== undefined) return pointAlong(pose, place.share);
    const type = this.scene.bodies[place.body].type;
    // Of an imported body the place of its file that lies there.
    if (type === "invariants") return pose.points[nearestStation(pose, place.point?.[0] ?? 0)].clone();
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
    const [x, y, z] = axes.map((axis) => new Vector3(...axis));
    const isLong = geometry.length !== undefined;
    const stations = isLong ? [0, 0.25, 0.5, 0.75, 1] : [0];
    const positions = stations.flatMap((s) =>
      geometry.origin.map((o, k) => o + s * (geometry.length ?? 0) * axes[0][k]),
    );
    return {
      stations,
      parts: stations.map(() => 0),
      positions: new Float32Array(positions),
      rotations: new Float32Array(turnTo(x, y, z).toArray()),
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

/** Turns the axes of space into x, y, z. */
export function turnTo(x: Vector3, y: Vector3, z: Vector3): Quaternion {
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
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
  const m = Math.min(Math.max(nearestStation(pose, share), 1), pose.stations.length - 2);
  const [s0, s1, s2] = [pose.stations[m - 1], pose.stations[m], pose.stations[m + 1]];
  const w0 = (2 * share - s1 - s2) / ((s0 - s1) * (s0 - s2));
  const w1 = (2 * share - s0 - s2) / ((s1 - s0) * (s1 - s2));
  const w2 = (2 * share - s0 - s1) / ((s2 - s0) * (s2 - s1));
  return new Vector3()
    .addScaledVector(pose.points[m - 1], w0)
    .addScaledVector(pose.points[m], w1)
    .addScaledVector(pose.points[m + 1], w2);
}

export function nearestStation(pose: BodyPose, x: number): number {
  const distances = pose.stations.map((s) => Math.abs(s - x));
  return distances.indexOf(Math.min(...distances));
}
