//! Lists of a TUM folder: `rgb.txt` with `depth.txt`, else `associations.txt`.

use super::association::pair_nearest;
use super::list::{ListedImage, parse_list, parse_pairs};
use crate::codec::is_depth_image;
use crate::files::{read_text, table_rows};
use crate::{Expected, IoError, Warnings};
use std::io::Read;
use std::path::Path;
use trundle_core::Stamp;

/// Text files of a TUM folder, which are not lists under another name.
const KNOWN_TEXTS: [&str; 6] =
    ["rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "odometry.txt", "accelerometer.txt"];
/// Number of text files that are named as possible lists. Source: ours.
const MAX_NAMED_LISTS: usize = 4;

/// The paired images of a folder.
pub(super) struct Members {
    /// Colour and depth images.
    pub frames: Vec<(ListedImage, ListedImage)>,
    /// Number of colour images without a near enough depth image.
    pub unpaired: usize,
    /// Number of colour images in the list, including those left out.
    pub listed: usize,
    pub warnings: Warnings,
}

impl Members {
    /// The images of the folder's lists, paired within `max_difference` s, or as `associations.txt` pairs them.
    pub(super) fn read(dir: &Path, max_difference: f64) -> Result<Self, IoError> {
        Expected::Sequence.check(dir)?;
        let there = |name: &str| dir.join(name).exists();
        if there("associations.txt") && !(there("rgb.txt") && there("depth.txt")) {
            return Self::of_associations(dir);
        }
        for name in ["rgb.txt", "depth.txt"] {
            if !there(name) {
                let problem =
                    format!("{name} is missing, expected rgb.txt and depth.txt, or associations.txt");
                return Err(IoError::malformed(dir, format!("{problem}{}", other_lists(dir))));
            }
        }
        Self::of_lists(dir, max_difference)
    }

    fn of_lists(dir: &Path, max_difference: f64) -> Result<Self, IoError> {
        let mut warnings = Warnings::default();
        let mut list = |name: &str| -> Result<_, IoError> {
            let path = dir.join(name);
            let text = read_text(&path)?;
            Ok((parse_list(&path, &text, &mut warnings)?, table_rows(&text).len()))
        };
        let ((color, listed), (depth, _)) = (list("rgb.txt")?, list("depth.txt")?);
        let stamps = |list: &[ListedImage]| list.iter().map(|image| image.stamp).collect::<Vec<Stamp>>();
        let pairs = pair_nearest(&stamps(&color), &stamps(&depth), max_difference);
        if pairs.is_empty() {
            return Err(IoError::malformed(dir, no_pair(&color, &depth, max_difference)));
        }
        let unpaired = color.len() - pairs.len();
        let frames = pairs.into_iter().map(|(i, j)| (color[i].clone(), depth[j].clone())).collect();
        Ok(Self { frames, unpaired, listed, warnings })
    }

    /// The pairs of the list; the first images determine which column is depth.
    fn of_associations(dir: &Path) -> Result<Self, IoError> {
        let mut warnings = Warnings::default();
        let path = dir.join("associations.txt");
        let mut frames = parse_pairs(&path, &read_text(&path)?, &mut warnings)?;
        let is_depth_first = frames.iter().find_map(|(first, second)| {
            let is_depth = |image: &ListedImage| Some(is_depth_image(&head(&dir.join(&image.file))?));
            Some(is_depth(first)? && !is_depth(second)?)
        });
        if is_depth_first == Some(true) {
            frames = frames.into_iter().map(|(depth, color)| (color, depth)).collect();
            frames.sort_by_key(|(color, _)| color.stamp);
        }
        let listed = frames.len();
        frames.dedup_by_key(|(color, _)| color.stamp);
        Ok(Self { frames, unpaired: 0, listed, warnings })
    }
}

/// Names of text files that may be lists under another name, with the advice to rename them; empty without such files.
fn other_lists(dir: &Path) -> String {
    let entries = std::fs::read_dir(dir).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let is_other = |name: &String| name.ends_with(".txt") && !KNOWN_TEXTS.contains(&name.as_str());
    let mut names: Vec<String> = names.filter(is_other).collect();
    if names.is_empty() {
        return String::new();
    }
    names.sort();
    names.truncate(MAX_NAMED_LISTS);
    format!("; rename {} if its lines are: timestamp filename", names.join(" or "))
}

/// The first bytes of an image.
fn head(path: &Path) -> Option<Vec<u8>> {
    let mut head = Vec::new();
    std::fs::File::open(path).ok()?.take(64).read_to_end(&mut head).ok()?;
    Some(head)
}

fn no_pair(color: &[ListedImage], depth: &[ListedImage], max_difference: f64) -> String {
    let span = |list: &[ListedImage]| match list {
        [first, .., last] => format!("{} s to {} s", first.stamp, last.stamp),
        [only] => format!("{} s", only.stamp),
        [] => "none".to_owned(),
    };
    format!(
        "no colour image of rgb.txt ({}) is within {max_difference} s of a depth image of depth.txt ({})",
        span(color),
        span(depth)
    )
}
