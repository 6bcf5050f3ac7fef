//! Implausible numbers, such as millimetres for metres, or degrees for radians.

use crate::RobotConfig;
use trundle_core::{FOCAL_LENGTH_PER_SIDE, Hypotenuse, Invalid, MAX_FOOTPRINT_RADIUS_M};

/// A number, its range for indoor robots, and the likely unit of a number outside the range.
struct Plausible {
    path: &'static str,
    value: f64,
    unit: &'static str,
    low: f64,
    high: f64,
    meant: &'static str,
}

/// Largest wheel radius of an indoor robot \[m\]. Source: ours, three times a wheelchair's.
const MAX_WHEEL_RADIUS_M: f64 = 0.5;
/// Largest wheelbase of an indoor robot \[m\]. Source: ours, the width of a double door.
const MAX_WHEELBASE_M: f64 = 2.0;
/// Largest forward speed \[m/s\]. Source: ours, a running person.
const MAX_SPEED_M_S: f64 = 5.0;
/// Largest turn rate \[rad/s\]. Source: ours, two turns per second.
const MAX_TURN_RATE_RAD_S: f64 = 15.0;
/// Largest acceleration \[m/s^2\], twice that of gravity; no wheel on a floor reaches it. Source: ours.
const MAX_ACCELERATION_M_S2: f64 = 20.0;
/// Largest angular acceleration \[rad/s^2\]. Source: ours.
const MAX_ANGULAR_ACCELERATION_RAD_S2: f64 = 100.0;

/// Refuses implausible numbers, and suggests the unit that was probably meant.
///
/// # Errors
/// Names the first such number.
pub fn require_plausible(config: &RobotConfig) -> Result<(), Invalid> {
    for check in lengths_and_speeds(config).into_iter().chain(camera(config)) {
        let Plausible { path, value, unit, low, high, meant } = check;
        let expected = match value {
            value if value > high => format!("at most {high} {unit}; is it in {meant}?"),
            value if value < low => format!("at least {low} {unit}; is it in {meant}?"),
            _ => continue,
        };
        return Err(Invalid::new(path, value, unit, expected));
    }
    Ok(())
}

fn lengths_and_speeds(config: &RobotConfig) -> [Plausible; 9] {
    // `Robot::new` refuses numbers below 0; a wrong unit does not change the sign.
    let low = f64::NEG_INFINITY;
    let below = |path, value, unit, high, meant| Plausible { path, value, unit, low, high, meant };
    let (drive, limits) = (&config.drive, &config.limits);
    [
        below("footprint_radius", config.footprint_radius, "m", MAX_FOOTPRINT_RADIUS_M, "millimetres"),
        below("footprint", farthest_corner(config), "m", MAX_FOOTPRINT_RADIUS_M, "millimetres"),
        below("drive.wheel_radius", drive.wheel_radius, "m", MAX_WHEEL_RADIUS_M, "millimetres"),
        below("drive.wheelbase", drive.wheelbase, "m", MAX_WHEELBASE_M, "millimetres"),
        below("limits.wheel_speed", limits.wheel_speed, "m/s", MAX_SPEED_M_S, "mm/s"),
        below("limits.v", limits.v, "m/s", MAX_SPEED_M_S, "mm/s"),
        below("limits.omega", limits.omega, "rad/s", MAX_TURN_RATE_RAD_S, "degrees per second"),
        below("limits.acceleration", limits.acceleration, "m/s^2", MAX_ACCELERATION_M_S2, "mm/s^2"),
        below(
            "limits.angular_acceleration",
            limits.angular_acceleration,
            "rad/s^2",
            MAX_ANGULAR_ACCELERATION_RAD_S2,
            "degrees per second squared",
        ),
    ]
}

/// The distance of the farthest corner of the outline from the base, m; 0 without corners.
fn farthest_corner(config: &RobotConfig) -> f64 {
    let distances = config.footprint.iter().flatten().map(|[x, y]| x.hypotenuse(*y));
    distances.fold(0.0, f64::max)
}

