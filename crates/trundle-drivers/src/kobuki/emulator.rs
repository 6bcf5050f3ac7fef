//! The device's side of the protocol: feedback packets from a state, wanted speeds from command bytes.
//!
//! The emulator has no clock, no noise and no inertia. A simulator supplies the state every 20 ms, and drives with the returned twist.

use super::decoder::{CommandDecoder, DecoderCounters};
use super::feedback_events::FEEDBACK_PERIOD_S;
use super::protocol::{
    Charger, CliffSignals, CoreSensors, Feedback, Gains, GeneralInputs, Inertia, KobukiCommand,
    MotorCurrents, Outputs, RawGyro, ThreeSides, UniqueId, Version,
};
use trundle_core::{DockInfrared, PerWheel, Twist2};

/// Milliseconds between feedback packets: 20 ms. Source: the protocol's "Feedback Identifier", 50 Hz.
const FEEDBACK_PERIOD_MS: u16 = 20;
/// Number of gyro readings per packet: 2. Source: the captured packet; the protocol allows two or three.
const READINGS_PER_PACKET: u8 = 2;
/// Maximum number of stored sounds: 64. Source: ours.
const MAX_KEPT_SOUNDS: usize = 64;
/// Units of the battery's byte in a volt: 10. Source: the protocol's "Basic Sensor Data".
const BATTERY_UNITS_PER_V: f64 = 10.0;

/// State of the base, as its sensors read it.
#[derive(Debug, Clone, PartialEq)]
pub struct KobukiState {
    /// Encoders (left, right), ticks, forward positive, wrapping.
    pub ticks: (u16, u16),
    /// Turn rate, rad/s, counter-clockwise, with the sensor's errors.
    pub gyro_rate: f64,
    /// Heading integrated by the firmware, rad, -pi to pi, counter-clockwise.
    pub heading: f64,
    /// Pressed bumpers.
    pub bumper: ThreeSides,
    /// Cliff sensors with no floor below.
    pub cliff: ThreeSides,
    /// Signals of the cliff sensors, 0 to 4095.
    pub cliff_signals: CliffSignals,
    /// Wheels that hang.
    pub wheel_drop: PerWheel,
    /// Wheel motors with too much current.
    pub over_current: PerWheel,
    /// Pressed buttons, B0 first.
    pub buttons: [bool; 3],
    /// Charger.
    pub charger: Charger,
    /// Voltage of the battery, V, 0 to 25.5.
    pub battery_v: f64,
    /// Light of the charging station.
    pub dock: DockInfrared,
}

/// A base on the floor with a full battery; the cliff signals are those of the captured packet.
impl Default for KobukiState {
    fn default() -> Self {
        Self {
            ticks: (0, 0),
            gyro_rate: 0.0,
            heading: 0.0,
            bumper: ThreeSides::default(),
            cliff: ThreeSides::default(),
            cliff_signals: CliffSignals { right: 1673, center: 1965, left: 1609 },
            wheel_drop: PerWheel::default(),
            over_current: PerWheel::default(),
            buttons: [false; 3],
            charger: Charger::default(),
            battery_v: 16.5,
            dock: DockInfrared::default(),
        }
    }
}

/// An emulated base: a device of the Kobuki's serial protocol.
#[derive(Debug, Clone)]
pub struct EmulatedKobuki {
    decoder: CommandDecoder,
    stamp_ms: u16,
    gyro_frame_id: u8,
    hardware: Version,
    firmware: Version,
    unique_id: UniqueId,
    gains: Gains,
    outputs: Outputs,
    sounds: Vec<KobukiCommand>,
    /// Content of the next packet besides the sensors.
    answers: Feedback,
}

impl Default for EmulatedKobuki {
    fn default() -> Self {
        Self::new(Version::new(1, 2, 0))
    }
}

impl EmulatedKobuki {
    /// Period at which [`EmulatedKobuki::feedback`] is called, s.
    pub const PERIOD_S: f64 = FEEDBACK_PERIOD_S;

