// Plays a GLB as azee writes it: skinned meshes with sparse morph targets, one animation.
// Written for that file alone; needs WebGL 2 and no network. `stage` holds a canvas, a button, a
// slider and an output; whatever fails leaves the picture that stands beside it.
function play(stage, base64) {
  'use strict';
  const canvas = stage.querySelector('canvas');
  const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return false;

  // --- The file -------------------------------------------------------------------------------
  const bytes = Uint8Array.from(atob(base64), c => c.charCodeAt(0)).buffer;
  const head = new DataView(bytes);
  const length = head.getUint32(12, true);
  const gltf = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 20, length)));
  const binary = 20 + length + 8;
  const TYPES = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
  const SIZES = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
  const slice = (view, type, count, offset = 0) => {
    const start = binary + (gltf.bufferViews[view].byteOffset || 0) + offset;
    return new TYPES[type](bytes.slice(start, start + count * TYPES[type].BYTES_PER_ELEMENT));
  };
  const values = index => {
    const a = gltf.accessors[index];
    return slice(a.bufferView, a.componentType, a.count * SIZES[a.type], a.byteOffset);
  };
  const displacement = index => { // which vertices a morph target moves, and how
    const { sparse, bufferView, count, type } = gltf.accessors[index];
    if (!sparse && bufferView === undefined) return { at: [], by: [] };
    if (!sparse) return { at: Uint32Array.from({ length: count }, (_, i) => i), by: values(index) };
    const { indices, values: moved } = sparse;
    return {
      at: slice(indices.bufferView, indices.componentType, sparse.count, indices.byteOffset),
      by: slice(moved.bufferView, 5126, sparse.count * SIZES[type], moved.byteOffset),
    };
  };

  // --- Matrices, column by column --------------------------------------------------------------
  const times = (a, b) => {
    const out = new Float32Array(16);
    for (let c = 0; c < 16; c += 4)
      for (let r = 0; r < 4; r++)
        out[c + r] = a[r] * b[c] + a[4 + r] * b[c + 1] + a[8 + r] * b[c + 2] + a[12 + r] * b[c + 3];
    return out;
  };
  const placed = ([x, y, z, w], [tx, ty, tz]) => new Float32Array([
    1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0,
    2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
    2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0, tx, ty, tz, 1,
  ]);

  // --- The animation ---------------------------------------------------------------------------
  const animation = (gltf.animations || [])[0] || { channels: [], samplers: [] };
  const channels = animation.channels.map(({ sampler, target }) => ({
    ...target, keys: values(animation.samplers[sampler].input),
    out: values(animation.samplers[sampler].output),
  }));
  const end = Math.max(0, ...channels.map(c => c.keys[c.keys.length - 1]));
  const sample = ({ keys, out, path }, time) => {
    const n = out.length / keys.length;
    let i = keys.findIndex(key => key > time);
    if (i < 0) i = keys.length;
    const after = Math.min(i, keys.length - 1), before = Math.max(i - 1, 0);
    const span = keys[after] - keys[before];
    const f = span > 0 ? (time - keys[before]) / span : 0;
    const a = out.subarray(before * n, before * n + n), b = out.subarray(after * n, after * n + n);
    const turn = path === 'rotation';
    const sign = turn && a.reduce((sum, x, k) => sum + x * b[k], 0) < 0 ? -1 : 1;
    const mixed = Array.from(a, (x, k) => x + f * (sign * b[k] - x));
    const size = turn ? Math.hypot(...mixed) : 1;
    return turn ? mixed.map(x => x / size) : mixed;
  };
  const skin = gltf.skins[0];
  const binds = values(skin.inverseBindMatrices);
  const posture = time => { // where every node is, and the weights of the morph targets
    const own = gltf.nodes.map(n => ({
      rotation: n.rotation || [0, 0, 0, 1], translation: n.translation || [0, 0, 0],
    }));
    let weights = gltf.meshes[0].weights || [];
    for (const channel of channels) {
      const value = sample(channel, time);
      if (channel.path === 'weights') weights = value;
      else own[channel.node][channel.path] = value;
    }
    const world = [];
    const visit = (index, parent) => {
      world[index] = times(parent, placed(own[index].rotation, own[index].translation));
      for (const child of gltf.nodes[index].children || []) visit(child, world[index]);
    };
    const none = placed([0, 0, 0, 1], [0, 0, 0]);
    for (const root of gltf.scenes[gltf.scene || 0].nodes) visit(root, none);
    return { world, weights };
  };

  // --- Drawing ---------------------------------------------------------------------------------
  const shader = (type, text) => {
    const made = gl.createShader(type);
    gl.shaderSource(made, `#version 300 es\nprecision highp float;\n${text}`);
    gl.compileShader(made);
    if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw Error(gl.getShaderInfoLog(made));
    return made;
  };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `
    layout(location=0) in vec3 place; layout(location=1) in vec3 normal;
    layout(location=2) in vec4 tint; layout(location=3) in uvec4 joints;
    layout(location=4) in vec4 weights;
    uniform highp sampler2D bones; uniform mat4 view;
    out vec3 n; out vec4 c;
    mat4 bone(uint j) {
      int y = int(j);
      return mat4(texelFetch(bones, ivec2(0, y), 0), texelFetch(bones, ivec2(1, y), 0),
                  texelFetch(bones, ivec2(2, y), 0), texelFetch(bones, ivec2(3, y), 0));
    }
    void main() {
      mat4 m = weights.x * bone(joints.x) + weights.y * bone(joints.y)
             + weights.z * bone(joints.z) + weights.w * bone(joints.w);
      n = mat3(m) * normal; c = tint;
      gl_Position = view * m * vec4(place, 1.0);
    }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `
    in vec3 n; in vec4 c; uniform vec3 base; out vec4 seen;
    void main() {
      vec3 up = normalize(n);
      float sun = max(dot(up, normalize(vec3(.28, .72, .95))), 0.0);
      vec3 light = sun * vec3(1.75, 1.68, 1.58) + mix(vec3(.3, .27, .25), vec3(.62, .66, .74),
                   .5 + .5 * up.y);
      seen = vec4(pow(base * c.rgb * light, vec3(1.0 / 2.2)), 1.0);
    }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(0.82, 0.86, 0.89, 1);
  const buffer = (data, target = gl.ARRAY_BUFFER, use = gl.STATIC_DRAW) => {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, data, use);
    return made;
  };
  const ATTRIBUTES = ['POSITION', 'NORMAL', 'COLOR_0', 'JOINTS_0', 'WEIGHTS_0'];
  const parts = gltf.meshes[0].primitives.map(primitive => {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const part = { array, moving: [], weights: '' };
    ATTRIBUTES.forEach((name, location) => {
      const index = primitive.attributes[name];
      if (index === undefined) return gl.vertexAttrib4f(location, 1, 1, 1, 1);
      const { componentType, normalized, type } = gltf.accessors[index];
      const data = values(index);
      const made = buffer(data, gl.ARRAY_BUFFER, location < 2 ? gl.DYNAMIC_DRAW : gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      if (name === 'JOINTS_0') gl.vertexAttribIPointer(location, 4, componentType, 0, 0);
      else gl.vertexAttribPointer(location, SIZES[type], componentType, !!normalized, 0, 0);
      if (location < 2) part.moving.push({
        buffer: made, rest: data,
        targets: (primitive.targets || []).map(t => t[name] === undefined ? null : displacement(t[name])),
      });
    });
    const indices = values(primitive.indices);
    buffer(indices, gl.ELEMENT_ARRAY_BUFFER);
    part.count = indices.length;
    part.type = gltf.accessors[primitive.indices].componentType;
    const material = gltf.materials[primitive.material] || {};
    const rough = material.pbrMetallicRoughness || {};
    part.base = (rough.baseColorFactor || [1, 1, 1, 1]).slice(0, 3);
    return part;
  });
  const morph = (part, weights) => {
    const key = weights.join();
    if (part.weights === key) return;
    part.weights = key;
    for (const { buffer: made, rest, targets } of part.moving) {
      const moved = rest.slice();
      targets.forEach((target, t) => {
        const w = weights[t];
        if (!w || !target) return;
        target.at.forEach((vertex, i) => {
          for (let k = 0; k < 3; k++) moved[3 * vertex + k] += w * target.by[3 * i + k];
        });
      });
      gl.bindBuffer(gl.ARRAY_BUFFER, made);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, moved);
    }
  };
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
    gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);

  const eye = { turn: 0, tilt: 0.05, away: 2.5, height: 1.18 };
  const camera = () => {
    const f = 1 / Math.tan(0.26), near = 0.05, far = 20;
    const lens = new Float32Array([f * canvas.height / canvas.width, 0, 0, 0, 0, f, 0, 0,
      0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
    const half = (angle, x, y) => [x * Math.sin(angle / 2), y * Math.sin(angle / 2), 0, Math.cos(angle / 2)];
    const tilted = times(placed([0, 0, 0, 1], [0, 0, -eye.away]), placed(half(eye.tilt, 1, 0), [0, 0, 0]));
    const turned = times(tilted, placed(half(eye.turn, 0, 1), [0, 0, 0]));
    return times(lens, times(turned, placed([0, 0, 0, 1], [0, -eye.height, 0])));
  };
  const draw = time => {
    const { world, weights } = posture(time);
    const bones = new Float32Array(16 * skin.joints.length);
    skin.joints.forEach((node, j) =>
      bones.set(times(world[node], binds.subarray(16 * j, 16 * j + 16)), 16 * j));
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, 4, skin.joints.length, 0, gl.RGBA, gl.FLOAT, bones);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, 'view'), false, camera());
    for (const part of parts) {
      morph(part, weights);
      gl.bindVertexArray(part.array);
      gl.uniform3fv(gl.getUniformLocation(program, 'base'), part.base);
      gl.drawElements(gl.TRIANGLES, part.count, part.type, 0);
    }
  };

  // --- Playing ---------------------------------------------------------------------------------
  const button = stage.querySelector('button'), slider = stage.querySelector('input');
  const output = stage.querySelector('output');
  let now = 0, running = true, before = null;
  slider.max = end;
  const show = time => {
    now = time;
    slider.value = time;
    output.textContent = `${time.toFixed(2)} s`;
    draw(time);
  };
  const step = stamp => {
    if (running && before !== null) show(end > 0 ? (now + (stamp - before) / 1000) % end : 0);
    before = stamp;
    requestAnimationFrame(step);
  };
  const run = on => { running = on; button.textContent = on ? '❚❚' : '▶'; };
  button.onclick = () => run(!running);
  slider.oninput = () => { run(false); show(+slider.value); };
  canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
  canvas.onpointermove = event => {
    if (!event.buttons) return;
    eye.turn += event.movementX / 150;
    eye.tilt = Math.max(-1.4, Math.min(1.4, eye.tilt + event.movementY / 150));
    draw(now);
  };
  canvas.onwheel = event => {
    event.preventDefault();
    eye.away = Math.max(0.5, Math.min(8, eye.away * Math.exp(event.deltaY / 800)));
    draw(now);
  };
  show(0);
  run(true);
  requestAnimationFrame(step);
  stage.azee = { // for who tests it
    stop(time) { run(false); show(time); },
    joints: time => Object.fromEntries(skin.joints.map(node =>
      [gltf.nodes[node].name, Array.from(posture(time).world[node].subarray(12, 15))])),
    error: () => gl.getError(),
  };
  return true;
}
