// Jolt by jolt-physics: the convex hull of points on the spheroid (a sphere where it is a ball) against a MeshShape.
//
// Jolt has no ellipsoid. Contact is a hit of NarrowPhaseQuery.CollideShape, back faces included; the distance is minus the
// deepest penetration, with a largest separation of more than 0. The tightest settings give the hull no convex radius,
// and leave its points outside of it by 1e-5 at most.
import { readFileSync } from 'node:fs';
import { readScene, serve, tightest } from './speak.mjs'; // first: it keeps standard output for replies
import initJolt from 'jolt-physics';

const Jolt = await initJolt();
const version = JSON.parse(readFileSync(new URL('./node_modules/jolt-physics/package.json', import.meta.url))).version;
const scene = readScene(process.argv[2]);

function world() {
  const settings = new Jolt.JoltSettings();
  const pairs = new Jolt.ObjectLayerPairFilterTable(1);
  const layers = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
  pairs.EnableCollision(0, 0);
  layers.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
  settings.mMaxWorkerThreads = 0;
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 1, pairs, 1);
  return new Jolt.JoltInterface(settings).GetPhysicsSystem();
}

function refuse(reason) {
  console.error(reason);
  process.exit(1);
}

function made(settings) {
  const result = settings.Create();
  if (result.HasError()) refuse(`Jolt refuses the shape: ${result.GetError().c_str()}`);
  return result.Get();
}

function surfaceShape() {
  const vertices = new Jolt.VertexList();
  const triangles = new Jolt.IndexedTriangleList();
  for (const [x, y, z] of scene.vertices) vertices.push_back(new Jolt.Float3(x, y, z));
  for (const [i, j, k] of scene.triangles) triangles.push_back(new Jolt.IndexedTriangle(i, j, k, 0));
  return made(new Jolt.MeshShapeSettings(vertices, triangles, new Jolt.PhysicsMaterialList()));
}

function bodyShape() {
  if (scene.round) return new Jolt.SphereShape(scene.b);
  const settings = new Jolt.ConvexHullShapeSettings();
  for (const [x, y, z] of scene.body) settings.mPoints.push_back(new Jolt.Vec3(x, y, z));
  if (tightest) {
    settings.mMaxConvexRadius = 0;
    settings.mHullTolerance = 1e-5; // by how much points may lie outside of the hull; 0 fails
  }
  return made(settings);
}

const physics = world();
const upright = new Jolt.Quat(0, 0, 0, 1);
const still = new Jolt.BodyCreationSettings(surfaceShape(), new Jolt.RVec3(0, 0, 0), upright, Jolt.EMotionType_Static, 0);
physics.GetBodyInterface().CreateAndAddBody(still, Jolt.EActivation_DontActivate);
const body = bodyShape();
const settings = new Jolt.CollideShapeSettings();
settings.mBackFaceMode = Jolt.EBackFaceMode_CollideWithBackFaces;
if (tightest) settings.mCollisionTolerance = settings.mPenetrationTolerance = 1e-6;
const filters = [new Jolt.BroadPhaseLayerFilter(), new Jolt.ObjectLayerFilter(), new Jolt.BodyFilter(), new Jolt.ShapeFilter()];
const scale = new Jolt.Vec3(1, 1, 1);
const base = new Jolt.RVec3(0, 0, 0);
const position = new Jolt.RVec3(0, 0, 0);
const rotation = new Jolt.Quat(0, 0, 0, 1);
const collector = new Jolt.CollideShapeAllHitCollisionCollector();

function hits({ center, turn }, reach) {
  position.Set(center.x, center.y, center.z);
  rotation.Set(turn.x, turn.y, turn.z, turn.w);
  settings.mMaxSeparationDistance = reach;
  collector.Reset();
  const placed = Jolt.RMat44.prototype.sRotationTranslation(rotation, position);
  physics.GetNarrowPhaseQuery().CollideShape(body, scale, placed, settings, base, collector, ...filters);
  return collector.mHits;
}

function touches(pose) {
  return hits(pose, 0).size() > 0;
}

function distance(pose) {
  const found = hits(pose, 4 * Math.max(scene.b, scene.d));
  let least = NaN;
  for (let place = 0; place < found.size(); place++) {
    const depth = -found.at(place).mPenetrationDepth;
    if (!(least <= depth)) least = depth;
  }
  return least;
}

serve(scene, 'jolt-physics', version, 'float32', touches, distance);
