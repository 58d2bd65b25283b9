// A posture of a body, in the order of its joints and face units.

/** Rotations are quaternions xyzw relative to the parent, the root is in metres. */
export class Pose {
  readonly rotations: Float32Array;
  readonly root = new Float32Array(3);
  readonly weights: Float32Array;

  constructor(joints: number, units: number) {
    this.rotations = new Float32Array(4 * joints);
    this.weights = new Float32Array(units);
    this.rest();
  }

  /** Takes the bind pose, but for the place of the root. */
  rest(): void {
    this.rotations.fill(0);
    for (let w = 3; w < this.rotations.length; w += 4) this.rotations[w] = 1;
    this.weights.fill(0);
  }

  /** Goes a share of the way to another posture, from 0 to 1. */
  towards(other: Pose, share: number): void {
    if (share <= 0) return;
    for (let at = 0; at < this.rotations.length; at += 4)
      turnBetween(this.rotations, at, other.rotations, at, share, 1, this.rotations, at);
    for (let k = 0; k < 3; k++) this.root[k]! += share * (other.root[k]! - this.root[k]!);
    for (let u = 0; u < this.weights.length; u++)
      this.weights[u]! += share * (other.weights[u]! - this.weights[u]!);
  }

  /** Returns the largest angle between a joint's rotations in two postures, radians. */
  angleTo(other: Pose): number {
    let least = 1;
    for (let at = 0; at < this.rotations.length; at += 4) {
      let dot = 0;
      for (let k = 0; k < 4; k++) dot += this.rotations[at + k]! * other.rotations[at + k]!;
      least = Math.min(least, Math.abs(dot));
    }
    return 2 * Math.acos(least);
  }
}

/**
 * Writes the rotation at a share of the shorter way between two, normalised after interpolation.
 * `steps` is the length of the quaternions that are read.
 */
export function turnBetween(
  a: ArrayLike<number>, i: number, b: ArrayLike<number>, j: number, share: number, steps: number,
  out: Float32Array, k: number,
): void {
  const dot = a[i]! * b[j]! + a[i + 1]! * b[j + 1]! + a[i + 2]! * b[j + 2]! + a[i + 3]! * b[j + 3]!;
  const q = (dot < 0 ? -share : share) / steps, p = (1 - share) / steps;
  const x = p * a[i]! + q * b[j]!, y = p * a[i + 1]! + q * b[j + 1]!;
  const z = p * a[i + 2]! + q * b[j + 2]!, w = p * a[i + 3]! + q * b[j + 3]!;
  const size = Math.hypot(x, y, z, w) || 1;
  out[k] = x / size;
  out[k + 1] = y / size;
  out[k + 2] = z / size;
  out[k + 3] = w / size;
}

/** Minimum jerk (Flash & Hogan 1985): from 0 to 1 with speed and acceleration 0 at both ends. */
export function minimumJerk(share: number): number {
  const s = Math.min(1, Math.max(0, share));
  return s * s * s * (10 + s * (6 * s - 15));
}
