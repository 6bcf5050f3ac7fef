use super::{DepthScanConfig, pixel_rays::PixelRay};

/// What one valid depth says about the bearing it lies in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Finding {
    /// Something in the height band at this range, m.
    Obstacle(f32),
    /// The ray passed through the height band and met nothing up to this range, m.
    Clear(f32),
    /// Neither: a floor that is too high for its noise, a hole, or a ray that never came down into the band.
    Nothing,
}

/// Sorts points by their height above the floor.
#[derive(Debug, Clone)]
pub(super) struct HeightGate {
    camera_height: f32,
    low: f32,
    high: f32,
    max_range: f32,
    noise_base: f32,
    noise_growth: f32,
    floor_sigmas: f32,
    tilt: f32,
}

impl HeightGate {
    pub(super) fn new(config: &DepthScanConfig, camera_height: f64) -> Self {
        Self {
            camera_height: camera_height as f32,
            low: config.band_low as f32,
            high: config.band_high as f32,
            max_range: config.max_range as f32,
            noise_base: config.noise_base as f32,
            noise_growth: config.noise_growth as f32,
            floor_sigmas: config.floor_sigmas as f32,
            tilt: config.tilt_error_deg.to_radians().tan() as f32,
        }
    }

    /// One sigma of a depth, m.
    pub(super) fn depth_noise(&self, depth: f32) -> f32 {
        self.noise_base + self.noise_growth * depth * depth
    }

    /// What a point at `depth` m along `ray` says.
    #[inline]
    pub(super) fn judge(&self, ray: &PixelRay, depth: f32) -> Finding {
        let range = ray.run * depth;
        let height = self.camera_height + ray.rise * depth;
        if range > self.max_range || height > self.high {
            return self.beyond(ray, range);
        }
        let edge = self.floor_edge(ray, depth, range);
        if height > edge {
            Finding::Obstacle(range)
        } else if height <= self.low && height >= -edge {
            Finding::Clear(range)
        } else {
            Finding::Nothing
        }
    }

    /// The height up to which a point may still be floor: the band's edge, or what noise and tilt can do to the floor.
    fn floor_edge(&self, ray: &PixelRay, depth: f32, range: f32) -> f32 {
        let noise = self.floor_sigmas * ray.rise.abs() * self.depth_noise(depth);
        self.low.max(noise + self.tilt * range)
    }

    /// A ray that ended above the band or beyond the greatest range: how far it travelled inside the band.
    fn beyond(&self, ray: &PixelRay, range: f32) -> Finding {
        if range <= self.max_range {
            return self.left_upward(ray, range);
        }
        let depth = self.max_range / ray.run;
        let height = self.camera_height + ray.rise * depth;
        if height > self.high {
            self.left_upward(ray, self.max_range)
        } else if height >= -self.floor_edge(ray, depth, self.max_range) {
            Finding::Clear(self.max_range)
        } else {
            Finding::Nothing
        }
    }

    /// A ray that is above the band at `range`: it may have begun in it.
    fn left_upward(&self, ray: &PixelRay, range: f32) -> Finding {
        if ray.exit > 0.0 { Finding::Clear(ray.exit.min(range)) } else { Finding::Nothing }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate(camera_height: f64) -> HeightGate {
        HeightGate::new(&DepthScanConfig::default(), camera_height)
    }

    fn ray(rise: f32) -> PixelRay {
        PixelRay::new(1.0, rise, 0, 0.65 - 0.4)
    }

    #[test]
    fn the_band_is_an_obstacle_and_the_floor_is_not() {
        assert_eq!(gate(0.4).judge(&ray(0.0), 2.0), Finding::Obstacle(2.0));
        assert_eq!(gate(0.4).judge(&ray(-0.2), 2.0), Finding::Clear(2.0));
        assert_eq!(gate(0.4).judge(&ray(-0.4), 2.0), Finding::Nothing, "a hole 0.4 m deep");
    }

    #[test]
    fn far_floor_that_rises_within_the_tilt_error_is_neither() {
        let half_a_degree_high = -0.4 / 5.0 + 0.0145;
        assert_eq!(gate(0.4).judge(&ray(half_a_degree_high), 5.0), Finding::Nothing);
    }

    #[test]
    fn a_ray_that_leaves_the_band_upward_clears_what_it_crossed() {
        let Finding::Clear(range) = gate(0.4).judge(&ray(0.1), 4.0) else { panic!("not clear") };
        assert!((range - 2.5).abs() < 1e-5);
        assert_eq!(gate(0.4).judge(&ray(0.1), 1.0), Finding::Obstacle(1.0));
    }

    #[test]
    fn a_ray_over_the_band_clears_nothing() {
        let ray = |rise| PixelRay::new(1.0, rise, 0, 0.65 - 1.0);
        assert_eq!(gate(1.0).judge(&ray(0.1), 4.0), Finding::Nothing);
        assert_eq!(gate(1.0).judge(&ray(-0.1), 3.0), Finding::Nothing, "a table top higher than the robot");
    }

    #[test]
    fn obstacles_beyond_the_greatest_range_leave_the_way_to_it_free() {
        assert_eq!(gate(0.4).judge(&ray(0.0), 7.0), Finding::Clear(6.0));
    }
}
