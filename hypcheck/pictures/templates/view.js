// Draws a scene, and a flight through it, from the numbers in #data. See hypcheck/pictures/__init__.py for their meaning.
const element = (id) => document.getElementById(id);
const data = JSON.parse(element('data').textContent);

const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const numbers = (text) => new Float32Array(bytes(text).buffer);
async function unpacked(id) {
  const packed = new Blob([bytes(element(id).textContent)]);
  return new Response(packed.stream().pipeThrough(new DecompressionStream('gzip'))).text();
}
const address = (code) => URL.createObjectURL(new Blob([code], { type: 'text/javascript' }));

async function loaded() {
  const core = address(await unpacked('three-core'));
  const module = address((await unpacked('three-module')).replaceAll("'./three.core.js'", `'${core}'`));
  const controls = address((await unpacked('three-controls')).replaceAll("from 'three'", `from '${module}'`));
  return [await import(module), (await import(controls)).OrbitControls];
}

function refuse(sentence) {
  element('trouble').textContent = sentence;
  element('trouble').hidden = false;
  document.body.dataset.ready = 'no';
}

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// A unit surface: u runs from the lower end (0) to the upper (1), turn around the axis; r < 1 only on flat ends.
function surface(THREE, sides, rings) {
  const place = [], index = [];
  const row = (u, r) => {
    for (let k = 0; k <= sides; k++) place.push((k / sides) * 2 * Math.PI, u, r);
    return place.length / 3 - sides - 1;
  };
  const rows = [row(0, 0)];
  for (let k = 0; k <= rings; k++) rows.push(row(k / rings, 1));
  rows.push(row(1, 0));
  for (let k = 0; k + 1 < rows.length; k++) {
    for (let j = 0; j < sides; j++) {
      const a = rows[k] + j, b = rows[k + 1] + j;
      index.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(place, 3));
  geometry.setIndex(index);
  return geometry;
}

const VERTEX = `
attribute vec4 shape; attribute vec3 centre; attribute vec3 axis; attribute vec2 flags;
varying vec3 vNormal; varying float vTouched;
vec3 across(vec3 w) { return normalize(abs(w.z) < 0.9 ? cross(w, vec3(0., 0., 1.)) : cross(w, vec3(1., 0., 0.))); }
void main() {
  vec3 w = normalize(axis), a = across(w), b = cross(w, a);
  float r = flags.x > .5 ? position.z : 1.;
  float z = mix(shape.z, shape.w, position.y);
  float wide = shape.x * sqrt(1. + z * z / (shape.y * shape.y));
  vec3 round = cos(position.x) * a + sin(position.x) * b;
  vec3 place = centre + r * wide * round + z * w;
  vec3 wall = normalize(round / (shape.x * shape.x) * wide - w * z / (shape.y * shape.y));
  vNormal = normalMatrix * (r < .5 ? (position.y < .5 ? -w : w) : wall);
  vTouched = flags.y;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.);
}`;
const FRAGMENT = `
uniform vec3 colour; uniform vec3 touched; uniform float alpha;
varying vec3 vNormal; varying float vTouched;
void main() {
  vec3 n = normalize(gl_FrontFacing ? vNormal : -vNormal);
  float light = .42 + .45 * max(dot(n, normalize(vec3(.35, .8, .6))), 0.) + .2 * abs(n.z);
  gl_FragColor = vec4(mix(colour, touched, vTouched) * light, alpha);
  #include <colorspace_fragment>
}`;

function drawBodies(THREE, scene) {
  const table = numbers(data.bodies), count = table.length / 12;
  const sides = count > 3000 ? 12 : count > 300 ? 24 : 64;
  const rings = count > 3000 ? 5 : count > 300 ? 10 : 32;
  const geometry = surface(THREE, sides, rings);
  const column = (from, size) => {
    const found = new Float32Array(count * size);
    for (let k = 0; k < count; k++) found.set(table.subarray(12 * k + from, 12 * k + from + size), size * k);
    return new THREE.InstancedBufferAttribute(found, size);
  };
  geometry.setAttribute('shape', column(0, 4));
  geometry.setAttribute('centre', column(4, 3));
  geometry.setAttribute('axis', column(7, 3));
  geometry.setAttribute('flags', column(10, 2));
  geometry.instanceCount = count;
  const open = data.see_through;
  const material = new THREE.ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide, transparent: open, depthWrite: !open,
    uniforms: { colour: { value: new THREE.Color() }, touched: { value: new THREE.Color() }, alpha: { value: open ? 0.42 : 1 } },
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.renderOrder = open ? 2 : 0;
  scene.add(mesh);
  return material;
}

// The flight: its corners, lengths, and for each segment the mover's axis and whether it has contact.
function flight() {
  const place = numbers(data.path), count = place.length / 3, lengths = [0];
  for (let k = 1; k < count; k++) {
    const step = Math.hypot(...[0, 1, 2].map((c) => place[3 * k + c] - place[3 * k - 3 + c]));
    lengths.push(lengths[k - 1] + step);
  }
  return { place, count, lengths, total: lengths[count - 1], hits: bytes(data.hits), axes: numbers(data.axes) };
}

function segmentAt(path, flown) {
  let low = 0, high = Math.max(path.count - 2, 0);
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (path.lengths[middle] <= flown) low = middle; else high = middle - 1;
  }
  return low;
}

