// parry3d 0.31.1 says contact, and 0.151 mm apart. Exact: clear by 0.58 mm (at a tower of 2 m).
// Settings: it offers no setting.
// Lengths are in the engine's unit, 1000 mm of the tower; b = 0.25, d = 0.01.
// Certificate: with n = (-0.21, -0.57, 0.79), every corner v of the triangle has n·v >= 0.1526171875, and every
// point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.15206876733899041;
// |n| = 0.99654402812921417.
// Needs: a package with parry = { package = "parry3d", version = "=0.31.1" } below [dependencies]. Ends with 1 while it is wrong.
use parry::math::{Pose, Real, Vector};
use parry::query;
use parry::shape::{Ball, ConvexPolyhedron, Shape, TriMesh};
use std::f64::consts::PI;

fn main() {
    let (b, d): (f64, f64) = (0.25, 0.01);
    let corners: [[f64; 3]; 3] = [[-0.068359375, -0.2412109375, 0.0009765625], [-0.1083984375, -0.2265625, 0.0009765625], [-0.11328125, -0.2392578125, 0.4345703125]];
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
    std::process::exit(i32::from(contact));
}
