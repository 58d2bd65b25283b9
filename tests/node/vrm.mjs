// node vrm.mjs AVATAR.vrm FILE.vrma TIMES: an avatar plays a movement, as three-vrm reads both.
// Prints, per time, where its bones are in the world, its expressions and its gaze in degrees.
import fs from 'node:fs';
import { AnimationMixer, LoopOnce, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMLoaderPlugin } from '@pixiv/three-vrm';
import {
  createVRMAnimationClip, VRMAnimationLoaderPlugin, VRMLookAtQuaternionProxy,
} from '@pixiv/three-vrm-animation';

globalThis.self = globalThis; // the loader asks for it
const [avatar, movement, times] = process.argv.slice(2);
const loader = new GLTFLoader();
loader.register(parser => new VRMLoaderPlugin(parser));
loader.register(parser => new VRMAnimationLoaderPlugin(parser));
const load = file => {
  const data = fs.readFileSync(file);
  return loader.parseAsync(
    data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength), '');
};
const { vrm } = (await load(avatar)).userData;
const animation = (await load(movement)).userData.vrmAnimations[0];
if (vrm.lookAt) vrm.scene.add(Object.assign(new VRMLookAtQuaternionProxy(vrm.lookAt), {
  name: 'lookAtQuaternionProxy' }));
const mixer = new AnimationMixer(vrm.scene);
const action = mixer.clipAction(createVRMAnimationClip(animation, vrm)).setLoop(LoopOnce);
action.clampWhenFinished = true; // else the last frame is the first again
action.play();
const point = new Vector3();
const frames = times.split(',').map(time => {
  mixer.setTime(Number(time));
  vrm.update(0);
  vrm.scene.updateMatrixWorld(true);
  const bones = {};
  for (const name of Object.keys(vrm.humanoid.humanBones)) {
    bones[name] = vrm.humanoid.getRawBoneNode(name).getWorldPosition(point).toArray();
  }
  const expressions = {};
  for (const { expressionName, weight } of vrm.expressionManager?.expressions ?? []) {
    if (weight) expressions[expressionName] = weight;
  }
  const morphs = {};
  vrm.scene.traverse(mesh => {
    for (const [name, n] of Object.entries(mesh.morphTargetDictionary ?? {})) {
      morphs[name] = mesh.morphTargetInfluences[n];
    }
  });
  const gaze = vrm.lookAt ? [vrm.lookAt.yaw, vrm.lookAt.pitch] : null;
  return { bones, expressions, morphs, gaze };
});
console.log(JSON.stringify({ frames }));
