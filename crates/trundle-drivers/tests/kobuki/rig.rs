//! A driver with its device.

use crate::device::{Device, Sends};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use trundle_core::{BodyEvent, BodyEventKind, Device as BodyDevice, Link, SensorEvent, Stamp, Twist2};
use trundle_drivers::clock::HostClock;
use trundle_drivers::kobuki::protocol::Version;
use trundle_drivers::kobuki::{KobukiBase, KobukiBaseConfig, SerialConnector, StartError};

/// Longer than a loaded machine needs.
const LIMIT: Duration = Duration::from_secs(30);

/// A configuration for a machine that may stall for seconds.
pub fn patient() -> KobukiBaseConfig {
    let mut config = KobukiBaseConfig::default();
    config.silence_limit_s = 5.0;
    config.start_limit_s = 30.0;
    config.transport_delay_s = 0.0;
    config
}

/// The host's clock.
pub fn clock() -> HostClock {
    let start = Instant::now();
    Arc::new(move || Stamp::from_nanos(start.elapsed().as_nanos() as i64))
}

/// Waits until `condition` holds.
#[track_caller]
pub fn wait_for(what: &str, mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < LIMIT, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A driver, the device it drives, and the events it gave.
pub struct Rig {
    pub base: KobukiBase,
    pub device: Device,
    events: Arc<Mutex<Vec<SensorEvent>>>,
}

impl Rig {
    pub fn start(name: &str, sends: Sends) -> Self {
        Self::with(name, sends, patient())
    }

    pub fn with(name: &str, sends: Sends, config: KobukiBaseConfig) -> Self {
        let device = Device::plugged(name, sends, Version::new(1, 2, 0));
        let events = Arc::new(Mutex::new(Vec::new()));
        let received = Arc::clone(&events);
        let sink = Box::new(move |event| received.lock().unwrap().push(event));
        let connector = Box::new(SerialConnector::new(device.port()));
        let base = KobukiBase::start(connector, config, clock(), sink).unwrap();
        Self { base, device, events }
    }

    pub fn events(&self) -> Vec<SensorEvent> {
        self.events.lock().unwrap().clone()
    }

    pub fn has_event(&self, is_it: impl Fn(&SensorEvent) -> bool) -> bool {
        self.events.lock().unwrap().iter().any(is_it)
    }

    /// The states of the link so far.
    pub fn links(&self) -> Vec<bool> {
        let is_up = |event: &SensorEvent| match event {
            SensorEvent::Body(BodyEvent { kind: BodyEventKind::Link(Link { device, is_up }), .. }) => {
                assert_eq!(*device, BodyDevice::Base);
                Some(*is_up)
            }
            _ => None,
        };
        self.events.lock().unwrap().iter().filter_map(is_up).collect()
    }

    /// Sends a speed repeatedly until it arrives.
    #[track_caller]
    pub fn drive(&self, twist: Twist2) {
        let commands = self.base.commands();
        wait_for("the speed at the device", || {
            commands.send(twist).unwrap();
            self.device.state().twists.last().is_some_and(|last| is_near(*last, twist))
        });
    }
}

/// Whether two twists differ by less than the protocol's resolution.
pub fn is_near(a: Twist2, b: Twist2) -> bool {
    (a.v - b.v).abs() < 0.004 && (a.omega - b.omega).abs() < 0.02
}

/// The error of a start at a device, within `start_limit_s`.
pub fn start_error(device: &Device, start_limit_s: f64) -> StartError {
    let mut config = patient();
    config.start_limit_s = start_limit_s;
    let connector = Box::new(SerialConnector::new(device.port()));
    KobukiBase::start(connector, config, clock(), Box::new(drop)).unwrap_err()
}
