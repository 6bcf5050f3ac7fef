use super::live_body::Arrived;
use super::memory::MemoryCurve;
use crate::failure::Failure;
use crate::pace::Pace;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::time::{Duration, Instant};
use trundle::core::{RobotBody, SensorEvent, Twist2};
use trundle::io::EncodedEvent;
use trundle::runtime::Histogram;
use trundle::runtime::real_time::{InboxDoor, Place, Post};
use trundle::sim::{CameraAside, Shot, Simulator};

/// The simulator living beside the robot: a thread for the base, one for the camera.
pub struct World {
    commands: Sender<Twist2>,
    stop: Arc<AtomicBool>,
    contacts: Arc<AtomicU32>,
    ended: Receiver<Result<WorldReport, Failure>>,
    _pools: [ThreadPool; 2],
}

/// How the simulator kept time: where it did not, the robot's figures are not the robot's alone.
#[derive(Debug, Clone, Default, Serialize)]
pub struct WorldReport {
    /// How late the base was with its readings, 999 of 1000 at most, ms.
    pub lateness_p999_ms: f64,
    /// The most, ms.
    pub lateness_most_ms: f64,
    /// Images that the camera had no time to take.
    pub images_not_taken: u64,
    /// Images taken.
    pub images: u64,
    /// From the moment of an image to its arrival at the robot, median, ms.
    pub image_age_median_ms: f64,
    /// Of the same, 99 of 100 at most.
    pub image_age_p99_ms: f64,
    /// Resident memory of the program.
    #[serde(skip)]
    pub memory: MemoryCurve,
}

/// What the two threads share.
#[derive(Clone)]
struct Shared {
    door: InboxDoor<Arrived>,
    stop: Arc<AtomicBool>,
    not_taken: Arc<AtomicU64>,
    /// What the body has touched by now.
    contacts: Arc<AtomicU32>,
    /// The moment of simulated time 0.
    origin: Instant,
}

impl World {
    /// Lets `body` live by the clock on the wall at `place`; what its sensors say goes to `door`.
    pub fn start(mut body: Simulator, door: InboxDoor<Arrived>, place: Place) -> Result<Self, Failure> {
        // The base is hardware to the robot: it keeps its time whatever the camera does.
        let pools = [pool("camera", place)?, pool("base", Place { is_first: true, ..place })?];
        let stop = Arc::<AtomicBool>::default();
        let contacts = Arc::<AtomicU32>::default();
        let shared = Shared {
            door,
            stop: Arc::clone(&stop),
            not_taken: Arc::default(),
            contacts: Arc::clone(&contacts),
            origin: Instant::now(),
        };
        let (commands, orders) = channel();
        let (shots, to_take) = sync_channel(1);
        let (ages, aged) = channel();
        if let Some(camera) = body.detach_camera() {
            let shared = shared.clone();
            pools[0].spawn(move || _ = ages.send(take(camera, &to_take, &shared)));
        }
        let (end, ended) = channel();
        pools[1].spawn(move || {
            let base = live(body, &orders, shots, &shared);
            // Without a camera there are no ages.
            let ages = aged.recv().unwrap_or_else(|_| Ok(Histogram::default()));
            let report = base.and_then(|report| with_ages(report, &ages?));
            let _ = end.send(report);
        });
        Ok(Self { commands, stop, contacts, ended, _pools: pools })
    }

    /// Where commands go.
    pub fn commands(&self) -> Sender<Twist2> {
        self.commands.clone()
    }

    /// What the body has touched by now, in truth.
    pub fn contacts(&self) -> Arc<AtomicU32> {
        Arc::clone(&self.contacts)
    }

    /// Ends both threads.
    pub fn stop(self) -> Result<WorldReport, Failure> {
        self.stop.store(true, Ordering::Relaxed);
        let gone = |_| Failure::Environment("the simulator's thread has died".to_owned());
        self.ended.recv().map_err(gone)?
    }
}

fn pool(name: &'static str, place: Place) -> Result<ThreadPool, Failure> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(1)
        .thread_name(move |_| name.to_owned())
        .start_handler(move |_| _ = place.take())
        .build();
    pool.map_err(|error| Failure::Environment(format!("cannot start a thread: {error}")))
}

/// The base: a millisecond at a time.
fn live(
    mut body: Simulator,
    orders: &Receiver<Twist2>,
    shots: SyncSender<Shot>,
    shared: &Shared,
) -> Result<WorldReport, Failure> {
    let refused = |error: trundle::sim::SimError| Failure::Input(error.to_string());
    let mut pace = Pace::start_at(shared.origin);
    let (mut lateness, mut images, mut memory) = (Histogram::default(), 0, MemoryCurve::default());
    while !shared.stop.load(Ordering::Relaxed) {
        let time = body.stamp().as_secs();
        let late = pace.wait_for(time);
        for twist in orders.try_iter() {
            body.command(twist).map_err(refused)?;
        }
        let events = body.advance().map_err(refused)?;
        shared.contacts.store(body.contacts(), Ordering::Relaxed);
        for event in events {
            if matches!(event, SensorEvent::Wheels(_)) {
                lateness.note(late * 1e3);
                memory.look(time);
            }
            send(&event, &shared.door)?;
        }
        for shot in body.shots() {
            images += 1;
            shared.not_taken.fetch_add(u64::from(shots.try_send(shot).is_err()), Ordering::Relaxed);
        }
    }
    Ok(WorldReport {
        lateness_p999_ms: lateness.quantile(0.999).unwrap_or_default(),
        lateness_most_ms: lateness.most().unwrap_or_default(),
        images_not_taken: shared.not_taken.load(Ordering::Relaxed),
        images,
        memory,
        ..WorldReport::default()
    })
}

fn send(event: &SensorEvent, door: &InboxDoor<Arrived>) -> Result<(), Failure> {
    let is_image = matches!(event, SensorEvent::Rgbd(_));
    let event = EncodedEvent::encode(event).map_err(|error| Failure::Input(error.to_string()))?;
    let arrived = Arrived { event, at: Instant::now() };
    door.put(if is_image { Post::Patient(arrived) } else { Post::Urgent(arrived) });
    Ok(())
}

/// The camera: an image at a time; how old they were when they left, ms.
fn take(mut camera: CameraAside, shots: &Receiver<Shot>, shared: &Shared) -> Result<Histogram, Failure> {
    let mut ages = Histogram::default();
    for shot in shots {
        let image = camera.take(&shot).map_err(|error| Failure::Input(error.to_string()))?;
        let taken = shared.origin + Duration::from_secs_f64(shot.stamp().as_secs());
        let arrival = taken + Duration::from_secs_f64(shot.delay());
        std::thread::sleep(arrival.saturating_duration_since(Instant::now()));
        send(&SensorEvent::Rgbd(image), &shared.door)?;
        ages.note(taken.elapsed().as_secs_f64() * 1e3);
    }
    Ok(ages)
}

fn with_ages(report: WorldReport, ages: &Histogram) -> Result<WorldReport, Failure> {
    let age = |fraction| ages.quantile(fraction).unwrap_or_default();
    Ok(WorldReport { image_age_median_ms: age(0.5), image_age_p99_ms: age(0.99), ..report })
}
