//! Commands to the base, to bytes and from bytes.

use super::base_control::BaseControl;
use super::device_info::Gains;
use super::fields::{Fields, bits, word_of};
use super::frame::{PayloadError, check_payload, frame, push_sub_payload, sub_payloads};
use std::fmt;

/// Time unit of a note's period: 2.75e-6 s. Source: the protocol's "Sound", period = 1 / (f a).
const NOTE_PERIOD_UNIT_S: f64 = 0.000_002_75;

/// A command to the base. Source: the protocol's "Command Packets".
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum KobukiCommand {
    /// Speed of the wheels.
    BaseControl(BaseControl),
    /// A note.
    Sound {
        /// Period of the note in units of 2.75e-6 s; see [`KobukiCommand::note`].
        period: u16,
        /// Duration, ms.
        duration_ms: u8,
    },
    /// A melody of the firmware.
    SoundSequence(SoundSequence),
    /// Requests versions and unique id.
    RequestExtra {
        /// Requests the version of the hardware.
        hardware: bool,
        /// Requests the version of the firmware.
        firmware: bool,
        /// Requests the unique id.
        unique_id: bool,
    },
    /// Sets all outputs together.
    Outputs(Outputs),
    /// Sets the gains of the wheels' speed controllers. Firmware 1.2.0 or later.
    SetGains(Gains),
    /// Requests the gains of the wheels' speed controllers. Firmware 1.2.0 or later.
    GetGains,
}

/// A melody of the firmware.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum SoundSequence {
    /// The base was switched on.
    On = 0,
    /// The base was switched off.
    Off = 1,
    /// Charging began.
    Recharge = 2,
    /// A button was pressed.
    Button = 3,
    /// An error.
    Error = 4,
    /// Cleaning began.
    CleaningStart = 5,
    /// Cleaning ended.
    CleaningEnd = 6,
}

impl SoundSequence {
    /// All melodies, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::On,
        Self::Off,
        Self::Recharge,
        Self::Button,
        Self::Error,
        Self::CleaningStart,
        Self::CleaningEnd,
    ];
}

/// The vendor's name of the melody.
impl fmt::Display for SoundSequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::On => "on",
            Self::Off => "off",
            Self::Recharge => "recharge",
            Self::Button => "button",
            Self::Error => "error",
            Self::CleaningStart => "cleaning start",
            Self::CleaningEnd => "cleaning end",
        })
    }
}

/// The colours of a light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Led {
    /// Red is on; with green it is orange.
    pub red: bool,
    /// Green is on.
    pub green: bool,
}

impl Led {
    /// The light is dark.
    pub const OFF: Self = Self { red: false, green: false };
    /// The light is red.
    pub const RED: Self = Self { red: true, green: false };
    /// The light is green.
    pub const GREEN: Self = Self { red: false, green: true };
    /// The light is orange.
    pub const ORANGE: Self = Self { red: true, green: true };
}

impl fmt::Display for Led {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match (self.red, self.green) {
            (false, false) => "off",
            (true, false) => "red",
            (false, true) => "green",
            (true, true) => "orange",
        })
    }
}

/// All outputs of the base. One command sets all of them. By default the four supplies are on, as at the base's start, and all others are
/// off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outputs {
    /// Digital outputs 0 to 3 of the expansion port.
    pub digital: [bool; 4],
    /// Supply of 3.3 V.
    pub power_3v3: bool,
    /// Supply of 5 V.
    pub power_5v: bool,
    /// Supply of 12 V, 5 A.
    pub power_12v_5a: bool,
    /// Supply of 12 V, 1.5 A.
    pub power_12v_1a5: bool,
    /// First light.
    pub led1: Led,
    /// Second light.
    pub led2: Led,
}

impl Default for Outputs {
    fn default() -> Self {
        Self::from_word(0x00F0)
    }
}

impl Outputs {
    /// The word of flags of the general purpose output command.
    pub fn word(&self) -> u16 {
        let [d0, d1, d2, d3] = self.digital;
        let power = [self.power_3v3, self.power_5v, self.power_12v_5a, self.power_12v_1a5];
        let leds = [self.led1.red, self.led1.green, self.led2.red, self.led2.green];
        word_of(&[[d0, d1, d2, d3], power, leds].concat())
    }

    /// The outputs of a word of flags; its highest four bits are unused.
    pub fn from_word(word: u16) -> Self {
        let [d0, d1, d2, d3, power_3v3, power_5v, power_12v_5a, power_12v_1a5, red1, green1, red2, green2] =
            bits(word);
        Self {
            digital: [d0, d1, d2, d3],
            power_3v3,
            power_5v,
            power_12v_5a,
            power_12v_1a5,
            led1: Led { red: red1, green: green1 },
            led2: Led { red: red2, green: green2 },
        }
    }
}

impl KobukiCommand {
    /// A note of `frequency_hz` (Hz) that lasts `duration_ms`. The lowest possible note is 5.5 Hz; zero or not a number gives that one.
    pub fn note(frequency_hz: f64, duration_ms: u8) -> Self {
        let period = 1.0 / (frequency_hz.max(0.0) * NOTE_PERIOD_UNIT_S);
        Self::Sound { period: period.round() as u16, duration_ms }
    }

    /// The whole frame of this command.
    pub fn encode(&self) -> Vec<u8> {
        let (id, data) = self.sub_payload();
        let mut payload = Vec::new();
        push_sub_payload(&mut payload, id, &data);
        frame(&payload)
    }

