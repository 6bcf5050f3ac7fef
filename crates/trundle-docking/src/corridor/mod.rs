//! Corridor problems: a generator, the four scenarios of \[Hong24\], and a text format. See `docs/corridor-benchmark.md`.

mod answers;
mod format;
mod generate;
mod problem;
mod scenarios;

pub use answers::{PathPiece, ProblemAnswer, parse_answers, time_of, write_answers};
pub use format::{parse, write};
pub use generate::generate;
pub use problem::Problem;
pub use scenarios::Scenario;
