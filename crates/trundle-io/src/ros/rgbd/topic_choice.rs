//! The topics of a bag, and the selection of the colour and depth topics.

use super::image_message::{BagImage, ImageKind};
use crate::IoError;
use crate::laser_log::is_named;
use crate::ros::bag::Bag;
use crate::ros::hidden_topics::is_hidden;
use crate::ros::messages::types;
use std::collections::BTreeMap;
use std::path::Path;

/// A topic of a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ImageTopic {
    pub(super) name: String,
    pub(super) frame: String,
    pub(super) kind: ImageKind,
    pub(super) encoding: String,
    pub(super) count: usize,
}

/// Suffixes of topics for the transport of images.
const TRANSPORTS: [&str; 3] = ["/compressed", "/compressedDepth", "/ffmpeg"];

/// The topic without the suffix of its transport.
pub(super) fn base_topic(topic: &str) -> &str {
    TRANSPORTS.iter().find_map(|transport| topic.strip_suffix(transport)).unwrap_or(topic)
}

/// The colour topic: the requested one, else the only one, or the one with the most messages; grey only without colour.
///
/// # Errors
/// When no such topic exists.
pub(super) fn choose_color<'a>(
    topics: &'a [ImageTopic],
    asked: Option<&str>,
) -> Result<&'a ImageTopic, String> {
    if let Some(asked) = asked {
        return named(topics, asked, &[ImageKind::Color, ImageKind::Grey], "colour images");
    }
    let of = |kind| topics.iter().filter(move |topic| topic.kind == kind);
    let found = max(of(ImageKind::Color)).or_else(|| max(of(ImageKind::Grey)));
    found.ok_or_else(|| format!("no colour images, expected some; its images: {}", listing(topics)))
}

/// The depth topic: the requested one, else the one in the frame of the colour images. For one image in several transports, the first with
/// the most messages.
///
/// # Errors
/// When no such topic exists, or several differ.
pub(super) fn choose_depth<'a>(
    topics: &'a [ImageTopic],
    asked: Option<&str>,
    color: &ImageTopic,
) -> Result<&'a ImageTopic, String> {
    if let Some(asked) = asked {
        return named(topics, asked, &[ImageKind::Depth], "depth images");
    }
    let all: Vec<&ImageTopic> = topics.iter().filter(|topic| topic.kind == ImageKind::Depth).collect();
    let registered: Vec<&ImageTopic> =
        all.iter().copied().filter(|topic| topic.frame == color.frame).collect();
    let candidates = if registered.is_empty() { all } else { registered };
    let found = max(candidates.iter().copied())
        .ok_or_else(|| format!("no depth images, expected some; its images: {}", listing(topics)))?;
    if candidates.iter().any(|topic| base_topic(&topic.name) != base_topic(&found.name)) {
        let names: Vec<&str> = candidates.iter().map(|topic| topic.name.as_str()).collect();
        let problem = format!(
            "several topics hold depth images ({}), expected one that is registered to {}: name it with --depth-topic",
            names.join(", "),
            color.name
        );
        return Err(problem);
    }
    Ok(found)
}

/// The topic with the most messages, of equals the first.
fn max<'a>(topics: impl Iterator<Item = &'a ImageTopic>) -> Option<&'a ImageTopic> {
    topics.reduce(|best, topic| if topic.count > best.count { topic } else { best })
}

fn named<'a>(
    topics: &'a [ImageTopic],
    asked: &str,
    kinds: &[ImageKind],
    what: &str,
) -> Result<&'a ImageTopic, String> {
    let is_asked = |topic: &&ImageTopic| is_named(&topic.name, asked) && kinds.contains(&topic.kind);
    topics
        .iter()
        .find(is_asked)
        .ok_or_else(|| format!("no {what} on {asked}, expected one of its images: {}", listing(topics)))
}

/// The image topics with their encodings, for messages.
fn listing(topics: &[ImageTopic]) -> String {
    let name = |topic: &ImageTopic| format!("{} ({}, {})", topic.name, topic.encoding, topic.count);
    let names: Vec<String> = topics.iter().map(name).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// The topics of a bag with their types and message counts; for images, the encoding of the first.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RosTopics {
    topics: BTreeMap<String, (String, usize, String)>,
}

