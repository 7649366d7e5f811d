// cannon-es: its Sphere of radius 1 against its Trimesh, in a space scaled by 1/b, 1/b, 1/d, where the spheroid is a ball.
//
// cannon-es has no ellipsoid, and no convex body meets its Trimesh. So upright spheroids alone are asked, and contact is
// that the narrow phase makes a contact. It reports no distance; the penetration is that of the deepest contact, and
// holds in the unscaled space for balls alone.
import { readFileSync } from 'node:fs';
import { readScene, serve } from './speak.mjs'; // first: it keeps standard output for replies
import * as cannon from 'cannon-es';

const version = JSON.parse(readFileSync(new URL('./node_modules/cannon-es/package.json', import.meta.url))).version;
const scene = readScene(process.argv[2]);
const { b, d } = scene;
const scaled = scene.vertices.flatMap(([x, y, z]) => [x / b, y / b, z / d]);
const surface = new cannon.Body({ mass: 0, shape: new cannon.Trimesh(scaled, scene.triangles.flat()) });
const body = new cannon.Body({ mass: 1, shape: new cannon.Sphere(1) });
const world = new cannon.World();
world.addBody(surface);
world.addBody(body);
surface.updateAABB();

function contacts({ center }) {
  body.position.set(center.x / b, center.y / b, center.z / d);
  body.aabbNeedsUpdate = true;
  const found = [];
  world.narrowphase.getContacts([body], [surface], world, found, [], [], []);
  return found;
}

function touches(pose) {
  return contacts(pose).length > 0;
}

function distance(pose) {
  if (!scene.round) return NaN;
  // From the point of the one body, along the normal, to the point of the other: negative where they penetrate.
  const depths = contacts(pose).map(({ bi, bj, ri, rj, ni }) => bj.position.vadd(rj).vsub(bi.position.vadd(ri)).dot(ni) * b);
  return depths.length > 0 ? Math.min(...depths) : NaN;
}

serve(scene, 'cannon-es', version, 'float64', touches, distance, false);
