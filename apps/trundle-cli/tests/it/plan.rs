use crate::program::{summary, text, trundle};
use std::fs;

/// A room of 6 x 4 m with a wall across, open at the top.
pub fn write_room(folder: &std::path::Path) -> std::path::PathBuf {
    let (width, height) = (120, 80);
    let cell = |x: usize, y: usize| {
        let border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        if border || (x == 60 && y > 25) { 0u8 } else { 254 }
    };
    let mut pgm = format!("P5\n{width} {height}\n255\n").into_bytes();
    pgm.extend((0..height).flat_map(|y| (0..width).map(move |x| cell(x, y))));
    fs::write(folder.join("room.pgm"), pgm).unwrap();
    let yaml = "image: room.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    fs::write(folder.join("room.yaml"), yaml).unwrap();
    folder.join("room.yaml")
}

#[test]
fn a_plan_leads_around_the_wall() {
    let scratch = tempfile::tempdir().unwrap();
    let (map, out) = (write_room(scratch.path()), scratch.path().join("out"));
    let output =
        trundle(&["plan", text(&map), "--from=1,1,0", "--to=5,1,-90", "--quiet", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["waypoints.csv", "curve.csv", "coefficients.csv", "trajectory.csv", "plan.png"] {
        assert!(fs::metadata(out.join(name)).unwrap().len() > 20, "{name}");
    }
    let length = summary(&out)["length_m"].as_f64().unwrap();
    assert!(length > 5.0 && length < 9.0, "{length}");
    let trajectory = fs::read_to_string(out.join("trajectory.csv")).unwrap();
    let last: Vec<f64> = trajectory.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert!((last[1] - 5.0).hypot(last[2] - 1.0) < 2e-3, "{last:?}");
    assert!((last[3] + std::f64::consts::FRAC_PI_2).abs() < 1e-3, "{last:?}");
}
