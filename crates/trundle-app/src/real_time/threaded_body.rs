//! The body of a real-time run: it joins the control thread with the threads of the sensors and the workers.

use super::{BackgroundBody, BodyTiming, QueueLength, RealTimeReport, ThreadLoad, TimedEvent};
use crate::{AppError, DisplayedState, EncodedBody, FinishedRun, RunInput, StateDisplay};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};
use trundle_core::Twist2;
use trundle_io::EncodedEvent;
use trundle_runtime::real_time::{
    Inbox, InboxItem, InboxSender, Input as Got, LoopTimer, LoopTimerConfig, ThreadPlacement, WorkerThreads,
};
use trundle_runtime::{Answer, Histogram, Job, Worker};

/// The body of a real-time run. The control thread takes events and answers from its inbox, and hands jobs to its worker threads.
pub struct ThreadedBody {
    inbox: Inbox<TimedEvent>,
    worker_threads: Option<WorkerThreads>,
    loop_timer: LoopTimer,
    commands: Option<Sender<Twist2>>,
    /// When the newest wheel reading arrived; `None` once its command was sent.
    reading: Option<Instant>,
    /// The workers that have a job, with its start.
    busy: BTreeMap<Worker, Instant>,
    /// Time from the start of a job to the use of its result \[ms\].
    waits: BTreeMap<Worker, Histogram>,
    costs: Vec<ThreadLoad>,
    /// Number of separate contacts of the true robot, counted by the simulator; `None` on a real robot.
    contacts: Option<Arc<AtomicU32>>,
    state_display: Option<StateDisplay>,
}

/// Largest number of events that wait for the control thread: those of some seconds. Further events are refused. Source: ours.
const INBOX_CAPACITY: usize = 1024;
/// Time without any event after which the body counts as lost. Source: ours.
const BODY_TIMEOUT: Duration = Duration::from_secs(5);

impl ThreadedBody {
    /// Starts the worker threads on the processor cores of `workers`.
    pub fn start(config: LoopTimerConfig, workers: ThreadPlacement) -> Result<Self, AppError> {
        let inbox = Inbox::new(INBOX_CAPACITY);
        let sender: InboxSender<TimedEvent> = inbox.sender();
        let worker_threads =
            WorkerThreads::start(workers, move |answer| _ = sender.send_waiting(InboxItem::Answer(answer)));
        let worker_threads = worker_threads
            .map_err(|error| AppError::Environment(format!("cannot start a thread: {error}")))?;
        Ok(Self {
            inbox,
            worker_threads: Some(worker_threads),
            loop_timer: LoopTimer::new(config.validated()?),
            commands: None,
            reading: None,
            busy: BTreeMap::new(),
            waits: BTreeMap::new(),
            costs: Vec::new(),
            contacts: None,
            state_display: None,
        })
    }

    /// Takes the events of the threads that read the sensors.
    pub fn event_sender(&self) -> InboxSender<TimedEvent> {
        self.inbox.sender()
    }

    /// From now on, sends commands to `body`, shows the state of the run by its lights and sounds, and reads the number of contacts, if a
    /// simulator counts them.
    pub fn connect(&mut self, body: &mut impl BackgroundBody) {
        self.commands = Some(body.commands());
        self.contacts = body.contacts();
        self.state_display = body.state_display();
    }

    fn wait_for_input(&mut self) -> Option<RunInput> {
        match self.inbox.next(&self.loop_timer, BODY_TIMEOUT)? {
            Got::Event(TimedEvent { event, at }) => {
                if matches!(event, EncodedEvent::Wheels(_) | EncodedEvent::Odometry(_)) {
                    self.loop_timer.begin();
                    self.reading = Some(at);
                }
                Some(RunInput::Event(event))
            }
            Got::Answer(answer) => {
                self.on_answer(answer.worker());
                Some(RunInput::Answer(answer))
            }
        }
    }

    fn on_answer(&mut self, worker: Worker) {
        if let Some(since) = self.busy.remove(&worker) {
            self.waits.entry(worker).or_default().note(since.elapsed().as_secs_f64() * 1e3);
        }
    }

    /// Load, delays and queue lengths of a finished run.
    pub fn report(mut self, run: &FinishedRun, control: Duration, body: BodyTiming) -> RealTimeReport {
        let part = |spent: Duration| spent.as_secs_f64() / run.seconds;
        let mut load = vec![ThreadLoad { thread: "control".to_owned(), part: part(control) }];
        for cost in self.worker_threads.take().map(WorkerThreads::finish).unwrap_or_default() {
            let thread = format!("{:?}", cost.worker).to_lowercase();
            load.push(ThreadLoad { thread, part: part(cost.spent) });
        }
        load.push(ThreadLoad { thread: "recorder".to_owned(), part: part(run.recording.cpu_time) });
        load.append(&mut self.costs);
        let queues = [("control", self.inbox.lengths()), ("recorder", &run.recording.queue_lengths)];
        RealTimeReport {
            control: self.loop_timer.report(),
            load_total: load.iter().map(|load| load.part).sum(),
            load,
            queues: queues.iter().filter_map(|(name, lengths)| QueueLength::of(name, lengths)).collect(),
            refused: self.inbox.refused(),
            lines_lost: run.recording.lines_lost,
            memory: body.memory.clone(),
            body,
            interrupted: run.log.is_interrupted(),
        }
    }
}

impl EncodedBody for ThreadedBody {
    fn next_input(&mut self) -> Result<Option<RunInput>, AppError> {
        Ok(self.wait_for_input())
    }

    fn send_command(&mut self, twist: Twist2) -> Result<(), AppError> {
        // A disconnected base takes no commands; its missing readings end the run.
        let _ = self.commands.as_ref().map(|commands| commands.send(twist));
        if let Some(arrival) = self.reading.take() {
            self.loop_timer.end(arrival);
        }
        Ok(())
    }

    fn start_job(&mut self, job: Job) {
        self.busy.insert(job.worker(), Instant::now());
        if let Some(worker_threads) = &self.worker_threads {
            worker_threads.give(job);
        }
    }

    fn finish_job(&mut self, worker: Worker) -> Option<Answer> {
        self.busy.get(&worker)?;
        let answer = self.inbox.next_answer(worker, BODY_TIMEOUT)?;
        self.on_answer(worker);
        Some(answer)
    }

    fn show_state(&mut self, run: &DisplayedState<'_>) {
        if let Some(display) = &mut self.state_display {
            display(run);
        }
    }

    fn true_contacts(&self) -> Option<u32> {
        self.contacts.as_ref().map(|contacts| contacts.load(Ordering::Relaxed))
    }
}
