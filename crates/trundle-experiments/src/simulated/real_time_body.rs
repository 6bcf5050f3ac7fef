//! The simulator in real time in parallel with the robot: a thread for the base, one for the camera.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::time::{Duration, Instant};
use trundle_app::AppError;
use trundle_app::real_time::{BackgroundBody, BodyTiming, Lateness, MemoryUsage, RealTimePacer, TimedEvent};
use trundle_core::{RobotBody, SensorEvent, Twist2};
use trundle_io::EncodedEvent;
use trundle_runtime::Histogram;
use trundle_runtime::real_time::{InboxItem, InboxSender, ThreadPlacement};
use trundle_sim::{DetachedCamera, Shot, Simulator};

/// The simulator in real time in parallel with the robot: a thread for the base, one for the camera.
pub struct SimulatedRealTimeBody {
    commands: Sender<Twist2>,
    stop: Arc<AtomicBool>,
    contacts: Arc<AtomicU32>,
    ended: Receiver<Result<BodyTiming, AppError>>,
    _pools: [ThreadPool; 2],
}

/// State shared by the two threads.
#[derive(Clone)]
struct Shared {
    events: InboxSender<TimedEvent>,
    stop: Arc<AtomicBool>,
    not_taken: Arc<AtomicU64>,
    /// Number of contacts so far.
    contacts: Arc<AtomicU32>,
    /// Wall-clock time of simulated time 0.
    origin: Instant,
}

impl SimulatedRealTimeBody {
    /// Starts the threads of `body` at `place`; its events go to `events`.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        mut body: Simulator,
        events: InboxSender<TimedEvent>,
        place: ThreadPlacement,
    ) -> Result<Self, AppError> {
        // Like hardware, the base has a timing independent of the camera.
        let pools = [pool("camera", place)?, pool("base", ThreadPlacement { is_first: true, ..place })?];
        let stop = Arc::<AtomicBool>::default();
        let contacts = Arc::<AtomicU32>::default();
        let shared = Shared {
            events,
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
            // Without a camera the histogram is empty.
            let ages = aged.recv().unwrap_or_else(|_| Ok(Histogram::default()));
            let report = base.and_then(|report| with_ages(report, &ages?));
            let _ = end.send(report);
        });
        Ok(Self { commands, stop, contacts, ended, _pools: pools })
    }
}

impl BackgroundBody for SimulatedRealTimeBody {
    fn commands(&self) -> Sender<Twist2> {
        self.commands.clone()
    }

    fn contacts(&self) -> Option<Arc<AtomicU32>> {
        Some(Arc::clone(&self.contacts))
    }

    fn stop(self) -> Result<BodyTiming, AppError> {
        self.stop.store(true, Ordering::Relaxed);
        let gone = |_| AppError::Environment("the simulator's thread has died".to_owned());
        self.ended.recv().map_err(gone)?
    }
}

fn pool(name: &'static str, place: ThreadPlacement) -> Result<ThreadPool, AppError> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(1)
        .thread_name(move |_| name.to_owned())
        .start_handler(move |_| _ = place.take())
        .build();
    pool.map_err(|error| AppError::Environment(format!("cannot start a thread: {error}")))
}

/// The base, in steps of one millisecond.
fn live(
    mut body: Simulator,
    orders: &Receiver<Twist2>,
    shots: SyncSender<Shot>,
    shared: &Shared,
) -> Result<BodyTiming, AppError> {
    let refused = |error: trundle_sim::SimError| AppError::Input(error.to_string());
    let mut pacer = RealTimePacer::start_at(shared.origin);
    let (mut lateness, mut images, mut memory) = (Histogram::default(), 0, MemoryUsage::default());
    while !shared.stop.load(Ordering::Relaxed) {
        let time = body.stamp().as_secs();
        let late = pacer.wait_for(time);
        for twist in orders.try_iter() {
            body.command(twist).map_err(refused)?;
        }
        let events = body.advance().map_err(refused)?;
        shared.contacts.store(body.contacts(), Ordering::Relaxed);
        for event in events {
            if matches!(event, SensorEvent::Wheels(_)) {
                lateness.note(late * 1e3);
                memory.sample(time);
            }
            send(&event, &shared.events)?;
        }
        for shot in body.shots() {
            images += 1;
            shared.not_taken.fetch_add(u64::from(shots.try_send(shot).is_err()), Ordering::Relaxed);
        }
    }
    Ok(BodyTiming {
        lateness: Some(Lateness {
            p999_ms: lateness.quantile(0.999).unwrap_or_default(),
            max_ms: lateness.max().unwrap_or_default(),
        }),
        images_not_taken: shared.not_taken.load(Ordering::Relaxed),
        images,
        memory,
        ..BodyTiming::default()
    })
}

fn send(event: &SensorEvent, events: &InboxSender<TimedEvent>) -> Result<(), AppError> {
    let is_image = matches!(event, SensorEvent::Rgbd(_));
    let event = EncodedEvent::encode(event).map_err(|error| AppError::Input(error.to_string()))?;
    let arrived = TimedEvent::now(event);
    events.put(if is_image { InboxItem::Deferred(arrived) } else { InboxItem::Urgent(arrived) });
    Ok(())
}

/// The camera, one image at a time; returns the images' ages at delivery, ms.
fn take(mut camera: DetachedCamera, shots: &Receiver<Shot>, shared: &Shared) -> Result<Histogram, AppError> {
    let mut ages = Histogram::default();
    for shot in shots {
        let image = camera.take(&shot).map_err(|error| AppError::Input(error.to_string()))?;
        let taken = shared.origin + Duration::from_secs_f64(shot.stamp().as_secs());
        let arrival = taken + Duration::from_secs_f64(shot.delay());
        std::thread::sleep(arrival.saturating_duration_since(Instant::now()));
        send(&SensorEvent::Rgbd(image), &shared.events)?;
        ages.note(taken.elapsed().as_secs_f64() * 1e3);
    }
    Ok(ages)
}

fn with_ages(report: BodyTiming, ages: &Histogram) -> Result<BodyTiming, AppError> {
    let age = |fraction| ages.quantile(fraction).unwrap_or_default();
    Ok(BodyTiming { image_age_median_ms: age(0.5), image_age_p99_ms: age(0.99), ..report })
}