fn camera(config: &RobotConfig) -> [Plausible; 4] {
    let camera = &config.camera;
    let (width, height) = (camera.width() as f64, camera.height() as f64);
    let (low, high) = (width * FOCAL_LENGTH_PER_SIDE.0, width * FOCAL_LENGTH_PER_SIDE.1);
    let focal =
        |path, value| Plausible { path, value, unit: "px", low, high, meant: "another unit than pixels" };
    let centre = |path, value, high| Plausible {
        path,
        value,
        unit: "px",
        low: 0.0,
        high,
        meant: "the image of another size",
    };
    [
        focal("camera.fx", camera.fx()),
        focal("camera.fy", camera.fy()),
        centre("camera.cx", camera.cx(), width - 1.0),
        centre("camera.cy", camera.cy(), height - 1.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::RobotFile;

    #[test]
    fn an_outline_may_be_the_text_that_nav2_takes() {
        let corners = |value: &str| {
            RobotFile::parse(&format!("footprint_m = {value}\n"), &[]).map(|file| file.config.footprint)
        };
        let list = "[[0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2], [0.3, -0.2]]";
        assert_eq!(corners(&format!("\"{list}\"")), corners(list));
        assert!(corners("\"[[0.3, 0.2]\"").unwrap_err().to_string().contains("expected [[X, Y], [X, Y]"));
    }

    fn refused(pair: &str) -> String {
        RobotFile::parse("", &[pair.to_owned()]).unwrap_err().to_string()
    }

    #[test]
    fn millimetres_degrees_and_wrong_images_are_refused() {
        assert!(
            refused("drive.wheel_radius_m=35").contains("drive.wheel_radius_m is 35 m"),
            "{}",
            refused("drive.wheel_radius_m=35")
        );
        assert!(refused("drive.wheel_radius_m=35").contains("millimetres?"));
        assert!(refused("drive.wheelbase_m=230").contains("millimetres?"));
        assert!(refused("footprint_m=[[300,200],[-300,200],[-300,-200]]").contains("footprint_m is 360"));
        assert!(refused("limits.acceleration_m_s2=500").contains("mm/s^2?"));
        assert!(refused("limits.angular_acceleration_rad_s2=180").contains("degrees per second squared?"));
        assert!(refused("limits.v_m_s=700").contains("mm/s?"));
        assert!(refused("limits.omega_rad_s=180").contains("degrees per second?"));
        assert!(refused("camera.fx_px=36100").contains("camera.fx_px is 36100 px"));
        assert!(refused("camera.cx_px=600").contains("the image of another size?"));
        assert!(refused("camera.cy_px=-3").contains("camera.cy_px is -3 px"));
    }

    #[test]
    fn each_limit_of_what_is_plausible_is_still_plausible() {
        let config = RobotConfig::default();
        assert_eq!(require_plausible(&config), Ok(()));
        let root = toml::Value::try_from(&config).unwrap();
        let limits = lengths_and_speeds(&config).into_iter().chain(camera(&config));
        for Plausible { path, high, .. } in limits.filter(|limit| limit.path != "footprint") {
            let with = |value: f64| {
                let mut root = root.clone();
                let (table, field) = path.split_once('.').unwrap_or(("", path));
                let at = if table.is_empty() { Some(&mut root) } else { root.get_mut(table) };
                at.and_then(|at| at.get_mut(field)).map(|at| *at = toml::Value::Float(value)).unwrap();
                require_plausible(&root.try_into::<RobotConfig>().unwrap())
            };
            assert_eq!(with(high), Ok(()), "{path}");
            let error = with(high * 1.001).unwrap_err();
            assert_eq!(error.field, path);
            assert!(error.to_string().contains("is it in"), "{error}");
        }
    }

    #[test]
    fn the_farthest_corner_of_an_outline_counts() {
        let with = |x: f64| {
            let footprint = Some(vec![[0.2, 0.2], [-x, 0.0], [0.2, -0.2]]);
            require_plausible(&RobotConfig { footprint, ..RobotConfig::default() })
        };
        assert_eq!(with(MAX_FOOTPRINT_RADIUS_M), Ok(()));
        assert_eq!(with(3.1).unwrap_err().field, "footprint");
    }
}
