//! Tests of the decision for every state, and of the bytes at an emulated base.

use super::*;
use trundle_runtime::Reason;

/// Every state, with the light of a robot that is not held and whose mission is not over, and that of one whose mission is over.
fn states() -> Vec<(DriveState, Led, Led)> {
    let reason = || Reason::MovingObstacle;
    let stopped = |reason| DriveState::Stopped { reason };
    let (green, orange) = (Led::GREEN, Led::ORANGE);
    vec![
        (DriveState::Idle, green, green),
        (DriveState::Initializing, green, green),
        (DriveState::Planning, green, green),
        (DriveState::Driving, green, green),
        (DriveState::FinalApproach, green, green),
        (DriveState::Maneuvering, green, green),
        (DriveState::Waiting { reason: reason() }, orange, orange),
        (DriveState::Recovering { reason: reason() }, orange, orange),
        (DriveState::Lost { reason: reason() }, orange, orange),
        (DriveState::Arrived, green, green),
        (stopped(reason()), orange, Led::RED),
        (stopped(Reason::TasksFailed(Vec::new())), orange, Led::RED),
        (stopped(Reason::Interrupted), Led::OFF, Led::OFF),
    ]
}

fn run_state(state: &DriveState, is_finished: bool, is_held: bool, tasks_done: usize) -> DisplayedState<'_> {
    DisplayedState { state, is_finished, is_held, tasks_done }
}

#[test]
fn every_state_has_its_light() {
    for (state, under_way, over) in states() {
        assert_eq!(light_of(&run_state(&state, false, false, 0)), under_way, "{state}");
        assert_eq!(light_of(&run_state(&state, true, false, 0)), over, "{state} at the end");
        for (is_finished, free) in [(false, under_way), (true, over)] {
            let held = light_of(&run_state(&state, is_finished, true, 0));
            let expected = if free == Led::GREEN { Led::ORANGE } else { free };
            assert_eq!(held, expected, "{state} while held");
        }
    }
}

#[test]
fn every_change_has_its_melody() {
    let lights = [Led::OFF, Led::GREEN, Led::ORANGE, Led::RED];
    for light in lights {
        let now = Shown { light, tasks_done: 3 };
        assert_eq!(melody_of(None, now), Some(SoundSequence::CleaningStart), "the run begins");
        for (before, tasks_done) in lights.into_iter().flat_map(|led| [(led, 2), (led, 3), (led, 4)]) {
            let turns_red = light == Led::RED && before != Led::RED;
            let expected = match tasks_done {
                _ if turns_red => Some(SoundSequence::Error),
                // A new mission has no task that is done.
                3 | 4 => None,
                _ => Some(SoundSequence::CleaningEnd),
            };
            assert_eq!(
                melody_of(Some(Shown { light: before, tasks_done }), now),
                expected,
                "{before} to {light}"
            );
        }
    }
}

#[cfg(unix)]
mod at_a_base {
    use super::*;
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::sync::{Arc, Mutex};
    use std::time::{Duration, Instant};
    use trundle_core::{Stamp, Twist2};
    use trundle_drivers::kobuki::protocol::KobukiCommand;
    use trundle_drivers::kobuki::{
        ByteLink, EmulatedKobuki, KobukiBase, KobukiBaseConfig, KobukiState, PseudoTerminal, SerialConnector,
    };

    /// Longest wait on a loaded machine.
    const LIMIT: Duration = Duration::from_secs(30);

    /// What an emulated base has received.
    #[derive(Default)]
    struct Received {
        lights: Vec<Led>,
        melodies: Vec<SoundSequence>,
        twists: Vec<Twist2>,
    }

    /// An emulated base at a pseudo terminal; it ends with the sender.
    fn emulate(port: &std::path::Path, received: Arc<Mutex<Received>>) -> Sender<()> {
        let (sender, end) = channel();
        let mut terminal = PseudoTerminal::open_at(port).unwrap();
        std::thread::spawn(move || {
            let mut base = EmulatedKobuki::default();
            while !is_over(&end) {
                std::thread::sleep(Duration::from_millis(20));
                let mut bytes = [0; 4096];
                let length = terminal.read(&mut bytes, Duration::ZERO).unwrap();
                for byte in bytes[..length].chunks(1) {
                    note(&mut base, byte, &mut received.lock().unwrap());
                }
                let _ = terminal.write(&base.feedback(&KobukiState::default()));
            }
        });
        sender
    }

