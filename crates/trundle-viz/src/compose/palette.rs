//! One colour per meaning, in every picture of the project.

use crate::color::Color;
use crate::map::{DotStyle, LineStyle};

pub(super) const ESTIMATE: Color = Color::BLUE;
pub(super) const TRUTH: Color = Color::ORANGE;
pub(super) const PLAN: Color = Color::rgb(0xb0_4f_88);
pub(super) const START: Color = Color::GREEN;
pub(super) const GOAL: Color = Color::VERMILLION;
pub(super) const SWEPT: Color = Color::SKY.alpha(70);
pub(super) const FORBIDDEN: Color = Color::VERMILLION.alpha(120);
pub(super) const HIGH_COST: Color = Color::PURPLE.alpha(150);
pub(super) const SLOW: Color = Color::YELLOW.alpha(150);
pub(super) const LANDMARKS: Color = Color::GREEN;
pub(super) const SCAN: Color = Color::SKY;

/// Plan, truth and estimate have decreasing widths: all remain visible where they agree.
pub(super) fn plan_line() -> LineStyle {
    LineStyle::solid(PLAN.alpha(95)).width(7.0).plain()
}

pub(super) fn truth_line() -> LineStyle {
    LineStyle::solid(TRUTH).width(3.4).plain()
}

pub(super) fn estimate_line() -> LineStyle {
    LineStyle::solid(ESTIMATE).width(1.4).plain()
}

pub(super) fn way_point_dots() -> DotStyle {
    DotStyle::circles(PLAN)
}
