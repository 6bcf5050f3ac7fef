//! A feedback packet: all its sub-payloads, from bytes and to bytes.

use super::core_sensors::CoreSensors;
use super::device_info::{Gains, UniqueId, Version};
use super::fields::Fields;
use super::frame::{PayloadError, SubPayload, check_payload, frame, push_sub_payload, sub_payloads};
use super::sensor_payloads::{
    CliffSignals, GeneralInputs, Inertia, MotorCurrents, RawGyro, decode_dock, dock_data,
};
use trundle_core::DockInfrared;

/// The sub-payloads of one packet; `None` if the packet has none of the kind.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Feedback {
    /// Stamp, bumper, wheels, charger.
    pub core: Option<CoreSensors>,
    /// Light of the charging station.
    pub dock: Option<DockInfrared>,
    /// Heading and turn rate, calibrated by the firmware.
    pub inertia: Option<Inertia>,
    /// Signals of the cliff sensors.
    pub cliff: Option<CliffSignals>,
    /// Currents of the wheel motors.
    pub currents: Option<MotorCurrents>,
    /// Version of the hardware, on request.
    pub hardware: Option<Version>,
    /// Version of the firmware, on request.
    pub firmware: Option<Version>,
    /// Raw readings of the gyro.
    pub gyro: Option<RawGyro>,
    /// Inputs of the expansion port.
    pub inputs: Option<GeneralInputs>,
    /// Unique id, on request.
    pub unique_id: Option<UniqueId>,
    /// Gains of the wheels' speed controllers, on request.
    pub gains: Option<Gains>,
}

impl Feedback {
    /// Reads a payload: the packet, and the number of its unknown sub-payloads, which are skipped.
    ///
    /// Bytes of a sub-payload after its known fields are ignored, because a later firmware may send more.
    ///
    /// # Errors
    /// When a sub-payload is damaged or shorter than its fields.
    pub fn decode(payload: &[u8]) -> Result<(Self, u32), PayloadError> {
        check_payload(payload, payload.len(), min_feedback_bytes)?;
        let (mut feedback, mut unknown) = (Self::default(), 0);
        for part in sub_payloads(payload) {
            unknown += u32::from(!feedback.take(part));
        }
        Ok((feedback, unknown))
    }

    /// Stores a sub-payload; returns false for an unknown one.
    fn take(&mut self, part: SubPayload<'_>) -> bool {
        let data = Fields(part.data);
        match part.id {
            1 => self.core = CoreSensors::decode(data),
            3 => self.dock = decode_dock(data),
            4 => self.inertia = Inertia::decode(data),
            5 => self.cliff = CliffSignals::decode(data),
            6 => self.currents = MotorCurrents::decode(data),
            10 => self.hardware = Version::decode(part.data),
            11 => self.firmware = Version::decode(part.data),
            13 => self.gyro = RawGyro::decode(data),
            16 => self.inputs = GeneralInputs::decode(data),
            19 => self.unique_id = UniqueId::decode(data),
            21 => self.gains = Gains::decode(data),
            _ => return false,
        }
        true
    }

    /// The whole frame of this packet.
    pub fn encode(&self) -> Vec<u8> {
        let parts = [
            (1, self.core.map(|core| core.data())),
            (3, self.dock.as_ref().map(dock_data)),
            (4, self.inertia.map(Inertia::data)),
            (5, self.cliff.map(CliffSignals::data)),
            (6, self.currents.map(|currents| vec![currents.left, currents.right])),
            (13, self.gyro.as_ref().map(RawGyro::data)),
            (16, self.inputs.map(GeneralInputs::data)),
            (10, self.hardware.map(Version::data)),
            (11, self.firmware.map(Version::data)),
            (19, self.unique_id.map(UniqueId::data)),
            (21, self.gains.map(Gains::data)),
        ];
        let mut payload = Vec::new();
        for (id, data) in parts {
            if let Some(data) = data {
                push_sub_payload(&mut payload, id, &data);
            }
        }
        frame(&payload)
    }
}

/// Minimum length of the data of a feedback sub-payload, bytes; `None` for an unknown identifier.
///
/// The length of the fields that are read. Source: the protocol's "Feedback Packets"; versions had two bytes in the first firmwares.
pub fn min_feedback_bytes(id: u8) -> Option<usize> {
    match id {
        1 => Some(15),
        3 => Some(3),
        4 => Some(4),
        5 => Some(6),
        6 | 10 | 11 | 13 => Some(2),
        16 => Some(10),
        19 => Some(12),
        21 => Some(13),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn full() -> Feedback {
        Feedback {
            core: Some(CoreSensors { stamp_ms: 65_500, battery_decivolts: 157, ..CoreSensors::default() }),
            dock: Some(DockInfrared::default()),
            inertia: Some(Inertia { angle_centideg: -6245, rate_centideg_s: 17 }),
            cliff: Some(CliffSignals { right: 1, center: 2, left: 3 }),
            currents: Some(MotorCurrents { left: 4, right: 5 }),
            hardware: Some(Version::new(1, 0, 4)),
            firmware: Some(Version::new(1, 2, 0)),
            gyro: Some(RawGyro { frame_id: 7, readings: vec![[1, -2, 3]; 3] }),
            inputs: Some(GeneralInputs { digital: [true, false, false, true], analog: [1, 2, 3, 4095] }),
            unique_id: Some(UniqueId([1, 2, 3])),
            gains: Some(Gains::default()),
        }
    }

    #[test]
    fn every_sub_payload_comes_back() {
        let bytes = full().encode();
        assert_eq!(Feedback::decode(&bytes[3..bytes.len() - 1]), Ok((full(), 0)));
    }

    #[test]
    fn a_sub_payload_one_byte_below_its_minimum_is_refused_and_a_longer_one_is_read() {
        let bytes = full().encode();
        for part in sub_payloads(&bytes[3..bytes.len() - 1]) {
            let expected = min_feedback_bytes(part.id).unwrap();
            let with = |data: &[u8]| {
                let mut payload = Vec::new();
                push_sub_payload(&mut payload, part.id, data);
                Feedback::decode(&payload)
            };
            let short = PayloadError::Short { id: part.id, bytes: expected - 1, expected };
            assert_eq!(with(&part.data[..expected - 1]), Err(short));
            let enough = with(&part.data[..expected]).unwrap().0;
            assert_ne!(enough, Feedback::default(), "sub-payload {}", part.id);
            let longer = with(&[part.data, &[9; 4]].concat()).unwrap().0;
            assert_eq!(longer, with(part.data).unwrap().0, "sub-payload {}", part.id);
        }
    }

    #[test]
    fn unknown_sub_payloads_are_skipped_and_counted() {
        let (feedback, unknown) = Feedback::decode(&[2, 1, 9, 6, 2, 4, 5, 99, 0]).unwrap();
        assert_eq!((feedback.currents, unknown), (Some(MotorCurrents { left: 4, right: 5 }), 2));
    }
}
