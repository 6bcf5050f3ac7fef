//! Lights, sounds and outputs of a running base, from any thread.

use super::protocol::{KobukiCommand, Outputs, SoundSequence};
use std::sync::mpsc::Sender;

/// The way to the lights, sounds and outputs of a running base. Clones lead to the same base.
#[derive(Debug, Clone)]
pub struct Accessories(Sender<KobukiCommand>);

impl Accessories {
    pub(super) fn new(commands: Sender<KobukiCommand>) -> Self {
        Self(commands)
    }

    /// Sets all outputs: digital outputs, supplies, lights. They are set again after the return of a lost link.
    pub fn set_outputs(&self, outputs: Outputs) {
        self.send(KobukiCommand::Outputs(outputs));
    }

    /// Plays a melody of the firmware. While the link is down the newest melody waits for its return.
    pub fn play(&self, sequence: SoundSequence) {
        self.send(KobukiCommand::SoundSequence(sequence));
    }

    pub(super) fn send(&self, command: KobukiCommand) {
        if self.0.send(command).is_err() {
            tracing::warn!("{command:?} is not sent: the thread of the base has ended");
        }
    }
}
