//! Commands that run until Ctrl-C.

/// Exit code of a program that ends by Ctrl-C. Source: the convention of shells, 128 and the number of the signal.
const INTERRUPTED_EXIT_CODE: u32 = 130;
/// Time between Ctrl-C and the end of a program by force \[s\]. Source: ours, results are written within a second.
const MAX_END_S: u32 = 60;

/// A script that interrupts each command of `text` after `seconds`, as Ctrl-C does. A command may also end before, and well.
pub fn script(text: &str, seconds: u32) -> String {
    let joined = text.replace("\\\n", " ");
    let commands = joined.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let one = |command: &str| {
        format!(
            "if timeout --foreground --preserve-status --signal=INT --kill-after={MAX_END_S} {seconds} {command}\n\
             then :; else end=$?; [ $end -eq {INTERRUPTED_EXIT_CODE} ] || exit $end; fi\n"
        )
    };
    commands.map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(text: &str) -> Option<i32> {
        let mut shell = std::process::Command::new("sh");
        shell.args(["-e", "-u", "-c", &script(text, 1)]);
        shell.status().unwrap().code()
    }

    #[test]
    fn a_command_may_end_well_or_by_ctrl_c_and_not_otherwise() {
        let lasting = "sh -c 'trap \"exit 130\" INT; while :; do sleep 0.05; done'";
        assert_eq!(end(&format!("true   # a comment\n\n{lasting}  # until Ctrl-C\n")), Some(0));
        assert_eq!(end("sh -c \\\n  'exit 3'\ntrue\n"), Some(3));
        assert_eq!(end("sh -c 'trap \"exit 4\" INT; while :; do sleep 0.05; done'\n"), Some(4));
    }
}
