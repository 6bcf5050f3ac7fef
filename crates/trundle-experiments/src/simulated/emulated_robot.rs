//! The simulator behind the wires of a real robot: a Kobuki at a pseudo terminal, a camera at a stream of frames.
//!
//! Any program for a Kobuki can drive the robot, which runs in real time with a packet every 20 ms.

use super::camera_server::CameraServer;
use std::path::Path;
use std::time::Duration;
use trundle_app::AppError;
use trundle_app::real_time::RealTimePacer;
use trundle_core::{BodyEvent, BodyEventKind, Pose2, RobotBody, SensorEvent, Twist2};
use trundle_drivers::kobuki::emulator::{EmulatedKobuki, KobukiState};
use trundle_drivers::kobuki::link::ByteLink;
use trundle_drivers::kobuki::protocol::{Charger, KobukiCommand};
use trundle_drivers::kobuki::pseudo_terminal::PseudoTerminal;
use trundle_sim::Simulator;

/// Maximum number of bytes of commands per read. Source: ours; a command has 10 bytes.
const READ_BYTES: usize = 4096;

/// The simulator behind the wires of a real robot.
pub struct EmulatedRobot {
    simulator: Simulator,
    /// The true pose at the start, world frame.
    start: Pose2,
    kobuki: EmulatedKobuki,
    state: KobukiState,
    terminal: PseudoTerminal,
    camera: Option<CameraServer>,
    /// The newest command, repeated to the simulator: a Kobuki keeps its speed until the next command.
    command: Twist2,
    counts: EmulationCounts,
}

/// Numbers of packets, commands and images over the wires.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EmulationCounts {
    /// Number of packets of the base.
    pub packets: u64,
    /// Number of speed commands.
    pub commands: u64,
    /// Number of images sent.
    pub images: u64,
    /// Number of images that no program read in time.
    pub images_not_taken: u64,
}

impl EmulatedRobot {
    /// The base of `simulator` at `terminal`, and its camera at the FIFO `camera_stream`, which is created if missing.
    ///
    /// # Errors
    /// When the FIFO cannot be created.
    pub fn new(
        mut simulator: Simulator,
        terminal: PseudoTerminal,
        camera_stream: Option<&Path>,
    ) -> Result<Self, AppError> {
        let info = super::camera_server::camera_info(simulator.config());
        let camera = simulator.detach_camera();
        let server = |path| CameraServer::start(path, info.clone());
        let camera =
            camera.zip(camera_stream).map(|(camera, path)| server(path)?.with_camera(camera)).transpose()?;
        Ok(Self {
            start: simulator.true_pose(),
            simulator,
            kobuki: EmulatedKobuki::default(),
            state: KobukiState::default(),
            terminal,
            camera,
            command: Twist2::ZERO,
            counts: EmulationCounts::default(),
        })
    }

    /// An emulated robot with its base at a new pseudo terminal, to which `port` becomes a symbolic link.
    ///
    /// # Errors
    /// When the pseudo terminal, the link or the FIFO cannot be created.
    pub fn at(simulator: Simulator, port: &Path, camera_stream: Option<&Path>) -> Result<Self, AppError> {
        let terminal = PseudoTerminal::open_at(port).map_err(|error| {
            AppError::Input(format!("{}: cannot create the pseudo terminal: {error}", port.display()))
        })?;
        Self::new(simulator, terminal, camera_stream)
    }

    /// Rows of the true pose and of the counts over the wires.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        let truth = self.start.inverse() * self.simulator.true_pose();
        let EmulationCounts { packets, commands, images, images_not_taken } = self.counts();
        let pose = format!("{:.3} m, {:.3} m, {:.2} deg", truth.x, truth.y, truth.theta.to_degrees());
        vec![
            row("true pose from the start", pose),
            row("true path", format!("{:.2} m", self.simulator.path_length())),
            row("true contacts", self.simulator.contacts().to_string()),
            row(
                "last command received",
                format!("{:.3} m/s, {:.3} rad/s", self.command.v, self.command.omega),
            ),
            row("packets sent, commands received", format!("{packets}, {commands}")),
            row("images sent, not taken", format!("{images}, {images_not_taken}")),
            row("first light", self.kobuki.outputs().led1.to_string()),
            row("melodies received", self.melodies()),
        ]
    }

    /// The melodies that the base was asked to play, in order.
    fn melodies(&self) -> String {
        let names = self.kobuki.sounds().iter().filter_map(|sound| match sound {
            KobukiCommand::SoundSequence(melody) => Some(melody.to_string()),
            _ => None,
        });
        let names: Vec<String> = names.collect();
        if names.is_empty() { "none".to_owned() } else { names.join(", ") }
    }

    /// The simulator: truth, contacts.
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// The counts so far.
    pub fn counts(&self) -> EmulationCounts {
        let (images, images_not_taken) = self.camera.as_ref().map_or((0, 0), CameraServer::counts);
        EmulationCounts { images, images_not_taken, ..self.counts }
    }

    /// Runs in real time until `is_over` is true, which is evaluated every millisecond.
    ///
    /// # Errors
    /// When the pseudo terminal breaks.
    pub fn run(&mut self, mut is_over: impl FnMut(&Simulator) -> bool) -> Result<(), AppError> {
        let origin = std::time::Instant::now() - Duration::from_secs_f64(self.simulator.stamp().as_secs());
        let mut pacer = RealTimePacer::start_at(origin);
        while !is_over(&self.simulator) {
            pacer.wait_for(self.simulator.stamp().as_secs());
            self.step()?;
        }
        Ok(())
    }

    /// A step of one millisecond: commands in, sensors out.
    fn step(&mut self) -> Result<(), AppError> {
        let mut bytes = [0; READ_BYTES];
        let length = self.terminal.read(&mut bytes, Duration::ZERO).map_err(broken)?;
        if let Some(twist) = self.kobuki.on_bytes(&bytes[..length]) {
            self.command = twist;
            self.counts.commands += 1;
        }
        self.simulator.command(self.command).map_err(AppError::input)?;
        let mut is_due = false;
        for event in self.simulator.advance().map_err(AppError::input)? {
            is_due |= matches!(event, SensorEvent::Wheels(_));
            note(&mut self.state, &event);
        }
        if let Some(camera) = &mut self.camera {
            self.simulator.shots().into_iter().for_each(|shot| camera.take(shot));
        }
        if is_due {
            let packet = self.kobuki.feedback(&self.state);
            self.counts.packets += 1;
            // A full line loses bytes, like a real one.
            self.terminal.write(&packet).map_err(broken)?;
        }
        Ok(())
    }
}

fn broken(error: std::io::Error) -> AppError {
    AppError::Environment(format!("the pseudo terminal of the emulated Kobuki is broken: {error}"))
}

/// Records a reading in the state of the next packet.
fn note(state: &mut KobukiState, event: &SensorEvent) {
    match event {
        SensorEvent::Wheels(wheels) => state.ticks = (wheels.left, wheels.right),
        SensorEvent::Gyro(gyro) => state.gyro_rate = gyro.omega,
        SensorEvent::Touch(touch) => state.bumper.center = touch.pressed,
        SensorEvent::Body(BodyEvent { kind: BodyEventKind::DockInfrared(light), .. }) => state.dock = *light,
        SensorEvent::Body(BodyEvent { kind: BodyEventKind::Battery(battery), .. }) => {
            state.charger = Charger { source: battery.source, is_charging: battery.is_charging };
            state.battery_v = battery.voltage_v;
        }
        SensorEvent::Cliff(cliff) => state.cliff.center = cliff.over_edge,
        _ => {}
    }
}