    /// A base of hardware 1.0.4 with this firmware, switched on just now.
    pub fn new(firmware: Version) -> Self {
        Self {
            decoder: CommandDecoder::default(),
            stamp_ms: 0,
            gyro_frame_id: 0,
            hardware: Version::new(1, 0, 4),
            firmware,
            unique_id: UniqueId([736_034_612, 892_621_875, 1_125_147_971]),
            gains: Gains::default(),
            outputs: Outputs::default(),
            sounds: Vec::new(),
            answers: Feedback::default(),
        }
    }

    /// The base with this unique id.
    #[must_use]
    pub fn with_unique_id(self, unique_id: UniqueId) -> Self {
        Self { unique_id, ..self }
    }

    /// The bytes of the next packet, 20 ms after the last one.
    pub fn feedback(&mut self, state: &KobukiState) -> Vec<u8> {
        self.stamp_ms = self.stamp_ms.wrapping_add(FEEDBACK_PERIOD_MS);
        let gyro = RawGyro {
            frame_id: self.gyro_frame_id,
            readings: vec![[0, 0, RawGyro::nearest_z(state.gyro_rate)]; usize::from(READINGS_PER_PACKET)],
        };
        self.gyro_frame_id = self.gyro_frame_id.wrapping_add(READINGS_PER_PACKET);
        let sensors = Feedback {
            core: Some(core_sensors(state, self.stamp_ms)),
            dock: Some(state.dock),
            inertia: Some(Inertia::nearest(state.heading, state.gyro_rate)),
            cliff: Some(state.cliff_signals),
            currents: Some(MotorCurrents::default()),
            gyro: Some(gyro),
            inputs: Some(GeneralInputs::default()),
            ..std::mem::take(&mut self.answers)
        };
        sensors.encode()
    }

    /// Processes bytes of a driver. Returns the twist of the last base control among them, if any: v in m/s, omega in rad/s.
    pub fn on_bytes(&mut self, bytes: &[u8]) -> Option<Twist2> {
        let mut commands = Vec::new();
        self.decoder.push(bytes, |command| commands.push(command));
        commands.into_iter().filter_map(|command| self.on_command(command)).last()
    }

    /// Outputs as last set.
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }

    /// Gains as last set.
    pub fn gains(&self) -> Gains {
        self.gains
    }

    /// Counts of read and dropped bytes of drivers.
    pub fn command_counters(&self) -> DecoderCounters {
        self.decoder.counters()
    }

    /// The requested sounds since the last removal, at most 64.
    pub fn sounds(&self) -> &[KobukiCommand] {
        &self.sounds
    }

    /// Returns and removes the requested sounds since the last call, at most 64.
    pub fn take_sounds(&mut self) -> Vec<KobukiCommand> {
        std::mem::take(&mut self.sounds)
    }

    fn on_command(&mut self, command: KobukiCommand) -> Option<Twist2> {
        match command {
            KobukiCommand::BaseControl(control) => return Some(control.twist()),
            KobukiCommand::Sound { .. } | KobukiCommand::SoundSequence(_) => {
                if self.sounds.len() < MAX_KEPT_SOUNDS {
                    self.sounds.push(command);
                }
            }
            KobukiCommand::RequestExtra { hardware, firmware, unique_id } => {
                self.answers.hardware = hardware.then_some(self.hardware).or(self.answers.hardware);
                self.answers.firmware = firmware.then_some(self.firmware).or(self.answers.firmware);
                self.answers.unique_id = unique_id.then_some(self.unique_id).or(self.answers.unique_id);
            }
            KobukiCommand::Outputs(outputs) => self.outputs = outputs,
            KobukiCommand::SetGains(gains) => self.gains = gains,
            KobukiCommand::GetGains => self.answers.gains = Some(self.gains),
        }
        None
    }
}

