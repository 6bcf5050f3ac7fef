//! The thread that converts and registers frames.

use super::config::CameraThreadConfig;
use super::mailbox::{GrabbedFrame, Mailbox};
use super::outbox::Outbox;
use crate::camera::pixels::{color_from_raw, depth_from_raw};
use crate::camera::registration::Registration;
use crate::camera::{CameraInfo, FrameMonitor};
use std::sync::Arc;
use trundle_core::{ColorImage, DepthImage, Invalid, RgbdImage};

/// Converts the newest frame and pushes it into the sink.
pub(super) struct Converter {
    mailbox: Arc<Mailbox>,
    outbox: Arc<Outbox>,
    config: CameraThreadConfig,
    /// For the camera of the last frame.
    setup: Option<Setup>,
    color: ColorImage,
    depth: DepthImage,
}

struct Setup {
    info: Arc<CameraInfo>,
    registration: Registration,
    monitor: FrameMonitor,
}

impl Converter {
    pub(super) fn new(mailbox: Arc<Mailbox>, outbox: Arc<Outbox>, config: CameraThreadConfig) -> Self {
        let (color, depth) = Default::default();
        Self { mailbox, outbox, config, setup: None, color, depth }
    }

    pub(super) fn run(mut self) {
        while let Some(grabbed) = self.mailbox.take() {
            match self.convert(&grabbed) {
                Ok(image) => self.outbox.push(image, grabbed.generation),
                Err(error) => self.outbox.on_broken(error.to_string()),
            }
        }
    }

    fn convert(&mut self, grabbed: &GrabbedFrame) -> Result<RgbdImage, Invalid> {
        let is_known = self.setup.as_ref().is_some_and(|setup| setup.info == grabbed.info);
        let setup = if is_known { self.setup.take() } else { None };
        let setup = self.setup.insert(setup.unwrap_or_else(|| Setup::new(&grabbed.info, &self.config)));
        color_from_raw(&grabbed.frame.color, &mut self.color)?;
        depth_from_raw(&grabbed.frame.depth, setup.info.depth_unit_m, &mut self.depth)?;
        if let Some(fault) = setup.monitor.on_depth(&self.depth) {
            self.outbox.on_fault(fault.to_string());
        }
        setup.registration.register(grabbed.stamp, &self.color, &self.depth)
    }
}

impl Setup {
    fn new(info: &Arc<CameraInfo>, config: &CameraThreadConfig) -> Self {
        let registration = Registration::new(info, config.output);
        Self { info: info.clone(), registration, monitor: FrameMonitor::new(info, config.expects_noise) }
    }
}
