//! Phase and amplitude from three shifted measurements.
//!
//! A measurement is v_k = a cos(phi + p_0 + p_k) with p_k = 0, 1/3, 2/3 of a turn. The phasor
//! z = 2/3 sum v_k exp(-i (p_0 + p_k)) has the argument phi and the magnitude a; ambient light cancels. Source: \[Lawin16\].

use super::companding::SATURATED_MEASUREMENT;
use super::layout::{FREQUENCY_COUNT, PIXEL_COUNT, SHIFT_COUNT};
use std::f32::consts::TAU;
use trundle_core::{Image, Invalid};

/// Steps of `p0` in one turn. Source: assumed, the range of its 16 bits.
const P0_STEPS_PER_TURN: f32 = 65_536.0;
/// Cosine of a third of a turn. Source: trigonometry.
const THIRD_TURN_COS: f32 = -0.5;
/// Sine of a third of a turn. Source: trigonometry.
const THIRD_TURN_SIN: f32 = 0.866_025_4;

/// Planes of a phasor image: real and imaginary part at each frequency.
pub const PLANE_COUNT: usize = 2 * FREQUENCY_COUNT;

/// The phasors of one pixel: real and imaginary part at each frequency. All zero without a measurement.
pub type Phasors = [f32; PLANE_COUNT];

/// The phasors of all pixels, one plane per part, for vectorised computation.
#[derive(Debug, Clone)]
pub struct PhasorImage {
    /// Rows from the top left, in the order of [`Phasors`].
    pub planes: [Vec<f32>; PLANE_COUNT],
}

impl PhasorImage {
    /// An image without measurements.
    pub fn empty() -> Self {
        Self { planes: std::array::from_fn(|_| vec![0.0; PIXEL_COUNT]) }
    }

    /// The phasors of a pixel. Panics for a pixel outside the image.
    #[inline]
    pub fn at(&self, pixel: usize) -> Phasors {
        std::array::from_fn(|plane| self.planes[plane][pixel])
    }

    fn set(&mut self, pixel: usize, phasors: &Phasors) {
        self.planes.iter_mut().zip(phasors).for_each(|(plane, part)| plane[pixel] = *part);
    }
}

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
        let of_pixel = |pixel: usize| -> Phasors {
            let [a, b, c] = std::array::from_fn(|frequency| turn(p0[frequency][pixel]));
            [a[0], a[1], b[0], b[1], c[0], c[1]]
        };
        Ok(Self { turns: (0..PIXEL_COUNT).map(of_pixel).collect() })
    }

    /// The phasors of all pixels from nine images of measurements, frequency by frequency.
    pub fn phasors(&self, images: &[Image<i16>; FREQUENCY_COUNT * SHIFT_COUNT], phasors: &mut PhasorImage) {
        let rows: [&[i16]; FREQUENCY_COUNT * SHIFT_COUNT] = std::array::from_fn(|i| images[i].data());
        for (pixel, turns) in self.turns.iter().enumerate() {
            let values: [i16; FREQUENCY_COUNT * SHIFT_COUNT] = std::array::from_fn(|i| rows[i][pixel]);
            let is_saturated = values.contains(&SATURATED_MEASUREMENT);
            phasors.set(pixel, &if is_saturated { Phasors::default() } else { of_pixel(values, turns) });
        }
    }
}

fn of_pixel(values: [i16; FREQUENCY_COUNT * SHIFT_COUNT], turns: &Phasors) -> Phasors {
    let mut phasors = Phasors::default();
    for frequency in 0..FREQUENCY_COUNT {
        let [v0, v1, v2] = std::array::from_fn(|shift| values[frequency * SHIFT_COUNT + shift] as f32);
        let re = (v0 + THIRD_TURN_COS * (v1 + v2)) * (2.0 / 3.0);
        let im = THIRD_TURN_SIN * (v2 - v1) * (2.0 / 3.0);
        let (cos, sin) = (turns[2 * frequency], turns[2 * frequency + 1]);
        phasors[2 * frequency] = re * cos - im * sin;
        phasors[2 * frequency + 1] = re * sin + im * cos;
    }
    phasors
}
