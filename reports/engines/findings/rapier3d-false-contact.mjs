// rapier3d 0.21.0 says contact, and 0.151 mm apart. Exact: clear by 0.58 mm (at a tower of 2 m).
// Settings: it offers no setting.
// Lengths are in the engine's unit, 1000 mm of the tower; b = 0.25, d = 0.01.
// Certificate: with n = (-0.21, -0.57, 0.79), every corner v of the triangle has n·v >= 0.1526171875, and every
// point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.15206876733899041;
// |n| = 0.99654402812921417.
// Needs: npm install @dimforge/rapier3d-compat@0.21.0. Ends with 1 while it is wrong.
import rapier from '@dimforge/rapier3d-compat';

await rapier.init();
const [b, d, corners] = [0.25, 0.01, [[-0.068359375, -0.2412109375, 0.0009765625], [-0.1083984375, -0.2265625, 0.0009765625], [-0.11328125, -0.2392578125, 0.4345703125]]];
const turns = (n) => [...Array(n).keys()];
const rings = turns(11).map((k) => [Math.sin((Math.PI * (k + 1)) / 12), Math.cos((Math.PI * (k + 1)) / 12)]);
const around = ([r, z]) => turns(20).map((t) => [b * r * Math.cos((Math.PI * t) / 10), b * r * Math.sin((Math.PI * t) / 10), d * z]);
const hull = [[0, 0, d], [0, 0, -d], ...rings.flatMap(around)]; // 222 points on the spheroid

function ask() {
  const triangle = new rapier.TriMesh(new Float32Array(corners.flat()), new Uint32Array([0, 1, 2]));
  const body = b === d ? new rapier.Ball(b) : new rapier.ConvexPolyhedron(new Float32Array(hull.flat()));
  const [origin, upright] = [{ x: 0, y: 0, z: 0 }, { x: 0, y: 0, z: 0, w: 1 }];
  const near = body.contactShape(origin, upright, triangle, origin, upright, 4 * Math.max(b, d));
  return [body.intersectsShape(origin, upright, triangle, origin, upright), near?.distance ?? NaN];
}

let contact, distance;
for (const settings of ['default', 'tightest']) {
  [contact, distance] = ask(settings !== 'default');
  console.log(`${settings} settings: contact: ${contact}, distance: ${distance}`);
}
process.exit(Number(contact));