function placeAt(THREE, path, flown) {
  const k = segmentAt(path, flown), next = Math.min(k + 1, path.count - 1);
  const step = path.lengths[next] - path.lengths[k];
  const share = step > 0 ? Math.min((flown - path.lengths[k]) / step, 1) : 0;
  const here = new THREE.Vector3().fromArray(path.place, 3 * k), there = new THREE.Vector3().fromArray(path.place, 3 * next);
  return [here.lerp(there, share), k];
}

function turned(THREE, path, k) {
  const axis = new THREE.Vector3().fromArray(path.axes, 3 * Math.min(k, path.axes.length / 3 - 1)).normalize();
  return new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis);
}

// What the mover sweeps: on each segment the tube along the outline of the spheroid as seen from ahead.
function drawSwept(THREE, scene, path) {
  const { b, d } = data.mover, sides = path.count > 3000 ? 8 : 20;
  const kinds = [[], []];
  const size = new THREE.Vector3(b, b, d);
  for (let k = 0; k + 1 < path.count; k++) {
    const here = new THREE.Vector3().fromArray(path.place, 3 * k), there = new THREE.Vector3().fromArray(path.place, 3 * k + 3);
    const turn = turned(THREE, path, k), back = turn.clone().invert();
    const along = there.clone().sub(here).applyQuaternion(back).divide(size);
    if (along.lengthSq() === 0) continue;
    along.normalize();
    const first = new THREE.Vector3(Math.abs(along.x) < 0.8 ? 1 : 0, Math.abs(along.x) < 0.8 ? 0 : 1, 0).cross(along).normalize();
    const second = along.clone().cross(first);
    const rim = [];
    for (let j = 0; j <= sides; j++) {
      const at = (2 * Math.PI * j) / sides;
      rim.push(first.clone().multiplyScalar(Math.cos(at)).addScaledVector(second, Math.sin(at)).multiply(size).applyQuaternion(turn));
    }
    const into = kinds[path.hits[k]];
    for (let j = 0; j < sides; j++) {
      for (const [end, side] of [[here, j], [there, j], [there, j + 1], [here, j], [there, j + 1], [here, j + 1]]) {
        into.push(end.x + rim[side].x, end.y + rim[side].y, end.z + rim[side].z);
      }
    }
  }
  return kinds.map((corners) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
    geometry.computeVertexNormals();
    const material = new THREE.MeshLambertMaterial({ transparent: true, opacity: 0.34, side: THREE.DoubleSide, depthWrite: false });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.renderOrder = 3;
    scene.add(mesh);
    return material;
  });
}

function drawLine(THREE, scene, path) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(path.place, 3));
  const material = new THREE.LineBasicMaterial();
  scene.add(new THREE.Line(geometry, material));
  return material;
}

function spheroid(THREE, b, d, opacity) {
  const material = new THREE.MeshLambertMaterial({ transparent: opacity < 1, opacity });
  const mesh = new THREE.Mesh(new THREE.SphereGeometry(1, 40, 28).rotateX(Math.PI / 2), material);
  mesh.scale.set(b, b, d);
  mesh.renderOrder = 1;
  return mesh;
}

function drawContacts(THREE, scene, path) {
  return data.contacts.map(({ at, segment }) => {
    const mesh = spheroid(THREE, data.mover.b, data.mover.d, 0.75);
    mesh.position.fromArray(at);
    mesh.quaternion.copy(turned(THREE, path, segment));
    scene.add(mesh);
    return mesh.material;
  });
}

function drawMover(THREE, scene) {
  const group = new THREE.Group(), parts = data.mover.parts;
  group.add(spheroid(THREE, data.mover.b, data.mover.d, parts.length ? 0.5 : 1));
  const inner = parts.map((part) => {
    const mesh = spheroid(THREE, part.b, part.d, 1);
    scene.add(mesh);
    return mesh;
  });
  scene.add(group);
  return (path, flown) => {
    const [at, k] = placeAt(THREE, path, flown), turn = turned(THREE, path, k);
    group.position.copy(at);
    group.quaternion.copy(turn);
    inner.forEach((mesh, number) => {
      mesh.position.fromArray(data.mover.parts[number].places[Math.min(k, data.mover.parts[number].places.length - 1)]).add(at);
      mesh.quaternion.copy(turn);
    });
    return [group.children[0].material, ...inner.map((mesh) => mesh.material)];
  };
}

