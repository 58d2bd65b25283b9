// What stands behind the body: a studio's backdrop, plain or with a picture on its wall.
import {
  type BufferGeometry, Color, Mesh, MeshStandardMaterial, PlaneGeometry, RepeatWrapping,
  SRGBColorSpace, TextureLoader,
} from 'three';
import type { Settings } from './settings';

const WIDTH_M = 16, BEHIND_M = 2.2, BEND_M = 1, HEIGHT_M = 6, FRONT_M = 5;
const STEPS = 64;
const PICTURE_M = 0.8;

export function makeBackdrop(settings: Settings): { wall: Mesh; ready: Promise<void> } {
  const colour = settings.color ?? new Color(0xd9dee3);
  const material = new MeshStandardMaterial({ color: colour, roughness: 1 });
  const wall = new Mesh(bent(), material);
  let ready = Promise.resolve();
  if (settings.background === 'photocall' && settings.img) {
    ready = new TextureLoader().loadAsync(settings.img).then(picture => {
      const gap = 1 + settings.offset;
      picture.colorSpace = SRGBColorSpace;
      picture.wrapS = picture.wrapT = RepeatWrapping;
      const { width, height } = picture.image as { width: number; height: number };
      const high = PICTURE_M * gap * (height / width);
      picture.repeat.set(WIDTH_M / (PICTURE_M * gap), length() / high);
      material.map = picture;
      material.needsUpdate = true;
    });
  }
  return { wall, ready };
}

function length(): number {
  return FRONT_M + BEHIND_M - BEND_M + (BEND_M * Math.PI) / 2 + HEIGHT_M - BEND_M;
}

/** Returns a sheet that lies on the floor and bends upwards behind the body. */
function bent(): BufferGeometry {
  const sheet = new PlaneGeometry(WIDTH_M, length(), 1, STEPS);
  const places = sheet.getAttribute('position');
  const flat = FRONT_M + BEHIND_M - BEND_M, arc = (BEND_M * Math.PI) / 2;
  for (let i = 0; i < places.count; i++) {
    const along = places.getY(i) + length() / 2; // from the front edge
    const angle = Math.min(Math.max((along - flat) / BEND_M, 0), Math.PI / 2);
    const up = Math.max(0, along - flat - arc);
    places.setY(i, BEND_M * (1 - Math.cos(angle)) + up);
    places.setZ(i, FRONT_M - Math.min(along, flat) - BEND_M * Math.sin(angle));
  }
  sheet.computeVertexNormals();
  return sheet;
}
