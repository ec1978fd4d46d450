// The surface of a body from a mesh: it follows its elastic coordinates and is coloured by its stress.
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  Vector3,
} from "three";
import { type Surface, unpack } from "../data";
import { stressColor } from "../theme";
import { type Look, showLook } from "./look";
import type { Member } from "./members";
import { type BodyPose, nearestStation } from "./pose";

/** Of a triangle: rows that make xx, yy and xy of its strain from the displacements of its corners. */
interface StrainRows {
  x: Vector3; // axes of its plane
  y: Vector3;
  slopes: [number, number][]; // ∂/∂x and ∂/∂y of the linear function that is 1 at a corner
  area: number;
}

function strainRows(a: Vector3, b: Vector3, c: Vector3): StrainRows {
  const [ab, ac] = [b.clone().sub(a), c.clone().sub(a)];
  const normal = ab.clone().cross(ac);
  const double = normal.length() || 1e-300; // twice its area
  const x = ab.clone().normalize();
  const y = normal.divideScalar(double).cross(x);
  const corners = [[0, 0], [ab.length(), 0], [ac.dot(x), ac.dot(y)]];
  const slopes = corners.map((_, i): [number, number] => {
    const [p, q] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
    return [(p[1] - q[1]) / double, (q[0] - p[0]) / double];
  });
  return { x, y, slopes, area: double / 2 };
}

/** Stress of a free surface is plane: von Mises of it from the strain of a triangle [Pa]. */
function vonMises(rows: StrainRows, corners: Vector3[], young: number, poisson: number): number {
  let [xx, yy, xy] = [0, 0, 0];
  corners.forEach((u, i) => {
    const [along, across] = [u.dot(rows.x), u.dot(rows.y)];
    const [dx, dy] = rows.slopes[i];
    xx += dx * along;
    yy += dy * across;
    xy += dy * along + dx * across;
  });
  const plane = young / (1 - poisson * poisson);
  const [sx, sy] = [plane * (xx + poisson * yy), plane * (yy + poisson * xx)];
  const t = (young / (2 + 2 * poisson)) * xy;
  return Math.sqrt(sx * sx - sx * sy + sy * sy + 3 * t * t);
}

/** Corners of the box around a surface, in the axes of its body. */
export function boxCorners(surface: Surface): Vector3[] {
  const flat = unpack(surface.positions);
  const range = [0, 1, 2].map((k) => {
    const all = flat.filter((_, i) => i % 3 === k);
    return [Math.min(...all), Math.max(...all)];
  });
  return range[0].flatMap((x) => range[1].flatMap((y) => range[2].map((z) => new Vector3(x, y, z))));
}

/** A displacement without which the places that joints hold are where they were: turned and stretched with them. */
class HeldMotion {
  private readonly from: Vector3;
  private readonly along: Vector3 | null;

  constructor(private readonly held: Vector3[]) {
    this.from = held[0] ?? new Vector3();
    this.along = held.length > 1 ? held[held.length - 1].clone().sub(this.from) : null;
  }

  /** @param moved displacements of the places */
  at(point: Vector3, moved: Vector3[]): Vector3 {
    const whole = moved[0]?.clone() ?? new Vector3();
    if (!this.along) return whole;
    const square = this.along.lengthSq();
    const change = moved[moved.length - 1].clone().sub(whole);
    const turn = this.along.clone().cross(change).divideScalar(square);
    const offset = point.clone().sub(this.from);
    const share = offset.dot(this.along) / square;
    whole.add(turn.cross(offset));
    return whole.addScaledVector(this.along, (share * change.dot(this.along)) / square);
  }

  get places(): Vector3[] {
    return this.held;
  }
}

export class SurfaceMember implements Member {
  readonly object = new Group();
  private readonly points: Vector3[];
  private readonly shapes: Float32Array; // coordinate by coordinate, 3 numbers a point
  private readonly triangles: number[][];
  private readonly strains: StrainRows[];
  private readonly held: HeldMotion;
  private readonly mesh: Mesh;
  private readonly edges: LineSegments;
  private readonly edgePoints: number[];
  private readonly displacements: Vector3[];
  private look: Look = { color: [0.7, 0.7, 0.7], edge: "#000", opacity: 1, isGhost: false };

