// Grips on the body: drawn, taken by pointer, dragged in the plane that faces the camera.
import { Group, type Object3D, Plane, Raycaster, Vector2, Vector3 } from 'three';
import type { Grip, Place } from './protocol';
import { dot, line, type Signer } from './signer';

const SITE = 0x0a5f63, ARROW = 0x7a3fa0, GAZE = 0x1f5fbf, CHOSEN = 0xd96c00;
const DOT_M = 0.0075, CHOSEN_M = 0.011;
const NEAR_PX = 12, NEAR_TOUCH_PX = 24;
const DEPTH_M = 0.02; // for a notch of the wheel

export interface Dragging {
  /** A grip is taken. */
  taken(handle: string): void;
  /** The pointer leads a grip to a place, metres. */
  led(handle: string, place: Place): void;
  /** The pointer has let it go. */
  left(handle: string): void;
}

export class GripView {
  private readonly drawn = new Group();
  private grips: readonly Grip[] = [];
  private chosen = '';
  private dragged: string | null = null;
  private readonly plane = new Plane();
  private readonly offset = new Vector3();
  private readonly rays = new Raycaster();

  constructor(private readonly signer: Signer, private readonly dragging: Dragging) {
    const { canvas } = signer;
    const first = { capture: true }; // before the view, which turns otherwise
    canvas.addEventListener('pointerdown', event => this.take(event), first);
    canvas.addEventListener('pointermove', event => this.lead(event), first);
    canvas.addEventListener('wheel', event => this.deepen(event), { capture: true, passive: false });
    for (const end of ['pointerup', 'pointercancel'] as const)
      canvas.addEventListener(end, event => this.leave(event), first);
  }

  /** Draws grips where they are now; none where there are none. */
  show(grips: readonly Grip[], chosen = this.chosen): void {
    this.grips = grips;
    this.chosen = chosen;
    this.drawn.clear();
    this.signer.scene?.add(this.drawn);
    for (const { handle, at, base } of grips) {
      const now = handle === chosen;
      const color = now ? CHOSEN : handle === 'gaze' ? GAZE : base ? ARROW : SITE;
      if (base) this.drawn.add(line(base, at, color));
      this.drawn.add(dot(at, color, now ? CHOSEN_M : DOT_M));
    }
    this.signer.redraw();
  }

  /** Where a grip is on the page, pixels; null where there is no such grip. */
  onPage(handle: string): [number, number] | null {
    const grip = this.grips.find(one => one.handle === handle);
    return grip && this.signer.scene ? this.pixel(grip.at, this.signer.scene) : null;
  }

  private pixel(at: Place, scene: Object3D): [number, number] {
    const seen = scene.localToWorld(new Vector3(...at)).project(this.signer.camera);
    const box = this.signer.canvas.getBoundingClientRect();
    return [box.left + (box.width * (seen.x + 1)) / 2, box.top + (box.height * (1 - seen.y)) / 2];
  }

  private nearest(event: PointerEvent): Grip | null {
    const { scene } = this.signer;
    if (!scene) return null;
    let best: Grip | null = null;
    let least = event.pointerType === 'touch' ? NEAR_TOUCH_PX : NEAR_PX;
    for (const grip of this.grips) {
      const [x, y] = this.pixel(grip.at, scene);
      const far = Math.hypot(x - event.clientX, y - event.clientY) - (grip.handle === this.chosen ? 4 : 0);
      if (far < least) [best, least] = [grip, far];
    }
    return best;
  }

  private take(event: PointerEvent): void {
    const grip = event.button === 0 ? this.nearest(event) : null;
    const { scene } = this.signer;
    if (!grip || !scene) return;
    event.stopImmediatePropagation();
    this.signer.canvas.setPointerCapture(event.pointerId);
    this.dragged = grip.handle;
    const at = scene.localToWorld(new Vector3(...grip.at));
    this.plane.setFromNormalAndCoplanarPoint(this.signer.camera.getWorldDirection(new Vector3()), at);
    this.offset.copy(at).sub(this.under(event) ?? at);
    this.dragging.taken(grip.handle);
  }

  private lead(event: PointerEvent): void {
    if (!this.dragged) {
      this.signer.canvas.style.cursor = this.grips.length > 0 && this.nearest(event) ? 'grab' : '';
      return;
    }
    event.stopImmediatePropagation();
    const place = this.under(event);
    if (place) this.tell(place.add(this.offset));
  }

  private tell(place: Vector3): void {
    this.signer.scene!.worldToLocal(place);
    this.dragging.led(this.dragged!, [place.x, place.y, place.z]);
  }

  /** Leads what is dragged away from the camera or to it. */
  private deepen(event: WheelEvent): void {
    if (!this.dragged) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const deeper = -Math.sign(event.deltaY) * DEPTH_M;
    this.plane.constant -= deeper;
    const place = this.under(event);
    if (place) this.tell(place.add(this.offset));
  }

  private leave(event: PointerEvent): void {
    if (!this.dragged) return;
    event.stopImmediatePropagation();
    const handle = this.dragged;
    this.dragged = null;
    this.dragging.left(handle);
  }

  /** The point of the plane that is under the pointer. */
  private under(event: MouseEvent): Vector3 | null {
    const box = this.signer.canvas.getBoundingClientRect();
    const on = new Vector2(
      (2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height,
    );
    this.rays.setFromCamera(on, this.signer.camera);
    return this.rays.ray.intersectPlane(this.plane, new Vector3());
  }
}
