use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use trundle::app::AppError;
use trundle::core::{Stamp, Vector2, Vector3};
use trundle::io::{
    EncodedEvent, EncodedRgbd, FeatureMarks, KeyframeGraph, LandmarkCloud, PoseInFrame, Recorder,
};
use trundle::slam::{KeyframeId, RgbdSlam, TrackReport};

/// Landmarks that two keyframes share to be drawn as covisible.
pub const COVISIBLE: usize = 30;

/// The frame that camera poses, landmarks and keyframes are in.
const FRAME: &str = "visual";

/// Records a tracked sequence: every image with its features and the camera's pose; landmarks and keyframe graph when a
/// loop was closed, and at the end.
pub struct SlamRecorder {
    recorder: Recorder<BufWriter<File>>,
    now: Stamp,
}

impl SlamRecorder {
    pub fn new(recorder: Recorder<BufWriter<File>>) -> Self {
        Self { recorder, now: Stamp::default() }
    }

    /// Takes down an image and what became of it.
    pub fn note(
        &mut self,
        image: EncodedRgbd,
        report: &TrackReport,
        slam: &RgbdSlam,
    ) -> Result<(), AppError> {
        self.now = report.stamp;
        self.recorder.record_event(&EncodedEvent::Rgbd(image))?;
        let mark = |feature: &trundle::slam::SeenFeature| {
            let keypoint = feature.keypoint;
            (Vector2::new(f64::from(keypoint.x), f64::from(keypoint.y)), feature.tracked)
        };
        let marks = FeatureMarks::new(self.now, slam.last_features().iter().map(mark));
        self.recorder.record_json("/slam/features", FeatureMarks::SCHEMA, self.now, &marks)?;
        let pose = PoseInFrame::new(self.now, FRAME, report.visual_from_camera);
        self.recorder.record_json("/slam/pose", PoseInFrame::SCHEMA, self.now, &pose)?;
        if report.closed_loop.is_some() { self.note_map(slam) } else { Ok(()) }
    }

    /// Takes down the final map and closes the recording.
    pub fn finish(mut self, slam: &RgbdSlam) -> Result<(), AppError> {
        self.note_map(slam)?;
        self.recorder.finish()?;
        Ok(())
    }

    fn note_map(&mut self, slam: &RgbdSlam) -> Result<(), AppError> {
        let cloud = LandmarkCloud::new(self.now, FRAME, slam.landmarks());
        self.recorder.record_json("/slam/landmarks", LandmarkCloud::SCHEMA, self.now, &cloud)?;
        let links = Links::of(slam);
        let graph = KeyframeGraph::new(self.now, FRAME, links.covisible, links.loops);
        self.recorder.record_json("/slam/graph", KeyframeGraph::SCHEMA, self.now, &graph)?;
        Ok(())
    }
}

/// Which keyframes are tied, by their positions in the visual frame, m.
pub struct Links {
    /// Those that share landmarks.
    pub covisible: Vec<(Vector3, Vector3)>,
    /// Those that closed a loop.
    pub loops: Vec<(Vector3, Vector3)>,
}

impl Links {
    pub fn of(slam: &RgbdSlam) -> Self {
        let places: BTreeMap<KeyframeId, Vector3> =
            slam.keyframes().map(|(id, _, pose)| (id, pose.translation)).collect();
        let pair = |a: KeyframeId, b: KeyframeId| Some((*places.get(&a)?, *places.get(&b)?));
        Self {
            covisible: slam.covisibility(COVISIBLE).into_iter().filter_map(|(a, b, _)| pair(a, b)).collect(),
            loops: slam.loops().into_iter().filter_map(|(a, b)| pair(a, b)).collect(),
        }
    }
}
