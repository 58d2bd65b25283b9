// What the signer does when (Gürel 2010, A.2.3): an idle loop; a movement that begins when the loop
// ends and is played from beginning to end; idle again.
import type { Label, Movement } from './clip';
import { labelAt } from './clip';
import { Pose, minimumJerk } from './pose';

export const SLOWEST = 0.1;
export const FASTEST = 2;
const FADE_S = 0.3; // of the idle loop into a movement and out of it, inside the movement

export type State = 'idle' | 'waiting' | 'playing';

export class Playback {
  /** Seconds into the movement. */
  time = 0;
  paused = false;
  loop = false;
  /** How many times faster than its own times a movement is played. The idle loop has its own. */
  speed = 1;
  private idleTime = 0;
  private other: Pose;
  private now: State = 'idle';
  private movement: Movement | null = null;

  constructor(joints: number, units: number, private idle: Movement | null = null) {
    this.other = new Pose(joints, units);
  }

  get state(): State {
    return this.now;
  }

  get playing(): Movement | null {
    return this.movement;
  }

  /** Seconds into the idle loop. */
  get idling(): number {
    return this.idleTime;
  }

  get duration(): number {
    return this.movement?.duration ?? 0;
  }

  /** The sign that is shown: none while idle. */
  get label(): Label | null {
    return this.now === 'playing' && this.movement ? labelAt(this.movement.labels, this.time) : null;
  }

  /** Whether the picture changes by itself. */
  get moving(): boolean {
    return this.now === 'playing' ? !this.paused : this.idle !== null;
  }

  setIdle(idle: Movement | null): void {
    this.idle = idle;
    this.idleTime = 0;
  }

  /** Plays a movement when the idle loop ends; at once if there is none, or if it is shown paused. */
  play(movement: Movement, paused = false): void {
    this.movement = movement;
    this.time = 0;
    this.paused = paused;
    this.now = this.idle && !paused && this.now !== 'playing' ? 'waiting' : 'playing';
  }

  /** Goes back to the idle loop, or to the beginning if there is none. */
  stop(): void {
    this.time = 0;
    this.paused = true;
    if (!this.idle) return;
    this.now = 'idle';
    this.movement = null;
    this.idleTime = 0;
  }

  seek(time: number): void {
    if (!this.movement) return;
    this.now = 'playing';
    this.time = Math.min(this.movement.duration, Math.max(0, time));
  }

  /** Lets seconds pass; returns whether a movement ended. */
  advance(seconds: number): boolean {
    if (this.idle && !(this.now === 'playing' && this.paused)) {
      this.idleTime += seconds;
      if (this.idleTime >= this.idle.duration) {
        this.idleTime %= this.idle.duration || 1;
        if (this.now === 'waiting') {
          this.now = 'playing';
          this.time = this.idleTime * this.speed;
          return false;
        }
      }
    }
    if (this.now !== 'playing' || this.paused || !this.movement) return false;
    const before = this.time;
    this.time += seconds * this.speed;
    const end = this.movement.duration, fade = end - FADE_S;
    if (before < fade && this.time >= fade) this.idleTime = 0; // the loop begins as the signs end
    if (this.time < end) return false;
    if (this.loop && end > 0) {
      this.time %= end;
      return false;
    }
    this.time = end;
    if (this.idle) {
      this.now = 'idle';
      this.time = 0;
      this.movement = null;
    } else {
      this.paused = true;
    }
    return true;
  }

  /** Writes the posture of now. */
  sample(out: Pose): void {
    if (this.now !== 'playing' || !this.movement) {
      const shown = this.idle ?? this.movement;
      shown?.sample(this.idle ? this.idleTime : this.time, out);
      return;
    }
    this.movement.sample(this.time, out);
    if (!this.idle || this.loop) return;
    const edge = Math.min(this.time, this.movement.duration - this.time) / FADE_S;
    if (edge >= 1) return;
    this.idle.sample(this.idleTime, this.other);
    out.towards(this.other, 1 - minimumJerk(edge));
  }
}