// The curve: for each piece of the flight the least distance on it.
function drawCurve(path, show) {
  const curve = element('curve'), { lower, upper } = data.distances, count = upper.length;
  const left = 38, right = 6, top = 8, bottom = 18;
  let now = null;
  const most = Math.max(...upper, 1e-300) * 1.08;
  const draw = () => {
    const wide = curve.clientWidth, tall = curve.clientHeight;
    curve.setAttribute('viewBox', `0 0 ${wide} ${tall}`);
    const x = (share) => left + share * (wide - left - right), y = (value) => top + (1 - value / most) * (tall - top - bottom);
    const steps = [];
    upper.forEach((value, k) => steps.push(`${x(k / count).toFixed(1)},${y(value).toFixed(1)}`, `${x((k + 1) / count).toFixed(1)},${y(value).toFixed(1)}`));
    const hits = upper.map((value, k) => (data.touched[k] ? `<rect class="hit" x="${x(k / count)}" width="${Math.max(x(1 / count) - x(0), 2)}" y="${y(0) - 5}" height="5"/>` : ''));
    const ruled = [0, most / 1.08].map((value) => `<line class="rule" x1="${left}" x2="${wide - right}" y1="${y(value)}" y2="${y(value)}"/><text x="${left - 4}" y="${y(value) + 4}" text-anchor="end">${short(value)}</text>`);
    const least = data.least ? `<circle class="least" r="4" cx="${x(data.least.flown / (path.total || 1))}" cy="${y(data.least.upper)}"/>` : '';
    curve.innerHTML = `${ruled.join('')}<polygon class="area" points="${x(0)},${y(0)} ${steps.join(' ')} ${x(1)},${y(0)}"/><polyline class="line" points="${steps.join(' ')}"/>${hits.join('')}${least}<line class="now" y1="${top}" y2="${tall - bottom}"/><text x="${left}" y="${tall - 4}">0</text><text x="${wide - right}" y="${tall - 4}" text-anchor="end">${short(path.total)}</text><text x="${(left + wide - right) / 2}" y="${tall - 4}" text-anchor="middle">least distance over the length flown</text>`;
    now = curve.querySelector('.now');
    mark(Number(element('at').value) / 1000);
  };
  const mark = (share) => {
    const at = left + share * (curve.clientWidth - left - right);
    now?.setAttribute('x1', at);
    now?.setAttribute('x2', at);
  };
  const seek = (event) => {
    if (event.buttons || event.type === 'pointerdown') {
      const box = curve.getBoundingClientRect();
      show(Math.min(Math.max((event.clientX - box.left - left) / (box.width - left - right), 0), 1));
    }
  };
  curve.addEventListener('pointerdown', (event) => { curve.setPointerCapture(event.pointerId); seek(event); });
  curve.addEventListener('pointermove', seek);
  addEventListener('resize', draw);
  draw();
  return mark;
}

const short = (value) => (value === 0 ? '0' : Number(value.toPrecision(3)).toString());

function say(path, share) {
  const { lower, upper } = data.distances, k = Math.min(Math.floor(share * upper.length), upper.length - 1);
  const flown = share * path.total, segment = segmentAt(path, flown);
  const near = data.touched[k] ? 'contact' : `at least ${short(lower[k])} from ${data.nearest[k]}`;
  element('said').textContent = `${short(flown)} of ${short(path.total)} flown, segment ${segment}: ${near}`;
}

