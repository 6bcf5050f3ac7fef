//! Reading a recording: every sensor event in the order in which the robot got it.
//!
//! `cargo run --release --example 07_replay_a_recording -- RECORDING.mcap`; without a recording, one is written first.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::path::{Path, PathBuf};
use trundle::core::{RobotBody, SensorEvent};
use trundle::io::{EncodedEvent, RecordedMessage, Recorder, RecordingReader};
use trundle::sim::{Scene, SimConfig, Simulator};

/// Prints the number of events of each kind in a recording.
///
/// # Errors
/// When the recording cannot be read.
pub fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1).map(PathBuf::from).filter(|argument| argument.is_file());
    if let Some(file) = argument {
        return count(&file);
    }
    let file = std::env::temp_dir().join(format!("trundle-example-{}.mcap", std::process::id()));
    let result = record(&file).and_then(|()| count(&file));
    std::fs::remove_file(&file)?;
    result
}

/// Prints the number of events of each kind.
fn count(file: &Path) -> Result<(), Box<dyn Error>> {
    let mut reader = RecordingReader::open(file)?;
    let (mut wheels, mut images) = (0, 0);
    while let Some(message) = reader.next_message()? {
        if let RecordedMessage::Event(event) = message {
            match event.decode()? {
                SensorEvent::Wheels(_) => wheels += 1,
                SensorEvent::Rgbd(_) => images += 1,
                _ => {}
            }
        }
    }
    println!("{wheels} wheel readings, {images} images");
    assert!(wheels > 0);
    Ok(())
}

/// A recording of the simulator standing still for half a second.
fn record(file: &Path) -> Result<(), Box<dyn Error>> {
    let mut body = Simulator::new(Scene::by_name("demo", 1)?, SimConfig::default(), 1)?;
    let mut recorder = Recorder::create(file)?;
    while let Some(event) = body.next_event()? {
        if event.stamp().as_secs() > 0.5 {
            break;
        }
        recorder.record_event(&EncodedEvent::encode(&event)?)?;
    }
    recorder.finish()?;
    Ok(())
}
