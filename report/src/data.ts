// What the program embeds into the page: its keys are those of the documents (docs/reference/commands.md). All numbers are in SI units.

export type Vec3 = [number, number, number];

export interface Packed {
  rows: number;
  f32: string;
}

export interface Unit {
  si: string;
  name: string;
  factor: number;
}

export interface Meaning {
  type: string;
  over_time: string;
  bodies: string[];
  joint?: string;
  at?: number;
  unit: Unit;
  /** Of its history: another one where the number is an integral. */
  history_unit?: Unit;
  /** Whether a limit on the number is one on each instant of its history. */
  limits_history?: boolean;
}

export interface Shown {
  name: string;
  value: number;
  peak_time?: number;
  peak_place?: string;
  peak_share?: number; // along the body, 0 … 1
  history?: Packed;
  gradients?: Record<string, number>;
  slopes?: Record<string, Packed>; // derivatives of the history by variable
}

export type Companion = Shown & Meaning;

export interface Place {
  body: number;
  at: Vec3;
  share?: number;
  point?: Vec3;
}

export interface Segment {
  begin: number;
  end: number;
  text: string;
  elements: number;
  outer: [number, number][];
  inner: [number, number][];
}

/** Of a body from a mesh, in its axes [m]. */
export interface Surface {
  positions: Packed;
  triangles: number[][];
  displacement: Packed; // of the points, per coordinate
  young: number; // [Pa]
  poisson: number;
}

export interface BodyGeometry {
  origin: Vec3;
  axes: [Vec3, Vec3, Vec3];
  length?: number;
  mass?: number;
  segments?: Segment[];
  surface?: Surface;
}

export interface Geometry {
  bodies: BodyGeometry[];
  joints: { places: [Place, Place]; drive?: Packed }[];
  loads: { places: Place[]; value?: Packed; text?: string }[];
}

export interface BodyMotion {
  stations: number[];
  parts: number[];
  positions: Packed;
  rotations: Packed;
  stress?: Packed;
  coordinates?: Packed; // elastic ones, of a body with a surface
  origins?: Packed; // of its frame
}

export interface Design {
  name: string;
  variables: number[];
  geometry: Geometry;
  masses?: Record<string, number>;
  motion?: { time: Packed; bodies: BodyMotion[] };
  responses?: Shown[];
  companions?: Companion[];
}

export interface SceneBody {
  name: string;
  type: "beam" | "rigid" | "point-mass" | "invariants";
  material?: string;
  is_rigid?: boolean;
  frames?: number;
  strength?: number;
  stress_limit?: number;
  /** Largest initial deflection and rate of an elastic body. */
  starts_bent?: { displacement: number; rate: number };
}

export interface SceneJoint {
  name: string;
  type: string;
  freedom: string;
  freedoms?: number;
  bodies: [string, string];
  axis: Vec3;
  second_axis?: Vec3;
  /** Along the axis, or in the plane across it. */
  slides?: "along" | "across";
  /** Whether the axis keeps its direction in the body that slides along it. */
  is_guide: boolean;
  drive?: "angle" | "displacement";
}

export interface SceneLoad {
  name: string;
  type: "force" | "torque" | "spring" | "joint-force";
  bodies?: string[];
  joint?: string;
  direction?: Vec3;
  follows_body?: boolean;
  unit?: string;
}

export interface Scene {
  gravity: Vec3;
  end_time: number;
  plane_normal?: Vec3;
  bodies: SceneBody[];
  joints: SceneJoint[];
  loads: SceneLoad[];
}

export interface Picture {
  name: string;
  description: string;
  scene: Scene;
  variables: Record<string, { start: number; lower: number; upper: number; unit: Unit }>;
  responses: Record<string, Meaning>;
  limits: Record<string, { unit: Unit; response?: string; lower?: number; upper?: number }>;
  size?: number; // of the mechanism [m]
  objective?: string;
  maximizes?: boolean;
  designs: Design[];
  /** Load case that it is of. */
  case?: string;
  /** Pictures of the other load cases of the run. */
  other_cases?: Picture[];
  /** Of the run that it is compared with. */
  compared?: Picture;
  /** Of the numbers of all load cases, by their names in the result. */
  units?: { responses: Record<string, Unit>; limits: Record<string, Unit> };
}

