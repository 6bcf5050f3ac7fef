//! Commands to lights, sounds and controllers that outlast a lost link.

use super::protocol::{Gains, KobukiCommand, Outputs};

/// The newest command of each kind for a base that may be away.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct KeptAccessories {
    /// Last requested outputs and gains: the base loses them when it is switched off, so they are set again after each return.
    outputs: Option<Outputs>,
    gains: Option<Gains>,
    /// Last sound during the absence: it is played once.
    sound: Option<KobukiCommand>,
    /// Whether the gains were requested during the absence.
    asks_for_gains: bool,
}

impl KeptAccessories {
    /// Keeps a command that goes out now: only what the base would lose.
    pub(super) fn note_sent(&mut self, command: KobukiCommand) {
        match command {
            KobukiCommand::Outputs(outputs) => self.outputs = Some(outputs),
            KobukiCommand::SetGains(gains) => self.gains = Some(gains),
            _ => {}
        }
    }

    /// Keeps a command that cannot go out; returns whether an earlier sound is given up for it, or the command cannot be kept.
    pub(super) fn note_unsent(&mut self, command: KobukiCommand) -> bool {
        match command {
            KobukiCommand::Outputs(_) | KobukiCommand::SetGains(_) => self.note_sent(command),
            KobukiCommand::GetGains => self.asks_for_gains = true,
            KobukiCommand::Sound { .. } | KobukiCommand::SoundSequence(_) => {
                return self.sound.replace(command).is_some();
            }
            _ => return true,
        }
        false
    }

    /// The commands for a base that has returned.
    pub(super) fn on_return(&mut self) -> impl Iterator<Item = KobukiCommand> {
        let asks_for_gains = std::mem::take(&mut self.asks_for_gains);
        let outputs = self.outputs.map(KobukiCommand::Outputs);
        let gains = self.gains.map(KobukiCommand::SetGains);
        let request = asks_for_gains.then_some(KobukiCommand::GetGains);
        [outputs, gains, request, self.sound.take()].into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::super::protocol::SoundSequence;
    use super::*;

    #[test]
    fn the_newest_of_each_kind_is_kept_and_a_sound_once() {
        let mut kept = KeptAccessories::default();
        let outputs = |word| KobukiCommand::Outputs(Outputs::from_word(word));
        let gains = KobukiCommand::SetGains(Gains { is_user: true, p: 90.0, i: 0.2, d: 1.5 });
        let sound = KobukiCommand::SoundSequence;
        kept.note_sent(outputs(1));
        kept.note_sent(sound(SoundSequence::On));
        assert_eq!(kept.on_return().collect::<Vec<_>>(), [outputs(1)]);
        let unsent = [
            sound(SoundSequence::Error),
            outputs(2),
            gains,
            KobukiCommand::GetGains,
            sound(SoundSequence::CleaningEnd),
        ];
        assert_eq!(unsent.map(|command| kept.note_unsent(command)), [false, false, false, false, true]);
        let expected = [outputs(2), gains, KobukiCommand::GetGains, sound(SoundSequence::CleaningEnd)];
        assert_eq!(kept.on_return().collect::<Vec<_>>(), expected);
        assert_eq!(kept.on_return().collect::<Vec<_>>(), expected[..2]);
    }
}
