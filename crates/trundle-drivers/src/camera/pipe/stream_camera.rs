//! A camera whose frames come as a stream of bytes.

use super::camera_file::{HeaderSearch, find_header, parse_header};
use super::frame_parser::{FrameLimits, FrameParser, ParserCounts};
use super::source;
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera};
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use trundle_core::Invalid;

/// Maximum number of bytes per read. Source: ours; the largest pipe buffer of Linux without privileges.
const READ_BYTES: usize = 1 << 20;
/// Bytes that are searched for a header: 2^30. Source: ours; a header comes every 30 frames, and 30 frames of 1920 x 1080 px have 0.4 GB.
const MAX_BYTES_BEFORE_HEADER: usize = 1 << 30;
/// Frames that wait between the reading thread and the caller. Source: ours; more would be delay.
const MAX_WAITING_FRAMES: usize = 2;

/// A camera whose frames come from a pipe, a FIFO, a file or standard input.
///
/// A camera whose bytes are read by a thread. A drop ends the thread; on standard input the thread ends with the next byte.
#[derive(Debug)]
pub struct StreamCamera {
    info: CameraInfo,
    place: String,
    messages: Receiver<Message>,
    counts: Arc<Mutex<ParserCounts>>,
    _stop: StopOnDrop,
    has_ended: bool,
}

#[derive(Debug)]
enum Message {
    Info(Box<CameraInfo>),
    Frame(Box<CameraFrame>),
    Broken(Invalid),
    BadHeader(String),
    Failed(std::io::Error),
    End,
}

impl StreamCamera {
    /// Opens a file or a FIFO, or standard input for `-`, and waits at most `timeout` for the header. A file, also as standard input, is a
    /// recording: it is not live, whatever its header contains.
    ///
    /// # Errors
    /// When the path cannot be read, or its header does not come in time or is not valid.
    pub fn open(path: &Path, timeout: Duration) -> Result<Self, CameraError> {
        let place = path.display().to_string();
        let is_stopped = Arc::new(AtomicBool::new(false));
        let source = source::open(path, is_stopped.clone())
            .map_err(|source| CameraError::Io { place: place.clone(), source })?;
        let mut camera = Self::start(source.reader, place, is_stopped, timeout)?;
        camera.info.is_live &= !source.is_file;
        Ok(camera)
    }

    /// Reads a stream from any reader, named `place` in messages; see [`StreamCamera::open`].
    ///
    /// # Errors
    /// When the header does not come in time or is not valid.
    pub fn from_reader(
        reader: Box<dyn Read + Send>,
        place: &str,
        timeout: Duration,
    ) -> Result<Self, CameraError> {
        Self::start(reader, place.to_owned(), Arc::new(AtomicBool::new(false)), timeout)
    }

    /// Frames found and bytes skipped so far.
    pub fn counts(&self) -> ParserCounts {
        *self.counts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn start(
        reader: Box<dyn Read + Send>,
        place: String,
        is_stopped: Arc<AtomicBool>,
        timeout: Duration,
    ) -> Result<Self, CameraError> {
        let (sender, messages) = sync_channel(MAX_WAITING_FRAMES);
        let counts = Arc::new(Mutex::new(ParserCounts::default()));
        let worker = Worker { reader, sender, counts: counts.clone(), is_stopped: is_stopped.clone() };
        let failed = |source| CameraError::Io { place: place.clone(), source };
        std::thread::Builder::new()
            .name("camera-stream".into())
            .spawn(move || worker.run())
            .map_err(failed)?;
        let guard = StopOnDrop(is_stopped);
        let bad = |problem: String| CameraError::BadHeader { place: place.clone(), problem };
        let info = match messages.recv_timeout(timeout) {
            Ok(Message::Info(info)) => *info,
            Ok(Message::BadHeader(problem)) => return Err(bad(problem)),
            Ok(Message::Failed(source)) => return Err(failed(source)),
            Ok(_) => return Err(bad("the stream ended within it".into())),
            Err(_) => return Err(bad(format!("none came within {:.1} s", timeout.as_secs_f64()))),
        };
        Ok(Self { info, place, messages, counts, _stop: guard, has_ended: false })
    }
}

/// Stops the reading thread.
#[derive(Debug)]
struct StopOnDrop(Arc<AtomicBool>);

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl DepthCamera for StreamCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        match self.messages.recv_timeout(timeout) {
            Ok(Message::Frame(frame)) => Ok(Some(*frame)),
            Ok(Message::Broken(problem)) => Err(CameraError::BrokenFrame(problem)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Ok(Message::Failed(source)) => Err(CameraError::Io { place: self.place.clone(), source }),
            Ok(_) | Err(RecvTimeoutError::Disconnected) if self.info.is_live => {
                Err(CameraError::Unplugged { device: self.place.clone() })
            }
            Ok(_) | Err(RecvTimeoutError::Disconnected) => {
                self.has_ended = true;
                Ok(None)
            }
        }
    }

