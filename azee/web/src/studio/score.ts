// The score on its time line: nested blocks, drawn as SVG, reached by mouse, touch and keys.
import { h, svg } from './elements';
import type { Block, Constraint } from './protocol';

const ROW = 26, RULER = 20, PAD = 12, LEAST_WIDTH = 4, LEAST_TITLED = 18;

interface Row {
  block: Block;
  index: number;
  depth: number;
  lane: number;
}

export class Score {
  readonly element: HTMLElement;
  private readonly drawing = svg('svg', { role: 'listbox', tabindex: 0, class: 'score' });
  private readonly head = svg('line', { class: 'playhead', y1: 0 });
  private rows: Row[] = [];
  private boxes = new Map<number, SVGGElement>();
  private lead = 0;
  private duration = 1;
  private missed = new Set<string>();
  private eased = new Set<string>();
  chosen = -1;

  constructor(
    label: string,
    private readonly picked: (block: Block | null, play: boolean) => void,
    private readonly sought: (time: number) => void,
  ) {
    this.drawing.setAttribute('aria-label', label);
    this.element = h('div', { class: 'score-scroll' }, this.drawing);
    this.drawing.addEventListener('pointerdown', event => this.press(event));
    this.drawing.addEventListener('pointermove', event => {
      if (event.buttons & 1 && this.drawing.hasPointerCapture(event.pointerId)) this.seekTo(event);
    });
    this.drawing.addEventListener('keydown', event => this.key(event));
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  rename(label: string): void {
    this.drawing.setAttribute('aria-label', label);
  }

  show(blocks: readonly Block[], lead: number, duration: number): void {
    const before = this.rows.find(row => row.index === this.chosen)?.block.path.join('/');
    const depths: number[] = [];
    this.rows = blocks.map((block, index) => {
      const depth = block.parent < 0 ? 0 : depths[block.parent]! + 1;
      depths.push(depth);
      return { block, index, depth, lane: 0 };
    });
    this.lead = lead;
    this.duration = Math.max(duration, 0.1);
    this.chosen = this.rows.find(row => row.block.path.join('/') === before)?.index ?? -1;
    this.place();
    this.draw();
  }

  report(constraints: readonly Constraint[]): void {
    const of = (outcome: string) => new Set(constraints.filter(c => c.outcome === outcome)
      .map(c => c.path.join('/')));
    this.missed = of('missed');
    this.eased = of('eased');
    this.draw();
  }

  choose(index: number): void {
    this.chosen = index;
    for (const [key, box] of this.boxes) box.setAttribute('aria-selected', String(key === index));
    const active = this.boxes.get(index);
    if (active) {
      this.drawing.setAttribute('aria-activedescendant', active.id);
      const rect = active.querySelector('rect')!;
      const top = Number(rect.getAttribute('y'));
      if (top < this.element.scrollTop + RULER || top + ROW > this.element.scrollTop + this.element.clientHeight)
        this.element.scrollTo({ top: Math.max(0, top - RULER - ROW) });
    } else this.drawing.removeAttribute('aria-activedescendant');
  }

  /** Moves the head and lights the blocks that run. Returns those with places, innermost last. */
  now(time: number): Block[] {
    const x = this.x(time - this.lead);
    this.head.setAttribute('x1', String(x));
    this.head.setAttribute('x2', String(x));
    const running: Block[] = [];
    for (const { block, index } of this.rows) {
      const on = block.start_s <= time - this.lead && time - this.lead < block.end_s;
      this.boxes.get(index)?.classList.toggle('now', on);
      if (on && block.place) running.push(block);
    }
    return running;
  }

  /** Gives every block a lane under its parent, so that none hides another. */
  private place(): void {
    const ends: number[] = [];
    for (const row of this.rows) {
      const parent = row.block.parent < 0 ? -1 : this.rows[row.block.parent]!.lane;
      let lane = parent + 1;
      while ((ends[lane] ?? -1) > row.block.start_s + 1e-6 || this.crosses(row, lane)) lane++;
      row.lane = lane;
      ends[lane] = Math.max(ends[lane] ?? -1, row.block.end_s);
    }
  }

  private crosses(row: Row, lane: number): boolean {
    return this.rows.some(other => other !== row && other.index < row.index && other.lane === lane
      && other.block.start_s < row.block.end_s - 1e-6 && row.block.start_s < other.block.end_s - 1e-6);
  }

  private x(time: number): number {
    const width = Math.max(200, this.element.clientWidth) - 2 * PAD;
    return PAD + ((time + this.lead) / this.duration) * width;
  }

  private draw(): void {
    const width = Math.max(200, this.element.clientWidth);
    const lanes = 1 + Math.max(-1, ...this.rows.map(row => row.lane));
    const height = RULER + lanes * ROW + 6;
    this.boxes.clear();
    this.drawing.replaceChildren(this.ruler(width));
    for (const row of this.rows) {
      const box = this.box(row);
      this.boxes.set(row.index, box);
      this.drawing.append(box);
    }
    this.head.setAttribute('y2', String(height));
    this.drawing.append(this.head);
    this.drawing.setAttribute('width', String(width));
    this.drawing.setAttribute('height', String(height));
    this.choose(this.chosen);
  }

  private ruler(width: number): SVGGElement {
    const group = svg('g', { class: 'ruler', 'aria-hidden': 'true' });
    const perSecond = (width - 2 * PAD) / this.duration;
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find(s => s * perSecond >= 60) ?? 100;
    for (let i = Math.ceil(-this.lead / step); i * step <= this.duration - this.lead; i++) {
      const x = this.x(i * step);
      group.append(
        svg('line', { x1: x, x2: x, y1: RULER - 5, y2: RULER }),
        svg('text', { x, y: RULER - 8, 'text-anchor': 'middle' }, `${+(i * step).toFixed(1)} s`),
      );
    }
    return group;
  }

  private box({ block, index, lane }: Row): SVGGElement {
    const x = this.x(block.start_s);
    const wide = Math.max(LEAST_WIDTH, this.x(block.end_s) - x - 1);
    const y = RULER + lane * ROW;
    const path = block.path.join('/');
    const state = this.missed.has(path) ? 'missed' : this.eased.has(path) ? 'eased' : '';
    const times = `${block.start_s.toFixed(2)}–${block.end_s.toFixed(2)} s`;
    const group = svg('g', {
      role: 'option', id: `block-${index}`, 'data-index': index,
      'aria-label': `${block.title}, ${times}${state ? `, ${state}` : ''}`, 'aria-selected': 'false',
      class: `block ${block.kind} ${block.place ? 'own' : 'library'} ${state}`,
    });
    group.append(
      svg('title', {}, `${block.title}, ${times}`),
      svg('rect', { x, y: y + 1, width: wide, height: ROW - 3, rx: 4 }),
    );
    if (wide >= LEAST_TITLED) // as HTML, which shortens what has no room by an ellipsis
      group.append(svg('foreignObject', { x: x + 6, y: y + 1, width: wide - 9, height: ROW - 3 },
        h('div', { class: 'block-title' }, block.title)));
    if (state) group.append(svg('circle', { cx: x + wide - 6, cy: y + 7, r: 3.5, class: 'flag' }));
    return group;
  }

  private seekTo(event: PointerEvent): void {
    const box = this.drawing.getBoundingClientRect();
    const share = (event.clientX - box.left - PAD) / (box.width - 2 * PAD);
    this.sought(share * this.duration);
  }

  private press(event: PointerEvent): void {
    const group = (event.target as Element).closest<SVGGElement>('.block');
    if (group) {
      this.pick(Number(group.dataset['index']), false);
    } else {
      this.drawing.setPointerCapture(event.pointerId);
      this.seekTo(event);
    }
  }

  private pick(index: number, play: boolean): void {
    this.choose(index);
    this.picked(this.rows.find(row => row.index === index)?.block ?? null, play);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const row = this.rows.find(candidate => candidate.index === this.chosen);
    const siblings = this.rows.filter(other => row && other.block.parent === row.block.parent);
    const at = row ? siblings.indexOf(row) : 0;
    const goals: Record<string, Row | undefined> = {
      ArrowRight: row ? siblings[at + 1] : this.rows[0],
      ArrowLeft: row ? siblings[at - 1] : this.rows[0],
      ArrowDown: row ? this.rows.find(other => other.block.parent === row.index) : this.rows[0],
      ArrowUp: row && row.block.parent >= 0 ? this.rows[row.block.parent] : undefined,
      Home: this.rows[0],
      End: this.rows.at(-1),
    };
    if (event.key in goals) {
      event.preventDefault();
      const goal = goals[event.key];
      if (goal) this.pick(goal.index, false);
    } else if ((event.key === 'Enter' || event.key === ' ') && row) {
      event.preventDefault();
      this.pick(row.index, true);
    } else if (event.key === 'Escape') {
      this.pick(-1, false);
    }
  }
}