export interface ErrorBar {
  total: number | null;
  step?: number | null;
  elements?: number | null;
  newton?: number | null;
  effects?: number | null;
  left_out?: Record<string, number>;
  is_modelled?: boolean;
}

// Documents of the program are looked at key by key: what is missing is not shown.
// eslint-disable-next-line @typescript-eslint/no-explicit-any
export type Document = any;

export interface ReportData {
  format: number;
  card: Document;
  result: Document;
  picture: Picture | null;
  files: Record<string, string>;
  /** Files that are too large for a page. */
  left_out?: string[];
}

export function readData(): ReportData | null {
  const text = document.getElementById("pleuel-data")?.textContent?.trim();
  if (!text) return null;
  // What turns the direction of writing is shown as what it is.
  const shown = text.replace(/[\u202a-\u202e\u2066-\u2069]/g, (mark) => `⟨U+${mark.charCodeAt(0).toString(16).toUpperCase()}⟩`);
  return JSON.parse(shown) as ReportData;
}

const unpackedNumbers = new WeakMap<Packed, Float32Array>();

/** The numbers, column by column. */
export function unpack(packed: Packed): Float32Array {
  const known = unpackedNumbers.get(packed);
  if (known) return known;
  const text = atob(packed.f32);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  const numbers = new Float32Array(bytes.buffer);
  unpackedNumbers.set(packed, numbers);
  return numbers;
}

export interface Curve {
  x: number[];
  y: number[];
  band?: number[]; // half-widths of the error band
}

/** A curve of two rows, time and value, or three, with the half-width of its band; in the units that people see. */
export function curveOf(packed: Packed, xFactor = 1, yFactor = 1): Curve {
  const numbers = unpack(packed);
  const rows = packed.rows;
  const curve: Curve = { x: [], y: [] };
  if (rows > 2) curve.band = [];
  for (let i = 0; i + rows <= numbers.length; i += rows) {
    curve.x.push(numbers[i] / xFactor);
    curve.y.push(numbers[i + 1] / yFactor);
    curve.band?.push(numbers[i + 2] / yFactor);
  }
  return curve;
}

/** Between which of rising numbers x is: behind which, and how far on the way to the next. */
export function intervalOf(x: number, numbers: ArrayLike<number>, stride = 1): { index: number; part: number } {
  let [low, high] = [0, numbers.length / stride - 1];
  if (!(x > numbers[0])) return { index: 0, part: 0 };
  if (x >= numbers[stride * high]) return { index: high, part: 0 };
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (numbers[stride * middle] <= x) low = middle;
    else high = middle;
  }
  const [before, behind] = [numbers[stride * low], numbers[stride * high]];
  return { index: low, part: (x - before) / (behind - before) };
}

/** Linear between the points of a curve; constant beyond. */
export function valueAt(packed: Packed, time: number): number {
  const numbers = unpack(packed);
  if (!numbers.length) return 0;
  const { index, part } = intervalOf(time, numbers, packed.rows);
  const at = (i: number) => numbers[packed.rows * i + 1];
  return part > 0 ? at(index) + part * (at(index + 1) - at(index)) : at(index);
}

/** RFC 4180, as the program writes it. */
export function parseCsv(text: string): { header: string[]; rows: string[][] } {
  const rows: string[][] = [];
  let row: string[] = [];
  let cell = "";
  let quoted = false;
  for (let i = 0; i < text.length; i++) {
    const letter = text[i];
    if (quoted) {
      if (letter === '"' && text[i + 1] === '"') cell += text[++i];
      else if (letter === '"') quoted = false;
      else cell += letter;
    } else if (letter === '"') quoted = true;
    else if (letter === "," || letter === "\n") {
      row.push(cell.replace(/\r$/, ""));
      cell = "";
      if (letter === "\n") {
        rows.push(row);
        row = [];
      }
    } else cell += letter;
  }
  if (cell || row.length) rows.push([...row, cell]);
  return { header: rows[0] ?? [], rows: rows.slice(1) };
}
