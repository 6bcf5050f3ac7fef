//! Any camera as frames in a pipe, a FIFO, a file, or a folder that grows.
//!
//! `docs/camera-stream.md` describes the format. Another program writes it, in any language; no library of the camera is needed.
//! [`StreamWriter`] writes the same format.

mod camera_file;
mod folder_camera;
mod folder_scan;
mod frame_parser;
mod process_camera;
mod source;
mod stream_camera;
mod stream_writer;

pub use camera_file::{header_line, parse_header};
pub use folder_camera::{FolderCamera, FolderCounts};
pub use frame_parser::{FRAME_MAGIC, FrameLimits, FrameParser, ParserCounts, StreamFrame};
pub use process_camera::ProcessCamera;
pub use stream_camera::StreamCamera;
pub use stream_writer::StreamWriter;
