// A body that is drawn: the skinned meshes of a GLB, posed joint by joint.
import {
  type Bone, Box3, type BufferAttribute, Color, type MeshStandardMaterial, type Object3D, SkinnedMesh,
} from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { clone } from 'three/addons/utils/SkeletonUtils.js';
import type { Names } from './clip';
import { Pose } from './pose';

const CLOTH = 'top'; // material of what is worn above
const STILL = 1e-9;

interface Morphed {
  readonly influences: number[];
  readonly units: readonly number[]; // of the body, an index per influence
}

const loaded = new Map<string, Promise<Object3D>>();

/** Loads a body; a page loads each once, however many players show it. */
export async function loadBody(url: string): Promise<Body> {
  const address = new URL(url, document.baseURI).href;
  let scene = loaded.get(address);
  if (!scene) {
    scene = new GLTFLoader().loadAsync(address).then(gltf => trimmed(gltf.scene));
    loaded.set(address, scene);
    scene.catch(() => loaded.delete(address));
  }
  return new Body(clone(await scene));
}

export class Body implements Names {
  readonly joints: readonly string[];
  readonly units: readonly string[];
  private readonly bones: readonly Bone[];
  private readonly rootAtRest: readonly number[];
  private readonly morphed: readonly Morphed[];
  private readonly cloth: { material: MeshStandardMaterial; own: Color }[] = [];

  constructor(readonly scene: Object3D) {
    const meshes: SkinnedMesh[] = [];
    scene.traverse(node => {
      if (node instanceof SkinnedMesh) meshes.push(node);
    });
    const first = meshes[0];
    if (!first) throw Error('the file has no body that moves');
    this.bones = first.skeleton.bones;
    this.joints = this.bones.map(nameOf);
    this.rootAtRest = this.bones[0]!.position.toArray();
    const units = new Map<string, number>();
    this.morphed = meshes.flatMap(mesh => {
      const named = mesh.userData['units'] as string[] | undefined;
      if (!mesh.morphTargetInfluences || !named) return [];
      for (const name of named) if (!units.has(name)) units.set(name, units.size);
      return [{ influences: mesh.morphTargetInfluences, units: named.map(n => units.get(n)!) }];
    });
    this.units = [...units.keys()];
    for (const mesh of meshes) {
      mesh.frustumCulled = false; // its bounds are those of the bind pose
      const material = mesh.material as MeshStandardMaterial;
      if (material.name !== CLOTH) continue;
      mesh.material = material.clone();
      this.cloth.push({ material: mesh.material as MeshStandardMaterial, own: material.color.clone() });
    }
  }

  /** Returns a posture of this body: the bind pose. */
  pose(): Pose {
    const pose = new Pose(this.joints.length, this.units.length);
    pose.root.set(this.rootAtRest);
    return pose;
  }

  /** Writes rotations of all joints, xyzw, and weights of units, by name, into a posture. */
  take(
    given: { rotations: readonly (readonly number[])[]; weights: Readonly<Record<string, number>> },
    pose: Pose,
  ): void {
    given.rotations.forEach((turn, j) => pose.rotations.set(turn, 4 * j));
    this.units.forEach((unit, u) => { pose.weights[u] = given.weights[unit] ?? 0; });
  }

  apply(pose: Pose): void {
    this.bones.forEach((bone, j) => bone.quaternion.fromArray(pose.rotations, 4 * j));
    this.bones[0]!.position.fromArray(pose.root);
    for (const { influences, units } of this.morphed)
      units.forEach((unit, k) => { influences[k] = pose.weights[unit]!; });
  }

  /** Height of the top of the head in the bind pose, metres. */
  get height(): number {
    return new Box3().setFromObject(this.scene).max.y;
  }

  /** Multiplies the colour of what is worn above, as `cloth` of performs does. */
  dye(colour: Color | null): void {
    for (const { material, own } of this.cloth) {
      material.color.copy(own);
      if (colour) material.color.multiply(colour);
    }
  }

  /** Returns where joints are in the world, by name; for tests. */
  places(): Record<string, number[]> {
    this.scene.updateMatrixWorld(true);
    return Object.fromEntries(this.bones.map((bone, j) =>
      [this.joints[j]!, bone.matrixWorld.elements.slice(12, 15)]));
  }
}

/** Returns a node's name in the file; three.js takes dots out of its own. */
function nameOf(node: Object3D): string {
  return (node.userData['name'] as string | undefined) ?? node.name;
}

/** Takes morph targets out of the meshes that they do not move: most move the face alone. */
function trimmed(scene: Object3D): Object3D {
  scene.traverse(node => {
    if (!(node instanceof SkinnedMesh) || !node.morphTargetDictionary) return;
    const { morphAttributes } = node.geometry;
    const names = Object.keys(node.morphTargetDictionary);
    const used = names.map((_, i) => i).filter(i => moves(morphAttributes['position']?.[i]));
    for (const kind of ['position', 'normal'] as const) {
      const all = morphAttributes[kind];
      if (!all) continue;
      if (used.length > 0) morphAttributes[kind] = used.map(i => all[i]!);
      else delete morphAttributes[kind];
    }
    node.updateMorphTargets();
    node.userData['units'] = used.map(i => names[i]!);
  });
  return scene;
}

function moves(attribute: BufferAttribute | { array: ArrayLike<number> } | undefined): boolean {
  if (!attribute) return false;
  const { array } = attribute;
  for (let i = 0; i < array.length; i++) if (Math.abs(array[i]!) > STILL) return true;
  return false;
}
