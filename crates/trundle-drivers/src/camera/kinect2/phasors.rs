//! Phase and amplitude from three shifted measurements.
//!
//! A measurement is v_k = a cos(phi + p_0 + p_k) with p_k = 0, 1/3, 2/3 of a turn. The phasor
//! z = 2/3 sum v_k exp(-i (p_0 + p_k)) has the argument phi and the magnitude a; ambient light cancels. Source: Lawin et al. 2016, section 2.

use super::companding::SATURATED;
use super::layout::{FREQUENCY_COUNT, PIXEL_COUNT, SHIFT_COUNT};
use std::f32::consts::TAU;
use trundle_core::{Image, Invalid};

/// Steps of `p0` in one turn. Source: assumed, the range of its 16 bits.
const P0_STEPS_PER_TURN: f32 = 65_536.0;
/// Cosine of a third of a turn.
const THIRD_TURN_COS: f32 = -0.5;
/// Sine of a third of a turn.
const THIRD_TURN_SIN: f32 = 0.866_025_4;

/// The phasors of one pixel at the three frequencies: real and imaginary part. All zero where there is no measurement.
pub type Phasors = [[f32; 2]; FREQUENCY_COUNT];

/// Turns of the phasors by `p0`, for each pixel.
#[derive(Debug, Clone)]
pub struct PhaseTables {
    turns: Vec<Phasors>,
}

impl PhaseTables {
    /// From the calibration of the device: a table of 512 x 424 numbers for each frequency.
    ///
    /// # Errors
    /// When a table has another length.
    pub fn new(p0: &[Vec<u16>; FREQUENCY_COUNT]) -> Result<Self, Invalid> {
        for (frequency, table) in p0.iter().enumerate() {
            if table.len() != PIXEL_COUNT {
                let place = format!("P0 table {frequency} of a Kinect V2");
                return Err(Invalid::new(place, table.len(), "numbers", PIXEL_COUNT.to_string()));
            }
        }
        let turn = |step: u16| {
            let (sin, cos) = (TAU * (step as f32 / P0_STEPS_PER_TURN)).sin_cos();
            [cos, -sin]
        };
        let of_pixel = |pixel: usize| std::array::from_fn(|frequency| turn(p0[frequency][pixel]));
        Ok(Self { turns: (0..PIXEL_COUNT).map(of_pixel).collect() })
    }

    /// The phasors of all pixels from nine images of measurements, frequency by frequency.
    pub fn phasors(&self, images: &[Image<i16>; FREQUENCY_COUNT * SHIFT_COUNT], phasors: &mut [Phasors]) {
        let rows: [&[i16]; FREQUENCY_COUNT * SHIFT_COUNT] = std::array::from_fn(|i| images[i].data());
        for ((pixel, turns), target) in self.turns.iter().enumerate().zip(phasors) {
            let values: [i16; FREQUENCY_COUNT * SHIFT_COUNT] = std::array::from_fn(|i| rows[i][pixel]);
            *target = if values.contains(&SATURATED) { Phasors::default() } else { of_pixel(values, turns) };
        }
    }
}

fn of_pixel(values: [i16; FREQUENCY_COUNT * SHIFT_COUNT], turns: &Phasors) -> Phasors {
    std::array::from_fn(|frequency| {
        let [v0, v1, v2] = std::array::from_fn(|shift| values[frequency * SHIFT_COUNT + shift] as f32);
        let re = (v0 + THIRD_TURN_COS * (v1 + v2)) * (2.0 / 3.0);
        let im = THIRD_TURN_SIN * (v2 - v1) * (2.0 / 3.0);
        let [cos, sin] = turns[frequency];
        [re * cos - im * sin, re * sin + im * cos]
    })
}
