//! Charts as inline SVG: lines and bars.

mod axes;
mod bars;
mod groups;
mod line;
mod standalone;
mod thin;

pub use bars::BarChart;
pub use groups::GroupChart;
pub use line::Chart;
