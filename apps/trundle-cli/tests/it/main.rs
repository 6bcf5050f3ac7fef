//! The program as its users meet it: arguments in, files, sentences and exit codes out.

mod bad_input;
mod demo;
mod plan;
mod program;
mod slam;
