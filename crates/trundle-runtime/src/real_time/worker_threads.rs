//! The worker threads that run the jobs.

use super::{ThreadPlacement, thread_time};
use crate::workers::job::{Answer, Job, Worker};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// The robot's helpers, a thread each. What they compute in parallel they compute on that one thread.
#[derive(Debug)]
pub struct WorkerThreads {
    posts: Vec<HelperPost>,
}

#[derive(Debug)]
struct HelperPost {
    helper: Worker,
    jobs: SyncSender<Job>,
    /// Processor time of the thread, sent at its end.
    spent: Receiver<Duration>,
    _pool: ThreadPool,
}

/// Processor time of a worker's thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WorkerCost {
    /// The worker.
    pub helper: Worker,
    /// Processor time.
    pub spent: Duration,
}

impl WorkerThreads {
    /// Starts the helpers at `place`; `report` is called in their threads with every answer.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        place: ThreadPlacement,
        report: impl Fn(Answer) + Clone + Send + 'static,
    ) -> Result<Self, ThreadPoolBuildError> {
        let post = |helper| HelperPost::start(helper, place, report.clone());
        Ok(Self { posts: Worker::ALL.into_iter().map(post).collect::<Result<_, _>>()? })
    }

    /// Gives a job to its helper, who is free: a robot gives no job to one who has one.
    pub fn give(&self, job: Job) {
        let post = self.posts.iter().find(|post| post.helper == job.worker());
        // A worker whose thread has ended gives no result. The robot continues without, and the safety monitor stops it on old data.
        let _ = post.map(|post| post.jobs.try_send(job));
    }

    /// Sends the helpers home, when they have done what they are at.
    pub fn dismiss(self) -> Vec<WorkerCost> {
        let end = |post: HelperPost| {
            let HelperPost { helper, jobs, spent, _pool } = post;
            drop(jobs);
            WorkerCost { helper, spent: spent.recv().unwrap_or_default() }
        };
        self.posts.into_iter().map(end).collect()
    }
}

impl HelperPost {
    fn start(
        helper: Worker,
        place: ThreadPlacement,
        report: impl Fn(Answer) + Send + 'static,
    ) -> Result<Self, ThreadPoolBuildError> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(1)
            .thread_name(move |_| format!("{helper:?}").to_lowercase())
            .build()?;
        let (jobs, inbox) = sync_channel::<Job>(1);
        let (end, spent) = sync_channel(1);
        pool.spawn(move || {
            place.take();
            inbox.iter().for_each(|job| report(job.run()));
            let _ = end.send(thread_time().unwrap_or_default());
        });
        Ok(Self { helper, jobs, spent, _pool: pool })
    }
}
