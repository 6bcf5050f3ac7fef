//! Laws of log-odds grids, scan rasterisation, published grids and compact tiles, and refused settings.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod lines;
mod maps;
mod scans;
mod settings;
