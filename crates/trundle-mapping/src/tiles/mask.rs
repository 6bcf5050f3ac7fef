/// One bit for each cell of a rectangle: which ones a scan has had its say about.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mask {
    corner: (i32, i32),
    words_a_row: usize,
    words: Vec<u64>,
}

impl Mask {
    /// Forgets all, and covers the cells from `low` to `high`.
    pub(crate) fn cover(&mut self, low: (i32, i32), high: (i32, i32)) {
        self.corner = low;
        self.words_a_row = (high.0 - low.0 + 1) as usize / 64 + 1;
        self.words.clear();
        self.words.resize(self.words_a_row * (high.1 - low.1 + 1) as usize, 0);
    }

    /// Sets the bit of a cell that is covered; whether it was not set before.
    #[inline]
    pub(crate) fn set(&mut self, x: i32, y: i32) -> bool {
        let (col, row) = ((x - self.corner.0) as usize, (y - self.corner.1) as usize);
        let word = &mut self.words[row * self.words_a_row + col / 64];
        let bit = 1 << (col % 64);
        let fresh = *word & bit == 0;
        *word |= bit;
        fresh
    }
}