impl RosTopics {
    /// Reads a ROS 2 bag or a ROS 1 bag. A truncated bag is read up to its end.
    ///
    /// # Errors
    /// When the bag cannot be read, or is truncated before its first message.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        let (mut bag, mut topics) = (Bag::open(path)?, Self::default());
        loop {
            match bag.next_message() {
                Ok(Some(message)) => {
                    let wire = bag.wire();
                    let kind = types::canonical(&message.schema);
                    let first = || {
                        let image = BagImage::read(kind, &message.data, wire)?.ok()?;
                        Some(image.encoding().to_owned())
                    };
                    let entry = topics.topics.entry(message.topic.clone());
                    entry.or_insert_with(|| (kind.to_owned(), 0, first().unwrap_or_default())).1 += 1;
                }
                Ok(None) => return Ok(topics),
                Err(_) if !topics.topics.is_empty() => return Ok(topics),
                Err(error) => return Err(error),
            }
        }
    }

    /// Whether the bag has sweeps of a laser.
    #[must_use]
    pub fn has_scans(&self) -> bool {
        self.has(&[types::LASER_SCAN])
    }

    /// Whether the bag has images, raw or compressed.
    #[must_use]
    pub fn has_images(&self) -> bool {
        self.has(&[types::IMAGE, types::COMPRESSED_IMAGE])
    }

    fn has(&self, kinds: &[&str]) -> bool {
        self.topics.values().any(|(kind, ..)| kinds.contains(&kind.as_str()))
    }

    /// A row a topic: name, type, number of messages, encoding of its first image. Inner topics of services and actions have none.
    pub fn rows(&self) -> impl Iterator<Item = [String; 4]> + '_ {
        let shown = self.topics.iter().filter(|(name, (kind, ..))| !is_hidden(name, kind));
        shown.map(|(name, (kind, count, encoding))| {
            [name.clone(), kind.clone(), count.to_string(), encoding.clone()]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn topic(name: &str, frame: &str, kind: ImageKind, count: usize) -> ImageTopic {
        let (name, frame) = (name.to_owned(), frame.to_owned());
        ImageTopic { name, frame, kind, encoding: "x".to_owned(), count }
    }

    #[test]
    fn colour_before_grey_and_depth_in_the_frame_of_colour() {
        let topics = [
            topic("/infra1/image_rect_raw", "infra", ImageKind::Grey, 90),
            topic("/color/image_raw", "color", ImageKind::Color, 30),
            topic("/color/image_raw/compressed", "color", ImageKind::Color, 30),
            topic("/depth/image_rect_raw", "depth", ImageKind::Depth, 90),
            topic("/aligned/image_raw", "color", ImageKind::Depth, 30),
            topic("/aligned/image_raw/compressedDepth", "color", ImageKind::Depth, 31),
        ];
        let color = choose_color(&topics, None).unwrap();
        assert_eq!(color.name, "/color/image_raw");
        assert_eq!(choose_depth(&topics, None, color).unwrap().name, "/aligned/image_raw/compressedDepth");
        let asked = choose_depth(&topics, Some("depth/image_rect_raw"), color).unwrap();
        assert_eq!(asked.name, "/depth/image_rect_raw");
        assert_eq!(choose_color(&topics[..1], None).unwrap().name, "/infra1/image_rect_raw");
        let problem = choose_color(&topics, Some("/depth/image_rect_raw")).unwrap_err();
        assert!(
            problem.starts_with("no colour images on /depth/image_rect_raw, expected one of"),
            "{problem}"
        );
        let other = topic("/second/depth", "color", ImageKind::Depth, 2);
        let problem = choose_depth(&[topics[4].clone(), other], None, color).unwrap_err();
        assert!(problem.contains("(/aligned/image_raw, /second/depth)"), "{problem}");
        assert!(problem.ends_with("name it with --depth-topic"), "{problem}");
        assert!(choose_depth(&topics[..3], None, color).unwrap_err().contains("no depth images"));
    }
}
