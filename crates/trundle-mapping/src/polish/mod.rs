//! Polish of a finished trajectory: a pose graph of all scans, each matched with its neighbours and with other passes of the same place.
//!
//! Problem: the particles' poses are samples, and loops are closed with submaps. Both leave errors of centimetres between scans that observe
//! the same surfaces. The polish minimises the distances between the hits of overlapping scans over all poses at once (\[Lu97\], and as a
//! sparse graph \[Konolige10\]). A hit is compared with the line through the surface of the other scan, or with the nearest hit if both have
//! no surface. A robust kernel, which narrows from round to round, drops outliers. Directions that a pair of scans does not determine
//! keep the filter's steps \[Zhang16\]. Each round associates the hits anew and takes one Gauss-Newton step of all poses.
//!
//! Cost: the number of pairs of a scan is bounded, so the time is linear in the scans, except for the Cholesky factor of the graph, whose
//! profile grows with the number of parallel passes.
//!
//! | paper symbol | name here | unit |
//! |---|---|---|
//! | D_ij, relative pose | `to_from_from` | m, rad |
//! | C_ij^-1, its information | `PairEquations::information` | 1/m^2, 1/rad^2 |
//! | X_i, pose | `poses` | m, rad |

mod line_fit;
mod overlap;
mod pair;
mod rounds;
mod surface_scan;

pub(crate) use rounds::polished;

#[cfg(test)]
mod tests;
