//! The images of a bag: topics of colour and depth, camera, pairs.

use super::options::RosSequenceOptions;
use super::survey::Survey;
use super::topic_choice::{ImageTopic, base_topic, choose_color, choose_depth};
use crate::TumSequence;
use crate::laser_log::is_named;
use crate::tum::pair_nearest;
use trundle_core::{PinholeCamera, Stamp};

/// The images that are used.
pub(super) struct ChosenImages {
    pub(super) color: ImageTopic,
    pub(super) depth: ImageTopic,
    /// Topic of the intrinsics; empty if none were needed.
    pub(super) info: String,
    pub(super) camera: Option<PinholeCamera>,
    /// Stamps of colour and depth.
    pub(super) pairs: Vec<(Stamp, Stamp)>,
    /// Number of colour images.
    pub(super) listed: usize,
}

/// Smallest distance of the depth camera from the colour camera at which depth is not registered to colour \[m\]. Source: ours.
const MAX_DEPTH_OFFSET_M: f64 = 1e-3;
/// Smallest turn between both cameras at which depth is not registered to colour \[rad\]. Source: ours.
const MAX_DEPTH_TURN_RAD: f64 = 1e-3;

impl ChosenImages {
    /// Chooses the images of a bag. `needs_camera`: whether the bag must contain the camera's intrinsics.
    ///
    /// # Errors
    /// When colour or depth is missing or ambiguous, depth is not registered to colour, no image can be paired, or the camera is missing or
    /// invalid.
    pub(super) fn of(
        survey: &mut Survey,
        options: &RosSequenceOptions,
        needs_camera: bool,
    ) -> Result<Self, String> {
        let images = survey.image_topics();
        let color = choose_color(&images, options.color_topic.as_deref())?;
        let depth = choose_depth(&images, options.depth_topic.as_deref(), color)?;
        require_registered(survey, color, depth)?;
        let (info, camera) = match needs_camera {
            true => camera(survey, color, options.info_topic.as_deref())?,
            false => (String::new(), None),
        };
        let (colors, depths) = (survey.stamps(&color.name), survey.stamps(&depth.name));
        let pairs = pair_nearest(&colors, &depths, TumSequence::MAX_DIFFERENCE);
        if pairs.is_empty() {
            return Err(no_pair((color, &colors), (depth, &depths)));
        }
        let pairs = pairs.into_iter().map(|(i, j)| (colors[i], depths[j])).collect();
        let (color, depth) = (color.clone(), depth.clone());
        Ok(Self { color, depth, info, camera, pairs, listed: colors.len() })
    }
}

/// Refuses depth whose camera pose differs from that of colour by the bag's transforms.
fn require_registered(survey: &mut Survey, color: &ImageTopic, depth: &ImageTopic) -> Result<(), String> {
    if color.frame == depth.frame {
        return Ok(());
    }
    let frames =
        format!("depth of {} is in {}, colour of {} in {}", depth.name, depth.frame, color.name, color.frame);
    match survey.contents.transform(&color.frame, &depth.frame) {
        Ok(pose) if pose.translation.norm() <= MAX_DEPTH_OFFSET_M && pose.angle() <= MAX_DEPTH_TURN_RAD => {}
        Ok(pose) => {
            return Err(format!(
                "{frames}, {:.3} m and {:.2} deg apart: expected depth registered to colour, in its frame (--depth-topic names it)",
                pose.translation.norm(),
                pose.angle().to_degrees()
            ));
        }
        Err(_) => survey.warnings.add("depth is taken as registered to colour", &frames),
    }
    Ok(())
}

/// The camera of the colour images and its topic: the requested one, the one with the images' prefix, or the only one in their frame.
fn camera(
    survey: &Survey,
    color: &ImageTopic,
    asked: Option<&str>,
) -> Result<(String, Option<PinholeCamera>), String> {
    let base = base_topic(&color.name);
    let beside = base.rsplit_once('/').map(|(folder, _)| format!("{folder}/camera_info"));
    let wanted = asked.map(str::to_owned).or(beside).unwrap_or_default();
    let by_name = survey.infos.iter().find(|(topic, _)| is_named(topic, &wanted));
    let in_frame = || survey.infos.iter().find(|(_, info)| asked.is_none() && info.frame == color.frame);
    let Some((topic, info)) = by_name.or_else(in_frame) else {
        let topics: Vec<&str> = survey.infos.keys().map(String::as_str).collect();
        let topics = if topics.is_empty() { "none".to_owned() } else { topics.join(", ") };
        return Err(format!(
            "no camera_info on {wanted} for the images of {} (topics of camera_info: {topics}), expected it, or --camera",
            color.name
        ));
    };
    let is_rectified = base.rsplit('/').next().is_some_and(|name| name.contains("rect"));
    let camera = info.camera(is_rectified).map_err(|invalid| format!("camera_info on {topic}: {invalid}"))?;
    Ok((topic.clone(), Some(camera)))
}

fn no_pair((color, colors): (&ImageTopic, &[Stamp]), (depth, depths): (&ImageTopic, &[Stamp])) -> String {
    let span = |stamps: &[Stamp]| match stamps {
        [first, .., last] => format!("{first} s to {last} s"),
        [only] => format!("{only} s"),
        [] => "none".to_owned(),
    };
    format!(
        "no image of {} ({}) is within {} s of one of {} ({})",
        color.name,
        span(colors),
        TumSequence::MAX_DIFFERENCE,
        depth.name,
        span(depths)
    )
}
