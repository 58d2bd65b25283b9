// From where the body is seen, moved by mouse, touch and keys (Gürel 2010, A.2.2): sideways turns
// about Y, up and down about X, sideways with the middle button about Z, the wheel goes forward.
import { MathUtils, PerspectiveCamera, Quaternion, Vector3 } from 'three';

const FOV_DEG = 28;
const HOME = { turn: 0, tilt: 0.03, roll: 0, away: 2.75 };
const NEAREST_M = 0.4, FARTHEST_M = 8;
const RESTRICTED = { turn: 1.2, tilt: 0.5, nearest: 1.2, farthest: 4 };
const HEIGHT_M = 1.67, LOOKED_AT = 0.72; // of a body, and the share of it that is in the middle
const RAD_PER_PIXEL = 1 / 180;
const KEY_RAD = 0.1, KEY_ZOOM = 1.1;
const WIDTH_M = 1.25; // of the signing space, which a narrow picture shows too
const Y = new Vector3(0, 1, 0), X = new Vector3(1, 0, 0), Z = new Vector3(0, 0, 1);

export class View {
  readonly camera = new PerspectiveCamera(FOV_DEG, 1, 0.05, 30);
  /** What the camera looks at: between chin and belly. */
  readonly target = new Vector3(0, LOOKED_AT * HEIGHT_M, 0);
  /** Whether the view stays near the front, without rolling. */
  restricted = false;
  turn = HOME.turn;
  tilt = HOME.tilt;
  roll = HOME.roll;
  away = HOME.away;
  private size = 1; // of the body, beside one of HEIGHT_M
  private readonly touches = new Map<number, { x: number; y: number }>();

  /** `changed` is called whenever the view is another. */
  constructor(private readonly element: HTMLElement, private readonly changed: () => void) {
    element.style.touchAction = 'none';
    element.addEventListener('pointerdown', event => this.grasp(event));
    element.addEventListener('pointermove', event => this.drag(event));
    for (const end of ['pointerup', 'pointercancel'] as const)
      element.addEventListener(end, event => this.touches.delete(event.pointerId));
    element.addEventListener('wheel', event => this.wheel(event), { passive: false });
    element.addEventListener('keydown', event => this.key(event));
    element.addEventListener('contextmenu', event => event.preventDefault());
    this.place();
  }

  /** Fits the picture to a body of some height. */
  frame(height: number): void {
    this.size = height / HEIGHT_M;
    this.target.setY(LOOKED_AT * height);
    this.place();
  }

  home(): void {
    Object.assign(this, HOME);
    this.place();
  }

  /** Looks from somewhere else. */
  look(from: { turn: number; tilt: number; away: number; target: readonly [number, number, number] }): void {
    this.target.set(...from.target);
    this.roll = 0;
    this.turn = from.turn;
    this.tilt = from.tilt;
    this.away = from.away;
    this.place();
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / height;
    this.place();
  }

  private grasp(event: PointerEvent): void {
    if (event.button === 1) event.preventDefault(); // no scrolling by the middle button
    this.element.setPointerCapture(event.pointerId);
    this.touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  private drag(event: PointerEvent): void {
    const before = this.touches.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before.x, dy = event.clientY - before.y;
    const others = [...this.touches].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const [other] = others;
    if (other) {
      const [ax, ay] = [before.x - other.x, before.y - other.y];
      const [bx, by] = [event.clientX - other.x, event.clientY - other.y];
      this.away *= Math.hypot(ax, ay) / Math.max(1, Math.hypot(bx, by));
      this.roll += Math.atan2(ay, ax) - Math.atan2(by, bx);
    } else if (event.buttons & 4) {
      this.roll -= dx * RAD_PER_PIXEL;
    } else {
      this.turn -= dx * RAD_PER_PIXEL;
      this.tilt += dy * RAD_PER_PIXEL;
    }
    this.place();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.away *= Math.exp(event.deltaY / 900);
    this.place();
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const moves: Record<string, () => void> = {
      ArrowLeft: () => { this.turn -= KEY_RAD; },
      ArrowRight: () => { this.turn += KEY_RAD; },
      ArrowUp: () => { this.tilt += KEY_RAD; },
      ArrowDown: () => { this.tilt -= KEY_RAD; },
      ',': () => { this.roll -= KEY_RAD; },
      '.': () => { this.roll += KEY_RAD; },
      '+': () => { this.away /= KEY_ZOOM; },
      '=': () => { this.away /= KEY_ZOOM; },
      '-': () => { this.away *= KEY_ZOOM; },
      '0': () => { Object.assign(this, HOME); },
    };
    const move = moves[event.key];
    if (!move) return;
    event.preventDefault();
    move();
    this.place();
  }

  private place(): void {
    const most = Math.PI / 2 - 0.02;
    if (this.restricted) {
      this.turn = MathUtils.clamp(this.turn, -RESTRICTED.turn, RESTRICTED.turn);
      this.tilt = MathUtils.clamp(this.tilt, -RESTRICTED.tilt, RESTRICTED.tilt);
      this.away = MathUtils.clamp(this.away, RESTRICTED.nearest, RESTRICTED.farthest);
      this.roll = 0;
    }
    this.tilt = MathUtils.clamp(this.tilt, -most, most);
    this.away = MathUtils.clamp(this.away, NEAREST_M, FARTHEST_M);
    const half = Math.tan(MathUtils.degToRad(FOV_DEG) / 2) * HOME.away;
    const narrow = Math.max(1, WIDTH_M / 2 / (half * this.camera.aspect));
    const turned = new Quaternion().setFromAxisAngle(Y, this.turn)
      .multiply(new Quaternion().setFromAxisAngle(X, -this.tilt))
      .multiply(new Quaternion().setFromAxisAngle(Z, this.roll));
    this.camera.position.copy(this.target)
      .add(new Vector3(0, 0, this.away * this.size * narrow).applyQuaternion(turned));
    this.camera.quaternion.copy(turned);
    this.camera.updateProjectionMatrix();
    this.changed();
  }
}
