//! The codes of the family tag36h11 \[Olson11\].

/// Number of markers of the family. Source: the family tag36h11, `data/README.md`.
pub const TAG_COUNT: usize = 587;
/// Cells along a side of a marker, its black border of one cell included. Source: the family tag36h11, `data/README.md`.
pub const TAG_CELLS: usize = 8;
/// Cells along a side of the code.
pub(super) const CODE_CELLS: usize = TAG_CELLS - 2;

/// Bits by row from the upper left cell, the first bit highest; 1 is white. Origin and licence: `data/README.md`.
const CODES: [u64; TAG_COUNT] = parsed(include_bytes!("../../../data/tag36h11.txt"));

/// Cells of a code, by row and column; `true` is white.
pub(super) type CodeCells = [[bool; CODE_CELLS]; CODE_CELLS];

/// Cells of a whole marker by row and column from the upper left; `true` is white. `None` for an id outside the family.
#[must_use]
pub fn tag_cells(id: usize) -> Option<[[bool; TAG_CELLS]; TAG_CELLS]> {
    let code = CODES.get(id)?;
    let mut cells = [[false; TAG_CELLS]; TAG_CELLS];
    for i in 0..CODE_CELLS * CODE_CELLS {
        let bit = code >> (CODE_CELLS * CODE_CELLS - 1 - i);
        cells[1 + i / CODE_CELLS][1 + i % CODE_CELLS] = bit & 1 == 1;
    }
    Some(cells)
}

/// A marker, turned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CodeMatch {
    /// Wrong cells.
    pub(super) distance: u32,
    pub(super) id: usize,
    /// Quarter turns: the marker's upper left corner is this corner of the cells, clockwise from the upper left.
    pub(super) turns: usize,
}

/// The nearest marker in any of four orientations; among equal ones the first.
pub(super) fn nearest_code(cells: &CodeCells) -> CodeMatch {
    let mut nearest = CodeMatch { distance: u32::MAX, id: 0, turns: 0 };
    let mut turned = *cells;
    for turns in 0..4 {
        let bits = turned.iter().flatten().fold(0_u64, |bits, cell| bits << 1 | u64::from(*cell));
        for (id, code) in CODES.iter().enumerate() {
            let distance = (code ^ bits).count_ones();
            if distance < nearest.distance {
                nearest = CodeMatch { distance, id, turns };
            }
        }
        turned = turned_left(&turned);
    }
    nearest
}

/// The cells with the upper right corner at the upper left.
fn turned_left(cells: &CodeCells) -> CodeCells {
    std::array::from_fn(|row| std::array::from_fn(|column| cells[column][CODE_CELLS - 1 - row]))
}

/// The cells seen from behind.
pub(super) fn mirrored(cells: &CodeCells) -> CodeCells {
    cells.map(|mut row| {
        row.reverse();
        row
    })
}

/// Hexadecimal numbers between blanks. Other text causes a compile error.
const fn parsed(text: &[u8]) -> [u64; TAG_COUNT] {
    let mut codes = [0; TAG_COUNT];
    let (mut i, mut count, mut is_inside) = (0, 0, false);
    while i < text.len() {
        let digit = match text[i] {
            byte @ b'0'..=b'9' => Some(byte - b'0'),
            byte @ b'a'..=b'f' => Some(byte - b'a' + 10),
            _ => None,
        };
        if let Some(digit) = digit {
            codes[count] = codes[count] << 4 | digit as u64;
        } else if is_inside {
            count += 1;
        }
        is_inside = digit.is_some();
        i += 1;
    }
    assert!(count == TAG_COUNT, "data/tag36h11.txt is not whole");
    codes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code_cells(id: usize) -> CodeCells {
        let cells = tag_cells(id).unwrap();
        std::array::from_fn(|row| std::array::from_fn(|column| cells[row + 1][column + 1]))
    }

    #[test]
    fn codes_differ_in_eleven_cells_in_every_orientation() {
        let bits =
            |cells: &CodeCells| cells.iter().flatten().fold(0_u64, |bits, cell| bits << 1 | u64::from(*cell));
        for id in 0..TAG_COUNT {
            let mut turned = code_cells(id);
            for turns in 0..4 {
                let turned_bits = bits(&turned);
                for (other, code) in CODES.iter().enumerate() {
                    let distance = (code ^ turned_bits).count_ones();
                    assert!(
                        distance >= 11 || (other == id && turns == 0),
                        "{id} turned {turns}, {other}: {distance}"
                    );
                }
                turned = turned_left(&turned);
            }
        }
    }

    #[test]
    fn a_turned_code_with_two_wrong_cells_is_named_with_its_turns() {
        for turns in 0..4 {
            let mut cells = code_cells(123);
            (0..turns).for_each(|_| cells = turned_left(&cells));
            cells[0][0] ^= true;
            cells[4][3] ^= true;
            assert_eq!(nearest_code(&cells), CodeMatch { distance: 2, id: 123, turns: (4 - turns) % 4 });
        }
    }

    #[test]
    fn no_code_is_that_of_another_seen_from_behind() {
        for id in 0..TAG_COUNT {
            assert!(nearest_code(&mirrored(&code_cells(id))).distance > 2, "{id}");
        }
        assert_eq!(tag_cells(TAG_COUNT), None);
    }
}
