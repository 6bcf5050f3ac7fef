//! Tables, way-points, paths and trajectories as CSV text.

use std::fmt::Write;
use trundle_core::{Path, Trajectory, Vector2};

/// A table as CSV: the header's names, then one line per row; every number is read back as the same f64. Names contain units (`x_m`) and no
/// comma.
pub fn table_csv<const N: usize>(header: [&str; N], rows: impl IntoIterator<Item = [f64; N]>) -> String {
    let mut text = header.join(",");
    text.push('\n');
    for row in rows {
        for (i, value) in row.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(text, "{comma}{value}").expect("invariant: a String takes any text");
        }
        text.push('\n');
    }
    text
}

/// Way-points (map frame, m) as `x_m,y_m`.
pub fn waypoints_csv(points: &[Vector2]) -> String {
    table_csv(["x_m", "y_m"], points.iter().map(|p| [p.x, p.y]))
}

/// A path as `s_m,x_m,y_m`: the distance along it and the point.
pub fn curve_csv(path: &Path) -> String {
    let mut distance = 0.0;
    let points = path.points();
    let rows = points.iter().enumerate().map(|(i, p)| {
        distance += if i == 0 { 0.0 } else { (p - points[i - 1]).norm() };
        [distance, p.x, p.y]
    });
    table_csv(["s_m", "x_m", "y_m"], rows)
}

/// A trajectory as `t_s,x_m,y_m,theta_rad,v_m_s,omega_rad_s`.
pub fn trajectory_csv(trajectory: &Trajectory) -> String {
    let header = ["t_s", "x_m", "y_m", "theta_rad", "v_m_s", "omega_rad_s"];
    let rows = trajectory.points().iter();
    table_csv(header, rows.map(|p| [p.time, p.pose.x, p.pose.y, p.pose.theta, p.twist.v, p.twist.omega]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Pose2, TrajectoryPoint, Twist2};

    #[test]
    fn tables_have_units_in_their_heads() {
        let path = Path::new(vec![Vector2::zeros(), Vector2::new(3.0, 4.0)]).unwrap();
        assert_eq!(curve_csv(&path), "s_m,x_m,y_m\n0,0,0\n5,3,4\n");
        assert_eq!(waypoints_csv(path.points()), "x_m,y_m\n0,0\n3,4\n");
        let point =
            TrajectoryPoint { time: 0.0, pose: Pose2::new(0.1, 0.2, 0.3), twist: Twist2::new(0.5, -1.0) };
        let text = trajectory_csv(&Trajectory::new(vec![point]).unwrap());
        assert_eq!(text, "t_s,x_m,y_m,theta_rad,v_m_s,omega_rad_s\n0,0.1,0.2,0.3,0.5,-1\n");
    }

    proptest! {
        #[test]
        fn numbers_come_back_exactly(rows in prop::collection::vec(prop::array::uniform3(prop::num::f64::NORMAL), 0..9)) {
            let text = table_csv(["a", "b", "c"], rows.iter().copied());
            let back: Vec<Vec<f64>> =
                text.lines().skip(1).map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect();
            prop_assert_eq!(back, rows.iter().map(|r| r.to_vec()).collect::<Vec<_>>());
        }
    }
}
