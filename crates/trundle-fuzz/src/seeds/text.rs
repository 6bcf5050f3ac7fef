//! Texts: maps, lists, trajectories, settings.

use super::texts;
use trundle::docking::corridor::{Scenario, write};
use trundle::io::CameraModel;
use trundle::runtime::RobotConfig;
use trundle::runtime::settings::to_commented_toml;

/// A map's YAML file whose picture is `map.pgm`.
pub(crate) const MAP_YAML: &str = "image: map.pgm\nresolution: 0.05\norigin: [-0.1, 0.2, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
/// A picture of 4 x 3 cells.
pub(crate) const SMALL_PGM: &[u8] = b"P5\n4 3\n255\n\x00\x00\xfe\xfe\xcd\xfe\xfe\xfe\x00\x00\x00\x00";

/// `map_server`'s YAML files in several modes.
pub fn map_yaml() -> Vec<Vec<u8>> {
    let turned = MAP_YAML.replace("0.2, 0.0]", "0.2, 0.7]");
    let scale = format!("{MAP_YAML}mode: scale\n");
    let raw =
        format!("{MAP_YAML}mode: raw\n").replace("origin: [-0.1, 0.2, 0.0]", "origin:\n- 1\n- 2.5\n- 0");
    texts(&[MAP_YAML, &turned, &scale, &raw])
}

/// Way-points with an edge.
pub fn graph() -> Vec<Vec<u8>> {
    texts(&[r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"id":0,"frame":"map"},"geometry":{"type":"Point","coordinates":[1.0,2.0]}},
{"type":"Feature","properties":{"id":1},"geometry":{"type":"Point","coordinates":[3.0,2.0,0.0]}},
{"type":"Feature","properties":{"id":2,"startid":0,"endid":1,"cost":1.5},"geometry":{"type":"MultiLineString","coordinates":[[[1.0,2.0],[3.0,2.0]]]}}]}"#])
}

/// Two named places.
pub fn places() -> Vec<Vec<u8>> {
    texts(&[
        "[dock]\nx = 1.2\ny = 0.5\nheading_deg = 90\n\n[\"north door\"]\nx = 7.0\ny = 3.5\nheading_deg = 0\n",
    ])
}

/// A list of images.
pub fn image_list() -> Vec<Vec<u8>> {
    texts(&[
        "# color images\n# timestamp filename\n1.0 rgb/1.png\n2.01 rgb/2.png\n",
        "1305031229.528748 rgb/1.jpg\n",
    ])
}

/// A trajectory in each of the forms that are read.
pub fn trajectory() -> Vec<Vec<u8>> {
    texts(&[
        "# timestamp tx ty tz qx qy qz qw\n1.0 0 0 0 0 0 0 1\n2.5 1e-3 -2 0.5 0.1 0.2 0.3 0.9\n",
        "#timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z\n1403636580838555648,1,2,3,1,0,0,0\n1403636580843555328,1,2,3,1,0,0,0\n",
        "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0.1 0 1 0 0 0 0 1 0.5\n",
    ])
}

/// Odometry in the plane.
pub fn odometry() -> Vec<Vec<u8>> {
    texts(&["# timestamp x y theta\n1.0 0 0 0\n1.02 0.01 0 0.001\n"])
}

/// Relations between poses.
pub fn relations() -> Vec<Vec<u8>> {
    texts(&["1.0 2.0 0.5 0 0 0 0 0.1\n2.0 4.0 -0.5 1 0 0 0 3.1\n"])
}

/// A camera file of trundle, and one in the form of ORB-SLAM.
pub fn camera() -> Vec<Vec<u8>> {
    let preset = CameraModel::preset("freiburg1").expect("invariant: the preset exists");
    let orb = "%YAML:1.0\nCamera.fx: 517.3\nCamera.fy: 516.5\nCamera.cx: 318.6\nCamera.cy: 255.3\nCamera.width: 640\nCamera.height: 480\nDepthMapFactor: 5000.0\n";
    texts(&[&preset.to_toml(), orb])
}

/// The default robot whole, and a short file.
pub fn robot_toml() -> Vec<Vec<u8>> {
    texts(&[
        "[body]\nfootprint = { radius_m = 0.2 }\n[control]\n",
        &to_commented_toml(&RobotConfig::default()),
    ])
}

/// A scene with a prop and a person.
pub fn scene_toml() -> Vec<Vec<u8>> {
    texts(&[
        "name = \"x\"\n[base]\nscene = \"demo\"\nseed = 3\n[robot]\nstart = { x = 1.0, y = 1.0, heading_deg = 90 }\n",
        "[base]\nscene = \"corridor\"\n[[props]]\nshape = \"box\"\nsize = [0.4, 0.4, 1.0]\nat = [2.0, 1.0]\n[[people]]\npath = [[1, 1], [3, 1]]\nspeed = 0.5\n",
    ])
}

/// A schedule of faults.
pub fn faults_toml() -> Vec<Vec<u8>> {
    texts(&[
        "[[faults]]\nfrom_s = 5.0\nto_s = 9.0\nkind = \"camera-black\"\n\n[[faults]]\nfrom_s = 11.0\nkind = { wheel-slips = { side = \"left\", factor = 0.5 } }\n",
    ])
}

/// Commands, and way-points.
pub fn drive_script() -> Vec<Vec<u8>> {
    texts(&["0 0.2 0\n2.5 0 0.5\n4 0 0\n", "1 2 90\n3 2 0 # the door\n"])
}

/// The built-in docking problems.
pub fn corridor_problem() -> Vec<Vec<u8>> {
    Scenario::ALL.map(|scenario| write(&[scenario.problem()]).into_bytes()).to_vec()
}
