//! Commands of a home: a word, or JSON.

use serde::Deserialize;
use trundle_core::{MAX_COORDINATE_M, Pose2};

/// Largest command \[bytes\]. Source: ours.
const MAX_COMMAND_BYTES: usize = 1024;

/// A command of a home.
#[derive(Debug, Clone, PartialEq)]
pub enum HomeCommand {
    /// Continue after a pause; else explore.
    Start,
    /// Stop, and keep the task.
    Pause,
    /// Continue after a pause.
    Continue,
    /// Stop, and drop the task.
    Stop,
    /// Explore until the map is complete.
    Explore,
    /// Drive to the pose at power-on.
    Return,
    /// Drive onto the charging station.
    Dock,
    /// Drive to the charging station if known, else to the pose at power-on.
    GoHome,
    /// Drive to a pose in the map frame.
    GoTo(Pose2),
    /// Drive to a named place.
    GoToPlace(String),
}

/// The JSON form of a command.
#[derive(Deserialize)]
struct CommandText {
    command: String,
    place: Option<String>,
    x: Option<f64>,
    y: Option<f64>,
    heading_deg: Option<f64>,
}

const WORDS: &str = "start, pause, continue, stop, explore, return, dock, return_to_base, or \
                     {\"command\": \"go\", \"x\": 1.5, \"y\": 0, \"heading_deg\": 90}, or {\"command\": \"go\", \"place\": \"kitchen\"}";

/// Reads a command: a word, or JSON with the fields `command`, `x`, `y` \[m\], `heading_deg` or `place`.
///
/// # Errors
/// The accepted content.
pub fn read_home_command(payload: &[u8]) -> Result<HomeCommand, String> {
    if payload.len() > MAX_COMMAND_BYTES {
        return Err(format!("command of {} bytes, expected at most {MAX_COMMAND_BYTES}", payload.len()));
    }
    let text = std::str::from_utf8(payload).map_err(|_| format!("no text; expected {WORDS}"))?.trim();
    if !text.starts_with('{') {
        return of_word(text);
    }
    let command: CommandText =
        serde_json::from_str(text).map_err(|error| format!("{error}; expected {WORDS}"))?;
    if command.command == "go" { of_goal(&command) } else { of_word(&command.command) }
}

fn of_word(word: &str) -> Result<HomeCommand, String> {
    Ok(match word {
        "start" => HomeCommand::Start,
        "pause" => HomeCommand::Pause,
        "continue" => HomeCommand::Continue,
        "stop" => HomeCommand::Stop,
        "explore" => HomeCommand::Explore,
        "return" => HomeCommand::Return,
        "dock" => HomeCommand::Dock,
        "return_to_base" => HomeCommand::GoHome,
        other => {
            let other: String = other.chars().take(40).collect();
            return Err(format!("'{other}' is not a command; expected {WORDS}"));
        }
    })
}

fn of_goal(command: &CommandText) -> Result<HomeCommand, String> {
    if let Some(place) = &command.place {
        return Ok(HomeCommand::GoToPlace(place.clone()));
    }
    let coordinate = |name: &str, value: Option<f64>| {
        let value = value.ok_or_else(|| format!("go needs {name} or place; expected {WORDS}"))?;
        let is_usable = value.abs() <= MAX_COORDINATE_M;
        if is_usable {
            Ok(value)
        } else {
            Err(format!("{name} is {value} m, expected up to {MAX_COORDINATE_M}"))
        }
    };
    let heading_deg = command.heading_deg.unwrap_or(0.0);
    let pose = Pose2::new(coordinate("x", command.x)?, coordinate("y", command.y)?, heading_deg.to_radians());
    Ok(HomeCommand::GoTo(pose))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn commands_are_words_or_json() {
        let read = |text: &str| read_home_command(text.as_bytes());
        assert_eq!(read("stop\n"), Ok(HomeCommand::Stop));
        assert_eq!(read(r#"{"command":"dock"}"#), Ok(HomeCommand::Dock));
        let goal = r#"{"command":"go","x":1.5,"y":-2,"heading_deg":90}"#;
        assert_eq!(read(goal), Ok(HomeCommand::GoTo(Pose2::new(1.5, -2.0, FRAC_PI_2))));
        let place = r#"{"command":"go","place":"kitchen"}"#;
        assert_eq!(read(place), Ok(HomeCommand::GoToPlace("kitchen".to_owned())));
        for wrong in ["", "fly", "{}", "{", r#"{"command":"go"}"#, r#"{"command":"go","x":1e9,"y":0}"#] {
            assert!(read(wrong).unwrap_err().contains("expected"), "{wrong}");
        }
        assert!(read_home_command(&[0xff; 4]).is_err() && read_home_command(&[b'a'; 2000]).is_err());
    }
}
