//! Pictures and the report.
