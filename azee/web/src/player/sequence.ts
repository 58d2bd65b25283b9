// Signs one after the other, each with an attack and a decay outside of what it means: the decay of
// a sign is blended with the attack of the next (Gürel 2010, 4.1.3), here by minimum jerk.
import type { Label, Movement, WebClip } from './clip';
import type { Body } from './body';
import { type Pose, minimumJerk } from './pose';

const LEAST_S = 0.15; // from a sign to the next, where attack and decay are as long
const FASTEST_RAD_S = 6; // at which the joint turns that has the longest way between two signs
const PAUSE_S = 0.4; // for a space between letters: the last letter is held

export interface Sign {
  readonly name: string;
  readonly clip: WebClip;
  /** Longer on the sign, before the next: for spaces. */
  readonly pause?: boolean;
}

interface Part {
  readonly name: string;
  readonly movement: Movement;
  readonly from: number; // seconds of the clip: from here to there it is what is meant
  readonly to: number;
  readonly pause: number;
  start: number; // seconds of the sequence at which the clip would begin
}

/** Joins signs to one movement of a body. */
export function sequence(signs: readonly Sign[], body: Body): Movement {
  const parts: Part[] = signs.map(({ name, clip, pause }) => {
    const movement = clip.on(body);
    const { attack_s = 0, decay_s = 0 } = clip.header.extras as { attack_s?: number; decay_s?: number };
    const to = Math.max(attack_s, movement.duration - decay_s);
    return { name, movement, from: attack_s, to, pause: pause ? PAUSE_S : 0, start: 0 };
  });
  const ways: number[] = []; // seconds from a sign to the next
  const [a, b] = [body.pose(), body.pose()];
  for (let n = 1; n < parts.length; n++) {
    const before = parts[n - 1]!, after = parts[n]!;
    before.movement.sample(before.to, a);
    after.movement.sample(after.from, b);
    const most = Math.min(before.movement.duration - before.to, after.from);
    const way = Math.max(LEAST_S, Math.min(most, a.angleTo(b) / FASTEST_RAD_S));
    ways.push(way);
    after.start = before.start + before.to + before.pause + way - after.from;
  }
  return new Sequence(parts, ways, body.pose());
}

class Sequence implements Movement {
  readonly duration: number;
  readonly labels: readonly Label[];

  constructor(private readonly parts: readonly Part[], private readonly ways: readonly number[],
    private readonly other: Pose) {
    const last = parts[parts.length - 1];
    this.duration = last ? last.start + last.movement.duration : 0;
    this.labels = parts.map((part, n) => ({
      text: part.name,
      path: [part.name],
      start_s: part.start + part.from - (ways[n - 1] ?? 0) / 2,
      end_s: part.start + part.to + part.pause + (ways[n] ?? 0) / 2,
    }));
  }

  sample(time: number, out: Pose): void {
    const n = Math.max(0, this.parts.findLastIndex((part, i) =>
      i === 0 || time >= part.start + part.from - this.ways[i - 1]!));
    const part = this.parts[n]!;
    part.movement.sample(this.within(n, time), out);
    const way = n > 0 ? this.ways[n - 1]! : 0;
    const share = n > 0 ? (time - (part.start + part.from - way)) / way : 1;
    if (share >= 1) return;
    this.parts[n - 1]!.movement.sample(this.within(n - 1, time), this.other);
    out.towards(this.other, 1 - minimumJerk(share));
  }

  /** Returns the time of a clip at one of the sequence; a pause holds the end of the sign. */
  private within(n: number, time: number): number {
    const part = this.parts[n]!;
    const at = time - part.start;
    return at <= part.to ? at : Math.max(part.to, at - part.pause);
  }
}
