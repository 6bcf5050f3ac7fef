//! Whether the robot is where its pose estimate says: hypotheses with probabilities.
//!
//! Problem: images that are not recognised and scans that contradict the map come from people, moved furniture and new rooms, and from a
//! robot that was carried away. Idea: the estimate by wheels, gyro, images and scans is one hypothesis, "somewhere else" is another,
//! and each pose that a search finds is a third. Each piece of evidence is a log-likelihood ratio between them. The estimate moves to another
//! place only when that place is 99.9 % probable; otherwise the robot goes on, or looks around.
//!
//! | file | holds |
//! |---|---|
//! | `scan_comparison` | a scan against the map at a pose: patches that agree, small and large contradictions |
//! | `view_evidence` | the newest comparison of each patch, and the scans for other poses |
//! | `image_evidence` | time without a recognised image, against its usual length |
//! | `monitor` | prior, sum of the evidence, probabilities |

pub(crate) mod config;
pub(crate) mod image_evidence;
pub(crate) mod monitor;
pub(crate) mod scan_comparison;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod view_evidence;
