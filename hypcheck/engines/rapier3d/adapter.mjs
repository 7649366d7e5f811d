// Rapier by @dimforge/rapier3d-compat: the convex hull of points on the spheroid (a ball where it is one) against a TriMesh.
//
// Rapier has no ellipsoid. Contact is Shape.intersectsShape; the distance is that of Shape.contactShape.
import { readScene, serve } from './speak.mjs'; // first: it keeps standard output for replies
import rapier from '@dimforge/rapier3d-compat';

await rapier.init();
const scene = readScene(process.argv[2]);
const surface = new rapier.TriMesh(new Float32Array(scene.vertices.flat()), new Uint32Array(scene.triangles.flat()));
const body = scene.round ? new rapier.Ball(scene.b) : new rapier.ConvexPolyhedron(new Float32Array(scene.body.flat()));
const origin = { x: 0, y: 0, z: 0 };
const upright = { x: 0, y: 0, z: 0, w: 1 };
const reach = 4 * Math.max(scene.b, scene.d);

function touches({ center, turn }) {
  return body.intersectsShape(center, turn, surface, origin, upright);
}

function distance({ center, turn }) {
  return body.contactShape(center, turn, surface, origin, upright, reach)?.distance ?? NaN;
}

serve(scene, 'rapier3d', rapier.version(), 'float32', touches, distance);
