// Bullet by ammo.js: a btConvexHullShape of points on the spheroid (btSphereShape where it is a ball) against a
// btBvhTriangleMeshShape.
//
// Bullet has no ellipsoid. Contact is a point of btCollisionWorld.contactPairTest with a distance of 0 or less, and the
// distance is the least of its points. Bullet pads the hull by a margin of 0.04; the tightest settings set it to 0.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { readScene, serve, tightest } from './speak.mjs'; // first: it keeps standard output for replies

const Ammo = createRequire(import.meta.url)('ammo.js');
const version = JSON.parse(readFileSync(new URL('./node_modules/ammo.js/package.json', import.meta.url))).version;
const scene = readScene(process.argv[2]);
const configuration = new Ammo.btDefaultCollisionConfiguration();
const dispatcher = new Ammo.btCollisionDispatcher(configuration);
const world = new Ammo.btDiscreteDynamicsWorld(
  dispatcher, new Ammo.btDbvtBroadphase(), new Ammo.btSequentialImpulseConstraintSolver(), configuration,
);
const vector = ([x, y, z]) => new Ammo.btVector3(x, y, z);
const mesh = new Ammo.btTriangleMesh(true, false);
const corners = scene.vertices.map(vector);
for (const [i, j, k] of scene.triangles) mesh.addTriangle(corners[i], corners[j], corners[k], false);

function object(shape) {
  const still = new Ammo.btDefaultMotionState(placed);
  const made = new Ammo.btRigidBody(new Ammo.btRigidBodyConstructionInfo(0, still, shape, origin));
  world.addRigidBody(made);
  return made;
}

function bodyShape() {
  if (scene.round) return new Ammo.btSphereShape(scene.b);
  const hull = new Ammo.btConvexHullShape();
  if (tightest) hull.setMargin(0);
  scene.body.map(vector).forEach((point) => hull.addPoint(point));
  return hull;
}

const origin = new Ammo.btVector3(0, 0, 0);
const rotation = new Ammo.btQuaternion(0, 0, 0, 1);
const placed = new Ammo.btTransform(rotation, origin);
const surface = object(new Ammo.btBvhTriangleMeshShape(mesh, true, true));
const body = object(bodyShape());
const found = new Ammo.ConcreteContactResultCallback();
let least = NaN;
found.addSingleResult = (point) => {
  const depth = Ammo.wrapPointer(point, Ammo.btManifoldPoint).getDistance();
  if (!(least <= depth)) least = depth;
  return 0;
};

function distance({ center, turn }) {
  origin.setValue(center.x, center.y, center.z);
  rotation.setValue(turn.x, turn.y, turn.z, turn.w);
  placed.setOrigin(origin);
  placed.setRotation(rotation);
  body.setWorldTransform(placed);
  least = NaN;
  world.contactPairTest(body, surface, found);
  return least;
}

function touches(pose) {
  return distance(pose) <= 0;
}

serve(scene, 'ammo.js', version, 'float32', touches, distance);
