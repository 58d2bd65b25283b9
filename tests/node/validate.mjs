// node validate.mjs FILE.glb: the Khronos validator's report as JSON.
import fs from 'node:fs';
import validator from 'gltf-validator';

const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
const report = await validator.validateBytes(bytes, { maxIssues: 200 });
console.log(JSON.stringify(report));
