//! The camera matrix of camera files.

use trundle_core::Invalid;

/// Order in which a file lists the numbers of a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MatrixOrder {
    RowByRow,
    ColumnByColumn,
}

/// The focal lengths and the principal point of a camera matrix, px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CameraMatrix {
    pub focal: (f64, f64),
    pub centre: (f64, f64),
}

impl CameraMatrix {
    /// Reads the nine numbers of the matrix `name`. All numbers but focal lengths and principal point must be those of a pinhole camera
    /// without skew.
    pub(super) fn parse(name: &str, numbers: &[f64], order: MatrixOrder) -> Result<Self, Invalid> {
        let &[fx, a, b, c, fy, d, e, f, scale] = numbers else {
            let found = format!("{} numbers", numbers.len());
            return Err(Invalid::new(name, found, "", format!("9, {}", order.words())));
        };
        let (centre, rest) = match order {
            MatrixOrder::RowByRow => ((b, d), [a, c, e, f]),
            MatrixOrder::ColumnByColumn => ((e, f), [a, b, c, d]),
        };
        if rest != [0.0; 4] || scale != 1.0 {
            return Err(Invalid::new(name, format!("{numbers:?}"), "", order.expected()));
        }
        Ok(Self { focal: (fx, fy), centre })
    }
}

impl MatrixOrder {
    fn words(self) -> &'static str {
        match self {
            Self::RowByRow => "row by row",
            Self::ColumnByColumn => "column by column",
        }
    }

    fn expected(self) -> String {
        let numbers = match self {
            Self::RowByRow => "fx, 0, cx, 0, fy, cy, 0, 0, 1",
            Self::ColumnByColumn => "fx, 0, 0, 0, fy, 0, cx, cy, 1",
        };
        format!("[{numbers}], {}", self.words())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BY_ROWS: [f64; 9] = [500.0, 0.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0];
    const BY_COLUMNS: [f64; 9] = [500.0, 0.0, 0.0, 0.0, 510.0, 0.0, 320.0, 240.0, 1.0];

    #[test]
    fn a_matrix_in_the_other_order_is_refused() {
        let expected = CameraMatrix { focal: (500.0, 510.0), centre: (320.0, 240.0) };
        for (order, right, wrong) in
            [(MatrixOrder::RowByRow, BY_ROWS, BY_COLUMNS), (MatrixOrder::ColumnByColumn, BY_COLUMNS, BY_ROWS)]
        {
            assert_eq!(CameraMatrix::parse("K", &right, order), Ok(expected));
            let problem = CameraMatrix::parse("K", &wrong, order).unwrap_err().to_string();
            assert!(problem.contains(order.words()), "{problem}");
            let few = CameraMatrix::parse("K", &right[..8], order).unwrap_err().to_string();
            assert!(few.starts_with("K is 8 numbers, expected 9, "), "{few}");
        }
    }
}