  /** @param held places that joints hold, in the axes of the body */
  constructor(
    readonly body: number,
    private readonly surface: Surface,
    held: Vector3[],
  ) {
    const flat = unpack(surface.positions);
    this.points = Array.from({ length: flat.length / 3 }, (_, i) => new Vector3(flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]));
    this.shapes = unpack(surface.displacement);
    this.triangles = surface.triangles;
    this.strains = this.triangles.map(([a, b, c]) => strainRows(this.points[a], this.points[b], this.points[c]));
    this.held = new HeldMotion(held);
    this.displacements = this.points.map(() => new Vector3());
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(flat.slice(), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(flat.length).fill(0.7), 3));
    geometry.setIndex(this.triangles.flat());
    this.mesh = new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, flatShading: true, side: DoubleSide, transparent: true }));
    this.mesh.userData.body = body;
    this.edgePoints = this.sharpEdges(geometry);
    const lines = new BufferGeometry();
    lines.setAttribute("position", new BufferAttribute(new Float32Array(3 * this.edgePoints.length), 3));
    this.edges = new LineSegments(lines, new LineBasicMaterial({ transparent: true }));
    this.mesh.frustumCulled = this.edges.frustumCulled = false;
    this.object.add(this.mesh, this.edges);
  }

  update(pose: BodyPose, limit: number | null): void {
    this.deform(pose);
    this.paint(this.look.isGhost ? null : limit);
    const positions = this.mesh.geometry.getAttribute("position");
    const lines = this.edges.geometry.getAttribute("position");
    this.edgePoints.forEach((p, i) => lines.setXYZ(i, positions.getX(p), positions.getY(p), positions.getZ(p)));
    positions.needsUpdate = lines.needsUpdate = true;
    this.mesh.geometry.boundingSphere = null;
  }

  setLook(look: Look, isSelected: boolean): void {
    this.look = look;
    showLook(this.mesh, this.edges, look, isSelected, 0.4);
  }

  deviation(pose: BodyPose): number {
    this.displace(pose);
    return Math.max(...this.fromHeld(pose).map((u) => u.length()));
  }

  private deform(pose: BodyPose): void {
    this.displace(pose);
    const { origin, scale } = pose.elastic ?? { origin: pose.origin, scale: 1 };
    const positions = this.mesh.geometry.getAttribute("position");
    const more = this.fromHeld(pose);
    this.points.forEach((point, i) => {
      const p = point.clone().add(this.displacements[i]).addScaledVector(more[i], scale - 1);
      p.applyQuaternion(pose.frames[0]).add(origin);
      positions.setXYZ(i, p.x, p.y, p.z);
    });
  }

  /** Displacements of the points in the frame of the body. */
  private displace(pose: BodyPose): void {
    const coordinates = pose.elastic?.coordinates ?? [];
    const rows = 3 * this.points.length;
    this.displacements.forEach((u, i) => {
      u.set(0, 0, 0);
      coordinates.forEach((q, k) => {
        const first = k * rows + 3 * i;
        u.x += q * this.shapes[first];
        u.y += q * this.shapes[first + 1];
        u.z += q * this.shapes[first + 2];
      });
    });
  }

  /** Without what the places that joints hold do. */
  private fromHeld(pose: BodyPose): Vector3[] {
    const origin = pose.elastic?.origin ?? pose.origin;
    const back = pose.frames[0].clone().invert();
    // The station nearest to a place tells where it is, in the axes of the body.
    const pointOf = (place: Vector3) => pose.points[nearestStation(pose, place.x)].clone().sub(origin).applyQuaternion(back);
    const moved = this.held.places.map((place) => pointOf(place).sub(place));
    return this.points.map((point, i) => this.displacements[i].clone().sub(this.held.at(point, moved)));
  }

  private paint(limit: number | null): void {
    const colors = this.mesh.geometry.getAttribute("color");
    const stress = limit ? this.stress() : null;
    this.points.forEach((_, i) => colors.setXYZ(i, ...(stress && limit ? stressColor(stress[i] / limit) : this.look.color)));
    colors.needsUpdate = true;
  }

  /** Von Mises at the points: the mean of the triangles around them, by area [Pa]. */
  stress(): number[] {
    const sums = this.points.map(() => 0);
    const areas = this.points.map(() => 0);
    this.triangles.forEach((triangle, t) => {
      const rows = this.strains[t];
      const value = vonMises(rows, triangle.map((i) => this.displacements[i]), this.surface.young, this.surface.poisson);
      for (const i of triangle) {
        sums[i] += rows.area * value;
        areas[i] += rows.area;
      }
    });
    return sums.map((sum, i) => sum / (areas[i] || 1));
  }

  /** Pairs of points whose edge is drawn: between surfaces that meet at an angle. */
  private sharpEdges(geometry: BufferGeometry): number[] {
    const key = (x: number, y: number, z: number) => [x, y, z].map((one) => one.toPrecision(6)).join(" ");
    const index = new Map(this.points.map((p, i) => [key(p.x, p.y, p.z), i]));
    const ends = new EdgesGeometry(geometry, 35).getAttribute("position");
    return Array.from({ length: ends.count }, (_, i) => index.get(key(ends.getX(i), ends.getY(i), ends.getZ(i)))!);
  }
}
