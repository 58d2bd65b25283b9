// node own_joints.mjs BODY.glb ANIMATION.glb TIMES: three.js plays an animation on a body's own file.
// Prints, per time, where nodes are in the world and the weights of morph targets, both by name.
import fs from 'node:fs';
import { AnimationMixer, LoopOnce, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

globalThis.self = globalThis; // the loader asks for it
const [body, animation, times] = process.argv.slice(2);
const complaints = [];
console.warn = console.error = (...words) => complaints.push(words.join(' '));
const load = file => {
  const data = fs.readFileSync(file);
  return new GLTFLoader().parseAsync(
    data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength), '');
};
const { scene } = await load(body);
const { animations: [clip] } = await load(animation);
const mixer = new AnimationMixer(scene);
const action = mixer.clipAction(clip).setLoop(LoopOnce);
action.clampWhenFinished = true; // else the last frame is the first again
action.play();
const point = new Vector3();
const frames = times.split(',').map(time => {
  mixer.setTime(Number(time));
  scene.updateMatrixWorld(true);
  const nodes = {}, morphs = {};
  scene.traverse(object => {
    nodes[object.name] = object.getWorldPosition(point).toArray();
    for (const [name, n] of Object.entries(object.morphTargetDictionary ?? {})) {
      morphs[name] = object.morphTargetInfluences[n];
    }
  });
  return { nodes, morphs };
});
console.log(JSON.stringify({ frames, complaints }));
