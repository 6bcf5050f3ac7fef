//! The bilateral filter on the phasors.
//!
//! Each phasor becomes the mean of the 3 x 3 phasors around it, weighted by their nearness in the image and by their likeness: phasors across
//! an edge get no weight. Likeness is measured at all frequencies together and relative to the amplitude, since the amplitude falls with the
//! square of the distance. Source: Tomasi and Manduchi 1998; the kernel of likeness is Tukey's, Durand and Dorsey 2002, section 3.

use super::layout::{COLUMNS, ROWS};
use super::phasors::Phasors;

/// Weights of the neighbours across and down, by a Gaussian of 1 px: exp(-1/2) beside the middle. Source: ours.
const SPATIAL_WEIGHTS: [f32; 3] = [0.606_53, 1.0, 0.606_53];
/// Difference of phasors, relative to the amplitude, from which a neighbour gets no weight \[1\]: 0.6. Source: ours; noise reaches 0.2 at the
/// lowest accepted amplitude, and 0.6 is a step of 0.12 m at 120 MHz.
const MAX_RELATIVE_DIFFERENCE: f32 = 0.6;

/// Filters all phasors; the border of one pixel is copied.
pub(super) fn smooth(phasors: &[Phasors], smoothed: &mut [Phasors]) {
    smoothed.copy_from_slice(phasors);
    for y in 1..ROWS - 1 {
        for x in 1..COLUMNS - 1 {
            let pixel = y * COLUMNS + x;
            if phasors[pixel] != Phasors::default() {
                smoothed[pixel] = mean_around(phasors, pixel);
            }
        }
    }
}

fn mean_around(phasors: &[Phasors], pixel: usize) -> Phasors {
    let own = &phasors[pixel];
    let power: f32 = own.iter().map(|z| z[0] * z[0] + z[1] * z[1]).sum();
    let scale = 1.0 / (MAX_RELATIVE_DIFFERENCE * MAX_RELATIVE_DIFFERENCE * power);
    let mut sum = Phasors::default();
    let mut total = 0.0;
    for (row, down) in SPATIAL_WEIGHTS.iter().enumerate() {
        let start = pixel + row * COLUMNS - COLUMNS - 1;
        for (other, across) in phasors[start..start + 3].iter().zip(SPATIAL_WEIGHTS) {
            let likeness = (1.0 - difference(own, other) * scale).max(0.0);
            let weight = down * across * likeness * likeness;
            total += weight;
            sum.iter_mut().flatten().zip(other.iter().flatten()).for_each(|(sum, z)| *sum += weight * z);
        }
    }
    sum.map(|z| z.map(|part| part / total))
}

/// Squared distance of the phasors of two pixels over all frequencies.
fn difference(a: &Phasors, b: &Phasors) -> f32 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b)).sum()
}
