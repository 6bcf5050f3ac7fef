//! The robot in real time: threads, queues, cores.
//!
//! The control thread feeds a [`crate::Robot`] with background jobs from an [`Inbox`]. [`WorkerThreads`] runs the jobs, one thread for each
//! worker. Events and results in the same order give the same reports.
//!
//! The control loop of a robot; the driver's threads put sensor events into the inbox:
//!
//! ```no_run
//! use std::time::Duration;
//! use trundle_core::{SensorEvent, Twist2};
//! use trundle_runtime::real_time::{WorkerThreads, Inbox, Input, ThreadPlacement, InboxItem, LoopTimer, LoopTimerConfig};
//! use trundle_runtime::{LazyImage, Robot, RobotConfig};
//!
//! # fn drive(base: impl Fn(Twist2)) -> Result<(), Box<dyn std::error::Error>> {
//! let mut robot = Robot::new(RobotConfig::default())?.with_background_jobs();
//! let mut inbox: Inbox<SensorEvent> = Inbox::new(1024);
//! let sender = inbox.sender(); // for the driver's threads: sender.put(InboxItem::Urgent(wheels)), sender.put(InboxItem::Deferred(image))
//! let answers = inbox.sender();
//! let workers = ThreadPlacement { core: Some(1), nice: 5, is_first: false };
//! let worker_threads = WorkerThreads::start(workers, move |answer| _ = answers.send_waiting(InboxItem::Answer(answer)))?;
//! ThreadPlacement { core: Some(1), nice: 0, is_first: true }.take();
//! let mut pulse = LoopTimer::new(LoopTimerConfig::default());
//! while let Some(input) = inbox.next(&pulse, Duration::from_millis(200)) {
//!     let arrival = std::time::Instant::now();
//!     let report = match input {
//!         Input::Event(SensorEvent::Rgbd(image)) => robot.queue_image(LazyImage::from(image)),
//!         Input::Event(event) => {
//!             if matches!(event, SensorEvent::Wheels(_)) {
//!                 pulse.begin();
//!             }
//!             robot.step(&event)
//!         }
//!         Input::Answer(answer) => robot.apply_answer(answer),
//!     };
//!     if let Some(twist) = report.twist {
//!         base(twist);
//!         pulse.end(arrival);
//!     }
//!     while let Some(job) = robot.next_job() {
//!         worker_threads.give(job);
//!     }
//! }
//! base(Twist2::ZERO); // no command for 0.2 s
//! # drop(sender);
//! # Ok(()) }
//! ```

mod inbox;
mod loop_timer;
mod thread_placement;
mod worker_threads;

pub use inbox::{Inbox, InboxItem, InboxSender, Input};
pub use loop_timer::{LoopTimer, LoopTimerConfig, LoopTimerReport};
pub use thread_placement::{ThreadPlacement, thread_time};
pub use worker_threads::{WorkerCost, WorkerThreads};
