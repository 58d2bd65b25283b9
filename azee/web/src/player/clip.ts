// A movement of a body, as docs/studio-protocol.md describes its bytes.
import { type Pose, turnBetween } from './pose';

const MAGIC = 0x4357_5a41; // "AZWC", little-endian
const ROTATION_STEPS = 32767;
const WEIGHT_STEPS = 16384;

/** A block of the score, or a sign: `path` has the names of those around it, its own last. */
export interface Label {
  readonly text: string;
  readonly path: readonly string[];
  readonly start_s: number;
  readonly end_s: number;
}

/** What can be played: a clip, or several joined. Times are in seconds from 0 to `duration`. */
export interface Movement {
  readonly duration: number;
  readonly labels: readonly Label[];
  sample(time: number, out: Pose): void;
}

interface Header {
  format: string;
  version: number;
  rig: string;
  frames: number;
  duration_s: number;
  joints: string[];
  still: Record<string, [number, number, number, number]>;
  units: string[];
  labels: Label[];
  extras: Record<string, unknown>;
}

/** The names by which a clip and a body find each other. */
export interface Names {
  readonly joints: readonly string[];
  readonly units: readonly string[];
}

export class WebClip {
  readonly header: Header;
  readonly times: Float32Array;
  readonly roots: Float32Array;
  readonly rotations: Int16Array;
  readonly weights: Int16Array;

  /** Reads a clip. Throws an Error that says what is wrong with the bytes. */
  constructor(data: ArrayBuffer) {
    const view = new DataView(data);
    if (data.byteLength < 8 || view.getUint32(0, true) !== MAGIC) throw Error('this is no web clip');
    const length = view.getUint32(4, true);
    if (8 + length > data.byteLength) throw Error('the web clip is cut off');
    this.header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 8, length))) as Header;
    if (this.header.version !== 1) throw Error(`web clips of version ${this.header.version} are not known`);
    const { frames, joints, units } = this.header;
    let at = 8 + length;
    const size = 4 * frames + 12 * frames + 8 * frames * joints.length + 2 * frames * units.length;
    if (frames < 1 || data.byteLength !== at + size) throw Error('the web clip is cut off');
    this.times = new Float32Array(data, at, frames);
    at += 4 * frames;
    this.roots = new Float32Array(data, at, 3 * frames);
    at += 12 * frames;
    this.rotations = new Int16Array(data, at, 4 * frames * joints.length);
    at += 8 * frames * joints.length;
    this.weights = new Int16Array(data, at, frames * units.length);
  }

  /** Returns the clip for the joints and face units of a body. */
  on(body: Names): Movement {
    return new BoundClip(this, body);
  }
}

class BoundClip implements Movement {
  readonly duration: number;
  readonly labels: readonly Label[];
  private readonly joints: number[]; // of the body, −1 where it has none
  private readonly units: number[];
  private readonly still: [number, readonly number[]][];

  constructor(private readonly clip: WebClip, body: Names) {
    const { header } = clip;
    const joint = new Map(body.joints.map((name, i) => [name, i]));
    const unit = new Map(body.units.map((name, i) => [name, i]));
    this.duration = header.duration_s;
    this.labels = header.labels;
    this.joints = header.joints.map(name => joint.get(name) ?? -1);
    this.units = header.units.map(name => unit.get(name) ?? -1);
    this.still = Object.entries(header.still).map(([name, turn]) => [joint.get(name) ?? -1, turn]);
  }

  sample(time: number, out: Pose): void {
    const { times, roots, rotations, weights } = this.clip;
    const frames = times.length;
    const before = frameAt(times, time);
    const after = Math.min(before + 1, frames - 1);
    const span = times[after]! - times[before]!;
    const share = span > 0 ? Math.min(1, Math.max(0, (time - times[before]!) / span)) : 0;
    out.rest();
    for (let k = 0; k < 3; k++)
      out.root[k] = roots[3 * before + k]! * (1 - share) + roots[3 * after + k]! * share;
    for (const [joint, turn] of this.still) if (joint >= 0) out.rotations.set(turn, 4 * joint);
    this.joints.forEach((joint, j) => {
      const row = 4 * frames * j;
      if (joint >= 0)
        turnBetween(rotations, row + 4 * before, rotations, row + 4 * after, share, ROTATION_STEPS,
          out.rotations, 4 * joint);
    });
    this.units.forEach((unit, u) => {
      if (unit < 0) return;
      const a = weights[frames * u + before]!, b = weights[frames * u + after]!;
      out.weights[unit] = (a * (1 - share) + b * share) / WEIGHT_STEPS;
    });
  }
}

/** Returns the last frame that is not after a time. */
function frameAt(times: Float32Array, time: number): number {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Returns the innermost label at a time, of those that run then the one that started last. */
export function labelAt(labels: readonly Label[], time: number): Label | null {
  let found: Label | null = null;
  for (const label of labels) {
    if (label.start_s > time) break;
    if (time < label.end_s && (!found || label.path.length >= found.path.length)) found = label;
  }
  return found;
}
