//! The office scene.

use trundle_core::{Footprint, Hypotenuse, PinholeCamera, Pose2, Pose3, Vector3};
use trundle_sim::scenes::{OFFICE_RING, OFFICE_TWINS};
use trundle_sim::{HeightBand, Renderer, Scene, View, camera_mount};

/// Poses along the ring's centre line, with the heading of the path.
fn ring(step: f64) -> impl Iterator<Item = Pose2> {
    (0..4).flat_map(move |i| {
        let ([ax, ay], [bx, by]) = (OFFICE_RING[i], OFFICE_RING[(i + 1) % 4]);
        let (length, heading) = ((bx - ax).hypotenuse(by - ay), (by - ay).atan2(bx - ax));
        let steps = (length / step) as usize;
        (0..steps).map(move |k| Pose2::new(ax, ay, heading) * Pose2::new(k as f64 * step, 0.0, 0.0))
    })
}

#[test]
fn the_ring_is_40_m_around_in_the_middle_of_its_corridor_and_free() {
    let scene = Scene::by_name("office", 5).unwrap();
    let around: f64 = (0..4)
        .map(|i| (OFFICE_RING[i], OFFICE_RING[(i + 1) % 4]))
        .map(|([ax, ay], [bx, by])| (bx - ax).hypotenuse(by - ay))
        .sum();
    assert!((around - 41.75).abs() < 1e-9, "{around} m");
    let band = HeightBand::new(0.012, 0.6).unwrap();
    for pose in ring(0.25) {
        let free = scene.world.clearance(&Footprint::KOBUKI, pose, band).unwrap();
        assert!(free > 0.1, "{free} m at {pose:?}");
        // Walls on both sides, above doors and posters; none at the corners.
        let eye = Vector3::new(pose.x, pose.y, 2.3);
        let wall = |turn: f64| {
            let (s, c) = (pose.theta + turn).sin_cos();
            scene.world.cast(eye, Vector3::new(c, s, 0.0), 100.0).map(|hit| hit.distance).unwrap()
        };
        let (left, right) = (wall(std::f64::consts::FRAC_PI_2), wall(-std::f64::consts::FRAC_PI_2));
        if left + right < 2.0 {
            assert!((left - right).abs() < 1e-9, "{left} and {right} m at {pose:?}");
        }
    }
}

fn look(renderer: &Renderer, scene: &Scene, pose: Pose2) -> View {
    let mut view = renderer.blank();
    let camera = Pose3::from_pose2(pose) * camera_mount(0.05, 0.45, 0.14);
    renderer.render(&scene.snapshot(), &camera, &mut view);
    view
}

/// Look-alikes for place recognition: the images are the same to the last byte.
#[test]
fn look_alike_rooms_have_equal_views() {
    let renderer =
        Renderer::new(PinholeCamera::from_field_of_view((256, 212), (1.232, 1.047)).unwrap()).unwrap();
    let scene = Scene::by_name("office", 2).unwrap();
    // Away from the doors, through which the rooms can be distinguished: the offices have theirs in the north.
    for ([one, two], headings) in
        OFFICE_TWINS.into_iter().zip([[-90.0_f64, -130.0, 180.0], [90.0, 50.0, 150.0]])
    {
        let at = |corner: [f64; 2], heading: f64| {
            look(&renderer, &scene, Pose2::new(corner[0] + 3.4, corner[1] + 2.25, heading.to_radians()))
        };
        for heading in headings {
            let (here, there) = (at(one, heading), at(two, heading));
            assert!(here.color == there.color, "colour at {heading} deg");
            assert!(here.depth == there.depth, "depth at {heading} deg");
        }
        // Through the door, and in the pantry, the view differs.
        assert!(at(one, headings[0]).color != at([5.0, 0.0], headings[0]).color);
        assert!(at(one, headings[0] + 180.0).color != at(two, headings[0] + 180.0).color);
    }
}