async function run() {
  let THREE, OrbitControls;
  try {
    [THREE, OrbitControls] = await loaded();
  } catch (error) {
    refuse(`This browser cannot unpack what the page holds (${error.message}); one from 2023 or later can.`);
    return;
  }
  const canvas = element('view');
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
  } catch (error) {
    refuse('This browser has no WebGL, which draws the scene. The curve and the numbers below need none.');
  }
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(45, 1, 0.01, 1e4);
  camera.up.set(0, 0, 1);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x777777, 2.2));
  const sun = new THREE.DirectionalLight(0xffffff, 1.2);
  sun.position.set(0.35, -0.5, 0.8);
  scene.add(sun);
  const bodies = drawBodies(THREE, scene);
  const path = data.path === null ? null : flight();
  const swept = path ? drawSwept(THREE, scene, path) : [];
  const line = path ? drawLine(THREE, scene, path) : null;
  const contacts = path ? drawContacts(THREE, scene, path) : [];
  const move = path ? drawMover(THREE, scene) : null;
  let movers = path ? move(path, 0) : [];

  const paint = () => {
    const set = (target, name) => target.set(colour(name));
    scene.background = new THREE.Color(colour('ground'));
    set(bodies.uniforms.colour.value, 'body');
    set(bodies.uniforms.touched.value, 'contact');
    swept.forEach((material, hit) => set(material.color, hit ? 'contact' : 'swept'));
    contacts.forEach((material) => set(material.color, 'contact'));
    movers.forEach((material) => set(material.color, 'mover'));
    if (line) set(line.color, 'mover');
  };

  const view = data.view, centre = new THREE.Vector3(...view.centre);
  camera.position.copy(centre).add(new THREE.Vector3(...view.from).multiplyScalar(view.radius * 2.1));
  camera.near = view.radius / 400;
  camera.far = view.extent * 8;
  const controls = new OrbitControls(camera, canvas);
  controls.target.copy(centre);
  controls.update();

  let wanted = true, playing = false, share = 0, before = 0;
  const redraw = () => { wanted = true; };
  controls.addEventListener('change', redraw);
  let mark = () => {};
  const show = (to) => {
    const held = path && placeAt(THREE, path, share * path.total)[0];
    share = to;
    element('at').value = share * 1000;
    movers = move(path, share * path.total);
    if (element('follow').checked) {
      const step = placeAt(THREE, path, share * path.total)[0].sub(held);
      camera.position.add(step);
      controls.target.add(step);
      controls.update();
    }
    mark(share);
    say(path, share);
    redraw();
  };
  const play = (on) => {
    playing = on;
    if (on && share >= 1) show(0);
    element('play').textContent = on ? 'Pause' : 'Play';
    element('play').setAttribute('aria-pressed', String(on));
    before = performance.now();
    redraw();
  };
  if (path) {
    mark = drawCurve(path, show);
    element('at').addEventListener('input', (event) => show(event.target.value / 1000));
    element('play').addEventListener('click', () => play(!playing));
    element('follow').addEventListener('change', (event) => {
      if (!event.target.checked) return;
      const at = placeAt(THREE, path, share * path.total)[0];
      const away = camera.position.clone().sub(controls.target).normalize().multiplyScalar(Math.max(data.mover.b, data.mover.d) * 25);
      controls.target.copy(at);
      camera.position.copy(at).add(away);
      controls.update();
    });
    show(data.least ? Math.min(data.least.flown / (path.total || 1), 1) : 0);
  }
  const turn = (about, up) => {
    const way = camera.position.clone().sub(controls.target), place = new THREE.Spherical().setFromVector3(new THREE.Vector3(way.x, way.z, -way.y));
    place.theta += about;
    place.phi = Math.min(Math.max(place.phi + up, 0.02), Math.PI - 0.02);
    const back = new THREE.Vector3().setFromSpherical(place);
    camera.position.copy(controls.target).add(new THREE.Vector3(back.x, -back.z, back.y));
    controls.update();
  };
  const zoom = (by) => { camera.position.sub(controls.target).multiplyScalar(by).add(controls.target); controls.update(); };
  const keys = {
    ArrowLeft: () => turn(-0.08, 0), ArrowRight: () => turn(0.08, 0), ArrowUp: () => turn(0, -0.06), ArrowDown: () => turn(0, 0.06),
    '+': () => zoom(0.9), '=': () => zoom(0.9), '-': () => zoom(1.1),
    ' ': () => path && play(!playing), ',': () => path && show(Math.max(share - 0.005, 0)), '.': () => path && show(Math.min(share + 0.005, 1)),
  };
  addEventListener('keydown', (event) => {
    const busy = event.target.closest?.('input, button') && event.target !== canvas;
    if (busy || event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    keys[event.key]();
    event.preventDefault();
    redraw();
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { paint(); redraw(); });
  new ResizeObserver(redraw).observe(canvas);
  paint();

  let frames = 0;
  const frame = (at) => {
    if (playing) {
      const next = Math.min(share + (at - before) / 1000 / 20, 1);
      before = at;
      show(next);
      if (next >= 1) play(false);
    }
    if (wanted && renderer) {
      wanted = false;
      const wide = canvas.clientWidth, tall = canvas.clientHeight;
      renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
      renderer.setSize(wide, tall, false);
      camera.aspect = wide / Math.max(tall, 1);
      camera.updateProjectionMatrix();
      renderer.render(scene, camera);
      document.body.dataset.frames = String(++frames);
    }
    if (document.body.dataset.ready === undefined) document.body.dataset.ready = 'yes';
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

run();
