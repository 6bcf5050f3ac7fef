//! The worker threads that run the jobs.

use super::{ThreadPlacement, thread_time};
use crate::workers::job::{Answer, Job, Worker};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// The robot's workers, one thread each. Parallel loops of a worker run on its own thread.
#[derive(Debug)]
pub struct WorkerThreads {
    handles: Vec<WorkerHandle>,
}

#[derive(Debug)]
struct WorkerHandle {
    worker: Worker,
    jobs: SyncSender<Job>,
    /// Processor time of the thread, sent at its end.
    spent: Receiver<Duration>,
    _pool: ThreadPool,
}

/// Processor time of a worker's thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WorkerCost {
    /// The worker.
    pub worker: Worker,
    /// Processor time.
    pub spent: Duration,
}

impl WorkerThreads {
    /// Starts the workers at `place`; `report` is called in their threads with every answer.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        place: ThreadPlacement,
        report: impl Fn(Answer) + Clone + Send + 'static,
    ) -> Result<Self, ThreadPoolBuildError> {
        let start = |worker| WorkerHandle::start(worker, place, report.clone());
        Ok(Self { handles: Worker::ALL.into_iter().map(start).collect::<Result<_, _>>()? })
    }

    /// Sends a job to its worker. The robot sends a worker its next job after the result of the previous one.
    pub fn give(&self, job: Job) {
        let handle = self.handles.iter().find(|handle| handle.worker == job.worker());
        // A worker with an ended thread gives no result. The robot continues, and the safety monitor stops it because of old data.
        let _ = handle.map(|handle| handle.jobs.try_send(job));
    }

    /// Waits for the running jobs and ends the threads; returns the processor time of each.
    pub fn finish(self) -> Vec<WorkerCost> {
        let end = |handle: WorkerHandle| {
            let WorkerHandle { worker, jobs, spent, _pool } = handle;
            drop(jobs);
            WorkerCost { worker, spent: spent.recv().unwrap_or_default() }
        };
        self.handles.into_iter().map(end).collect()
    }
}

impl WorkerHandle {
    fn start(
        worker: Worker,
        place: ThreadPlacement,
        report: impl Fn(Answer) + Send + 'static,
    ) -> Result<Self, ThreadPoolBuildError> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(1)
            .thread_name(move |_| format!("{worker:?}").to_lowercase())
            .build()?;
        let (jobs, inbox) = sync_channel::<Job>(1);
        let (end, spent) = sync_channel(1);
        pool.spawn(move || {
            place.take();
            inbox.iter().for_each(|job| report(job.run()));
            let _ = end.send(thread_time().unwrap_or_default());
        });
        Ok(Self { worker, jobs, spent, _pool: pool })
    }
}
