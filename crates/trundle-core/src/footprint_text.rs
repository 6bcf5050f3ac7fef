//! Footprints as text: a radius, corners, or the form of Nav2's costmaps.

use crate::{Footprint, Invalid, MAX_FOOTPRINT_RADIUS_M, Vector2};
use std::str::FromStr;

impl FromStr for Footprint {
    type Err = String;

    /// A radius (`0.2`), corners (`0.3,0.2 -0.3,0.2 ...`), or corners in Nav2's format (`[[0.3, 0.2], [-0.3, 0.2], ...]`), m.
    fn from_str(text: &str) -> Result<Self, String> {
        let footprint = match text.contains([',', '[']) {
            true => Self::polygon(footprint_corners(text)?),
            false => Self::disc(number(text)?),
        };
        footprint.and_then(plausible).map_err(|invalid| invalid.to_string())
    }
}

/// Refuses a footprint that is too large for an indoor robot.
fn plausible(footprint: Footprint) -> Result<Footprint, Invalid> {
    let radius = footprint.circumscribed_radius();
    let expected = format!("at most {MAX_FOOTPRINT_RADIUS_M} m; is it in millimetres?");
    let is_plausible = radius <= MAX_FOOTPRINT_RADIUS_M;
    let rounded = (radius * 1e3).round() / 1e3;
    if is_plausible { Ok(footprint) } else { Err(Invalid::new("footprint radius", rounded, "m", expected)) }
}

/// The corners of a footprint as text, in either form, base frame, m.
///
/// # Errors
/// Names the text that is no corner.
pub fn footprint_corners(text: &str) -> Result<Vec<Vector2>, String> {
    let text = text.trim();
    let Some(list) = text.strip_prefix('[') else {
        return text.split_whitespace().map(corner).collect();
    };
    let unfinished = || format!("footprint is {text}, expected [[X, Y], [X, Y], [X, Y], ...] in m");
    let list = list.trim_end().strip_suffix(']').ok_or_else(unfinished)?;
    let (pairs, rest) = list.rsplit_once(']').ok_or_else(unfinished)?;
    if !rest.trim().trim_end_matches(',').is_empty() {
        return Err(unfinished());
    }
    let pair =
        |pair: &str| pair.trim_start_matches([',', ' ', '\t', '\n', '\r']).strip_prefix('[').map(corner);
    pairs.split(']').map(|text| pair(text).unwrap_or_else(|| Err(unfinished()))).collect()
}

fn corner(pair: &str) -> Result<Vector2, String> {
    let (x, y) = pair.split_once(',').ok_or_else(|| format!("corner '{pair}', expected X,Y"))?;
    Ok(Vector2::new(number(x)?, number(y)?))
}

fn number(word: &str) -> Result<f64, String> {
    word.trim().parse::<f64>().map_err(|_| format!("'{word}' in the footprint is not a number, expected m"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn footprints_are_radii_or_convex_corners() {
        assert_eq!("0.2".parse(), Ok(Footprint::Disc { radius: 0.2 }));
        let ours: Footprint = "0.3,0.2 -0.3,0.2 -0.3,-0.2 0.3,-0.2".parse().unwrap();
        for nav2 in [
            "[[0.3,0.2],[-0.3,0.2],[-0.3,-0.2],[0.3,-0.2]]",
            "[ [0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2], [0.3, -0.2] ]",
            " [[0.3,0.2] , [-0.3,0.2],\n[-0.3,-0.2],[0.3,-0.2],] ",
        ] {
            assert_eq!(nav2.parse(), Ok(ours.clone()), "{nav2}");
        }
    }

    #[test]
    fn text_that_is_not_a_footprint_is_named() {
        let refused = |text: &str| text.parse::<Footprint>().unwrap_err();
        assert_eq!(refused("wide"), "'wide' in the footprint is not a number, expected m");
        assert_eq!(refused("0.3,0.2 0.1"), "corner '0.1', expected X,Y");
        assert_eq!(refused("0,0 1,0 0.2,0.2 0,1"), "footprint is turned inward at corner 1, expected convex");
        assert_eq!(refused("200"), "footprint radius is 200 m, expected at most 3 m; is it in millimetres?");
        assert!(refused("300,200 -300,200 -300,-200").ends_with("is it in millimetres?"));
        assert!("3".parse::<Footprint>().is_ok());
        assert!(refused("0,0 1,0 2,0").contains("footprint area is 0 m^2"));
        assert_eq!(refused("[[0.3,0.2],[a,1]]"), "'a' in the footprint is not a number, expected m");
        for broken in ["[[0.3,0.2],[0.1,0.2]", "[", "[]", "[[0.3,0.2],3]", "[[0.3,0.2] 3]", "[0.3,0.2]"] {
            assert!(refused(broken).contains("expected [[X, Y], [X, Y]"), "{broken}: {}", refused(broken));
        }
        assert!(refused("[[0.3],[1,2]]").contains("corner '0.3', expected X,Y"));
    }
}
