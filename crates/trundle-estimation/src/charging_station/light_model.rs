//! The measurement model: probability of a reading at a pose of the robot in the station's frame.

use super::light_config::StationLightConfig;
use super::random::Random;
use trundle_core::{DockBeams, DockInfrared, Pose2, Vector2, difference_of_angles};

/// The measurement model of the light.
#[derive(Debug, Clone)]
pub(super) struct LightModel {
    config: StationLightConfig,
    /// `base_from_receiver`: left, middle, right.
    receivers: [Pose2; 3],
}

/// Smallest distance of a receiver from the station in a first guess \[m\]. Source: ours.
const MIN_FIRST_RANGE_M: f64 = 0.02;

impl LightModel {
    pub(super) fn new(config: StationLightConfig) -> Self {
        let bearing = config.receiver_bearing_deg.to_radians();
        let receivers = [bearing, 0.0, -bearing].map(|bearing| {
            Pose2::new(
                config.receiver_radius * bearing.cos(),
                config.receiver_radius * bearing.sin(),
                bearing,
            )
        });
        Self { config, receivers }
    }

    /// Distance of the receivers from the base's origin, m.
    pub(super) fn receiver_radius(&self) -> f64 {
        self.config.receiver_radius
    }

    /// Likelihood of a reading at `station_from_base`: the product over the receivers.
    pub(super) fn likelihood(&self, reading: &DockInfrared, station_from_base: Pose2) -> f64 {
        let seen = [reading.left, reading.center, reading.right];
        let of =
            |(beams, receiver): (DockBeams, Pose2)| self.likelihood_at(&beams, station_from_base * receiver);
        seen.into_iter().zip(self.receivers).map(of).product()
    }

    fn likelihood_at(&self, beams: &DockBeams, receiver: Pose2) -> f64 {
        let outlier = self.config.outlier_probability;
        let expected = self.visibility(receiver).map(|v| outlier + (1.0 - 2.0 * outlier) * v);
        let factor = |(is_seen, p): (bool, f64)| if is_seen { p } else { 1.0 - p };
        let likelihood = bits(beams).into_iter().zip(expected).map(factor).product::<f64>();
        if *beams == DockBeams::default() { likelihood.max(self.config.dark_likelihood) } else { likelihood }
    }

    /// Visibility of each field, 0 to 1, for a receiver at `station_from_receiver`: sector x range x field of view.
    fn visibility(&self, receiver: Pose2) -> [f64; 6] {
        let c = &self.config;
        let (range, bearing) = (receiver.position().norm(), receiver.y.atan2(receiver.x).to_degrees());
        let to_station = (-receiver.y).atan2(-receiver.x);
        let off_axis = difference_of_angles(to_station, receiver.theta).abs().to_degrees();
        let view = ramp(c.receiver_half_view_deg - off_axis, c.view_edge_deg);
        if view == 0.0 {
            return [0.0; 6];
        }
        let edge = c.sector_edge_deg;
        let side = |bearing: f64| {
            ramp(bearing - c.middle_half_angle_deg, edge) * ramp(c.side_bound_deg - bearing, 2.0 * edge)
        };
        let middle = ramp(c.middle_half_angle_deg - bearing.abs(), edge);
        let near = ramp(c.near_range - range, c.range_edge * c.near_range);
        let far = (1.0 - near) * ramp(c.far_range - range, c.range_edge * c.far_range);
        let sectors = [side(bearing), middle, side(-bearing)].map(|sector| sector * view);
        let [left, center, right] = sectors;
        [near * left, near * center, near * right, far * left, far * center, far * right]
    }

    /// An initial guess of `base_from_station` from a reading with light: a receiver that detects a field, and a place within that field.
    pub(super) fn first_guess(&self, reading: &DockInfrared, random: &mut Random) -> Option<Pose2> {
        let seen = [reading.left, reading.center, reading.right];
        let fields: Vec<(usize, usize)> = seen
            .iter()
            .enumerate()
            .flat_map(|(receiver, beams)| {
                (0..6).filter(|field| bits(beams)[*field]).map(move |f| (receiver, f))
            })
            .collect();
        let (receiver, field) = *fields.get((random.unit() * fields.len() as f64) as usize)?;
        let c = &self.config;
        let range = if field < 3 {
            random.between(MIN_FIRST_RANGE_M, c.near_range * (1.0 + c.range_edge))
        } else {
            random.between(c.near_range * (1.0 - c.range_edge), c.far_range * (1.0 + c.range_edge))
        };
        let (low, high) = match field % 3 {
            0 => (c.middle_half_angle_deg - c.sector_edge_deg, c.side_bound_deg),
            1 => (-c.middle_half_angle_deg - c.sector_edge_deg, c.middle_half_angle_deg + c.sector_edge_deg),
            _ => (-c.side_bound_deg, c.sector_edge_deg - c.middle_half_angle_deg),
        };
        let view = c.receiver_half_view_deg + c.view_edge_deg;
        let (bearing, off_axis) = (random.between(low, high), random.between(-view, view));
        let at = Vector2::new(bearing.to_radians().cos(), bearing.to_radians().sin()) * range;
        let heading = (-at.y).atan2(-at.x) - off_axis.to_radians();
        let station_from_receiver = Pose2::new(at.x, at.y, heading);
        Some(self.receivers[receiver] * station_from_receiver.inverse())
    }
}

/// The fields in the order near left, middle, right, far left, middle, right.
fn bits(beams: &DockBeams) -> [bool; 6] {
    let DockBeams { near_left, near_center, near_right, far_left, far_center, far_right } = *beams;
    [near_left, near_center, near_right, far_left, far_center, far_right]
}

/// 0 below `-width`, 1 above `width`, linear in between.
fn ramp(x: f64, width: f64) -> f64 {
    (0.5 + 0.5 * x / width).clamp(0.0, 1.0)
}
