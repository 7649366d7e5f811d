// Rapier by @dimforge/rapier3d-compat: the convex hull of points on the spheroid (a ball where it is one) against the
// collider of a TriMesh.
//
// Rapier has no ellipsoid. Contact is Collider.intersectsShape; the distance is that of Collider.contactShape.
import { readScene, serve } from './speak.mjs'; // first: it keeps standard output for replies
import rapier from '@dimforge/rapier3d-compat';

await rapier.init();
const scene = readScene(process.argv[2]);
const world = new rapier.World({ x: 0, y: 0, z: 0 });
const mesh = rapier.ColliderDesc.trimesh(new Float32Array(scene.vertices.flat()), new Uint32Array(scene.triangles.flat()));
const surface = world.createCollider(mesh);
const body = scene.round ? new rapier.Ball(scene.b) : new rapier.ConvexPolyhedron(new Float32Array(scene.body.flat()));
const reach = 4 * Math.max(scene.b, scene.d);

function touches({ center, turn }) {
  return surface.intersectsShape(body, center, turn);
}

function distance({ center, turn }) {
  return surface.contactShape(body, center, turn, reach)?.distance ?? NaN;
}

serve(scene, 'rapier3d', rapier.version(), 'float32', touches, distance);
