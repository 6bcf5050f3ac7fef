//! The recording of a tracked sequence, and its links between keyframes.

use crate::RecordingContent;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use trundle_core::{FrameId, PinholeCamera, Stamp, Vector2, Vector3};
use trundle_io::ros_message::RosMessage;
use trundle_io::{EncodedEvent, EncodedRgbd, IoError, OutputFolder, Recorder, ros_message};
use trundle_slam::{KeyframeId, RgbdSlam, TrackReport};

/// Smallest number of shared landmarks at which two keyframes are drawn as covisible. Source: ours.
const MIN_SHARED_LANDMARKS: usize = 30;

/// The frame that camera poses, landmarks and keyframes are in.
const FRAME: &str = "visual";

/// Records a tracked sequence: every image with its features and camera pose. Landmarks and keyframe graph follow after each loop closure
/// and at the end.
///
/// A disk that is full ends the recording.
pub struct SequenceRecorder {
    recorder: Recorder<BufWriter<File>>,
    /// Whether images are recorded.
    has_images: bool,
    failure: Option<IoError>,
    now: Stamp,
}

impl SequenceRecorder {
    /// Records tracking, and with `content` all the images of `camera`, into `recording.mcap` of `folder`; `None` if nothing is to be
    /// recorded.
    ///
    /// # Errors
    /// When the file cannot be made.
    pub fn begin(
        content: RecordingContent,
        folder: &OutputFolder,
        camera: PinholeCamera,
    ) -> Result<Option<Self>, IoError> {
        if content == RecordingContent::None {
            return Ok(None);
        }
        let mut recorder = folder.recorder("recording.mcap")?;
        recorder.set_camera(camera);
        let has_images = content == RecordingContent::All;
        Ok(Some(Self { recorder, has_images, failure: None, now: Stamp::default() }))
    }

    /// Records an image and the result of its tracking.
    pub fn record(&mut self, image: EncodedRgbd, report: &TrackReport, slam: &RgbdSlam) {
        if self.failure.is_some() {
            return;
        }
        self.failure = self.record_frame(image, report, slam).err();
        if let Some(failure) = &self.failure {
            tracing::warn!("{failure}; the recording ends here, tracking continues");
        }
    }

    fn record_frame(
        &mut self,
        image: EncodedRgbd,
        report: &TrackReport,
        slam: &RgbdSlam,
    ) -> Result<(), IoError> {
        self.now = report.stamp;
        if self.has_images {
            self.recorder.record_event(&EncodedEvent::Rgbd(image))?;
        }
        let mark = |feature: &trundle_slam::SeenFeature| {
            let keypoint = feature.keypoint;
            (Vector2::new(f64::from(keypoint.x), f64::from(keypoint.y)), feature.tracked)
        };
        let marks: Vec<(Vector2, bool)> = slam.last_features().iter().map(mark).collect();
        let camera = FrameId::Camera.to_string();
        self.show("/slam/features", &ros_message::features(self.now, &camera, &marks))?;
        self.show("/slam/pose", &ros_message::pose(self.now, FRAME, report.visual_from_camera))?;
        let transform = (self.now, FRAME, camera.as_str(), report.visual_from_camera);
        self.show("/tf", &ros_message::transforms(&[transform]))?;
        if report.closed_loop.is_some() { self.record_map(slam) } else { Ok(()) }
    }

    /// Records the final map and closes the recording; one that could not be written is left out of `folder`.
    pub fn finish(mut self, slam: &RgbdSlam, folder: &OutputFolder) {
        let failure = self.failure.take().or_else(|| self.record_map(slam).err());
        if let Some(failure) = failure.or_else(|| self.recorder.finish().err()) {
            _ = std::fs::remove_file(folder.staged("recording.mcap"));
            folder.leave_out(failure);
        }
    }

    fn record_map(&mut self, slam: &RgbdSlam) -> Result<(), IoError> {
        self.show("/slam/landmarks", &ros_message::points(self.now, FRAME, slam.landmarks()))?;
        let links = KeyframeLinks::of(slam);
        let graph = ros_message::keyframe_graph(self.now, FRAME, &links.covisible, &links.loops);
        self.show("/slam/graph", &graph)
    }

    /// Records a message for other programs.
    fn show(&mut self, topic: &str, message: &RosMessage) -> Result<(), IoError> {
        self.recorder.record_message(topic, self.now, message)
    }
}

/// Links between keyframes, by their positions in the visual frame, m.
pub struct KeyframeLinks {
    /// Pairs of keyframes that share landmarks.
    pub covisible: Vec<(Vector3, Vector3)>,
    /// Pairs of keyframes that closed a loop.
    pub loops: Vec<(Vector3, Vector3)>,
}

impl KeyframeLinks {
    /// The links of the map of `slam`.
    pub fn of(slam: &RgbdSlam) -> Self {
        let positions: BTreeMap<KeyframeId, Vector3> =
            slam.keyframes().map(|(id, _, pose)| (id, pose.translation)).collect();
        let pair = |a: KeyframeId, b: KeyframeId| Some((*positions.get(&a)?, *positions.get(&b)?));
        Self {
            covisible: slam
                .covisibility(MIN_SHARED_LANDMARKS)
                .into_iter()
                .filter_map(|(a, b, _)| pair(a, b))
                .collect(),
            loops: slam.loops().into_iter().filter_map(|(a, b)| pair(a, b)).collect(),
        }
    }
}
