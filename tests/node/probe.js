// What three.js makes of a GLB: joints and skinned vertices in the world at given times.
// Runs in Node and in the browser alike.
import { AnimationMixer, LoopOnce, Vector3 } from 'three';

/** times: seconds. step: every step-th vertex of each skinned mesh is reported. */
export function probe(gltf, times, step) {
  const joints = [], meshes = [];
  gltf.scene.traverse(object => {
    if (object.isBone) joints.push(object);
    if (object.isSkinnedMesh) meshes.push(object);
  });
  const mixer = new AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations[0]).setLoop(LoopOnce);
  action.clampWhenFinished = true; // else the last moment is the first again
  action.play();
  const point = new Vector3();
  const at = times.map(time => {
    mixer.setTime(time);
    gltf.scene.updateMatrixWorld(true);
    return {
      joints: Object.fromEntries(
        joints.map(j => [j.userData.name ?? j.name, j.getWorldPosition(point).toArray()])),
      vertices: meshes.map(mesh => {
        mesh.skeleton.update();
        const positions = [];
        for (let i = 0; i < mesh.geometry.attributes.position.count; i += step) {
          positions.push(mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld).toArray());
        }
        return positions;
      }),
    };
  });
  return {
    at,
    materials: meshes.map(mesh => mesh.material.name),
    morphs: meshes.map(mesh => Object.keys(mesh.morphTargetDictionary ?? {})),
    animations: gltf.animations.map(clip => ({
      name: clip.name, duration: clip.duration, tracks: clip.tracks.length,
      extras: clip.userData ?? null,
    })),
  };
}
