//! Another program as planner: one process per problem, the problem on its standard input, the answer on its standard output.

use super::judge::Judged;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use trundle_docking::corridor::{Problem, ProblemAnswer, parse_answers, write};

/// Interval between two looks at a running planner: 2 ms, small against the time limit. Source: ours.
const POLL: Duration = Duration::from_millis(2);
/// Longest answer that is read: 1 MB, a manoeuvre of over 10,000 pieces. Source: ours.
const MAX_ANSWER_BYTES: u64 = 1_000_000;

/// Answers of a planner, evaluated, and its times.
#[derive(Debug, Default)]
pub struct Entry {
    judged: Judged,
    /// Wall time of each process, its start included, ms.
    times_ms: Vec<f64>,
}

/// Runs `program` on each problem, for at most `limit` each. A process that fails, or whose answer is not readable, has a wrong answer.
///
/// # Errors
///
/// If the program cannot be started.
pub fn run(program: &str, problems: &[Problem], limit: Duration) -> Result<Entry, String> {
    let mut entry = Entry::default();
    for problem in problems {
        let child = start(program)?;
        let begin = Instant::now();
        let answer = answer(child, problem, limit);
        entry.times_ms.push(begin.elapsed().as_secs_f64() * 1e3);
        match answer {
            Ok(answer) => entry.judged.note(problem, Some(&answer)),
            Err(reason) => entry.judged.refuse(problem, &reason),
        }
    }
    Ok(entry)
}

fn start(program: &str) -> Result<Child, String> {
    let mut command = Command::new(program);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    command.spawn().map_err(|e| format!("cannot start the planner {program}: {e}"))
}

/// The answer of a started process, or the reason why there is none.
fn answer(mut child: Child, problem: &Problem, limit: Duration) -> Result<ProblemAnswer, String> {
    let text = write(std::slice::from_ref(problem));
    let (input, output) = (child.stdin.take(), child.stdout.take());
    // A planner that ends without reading its input is no error of the input: its answer counts.
    let writer = thread::spawn(move || input.map(|mut input| input.write_all(text.as_bytes())));
    let reader = thread::spawn(move || {
        let mut text = String::new();
        let read = output.map(|output| output.take(MAX_ANSWER_BYTES).read_to_string(&mut text));
        read.map_or(Err("standard output is closed".to_owned()), |read| read.map_err(|e| e.to_string()))
            .map(|_| text)
    });
    let status = wait(&mut child, limit);
    let _ = writer.join();
    let printed = reader.join().map_err(|_| "standard output cannot be read")?;
    let status = status?;
    if !status.success() {
        return Err(format!("the planner ends with {status}, expected exit code 0"));
    }
    let answers = parse_answers(&printed?).map_err(|e| format!("the answer is not readable: {e}"))?;
    match <[ProblemAnswer; 1]>::try_from(answers) {
        Ok([answer]) if answer.problem == problem.name => Ok(answer),
        Ok([answer]) => Err(format!("the answer is to problem `{}`", answer.problem)),
        Err(answers) => Err(format!("{} answers, expected one", answers.len())),
    }
}

/// Waits for the end of a process; ends it at the limit.
fn wait(child: &mut Child, limit: Duration) -> Result<std::process::ExitStatus, String> {
    let begin = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status),
            Ok(None) if begin.elapsed() < limit => thread::sleep(POLL),
            Ok(None) => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("no answer after {} s", limit.as_secs_f64()));
            }
            Err(e) => return Err(format!("the planner cannot be waited for: {e}")),
        }
    }
}

impl Entry {
    /// The evaluation of the answers, and the times.
    pub fn summary(&self) -> String {
        let mut times = self.times_ms.clone();
        times.sort_by(f64::total_cmp);
        let at = |share: f64| times.get((share * times.len() as f64) as usize).or(times.last());
        let ms = |share| at(share).copied().unwrap_or(0.0);
        format!(
            "{}\nprocess: median {:.1} ms, p99 {:.1} ms, its start included",
            self.judged.summary(),
            ms(0.5),
            ms(0.99)
        )
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;
    use trundle_docking::corridor::Scenario;

    /// Runs a shell script as planner of the paper's scenarios.
    fn run_script(script: &str) -> Entry {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("planner");
        std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        let problems = Scenario::ALL.map(Scenario::problem);
        run(path.to_str().unwrap(), &problems, Duration::from_millis(500)).unwrap()
    }

    #[test]
    fn an_answer_on_standard_output_is_evaluated() {
        let entry = run_script(
            "name=$(sed -n 's/^problem //p'); printf 'trundle-answers 1\\nproblem %s\\nturn -90\\ndrive 0.2\\nturn 90\\n' $name",
        );
        // The manoeuvre by hand of scenarios a and c. It touches a box in b, and ends beside the goal in d.
        assert_eq!((entry.judged.times.len(), entry.judged.wrong.len()), (2, 2), "{}", entry.summary());
    }

    #[test]
    fn failures_of_a_planner_are_wrong_answers_with_a_reason() {
        let wrong = |script, reason: &str| {
            let entry = run_script(script);
            assert_eq!(entry.judged.wrong.len(), 4, "{}", entry.summary());
            assert!(entry.judged.wrong.iter().all(|line| line.contains(reason)), "{}", entry.summary());
        };
        wrong("exit 3", "exit status: 3");
        wrong("echo nonsense", "not readable");
        wrong("exec sleep 30", "no answer after 0.5 s");
        wrong("printf 'trundle-answers 1\\nproblem other\\nturn 3\\n'", "is to problem `other`");
        wrong("printf 'trundle-answers 1\\n'", "0 answers");
    }

    #[test]
    fn a_missing_planner_is_named() {
        let error = run("/no/planner", &Scenario::ALL.map(Scenario::problem), Duration::from_secs(1));
        assert!(error.unwrap_err().contains("/no/planner"));
    }
}
