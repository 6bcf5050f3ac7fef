//! Charts as inline SVG: lines and bars.

mod axes;
mod bars;
mod line;
mod thin;

pub use bars::BarChart;
pub use line::Chart;
