//! The start of a base: checks that the link has exactly one Kobuki, and its version.

use super::base_config::KobukiBaseConfig;
use super::base_status::Versions;
use super::decoder::FeedbackDecoder;
use super::link::ByteLink;
use super::protocol::{BaseControl, Feedback, KobukiCommand};
use super::start_error::StartError;
use super::stream_check::{StreamCheck, StreamFault};
use crate::clock::HostClock;
use std::time::Duration;

/// Number of packets read before the base counts as found: 12, enough for two stamps of a second base. Source: ours.
const MIN_PACKETS: u64 = 12;
/// Time between requests for the versions: 0.5 s. Source: ours.
const REQUEST_PERIOD_S: f64 = 0.5;
/// Number of bytes shown of another device's data: 16. Source: ours.
const MAX_SHOWN_BYTES: usize = 16;
/// Longest wait per read: 10 ms. Source: ours, half a packet's period.
const READ_WAIT: Duration = Duration::from_millis(10);
/// Major version of the firmware with this protocol: 1. Source: the vendor's driver, compatible major version.
const FIRMWARE_MAJOR: u8 = 1;

/// Bytes that the start has read so far.
struct Probe<'a> {
    link: &'a mut dyn ByteLink,
    decoder: FeedbackDecoder,
    check: StreamCheck,
    versions: Versions,
    packets: u64,
    bytes: u64,
    first_bytes: Vec<u8>,
}

/// Commands at the beginning of every connection: zero speed, and the request for versions and unique id.
pub(super) fn greeting() -> Vec<u8> {
    let request = KobukiCommand::RequestExtra { hardware: true, firmware: true, unique_id: true };
    [KobukiCommand::BaseControl(BaseControl::STOP).encode(), request.encode()].concat()
}

/// Stops the base, and waits until it sent packets and its versions.
///
/// # Errors
/// When no packet comes within the start limit, the stream has two sources, the firmware is of another major version, or the link breaks.
pub(super) fn probe(
    link: &mut dyn ByteLink,
    port: &str,
    config: &KobukiBaseConfig,
    clock: &HostClock,
) -> Result<(FeedbackDecoder, Versions), StartError> {
    let mut probe = Probe {
        link,
        decoder: FeedbackDecoder::default(),
        check: StreamCheck::default(),
        versions: Versions::default(),
        packets: 0,
        bytes: 0,
        first_bytes: Vec::new(),
    };
    let broken = |source| StartError::Link { port: port.to_owned(), source };
    probe.run(config.start_limit_s, clock).map_err(broken)?;
    probe.judge(port, config.start_limit_s)?;
    Ok((probe.decoder, probe.versions))
}

impl Probe<'_> {
    fn run(&mut self, limit_s: f64, clock: &HostClock) -> std::io::Result<()> {
        let (start, mut requests) = (clock(), 0.0);
        while clock() - start < limit_s && !self.is_done() {
            if clock() - start >= requests * REQUEST_PERIOD_S {
                self.link.write(&greeting())?;
                requests += 1.0;
            }
            self.read()?;
        }
        Ok(())
    }

    fn is_done(&self) -> bool {
        self.packets >= MIN_PACKETS && self.versions.is_complete()
    }

    fn read(&mut self) -> std::io::Result<()> {
        let mut buffer = [0; 512];
        let bytes = self.link.read(&mut buffer, READ_WAIT)?;
        self.bytes += bytes as u64;
        let shown = bytes.min(MAX_SHOWN_BYTES - self.first_bytes.len());
        self.first_bytes.extend(&buffer[..shown]);
        let refused = self.decoder.counters().refused();
        let Self { decoder, check, versions, packets, .. } = self;
        decoder.push(&buffer[..bytes], |feedback: Feedback| {
            versions.update(&feedback);
            if let Some(core) = feedback.core {
                check.on_packet(core.stamp_ms);
                *packets += 1;
            }
        });
        check.on_refused(decoder.counters().refused() - refused);
        Ok(())
    }

    /// Whether the bytes read are those of a usable Kobuki.
    fn judge(&self, port: &str, waited_s: f64) -> Result<(), StartError> {
        let port = port.to_owned();
        if self.bytes == 0 {
            return Err(StartError::NoBytes { port, waited_s });
        }
        if self.packets == 0 {
            let shown: Vec<String> = self.first_bytes.iter().map(|byte| format!("{byte:02X}")).collect();
            let (bytes, refused) = (self.bytes, self.decoder.counters().refused());
            return Err(StartError::NotAKobuki {
                port,
                waited_s,
                bytes,
                refused,
                first_bytes: shown.join(" "),
            });
        }
        match self.check.fault() {
            Some(fault @ StreamFault::TwoSources { .. }) => return Err(StartError::Stream { port, fault }),
            Some(fault) => tracing::warn!("port {port}: {fault}"),
            None => {}
        }
        self.judge_firmware(port)
    }

    fn judge_firmware(&self, port: String) -> Result<(), StartError> {
        match self.versions.firmware {
            Some(firmware) if firmware.major != FIRMWARE_MAJOR => {
                return Err(StartError::Firmware { port, firmware });
            }
            _ => {}
        }
        self.versions.firmware_fault().iter().for_each(|fault| tracing::warn!("port {port}: {fault}"));
        Ok(())
    }
}
