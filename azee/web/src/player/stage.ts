// The body in its surroundings, drawn by WebGL.
import {
  Color, DirectionalLight, HemisphereLight, Scene, SRGBColorSpace, WebGLRenderer,
} from 'three';
import { makeBackdrop } from './backdrop';
import type { Body } from './body';
import type { Settings } from './settings';
import { View } from './view';

const SKY = 0xdfe8f5, GROUND = 0x8d7f74, BEHIND = 0xd1dbe3;
const AMBIENT = 1.7, KEY = 2.3, FILL = 0.5;
const MOST_PIXELS = 2; // a CSS pixel has at most so many of the screen's, each way

export class Stage {
  readonly view: View;
  /** Whether the picture is to be drawn again. */
  dirty = true;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly key = new DirectionalLight(0xfff4e6, KEY);
  private body: Body | null = null;
  private backdrop: ReturnType<typeof makeBackdrop> | null = null;

  /** Throws an Error where there is no WebGL. */
  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'low-power' });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.scene.background = new Color(BEHIND); // until it is arranged
    this.view = new View(canvas, () => { this.dirty = true; });
    const fill = new DirectionalLight(0xe8eeff, FILL);
    fill.position.set(-2, 1.4, 1.6);
    this.scene.add(new HemisphereLight(SKY, GROUND, AMBIENT), this.key, this.key.target, fill);
    this.key.target.position.set(0, 1.1, 0);
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => { this.dirty = true; });
  }

  show(body: Body): void {
    if (this.body) this.scene.remove(this.body.scene);
    this.body = body;
    this.view.frame(body.height);
    this.scene.add(body.scene);
    this.dirty = true;
  }

  /** Takes colours, lights and places from settings. Returns what could not be loaded. */
  async arrange(settings: Settings): Promise<void> {
    this.key.color.copy(settings.light);
    this.key.position.fromArray(settings.lightpos);
    this.view.restricted = settings.restrictView;
    this.scene.background = settings.color ? settings.color : new Color(BEHIND);
    if (this.body) {
      this.body.dye(settings.cloth);
      this.body.scene.position.fromArray(settings.position);
      this.body.scene.quaternion.fromArray(settings.rotation).normalize();
      this.body.scene.scale.setScalar(settings.scale);
    }
    if (this.backdrop) this.scene.remove(this.backdrop.wall);
    this.backdrop = settings.background === 'open' ? null : makeBackdrop(settings);
    if (this.backdrop) this.scene.add(this.backdrop.wall);
    this.dirty = true;
    await this.backdrop?.ready;
    this.dirty = true;
  }

  /** Fits the picture to its place on the page, if that is another than before. */
  fit(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width < 1 || height < 1) return;
    const ratio = Math.min(window.devicePixelRatio, MOST_PIXELS);
    if (this.canvas.width === Math.floor(width * ratio)
      && this.canvas.height === Math.floor(height * ratio)) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.view.resize(width, height);
    this.dirty = true;
  }

  draw(): void {
    this.dirty = false;
    this.renderer.render(this.scene, this.view.camera);
  }

  /** Draws and waits for the last pixel; returns milliseconds. For measuring. */
  timed(): number {
    const before = performance.now();
    this.draw();
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - before;
  }

  /** The name of what draws. */
  get device(): string {
    const gl = this.renderer.getContext();
    const info = gl.getExtension('WEBGL_debug_renderer_info');
    return String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  }

  close(): void {
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