    fn sub_payload(&self) -> (u8, Vec<u8>) {
        match *self {
            Self::BaseControl(BaseControl { speed_mm_s, radius_mm }) => {
                (1, [speed_mm_s.to_le_bytes(), radius_mm.to_le_bytes()].concat())
            }
            Self::Sound { period, duration_ms } => {
                let [low, high] = period.to_le_bytes();
                (3, vec![low, high, duration_ms])
            }
            Self::SoundSequence(sequence) => (4, vec![sequence as u8]),
            Self::RequestExtra { hardware, firmware, unique_id } => {
                (9, word_of(&[hardware, firmware, false, unique_id]).to_le_bytes().to_vec())
            }
            Self::Outputs(outputs) => (12, outputs.word().to_le_bytes().to_vec()),
            Self::SetGains(gains) => (13, gains.data()),
            Self::GetGains => (14, vec![0]),
        }
    }

    /// The commands of a payload, in order; unknown identifiers and unknown melodies are left out.
    ///
    /// # Errors
    /// When a sub-payload is damaged or shorter than its fields.
    pub fn decode(payload: &[u8]) -> Result<Vec<Self>, PayloadError> {
        check_payload(payload, payload.len(), min_command_bytes)?;
        Ok(sub_payloads(payload).filter_map(|part| Self::of(part.id, Fields(part.data))).collect())
    }

    fn of(id: u8, mut data: Fields<'_>) -> Option<Self> {
        Some(match id {
            1 => Self::BaseControl(BaseControl { speed_mm_s: data.i16()?, radius_mm: data.i16()? }),
            3 => Self::Sound { period: data.u16()?, duration_ms: data.u8()? },
            4 => Self::SoundSequence(*SoundSequence::ALL.get(usize::from(data.u8()?))?),
            9 => {
                let [hardware, firmware, _, unique_id] = bits(data.u16()?);
                Self::RequestExtra { hardware, firmware, unique_id }
            }
            12 => Self::Outputs(Outputs::from_word(data.u16()?)),
            13 => Self::SetGains(Gains::decode(data)?),
            14 => Self::GetGains,
            _ => return None,
        })
    }
}

/// Minimum length of the data of a command, bytes; `None` for an unknown identifier. Source: the protocol's "Command Packets".
pub fn min_command_bytes(id: u8) -> Option<usize> {
    match id {
        1 => Some(4),
        3 => Some(3),
        4 | 14 => Some(1),
        9 | 12 => Some(2),
        13 => Some(13),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<KobukiCommand> {
        let mut commands = vec![
            KobukiCommand::BaseControl(BaseControl { speed_mm_s: -300, radius_mm: 666 }),
            KobukiCommand::Sound { period: 826, duration_ms: 200 },
            KobukiCommand::RequestExtra { hardware: true, firmware: false, unique_id: true },
            KobukiCommand::Outputs(Outputs { led2: Led { red: false, green: true }, ..Outputs::default() }),
            KobukiCommand::SetGains(Gains { is_user: true, p: 100.0, i: 0.1, d: 2.0 }),
            KobukiCommand::GetGains,
        ];
        commands.extend(SoundSequence::ALL.map(KobukiCommand::SoundSequence));
        commands
    }

    #[test]
    fn every_command_comes_back_and_has_its_minimum_length() {
        for command in all() {
            let bytes = command.encode();
            let payload = &bytes[3..bytes.len() - 1];
            assert_eq!(KobukiCommand::decode(payload), Ok(vec![command]));
            assert_eq!(min_command_bytes(payload[0]), Some(usize::from(payload[1])), "{command:?}");
        }
    }

    #[test]
    fn bytes_are_those_of_the_protocol() {
        let stop = KobukiCommand::BaseControl(BaseControl::STOP).encode();
        assert_eq!(stop, [0xAA, 0x55, 6, 1, 4, 0, 0, 0, 0, 3]);
        let request = KobukiCommand::RequestExtra { hardware: true, firmware: true, unique_id: true };
        assert_eq!(request.encode()[3..7], [9, 2, 0x0B, 0]);
        assert_eq!(KobukiCommand::GetGains.encode()[3..6], [14, 1, 0]);
        assert_eq!(Outputs::default().word(), 0x00F0);
        let green2 = Outputs { led2: Led { red: false, green: true }, ..Outputs::from_word(0) };
        assert_eq!(green2.word(), 0x0800);
        assert_eq!(Outputs { digital: [false, false, true, false], ..Outputs::from_word(0) }.word(), 4);
    }

    #[test]
    fn a_note_is_its_period() {
        assert_eq!(KobukiCommand::note(440.0, 10), KobukiCommand::Sound { period: 826, duration_ms: 10 });
        assert_eq!(KobukiCommand::note(0.0, 10), KobukiCommand::Sound { period: u16::MAX, duration_ms: 10 });
    }

    #[test]
    fn unknown_commands_are_left_out_and_short_ones_refused() {
        let stop = KobukiCommand::BaseControl(BaseControl::STOP);
        assert_eq!(KobukiCommand::decode(&[77, 1, 0, 1, 4, 0, 0, 0, 0, 4, 1, 9]), Ok(vec![stop]));
        assert_eq!(
            KobukiCommand::decode(&[1, 2, 0, 0]),
            Err(PayloadError::Short { id: 1, bytes: 2, expected: 4 })
        );
    }
}
