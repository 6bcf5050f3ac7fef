//! The exit codes of a program that runs commands, and their text for its help.

/// The run missed its goal or a limit. Source: ours.
pub const CODE_MISSED: u8 = 1;
/// The input or the place to write to has to change first; nothing was written. Source: ours.
pub const CODE_BAD_INPUT: u8 = 2;
/// The run worked, but its results could not all be written. Source: ours.
pub const CODE_INCOMPLETE: u8 = 3;

/// The exit codes, for the help.
pub const EXIT_CODES: &str = "Exit codes:\n  \
    0  done\n  \
    1  the run missed its goal or a limit\n  \
    2  bad input, nothing is written\n  \
    3  the run worked, but its results could not all be written\n  \
    130, 143  stopped by Ctrl-C or SIGTERM; what was done until then is written\n\n\
    A folder of results is replaced only where trundle made it, and the last run is kept as NAME.1.";
