// The signer: the body drawn by WebGL, its time, its cameras, and marks of constraints.
import {
  BufferGeometry, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, type Object3D,
  type PerspectiveCamera, SphereGeometry, Vector3,
} from 'three';
import { type Body, loadBody } from '../player/body';
import { type Movement, WebClip } from '../player/clip';
import type { Pose } from '../player/pose';
import { parametersOf, readSettings, type Settings } from '../player/settings';
import { Stage } from '../player/stage';
import type { Mark, Posture } from './protocol';

const LONGEST_STEP_S = 0.25;
const SITE = 0xd96c00, GOAL = 0x0a7d4f;
const DOT_M = 0.009;

interface Camera {
  turn: number;
  tilt: number;
  away: number;
  target: readonly [number, number, number];
}

/** Named cameras, for a strong right hand; angles in radians. */
export const CAMERAS: Readonly<Record<'front' | 'side' | 'above' | 'hands' | 'face', Camera>> = {
  front: { turn: 0, tilt: 0.03, away: 2.75, target: [0, 1.2, 0] },
  side: { turn: -1.35, tilt: 0.03, away: 2.75, target: [0, 1.2, 0] },
  above: { turn: 0, tilt: 1.1, away: 2.4, target: [0, 1.2, 0.1] },
  hands: { turn: -0.2, tilt: 0.12, away: 1.75, target: [0, 1.26, 0.15] },
  face: { turn: 0, tilt: 0, away: 0.95, target: [0, 1.52, 0.05] },
};

export class Signer {
  time = 0;
  playing = false;
  speed = 1;
  /** Seconds between which it repeats; the whole where there are none. */
  loop: readonly [number, number] | null = null;
  duration = 0;
  /** Milliseconds between pictures, of the last ones. */
  readonly intervals: number[] = [];
  private readonly stage: Stage;
  private readonly settings: Settings;
  private body: Body | null = null;
  private pose: Pose | null = null;
  private clip: WebClip | null = null;
  private movement: Movement | null = null;
  private readonly marks = new Group();
  /** What is shown in place of the movement, while somebody poses the body. */
  private held: Posture | null = null;
  private wanted = '';
  private last: number | null = null;
  private drawn: (() => void)[] = [];

  /** Throws an Error where there is no WebGL. `changed` is called when the time is another. */
  constructor(readonly canvas: HTMLCanvasElement, private readonly changed: () => void) {
    this.stage = new Stage(canvas);
    this.settings = readSettings(parametersOf(location.search), message => console.warn(message));
    this.speed = this.settings.speed;
    requestAnimationFrame(now => this.step(now));
  }

  /** Shows a body; resolves when it stands there. */
  async dress(address: string): Promise<void> {
    this.wanted = address;
    const body = await loadBody(address);
    if (this.wanted !== address) return;
    this.body?.scene.remove(this.marks);
    this.body = body;
    this.pose = body.pose();
    this.stage.show(body);
    body.scene.add(this.marks);
    await this.stage.arrange(this.settings);
    this.bind();
  }

  /** Takes a movement; the time stays, as far as it is in it. */
  show(data: ArrayBuffer, drawn: () => void): void {
    this.clip = new WebClip(data);
    this.duration = this.clip.header.duration_s;
    this.drawn.push(drawn);
    this.bind();
    this.seek(Math.min(this.time, this.duration));
  }

  /** Shows a posture until the time is another; null: the movement again. */
  hold(posture: Posture | null): void {
    this.held = posture;
    this.pose_();
  }

  get camera(): PerspectiveCamera {
    return this.stage.view.camera;
  }

  /** What of the drawing is the body, in whose metres all places are; null before it is loaded. */
  get scene(): Object3D | null {
    return this.body?.scene ?? null;
  }

  /** Draws again soon. */
  redraw(): void {
    this.stage.dirty = true;
  }

  seek(time: number): void {
    this.held = null;
    this.time = Math.min(Math.max(0, time), this.duration);
    this.pose_();
    this.changed();
  }

  play(on: boolean): void {
    this.playing = on && this.duration > 0;
    const [start, end] = this.loop ?? [0, this.duration];
    if (this.playing && (this.time >= end - 1e-3 || this.time < start)) this.time = start;
    this.changed();
  }

  frame(direction: 1 | -1): void {
    this.playing = false;
    const times = this.clip?.times ?? new Float32Array(0);
    const other = direction > 0
      ? times.find(time => time > this.time + 1e-4)
      : times.findLast(time => time < this.time - 1e-4);
    this.seek(other ?? this.time);
  }

  look(name: keyof typeof CAMERAS, mirrored: boolean): void {
    const camera = CAMERAS[name];
    const { view } = this.stage;
    const turn = mirrored ? -camera.turn : camera.turn;
    view.look({ ...camera, turn });
  }

  /** Draws where sites are and where they should be. */
  mark(shown: readonly Mark[]): void {
    this.marks.clear();
    for (const { at, goal, base } of shown) {
      if (base) this.marks.add(line(base, at, SITE), line(base, goal, GOAL), dot(at, SITE));
      else this.marks.add(line(at, goal, GOAL), dot(at, SITE));
      this.marks.add(dot(goal, GOAL));
    }
    this.stage.dirty = true;
  }

  get device(): string {
    return this.stage.device;
  }

  /** Draws the frame at a time and returns how long that took, milliseconds. For measuring. */
  timed(time: number): number {
    this.seek(time);
    return this.stage.timed();
  }

  joints(): Record<string, number[]> {
    return this.body?.places() ?? {};
  }

  private bind(): void {
    this.movement = this.body && this.clip ? this.clip.on(this.body) : null;
    if (this.body) this.body.scene.visible = this.movement !== null; // nobody stands in the bind pose
    this.pose_();
  }

  private pose_(): void {
    if (!this.body || !this.pose || !this.movement) return;
    this.movement.sample(this.time, this.pose);
    if (this.held) this.body.take(this.held, this.pose);
    this.body.apply(this.pose);
    this.stage.dirty = true;
  }

  private step(now: number): void {
    requestAnimationFrame(next => this.step(next));
    const seconds = this.last === null ? 0 : (now - this.last) / 1000;
    this.last = now;
    this.stage.fit();
    if (this.playing) {
      this.advance(Math.min(seconds, LONGEST_STEP_S) * this.speed);
      this.intervals.push(1000 * seconds);
      if (this.intervals.length > 240) this.intervals.shift();
    }
    if (!this.stage.dirty) return;
    this.stage.draw();
    if (this.movement) for (const done of this.drawn.splice(0)) done();
  }

  private advance(seconds: number): void {
    const [start, end] = this.loop ?? [0, this.duration];
    const length = Math.max(end - start, 1e-3);
    const time = this.time + seconds;
    this.seek(time < end ? time : start + ((time - start) % length));
  }
}

type Place = readonly [number, number, number];

export function line(from: Place, to: Place, color: number): Line {
  const ends = [new Vector3(...from), new Vector3(...to)];
  const made = new Line(
    new BufferGeometry().setFromPoints(ends), new LineBasicMaterial({ color, depthTest: false }),
  );
  made.renderOrder = 10;
  return made;
}

export function dot(at: Place, color: number, radius = DOT_M): Mesh {
  const made = new Mesh(
    new SphereGeometry(radius, 12, 8), new MeshBasicMaterial({ color, depthTest: false }),
  );
  made.position.set(...at);
  made.renderOrder = 11;
  return made;
}
