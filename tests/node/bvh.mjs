// node bvh.mjs FILE.bvh: joint positions in the world, frame by frame, as three.js reads them.
import fs from 'node:fs';
import { AnimationMixer, LoopOnce, Vector3 } from 'three';
import { BVHLoader } from 'three/addons/loaders/BVHLoader.js';

const { skeleton, clip } = new BVHLoader().parse(fs.readFileSync(process.argv[2], 'utf8'));
const root = skeleton.bones[0];
const mixer = new AnimationMixer(root);
const action = mixer.clipAction(clip).setLoop(LoopOnce);
action.clampWhenFinished = true; // else the last frame is the first again
action.play();
const times = clip.tracks[0].times;
const joints = skeleton.bones.filter(bone => bone.name !== 'ENDSITE');
const point = new Vector3();
const frames = Array.from(times, time => {
  mixer.setTime(time);
  root.updateMatrixWorld(true);
  return joints.map(joint => joint.getWorldPosition(point).toArray());
});
console.log(JSON.stringify({
  names: joints.map(joint => joint.name), times: Array.from(times), frames,
}));
