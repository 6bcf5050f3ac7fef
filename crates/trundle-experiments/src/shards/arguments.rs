//! The arguments that decide on the runs of an experiment.

/// Options that differ between the shards of one experiment, or that the manifest stores separately.
const LEFT_OUT: [&str; 10] = [
    "--shard",
    "--run",
    "--out",
    "--threads",
    "--live",
    "--live-tokens",
    "--live-certificate",
    "--live-key",
    "--config",
    "--set",
];
/// Such options without a value.
const FLAGS_LEFT_OUT: [&str; 4] = ["-q", "--quiet", "-v", "--verbose"];

/// The words after `trundle experiment` without the options that differ between the shards of one experiment.
///
/// `faults --seeds 4 --shard 1/2 --out part1` gives `faults --seeds 4`.
pub fn shard_arguments(words: impl IntoIterator<Item = String>) -> Vec<String> {
    let (mut kept, mut is_left_out) = (Vec::new(), false);
    for word in words {
        if word.starts_with('-') {
            let name = word.split('=').next().unwrap_or_default();
            let is_flag = FLAGS_LEFT_OUT.contains(&name) || name.strip_prefix('-').is_some_and(is_verbosity);
            is_left_out = LEFT_OUT.contains(&name) && name == word;
            if is_flag || LEFT_OUT.contains(&name) {
                continue;
            }
        } else if is_left_out {
            continue;
        }
        kept.push(word);
    }
    kept
}

/// Whether the letters are those of the short options `-v`, as in `-vv`, and `-q`.
fn is_verbosity(letters: &str) -> bool {
    !letters.is_empty() && letters.chars().all(|letter| letter == 'v' || letter == 'q')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(line: &str) -> String {
        shard_arguments(line.split(' ').map(str::to_owned)).join(" ")
    }

    #[test]
    fn options_of_the_shard_and_of_the_output_are_left_out() {
        for line in [
            "faults --seeds 4 --shard 1/2 --out part1",
            "-vv faults --shard=2/2 --seeds 4 -q --threads 3 --out=x --live --set a=1 --set=b=2",
            "faults --live 127.0.0.1:80 --seeds 4 --config r.toml --run name",
        ] {
            assert_eq!(kept(line), "faults --seeds 4", "{line}");
        }
        assert_eq!(kept("barn --worlds 2-5 --data=x --shard 1/2"), "barn --worlds 2-5 --data=x");
    }
}
