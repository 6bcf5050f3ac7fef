/// A turn that the gyro told of, and how long it took.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Told {
    /// rad.
    pub(crate) turn: f64,
    /// s.
    pub(crate) time: f64,
}

/// What the gyro tells while no wheel ticks. A robot that rests does not turn, whatever its gyro's noise says; but one that creeps
/// shows no tick either, for many readings on end, and turns on in each of them: with the next tick it is known which it was.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BetweenTicks(Told);

impl BetweenTicks {
    /// A step without a tick, of a turn so slow that it may be noise.
    pub(crate) fn hold(&mut self, step: Told) {
        self.0 = self.0.and(step);
    }

    /// The robot turns: this step and what was held before it.
    pub(crate) fn count(&mut self, step: Told) -> Told {
        std::mem::take(self).0.and(step)
    }

    /// The robot rests, or nobody knows what it did.
    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }
}

impl Told {
    fn and(self, other: Self) -> Self {
        Self { turn: self.turn + other.turn, time: self.time + other.time }
    }
}
