// What server and page say to each other; docs/studio-protocol.md describes it.

export interface Diagnostic {
  code: string;
  severity: 'error' | 'warning';
  message: string;
  file: string | null;
  line: number | null;
  column: number | null;
  end_line: number | null;
  end_column: number | null;
  label: string;
  notes: string[];
  help: string | null;
}

/** A block of the score; times are the score's own. `place`: line and column in the text, from 1. */
export interface Block {
  path: string[];
  parent: number;
  title: string;
  rule: string | null;
  kind: 'key' | 'hold' | 'recorded' | 'blank' | 'sync' | 'seq';
  start_s: number;
  end_s: number;
  place: [number, number] | null;
  constraints: { text: string; place: [number, number] | null }[];
}

export type Place = [number, number, number];

/** Where a site or the tip of an axis is, and where it should be; `base` is the foot of an axis. */
export interface Mark {
  time_s: number;
  at: Place;
  goal: Place;
  base?: Place;
}

export interface Marked {
  path: string[];
  text: string;
  marks: Mark[];
}

export interface Constraint {
  path: string[];
  kind: string;
  subject: string;
  target: string;
  start_s: number;
  end_s: number;
  residual: number | null;
  unit: 'm' | 'rad';
  tolerance: number;
  outcome: 'met' | 'eased' | 'missed';
  reason: string | null;
}

export interface Rule {
  name: string;
  signature: string;
  meaning: string;
  source: string;
  library: string | null;
  status: string | null;
  gives: string | null;
  arguments: { name: string; default: string | null }[];
}

export interface Listing {
  folder: string;
  root: string;
  files: string[];
  films: string[];
  drafts: string[];
  first: string | null;
  bodies: string[];
  formats: string[];
}

export interface Opened {
  file: string;
  text: string;
  digest: string | null;
  draft: { text: string; digest: string | null; at: number } | null;
}

export interface Options {
  rig: string;
  dominant: 'right' | 'left';
  rest: 'hanging' | 'folded' | 'ready';
  tempo: number;
  life: boolean;
  precise: boolean;
}

/** A point by which a part of the body is dragged; `base` is the foot of an arrow that turns. */
export interface Grip {
  handle: string;
  at: Place;
  base: Place | null;
}

/** Rotations xyzw of all joints in the order of the body's skeleton, weights of face units. */
export interface Posture {
  rotations: [number, number, number, number][];
  weights: Record<string, number>;
}

/** What could be written for what was dragged. `change`: offsets of the editor. */
export interface Proposal {
  handle: string;
  written: string;
  kind: 'replace' | 'beside' | 'argument' | 'relocate' | 'own-rule' | 'block';
  where: string;
  fixes: string;
  off: number;
  unit: 'm' | 'rad' | null;
  change: { from: number; to: number; insert: string };
}

export type PoseAct =
  | { act: 'open'; at_s: number }
  | { act: 'drag'; handle: string; target: readonly number[] }
  | { act: 'release' | 'propose'; handle: string }
  | { act: 'close' };

/** What came of an act of posing; `lost`: there is no such session, `message`: why it did nothing. */
export interface Posed extends Partial<Posture> {
  kind: 'posed';
  act: PoseAct['act'];
  session: number;
  serial: number;
  lost?: boolean;
  message?: string;
  grips?: Grip[];
  fingers?: string[];
  face?: string[];
  blocked?: string[];
  missed?: string[];
  proposals?: Proposal[];
}

export type Answer =
  | Posed
  | { kind: 'hello'; root: string }
  | { kind: 'score'; number: number; diagnostics: Diagnostic[]; blocks: Block[]; ms: number }
  | {
    kind: 'clip'; number: number; blocks: Block[]; lead_s: number; key_times: number[];
    diagnostics: Diagnostic[]; ms: Record<string, number>; processor_ms: number;
  }
  | { kind: 'report'; number: number; constraints: Constraint[]; marks: Marked[] }
  | { kind: 'done' | 'superseded'; number: number | null }
  | { kind: 'stopped'; number: number | null; reason: string }
  | { kind: 'refused'; number?: number; message?: string; diagnostics?: Diagnostic[] }
  | { kind: 'kept'; file: string; number: number }
  | { kind: 'disk'; file: string; digest: string | null; text: string | null }
  | { kind: 'lsp'; message: unknown };
