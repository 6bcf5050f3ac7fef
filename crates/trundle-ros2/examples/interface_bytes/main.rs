//! The structures of all interfaces as CDR bytes, for a comparison with another serialiser.
//!
//! `interface_bytes write` prints a line `NAME HEX JSON` per structure, filled with distinct values. `interface_bytes read` reads lines
//! `NAME HEX` from stdin and prints `NAME HEX JSON`, HEX written again from the values that were read. NAME is `package/msg/Name`,
//! `package/srv/Name_Request`, `package/action/Name_Goal`, `package/action/Name_SendGoal_Request`. HEX are the bytes with their
//! encapsulation. `bench/ros2/tests/serialiser.py` compares the lines with rclpy.

#[rustfmt::skip]
mod all;
mod filler;
mod structure;

use std::io::{BufRead, Write};
use std::process::ExitCode;
use structure::{Encoded, Structure};

fn main() -> ExitCode {
    let mode = std::env::args().nth(1).unwrap_or_default();
    let written = match mode.as_str() {
        "write" => write(&mut std::io::stdout()),
        "read" => read(&mut std::io::stdin().lock(), &mut std::io::stdout()),
        _ => Err(format!("interface_bytes: '{mode}', expected write or read")),
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            // Without a place for the message, the exit code has to do.
            let _ = writeln!(std::io::stderr(), "{why}");
            ExitCode::FAILURE
        }
    }
}

fn write(out: &mut impl Write) -> Result<(), String> {
    all::structures().iter().try_for_each(|structure| print(out, structure, (structure.filled)()?))
}

fn read(lines: &mut impl BufRead, out: &mut impl Write) -> Result<(), String> {
    let structures = all::structures();
    for line in lines.lines() {
        let line = line.map_err(|e| format!("stdin: {e}"))?;
        let mut words = line.split_whitespace();
        let (Some(name), Some(hex)) = (words.next(), words.next()) else {
            return Err(format!("stdin: '{line}', expected NAME HEX"));
        };
        let structure = structures.iter().find(|structure| structure.name == name);
        let structure = structure.ok_or_else(|| format!("{name}: no such structure in the table"))?;
        let bytes =
            bytes_of(hex).ok_or_else(|| format!("{name}: '{hex}', expected pairs of hexadecimal digits"))?;
        let decoded = (structure.decoded)(&bytes).map_err(|why| format!("{name}: {why}"))?;
        print(out, structure, decoded)?;
    }
    Ok(())
}

fn print(out: &mut impl Write, structure: &Structure, encoded: Encoded) -> Result<(), String> {
    let hex: String = encoded.bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    writeln!(out, "{} {hex} {}", structure.name, encoded.fields).map_err(|e| format!("stdout: {e}"))
}

fn bytes_of(hex: &str) -> Option<Vec<u8>> {
    let pairs = hex.as_bytes().chunks(2).map(|pair| std::str::from_utf8(pair).ok());
    pairs.map(|pair| u8::from_str_radix(pair?, 16).ok()).collect()
}