    fn is_over(end: &Receiver<()>) -> bool {
        matches!(end.try_recv(), Err(std::sync::mpsc::TryRecvError::Disconnected))
    }

    fn note(base: &mut EmulatedKobuki, byte: &[u8], received: &mut Received) {
        let before = base.outputs();
        received.twists.extend(base.on_bytes(byte));
        if base.outputs() != before {
            assert_eq!(Outputs { led1: Led::OFF, ..base.outputs() }, Outputs::default(), "supplies stay on");
            received.lights.push(base.outputs().led1);
        }
        received.melodies.extend(base.take_sounds().into_iter().filter_map(|sound| match sound {
            KobukiCommand::SoundSequence(melody) => Some(melody),
            _ => None,
        }));
    }

    fn wait_for(what: &str, mut condition: impl FnMut() -> bool) {
        let start = Instant::now();
        while !condition() {
            assert!(start.elapsed() < LIMIT, "waited in vain: {what}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn started(port: &std::path::Path) -> KobukiBase {
        let mut config = KobukiBaseConfig::default();
        (config.silence_limit_s, config.start_limit_s) = (5.0, 30.0);
        let start = Instant::now();
        let clock = Arc::new(move || Stamp::default().after(start.elapsed().as_secs_f64()));
        let connector = Box::new(SerialConnector::new(port));
        let base = KobukiBase::start(connector, config, clock, Box::new(drop)).unwrap();
        wait_for("the link", || base.is_up());
        base
    }

    #[test]
    fn each_change_arrives_once_and_the_base_does_not_move() {
        let folder = tempfile::tempdir().unwrap();
        let (port, received) = (folder.path().join("kobuki"), Arc::new(Mutex::new(Received::default())));
        let _end = emulate(&port, Arc::clone(&received));
        let base = started(&port);
        let mut signals = StateSignals::new(base.accessories());
        let reason = || Reason::MovingObstacle;
        let (driving, waiting) = (DriveState::Driving, DriveState::Waiting { reason: reason() });
        let stopped = DriveState::Stopped { reason: reason() };
        for (state, is_finished, is_held, tasks_done) in [
            (&driving, false, false, 0),
            (&driving, false, false, 0),
            (&waiting, false, false, 0),
            (&waiting, false, true, 0),
            (&driving, false, false, 0),
            (&driving, false, false, 1),
            (&driving, false, true, 1),
            (&stopped, true, false, 1),
            (&stopped, true, false, 1),
        ] {
            (0..3).for_each(|_| signals.show(&run_state(state, is_finished, is_held, tasks_done)));
        }
        // The last signals arrive although the base is stopped at once.
        signals.end();
        base.stop();
        use SoundSequence::{CleaningEnd, CleaningStart, Error};
        let melodies = [CleaningStart, CleaningEnd, Error];
        wait_for("the last melody", || received.lock().unwrap().melodies == melodies);
        let received = received.lock().unwrap();
        assert_eq!(received.lights, [Led::GREEN, Led::ORANGE, Led::GREEN, Led::ORANGE, Led::RED]);
        assert!(received.twists.iter().all(|twist| *twist == Twist2::ZERO), "{:?}", received.twists);
    }

    #[test]
    fn the_light_goes_out_with_a_run_that_has_not_failed() {
        let folder = tempfile::tempdir().unwrap();
        let (port, received) = (folder.path().join("kobuki"), Arc::new(Mutex::new(Received::default())));
        let _end = emulate(&port, Arc::clone(&received));
        let base = started(&port);
        let mut signals = StateSignals::new(base.accessories());
        signals.end();
        signals.show(&run_state(&DriveState::Arrived, true, false, 1));
        signals.end();
        base.stop();
        wait_for("the dark", || received.lock().unwrap().lights == [Led::GREEN, Led::OFF]);
    }
}
