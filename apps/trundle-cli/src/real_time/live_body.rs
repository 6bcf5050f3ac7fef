use super::{Load, QueueLength, Timing, WorldReport};
use crate::body::{Input, WiredBody};
use crate::failure::Failure;
use crate::run::Run;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};
use trundle::core::Twist2;
use trundle::io::EncodedEvent;
use trundle::runtime::real_time::{Crew, Inbox, InboxDoor, Input as Got, Place, Post, Pulse, PulseConfig};
use trundle::runtime::{Answer, Helper, Histogram, Job};

/// An event and when it arrived.
pub struct Arrived {
    pub event: EncodedEvent,
    pub at: Instant,
}

/// The body as the control thread meets it: events and answers come through the inbox, jobs go to the crew.
pub struct LiveBody {
    inbox: Inbox<Arrived>,
    crew: Option<Crew>,
    pulse: Pulse,
    commands: Option<Sender<Twist2>>,
    stop: Arc<AtomicBool>,
    /// When the reading at hand arrived, until its command leaves.
    reading: Option<Instant>,
    /// Helpers that are at work.
    busy: BTreeMap<Helper, Instant>,
    /// From giving a job to taking up its answer, ms.
    waits: BTreeMap<Helper, Histogram>,
    costs: Vec<Load>,
    /// What the body has touched, by the world's count.
    contacts: Arc<AtomicU32>,
}

/// Things that wait for the control thread at most: some seconds' worth.
const CAPACITY: usize = 1024;
/// When nothing comes for so long the body is gone.
const PATIENCE: Duration = Duration::from_secs(5);

impl LiveBody {
    /// Starts the crew at `helpers`.
    pub fn start(config: PulseConfig, helpers: Place, stop: Arc<AtomicBool>) -> Result<Self, Failure> {
        let inbox = Inbox::new(CAPACITY);
        let door: InboxDoor<Arrived> = inbox.door();
        let crew = Crew::start(helpers, move |answer| _ = door.hand_in(Post::Answer(answer)));
        let crew = crew.map_err(|error| Failure::Environment(format!("cannot start a thread: {error}")))?;
        Ok(Self {
            inbox,
            crew: Some(crew),
            pulse: Pulse::new(config.validated()?),
            commands: None,
            stop,
            reading: None,
            busy: BTreeMap::new(),
            waits: BTreeMap::new(),
            costs: Vec::new(),
            contacts: Arc::default(),
        })
    }

    /// The way in.
    pub fn door(&self) -> InboxDoor<Arrived> {
        self.inbox.door()
    }

    /// Commands go there from now on, and the world counts there what the body touches.
    pub fn listen(&mut self, commands: Sender<Twist2>, contacts: Arc<AtomicU32>) {
        self.commands = Some(commands);
        self.contacts = contacts;
    }

    fn wait_for_input(&mut self) -> Option<Input> {
        match self.inbox.next(&self.pulse, PATIENCE)? {
            Got::Event(Arrived { event, at }) => {
                if matches!(event, EncodedEvent::Wheels(_)) {
                    self.pulse.begin();
                    self.reading = Some(at);
                }
                Some(Input::Event(event))
            }
            Got::Answer(answer) => {
                self.is_back(answer.helper());
                Some(Input::Answer(answer))
            }
        }
    }

    fn is_back(&mut self, helper: Helper) {
        if let Some(since) = self.busy.remove(&helper) {
            self.waits.entry(helper).or_default().note(since.elapsed().as_secs_f64() * 1e3);
        }
    }

    /// How the run kept time, when it is over.
    pub fn timing(mut self, run: &Run, control: Duration, world: WorldReport) -> Timing {
        let part = |spent: Duration| spent.as_secs_f64() / run.seconds;
        let mut load = vec![Load { thread: "control".to_owned(), part: part(control) }];
        for cost in self.crew.take().map(Crew::dismiss).unwrap_or_default() {
            let thread = format!("{:?}", cost.helper).to_lowercase();
            load.push(Load { thread, part: part(cost.spent) });
        }
        load.push(Load { thread: "recorder".to_owned(), part: part(run.tape.spent) });
        load.append(&mut self.costs);
        let queues = [("control", self.inbox.lengths()), ("recorder", &run.tape.waiting)];
        Timing {
            control: self.pulse.report(),
            load_total: load.iter().map(|load| load.part).sum(),
            load,
            queues: queues.iter().filter_map(|(name, lengths)| QueueLength::of(name, lengths)).collect(),
            refused: self.inbox.refused(),
            lines_lost: run.tape.lost,
            memory: world.memory.clone(),
            world,
            interrupted: self.stop.load(Ordering::Relaxed),
        }
    }
}

impl WiredBody for LiveBody {
    fn next_input(&mut self) -> Result<Option<Input>, Failure> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(Some(Input::Interrupted));
        }
        Ok(self.wait_for_input())
    }

    fn command(&mut self, twist: Twist2) -> Result<(), Failure> {
        // A base that is gone takes no commands; the missing readings tell.
        let _ = self.commands.as_ref().map(|commands| commands.send(twist));
        if let Some(arrival) = self.reading.take() {
            self.pulse.end(arrival);
        }
        Ok(())
    }

    fn give(&mut self, job: Job) {
        self.busy.insert(job.helper(), Instant::now());
        if let Some(crew) = &self.crew {
            crew.give(job);
        }
    }

    fn last_answer(&mut self, helper: Helper) -> Option<Answer> {
        self.busy.get(&helper)?;
        let answer = self.inbox.next_answer(helper, PATIENCE)?;
        self.is_back(helper);
        Some(answer)
    }

    fn contacts(&self) -> Option<u32> {
        Some(self.contacts.load(Ordering::Relaxed))
    }
}