fn core_sensors(state: &KobukiState, stamp_ms: u16) -> CoreSensors {
    let (left_ticks, right_ticks) = state.ticks;
    CoreSensors {
        stamp_ms,
        bumper: state.bumper,
        wheel_drop: state.wheel_drop,
        cliff: state.cliff,
        left_ticks,
        right_ticks,
        left_pwm: 0,
        right_pwm: 0,
        buttons: state.buttons,
        charger: state.charger,
        battery_decivolts: (state.battery_v * BATTERY_UNITS_PER_V).round() as u8,
        over_current: state.over_current,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kobuki::decoder::FeedbackDecoder;
    use crate::kobuki::protocol::{BaseControl, SoundSequence};

    fn packet(emulator: &mut EmulatedKobuki, state: &KobukiState) -> Feedback {
        let mut packets = Vec::new();
        FeedbackDecoder::default().push(&emulator.feedback(state), |feedback| packets.push(feedback));
        assert_eq!(packets.len(), 1);
        packets.remove(0)
    }

    #[test]
    fn a_packet_holds_the_state() {
        let mut state =
            KobukiState { ticks: (7, 65_535), gyro_rate: 0.5, heading: -1.0, ..KobukiState::default() };
        (state.bumper.left, state.wheel_drop.right, state.buttons[2]) = (true, true, true);
        (state.dock.left.near_center, state.battery_v) = (true, 14.36);
        let feedback = packet(&mut EmulatedKobuki::default(), &state);
        let core = feedback.core.unwrap();
        assert_eq!((core.stamp_ms, core.left_ticks, core.right_ticks), (20, 7, 65_535));
        assert_eq!((core.bumper, core.wheel_drop), (state.bumper, state.wheel_drop));
        assert_eq!((core.buttons, core.battery_decivolts), ([false, false, true], 144));
        assert_eq!(feedback.dock, Some(state.dock));
        let gyro = feedback.gyro.unwrap();
        assert_eq!(gyro.rates().len(), 2);
        assert!(gyro.rates().all(|rates| (rates[2] - 0.5).abs() < 1e-4));
        assert!((feedback.inertia.unwrap().angle() + 1.0).abs() < 1e-4);
    }

    #[test]
    fn it_has_the_size_of_a_real_packet() {
        assert_eq!(EmulatedKobuki::default().feedback(&KobukiState::default()).len(), 81);
    }

    #[test]
    fn stamps_wrap() {
        let mut emulator = EmulatedKobuki::default();
        let stamps: Vec<u16> = (0..3278)
            .map(|_| packet(&mut emulator, &KobukiState::default()).core.unwrap().stamp_ms)
            .collect();
        assert_eq!(stamps[3275..], [65_520, 4, 24]);
    }

    #[test]
    fn requests_are_answered_once_in_the_next_packet() {
        let mut emulator = EmulatedKobuki::default();
        let state = KobukiState::default();
        assert_eq!(packet(&mut emulator, &state).firmware, None);
        let request = KobukiCommand::RequestExtra { hardware: true, firmware: true, unique_id: true };
        emulator.on_bytes(&[request.encode(), KobukiCommand::GetGains.encode()].concat());
        let answer = packet(&mut emulator, &state);
        assert_eq!(
            (answer.hardware, answer.firmware),
            (Some(Version::new(1, 0, 4)), Some(Version::new(1, 2, 0)))
        );
        assert_eq!((answer.unique_id.is_some(), answer.gains), (true, Some(Gains::default())));
        let after = packet(&mut emulator, &state);
        assert!(after.hardware.is_none() && after.unique_id.is_none() && after.gains.is_none());
    }

    #[test]
    fn commands_take_effect_however_they_are_cut() {
        let mut emulator = EmulatedKobuki::default();
        let outputs = Outputs { power_5v: false, ..Outputs::default() };
        let gains = Gains { is_user: true, p: 50.0, i: 1.0, d: 0.5 };
        let sound = KobukiCommand::SoundSequence(SoundSequence::Error);
        let drive = |v, omega| KobukiCommand::BaseControl(BaseControl::from_twist(Twist2::new(v, omega)));
        let commands = [
            drive(0.3, 0.0),
            KobukiCommand::Outputs(outputs),
            sound,
            KobukiCommand::SetGains(gains),
            drive(0.2, 0.5),
        ];
        let bytes = commands.map(|command| command.encode()).concat();
        let twists: Vec<Twist2> = bytes.chunks(3).filter_map(|chunk| emulator.on_bytes(chunk)).collect();
        assert_eq!(twists.len(), 2);
        assert!((twists[1].v - 0.2).abs() < 0.003 && (twists[1].omega - 0.5).abs() < 0.01, "{twists:?}");
        assert_eq!(
            (emulator.outputs(), emulator.gains(), emulator.take_sounds()),
            (outputs, gains, vec![sound])
        );
        assert_eq!(emulator.take_sounds(), []);
    }
}
