//! A board of markers of the family tag36h11, in the layout of Kalibr's aprilgrid.

use super::board_view::{BoardPoint, BoardProblem, BoardView};
use super::tags::{TAG_COUNT, Tag, TagSearch, find_tags};
use trundle_core::{GrayImage, Vector2};

/// A grid of markers, seen from the front. Ids run along the rows, from the lower left marker to the right, then row by row upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TagBoard {
    /// Markers along a row.
    pub columns: usize,
    /// Markers down a column.
    pub rows: usize,
    /// Side of a marker's black square, m.
    pub side: f64,
    /// Space between two markers over the side.
    pub gap_ratio: f64,
    /// Id of the lower left marker.
    pub first_id: usize,
}

/// Smallest number of markers of a view: 4, of a board of fewer all. Source: ours; the pose by fewer is uncertain.
const MIN_TAGS: usize = 4;
/// Largest number of ids that a message lists. Source: ours.
const MAX_LISTED_IDS: usize = 8;

impl TagBoard {
    /// Ids on the board.
    #[must_use]
    pub fn ids(&self) -> std::ops::Range<usize> {
        self.first_id..self.first_id + self.columns * self.rows
    }

    /// Whether the family has an id for each marker.
    #[must_use]
    pub fn is_in_family(&self) -> bool {
        self.ids().end <= TAG_COUNT
    }

    /// Corners of a marker's black square on the board, m, x right and y down from the upper left corner of the board. Order: upper left,
    /// upper right, lower right, lower left. `None` for an id that is not on the board.
    #[must_use]
    pub fn corners(&self, id: usize) -> Option<[Vector2; 4]> {
        let index = self.ids().contains(&id).then(|| id - self.first_id)?;
        let (column, row) = (index % self.columns, self.rows - 1 - index / self.columns);
        let upper_left = Vector2::new(column as f64, row as f64) * (self.side * (1.0 + self.gap_ratio));
        let offsets = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        Some(offsets.map(|(x, y)| upper_left + Vector2::new(x, y) * self.side))
    }

    /// The corners of the markers in an image. A part of the board is enough.
    pub(super) fn find(&self, image: &GrayImage) -> Result<BoardView, BoardProblem> {
        let found = find_tags(image);
        let minimum = MIN_TAGS.min(self.columns * self.rows);
        let (ids, end) = (self.ids(), self.ids().end - 1);
        let expected = format!("tags {} to {end}", ids.start);
        if found.tags.is_empty() {
            return Err(problem_without_tags(&found, expected));
        }
        let foreign: Vec<usize> =
            found.tags.iter().map(|tag| tag.id).filter(|id| !ids.contains(id)).collect();
        if !foreign.is_empty() {
            return Err(BoardProblem::ForeignTags { ids: listed(&foreign), expected });
        }
        if let Some(pair) = found.tags.windows(2).find(|pair| pair[0].id == pair[1].id) {
            return Err(BoardProblem::RepeatedTag { id: pair[0].id });
        }
        if found.tags.len() < minimum {
            return Err(BoardProblem::TooFewTags { found: found.tags.len(), minimum });
        }
        Ok(BoardView { points: found.tags.iter().flat_map(|tag| self.points(tag)).collect() })
    }

    fn points(&self, tag: &Tag) -> Vec<BoardPoint> {
        let corners = self.corners(tag.id).into_iter().flatten();
        corners.zip(tag.corners).map(|(board, pixel)| BoardPoint { board, pixel }).collect()
    }
}

fn problem_without_tags(found: &TagSearch, expected: String) -> BoardProblem {
    if found.mirrored > 0 {
        return BoardProblem::Mirrored { tags: found.mirrored };
    }
    match found.unknown.iter().min() {
        Some(wrong_cells) => {
            BoardProblem::OtherFamily { squares: found.unknown.len(), wrong_cells: *wrong_cells, expected }
        }
        None => BoardProblem::NoTags { expected },
    }
}

fn listed(ids: &[usize]) -> String {
    let shown: Vec<String> = ids.iter().take(MAX_LISTED_IDS).map(usize::to_string).collect();
    let more = if ids.len() > MAX_LISTED_IDS { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_run_from_the_lower_left_marker_upwards() {
        let board = TagBoard { columns: 3, rows: 2, side: 0.1, gap_ratio: 0.5, first_id: 10 };
        let upper_left = |id: usize| board.corners(id).unwrap()[0];
        assert!((upper_left(10) - Vector2::new(0.0, 0.15)).norm() < 1e-12);
        assert!((upper_left(12) - Vector2::new(0.3, 0.15)).norm() < 1e-12);
        assert!((upper_left(13) - Vector2::zeros()).norm() < 1e-12);
        assert!((board.corners(13).unwrap()[2] - Vector2::repeat(0.1)).norm() < 1e-12);
        assert_eq!((board.corners(9), board.corners(16)), (None, None));
    }
}