    fn has_ended(&self) -> bool {
        self.has_ended
    }
}

/// The reading thread.
struct Worker {
    reader: Box<dyn Read + Send>,
    sender: SyncSender<Message>,
    counts: Arc<Mutex<ParserCounts>>,
    is_stopped: Arc<AtomicBool>,
}

impl Worker {
    fn run(mut self) {
        let last = match self.read_header() {
            Ok((info, rest)) => {
                let message = Message::Info(Box::new(info.clone()));
                if self.sender.send(message).is_err() { return } else { self.read_frames(&info, &rest) }
            }
            Err(problem) => problem,
        };
        // The receiver may be dropped; then the message is lost.
        let _ = self.sender.send(last);
    }

    /// The camera, and the bytes read after its header. Bytes before the header belong to a stream that was joined midway.
    fn read_header(&mut self) -> Result<(CameraInfo, Vec<u8>), Message> {
        let (mut bytes, mut chunk) = (Vec::new(), vec![0; READ_BYTES]);
        let mut skipped = 0;
        loop {
            match find_header(&bytes).map_err(Message::BadHeader)? {
                HeaderSearch::Found(header) => {
                    let info = parse_header(&bytes[header.clone()]).map_err(Message::BadHeader)?;
                    return Ok((info, bytes.split_off(header.end)));
                }
                HeaderSearch::From(start) => skipped += bytes.drain(..start).count(),
            }
            if skipped > MAX_BYTES_BEFORE_HEADER {
                return Err(Message::BadHeader(format!("none within {skipped} bytes")));
            }
            match self.read(&mut chunk)? {
                0 => return Err(Message::BadHeader("the stream ended before or within it".into())),
                length => bytes.extend_from_slice(&chunk[..length]),
            }
        }
    }

    /// Sends frames until the stream ends; the reason of the end.
    fn read_frames(&mut self, info: &CameraInfo, first: &[u8]) -> Message {
        let mut parser = FrameParser::new(FrameLimits::of(info));
        let mut chunk = vec![0; READ_BYTES];
        parser.push(first);
        loop {
            while let Some(frame) = parser.next_frame() {
                *self.counts.lock().unwrap_or_else(PoisonError::into_inner) = parser.counts();
                if self.sender.send(Message::Frame(Box::new(frame.into_camera_frame(info)))).is_err() {
                    return Message::End;
                }
            }
            *self.counts.lock().unwrap_or_else(PoisonError::into_inner) = parser.counts();
            if let Some(problem) = parser.take_refusal()
                && self.sender.send(Message::Broken(problem)).is_err()
            {
                return Message::End;
            }
            match self.read(&mut chunk) {
                Ok(0) => return Message::End,
                Ok(length) => parser.push(&chunk[..length]),
                Err(failure) => return failure,
            }
        }
    }

    /// Bytes read; 0 at the end.
    fn read(&mut self, chunk: &mut [u8]) -> Result<usize, Message> {
        while !self.is_stopped.load(Ordering::Relaxed) {
            match self.reader.read(chunk) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                result => return result.map_err(Message::Failed),
            }
        }
        Ok(0)
    }
}
