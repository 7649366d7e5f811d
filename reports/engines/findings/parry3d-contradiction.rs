// parry3d 0.31.1 says contact, and 0.0321 mm apart. Exact: clear by 0.021 mm (at a tower of 2 m).
// Settings: it offers no setting.
// Lengths are in the engine's unit, 1000 mm of the tower; b = 0.005, d = 0.003.
// Certificate: with n = (0.99628, -0.05084, 0.06962), every corner v of the triangle has n·v >= 0.0050130273437500004, and every
// point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.0049922526077513353;
// |n| = 1.0000027441962347.
// Needs: a package with parry = { package = "parry3d", version = "=0.31.1" } below [dependencies]. Ends with 1 while it is wrong.
use parry::math::{Pose, Real, Vector};
use parry::query;
use parry::shape::{Ball, ConvexPolyhedron, Shape, TriMesh};
use std::f64::consts::PI;

fn main() {
    let (b, d): (f64, f64) = (0.005, 0.003);
    let corners: [[f64; 3]; 3] = [[0.021331787109375, 0.04034423828125, -0.20379638671875], [0.0186767578125, -0.011688232421875, -0.20379638671875], [-0.0115966796875, -0.01043701171875, 0.2303466796875]];
    let vector = |x: f64, y: f64, z: f64| Vector::new(x as Real, y as Real, z as Real);
    let mut hull = vec![vector(0.0, 0.0, d), vector(0.0, 0.0, -d)]; // 222 points on the spheroid
    for k in 1..12 {
        let (r, z) = (PI * k as f64 / 12.0).sin_cos();
        hull.extend((0..20).map(|t| (PI * t as f64 / 10.0).sin_cos()).map(|(s, c)| vector(b * r * c, b * r * s, d * z)));
    }
    let body: Box<dyn Shape> =
        if b == d { Box::new(Ball::new(b as Real)) } else { Box::new(ConvexPolyhedron::from_convex_hull(&hull).unwrap()) };
    let vertices = corners.iter().map(|v| vector(v[0], v[1], v[2])).collect();
    let triangle = TriMesh::new(vertices, vec![[0, 1, 2]]).unwrap();
    let (here, reach) = (Pose::IDENTITY, 4.0 * b.max(d) as Real);
    let contact = query::intersection_test(&here, body.as_ref(), &here, &triangle).unwrap().intersecting;
    let found = query::contact(&here, body.as_ref(), &here, &triangle, reach).unwrap();
    let distance = found.map_or(f64::NAN, |each| f64::from(each.dist));
    println!("contact: {contact}, distance: {distance}");
    std::process::exit(i32::from(contact && distance > 0.0));
}
