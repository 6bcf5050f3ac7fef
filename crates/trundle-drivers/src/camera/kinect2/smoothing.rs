//! The bilateral filter on the phasors.
//!
//! Each phasor becomes the mean of the 3 x 3 phasors around it, weighted by distance in the image and by similarity: phasors across an edge
//! get no weight. Similarity is measured at all frequencies together and relative to the amplitude, because the amplitude falls with the
//! square of the distance. Source: \[Tomasi98\]; the kernel of likeness is Tukey's, \[Durand02\].

use super::layout::{COLUMNS, ROWS};
use super::phasors::{PLANE_COUNT, PhasorImage};

/// Number of pixels computed together: the compiler turns loops over this number into vector instructions. Source: ours.
const LANES: usize = 8;
/// Smallest power of a phasor used as a divisor \[1\]. It keeps pixels without a measurement finite. Source: ours.
const MIN_POWER: f32 = 1e-6;
/// Weights of the neighbours in columns and rows, by a Gaussian of 1 px: exp(-1/2) next to the middle. Source: ours.
const SPATIAL_WEIGHTS: [f32; 3] = [0.606_53, 1.0, 0.606_53];
/// Difference of phasors, relative to the amplitude, above which a neighbour gets no weight \[1\]: 0.6. Source: ours; noise reaches 0.2 at the
/// lowest accepted amplitude, and 0.6 is a step of 0.12 m at 120 MHz.
const MAX_RELATIVE_DIFFERENCE: f32 = 0.6;

/// Numbers of neighbouring pixels.
type Lanes = [f32; LANES];
/// The phasors of neighbouring pixels, one part after the other.
type LanePhasors = [Lanes; PLANE_COUNT];

/// Filters all phasors; the border of one pixel is copied. Pixels without a measurement do not change.
pub(super) fn smooth(phasors: &PhasorImage, smoothed: &mut PhasorImage) {
    for (target, source) in smoothed.planes.iter_mut().zip(&phasors.planes) {
        target.copy_from_slice(source);
    }
    for y in 1..ROWS - 1 {
        for block in (1..COLUMNS - 1).step_by(LANES) {
            // The last block overlaps the previous one, to end before the border.
            let start = y * COLUMNS + block.min(COLUMNS - 1 - LANES);
            let means = means_around(phasors, start);
            for (target, mean) in smoothed.planes.iter_mut().zip(&means) {
                target[start..start + LANES].copy_from_slice(mean);
            }
        }
    }
}

/// The weighted means around the pixels from `start` on.
fn means_around(phasors: &PhasorImage, start: usize) -> LanePhasors {
    let own = load(phasors, start);
    let power = lanes(|i| own.iter().map(|part| part[i] * part[i]).sum());
    let scale =
        power.map(|power| 1.0 / (MAX_RELATIVE_DIFFERENCE * MAX_RELATIVE_DIFFERENCE * power.max(MIN_POWER)));
    let mut sum = LanePhasors::default();
    let mut total = Lanes::default();
    for (row, down) in SPATIAL_WEIGHTS.into_iter().enumerate() {
        for (column, across) in SPATIAL_WEIGHTS.into_iter().enumerate() {
            let other = load(phasors, start + row * COLUMNS + column - COLUMNS - 1);
            let weight = weights(&own, &other, &scale, down * across);
            for i in 0..LANES {
                total[i] += weight[i];
            }
            for (sum, part) in sum.iter_mut().zip(&other) {
                for i in 0..LANES {
                    sum[i] += weight[i] * part[i];
                }
            }
        }
    }
    sum.map(|part| lanes(|i| part[i] / total[i]))
}

/// Weights of neighbours by their similarity. A pixel without a measurement is similar only to itself.
fn weights(own: &LanePhasors, other: &LanePhasors, scale: &Lanes, spatial: f32) -> Lanes {
    let mut difference = Lanes::default();
    for (own, other) in own.iter().zip(other) {
        for i in 0..LANES {
            difference[i] += (own[i] - other[i]) * (own[i] - other[i]);
        }
    }
    lanes(|i| {
        let likeness = (1.0 - difference[i] * scale[i]).max(0.0);
        spatial * likeness * likeness
    })
}

#[inline(always)]
fn lanes(value: impl FnMut(usize) -> f32) -> Lanes {
    std::array::from_fn(value)
}

#[inline(always)]
fn load(phasors: &PhasorImage, start: usize) -> LanePhasors {
    std::array::from_fn(|plane| {
        let mut part = Lanes::default();
        part.copy_from_slice(&phasors.planes[plane][start..start + LANES]);
        part
    })
}
