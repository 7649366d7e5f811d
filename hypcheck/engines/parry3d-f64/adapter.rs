//! Parry: the ConvexPolyhedron of points on the spheroid (a Ball where it is one) against a TriMesh.
//!
//! Parry has no ellipsoid. Contact is `query::intersection_test`; the distance is that of `query::contact` within reach,
//! which is negative where bodies penetrate. Built with parry3d-f64 and with parry3d, whose numbers are float32.

mod speak;

use parry::math::{Pose, Real, Rotation, Vector};
use parry::query;
use parry::shape::{Ball, ConvexPolyhedron, Shape, TriMesh};

fn vector(of: &speak::Triple) -> Vector {
    Vector::new(of[0] as Real, of[1] as Real, of[2] as Real)
}

fn body(scene: &speak::Scene) -> Box<dyn Shape> {
    if scene.round() {
        return Box::new(Ball::new(scene.sizes[2] as Real));
    }
    let points: Vec<Vector> = scene.body.iter().map(vector).collect();
    Box::new(ConvexPolyhedron::from_convex_hull(&points).expect("a hull"))
}

fn main() -> std::io::Result<()> {
    let scene = speak::Scene::read(&std::env::args().nth(1).expect("the scene's folder"));
    let vertices = scene.vertices.iter().map(vector).collect();
    let surface = TriMesh::new(vertices, scene.triangles.clone()).expect("a mesh");
    let (body, still) = (body(&scene), Pose::IDENTITY);
    let reach = 4.0 * scene.sizes[2].max(scene.sizes[3]) as Real;
    let placed = |pose: &speak::Pose| {
        let [x, y, z, w] = pose.1.map(|each| each as Real);
        Pose::from_parts(vector(&pose.0), Rotation::from_xyzw(x, y, z, w))
    };
    let touches = |pose: &speak::Pose| {
        query::intersection_test(&placed(pose), body.as_ref(), &still, &surface).expect("supported").intersecting
    };
    let distance = |pose: &speak::Pose| {
        let found = query::contact(&placed(pose), body.as_ref(), &still, &surface, reach).expect("supported");
        found.map_or(f64::NAN, |contact| f64::from(contact.dist))
    };
    let (name, precision) = if size_of::<Real>() == 8 { ("parry3d-f64", "float64") } else { ("parry3d", "float32") };
    speak::serve(&scene, name, "0.31.1", precision, touches, distance)
}
