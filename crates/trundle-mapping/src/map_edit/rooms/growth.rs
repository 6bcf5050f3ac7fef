//! Pieces of wide floor, grown over the whole floor.

use super::regions::{Regions, connected, neighbours};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use trundle_core::{Cell, OccupancyGrid};
use trundle_grid::DistanceField;

/// Steps of a metre to which clearances are rounded. Source: ours, 1 mm.
const CLEARANCE_STEPS_PER_M: f64 = 1000.0;

/// The pieces of the floor that are farther than `clearance` m from walls, and the floor that is connected with each, wide places first:
/// pieces meet at the narrowest places between them. Floor that is connected with no piece is a region of its own.
pub(super) fn grown(floor: &OccupancyGrid, field: &DistanceField, clearance: f64) -> Regions {
    let geometry = *floor.geometry();
    let is_floor = |i: usize| floor.cells()[i] == Cell::Free;
    let mut cells: Vec<Option<u32>> = vec![None; geometry.len()];
    let mut count = 0;
    let mut label_pieces = |cells: &mut Vec<Option<u32>>, is_member: &dyn Fn(usize) -> bool| {
        for start in 0..geometry.len() {
            if cells[start].is_some() || !is_member(start) {
                continue;
            }
            cells[start] = Some(count);
            connected(&geometry, start, |near| {
                let is_new = cells[near].is_none() && is_member(near);
                if is_new {
                    cells[near] = Some(count);
                }
                is_new
            });
            count += 1;
        }
    };
    label_pieces(&mut cells, &|i| is_floor(i) && field.at_linear(i) > clearance);
    grow(&mut cells, floor, field);
    label_pieces(&mut cells, &is_floor);
    Regions::new(geometry, cells, count as usize)
}

/// Gives each cell of the floor the label of a neighbour, the cells with the largest clearance first.
fn grow(cells: &mut [Option<u32>], floor: &OccupancyGrid, field: &DistanceField) {
    let geometry = floor.geometry();
    let clearance = |i: usize| (field.at_linear(i) * CLEARANCE_STEPS_PER_M) as u64;
    let mut order = 0_u64;
    let mut open: BinaryHeap<(u64, Reverse<u64>, usize)> = BinaryHeap::new();
    for i in (0..cells.len()).filter(|i| cells[*i].is_some()) {
        open.push((clearance(i), Reverse(order), i));
        order += 1;
    }
    while let Some((_, _, i)) = open.pop() {
        for near in neighbours(geometry, i).into_iter().flatten() {
            if cells[near].is_none() && floor.cells()[near] == Cell::Free {
                cells[near] = cells[i];
                open.push((clearance(near), Reverse(order), near));
                order += 1;
            }
        }
    }
}
