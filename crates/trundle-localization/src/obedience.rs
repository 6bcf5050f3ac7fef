use crate::odometry_noise::Untold;
use trundle_core::Twist2;

/// Compares what the base is told with what its wheels count, to tell wheels that do not answer (encoders that are stuck, wheels
/// that are blocked, motors without power) from a robot at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Obedience {
    told: Twist2,
    /// How fast the base may be after what it was told: m/s and rad/s, neither negative.
    pace: (f64, f64),
    /// Since it was told to roll and counted nothing: s, and the way and the turn that it was told, m and rad.
    unanswered: (f64, f64, f64),
    /// Nothing was counted for too long, and nothing since.
    is_refused: bool,
}

/// Rims that are told to go so fast roll, m/s: slower ones may stick.
const ROLLS: f64 = 0.04;
/// And they do within so long, s: motors answer late, and on a carpet later still.
const ANSWERS: f64 = 0.5;
/// So a base slows that is told to, m/s^2 and rad/s^2, at least.
const SLOWS: (f64, f64) = (0.3, 1.5);

impl Default for Obedience {
    fn default() -> Self {
        Self { told: Twist2::ZERO, pace: (0.0, 0.0), unanswered: (0.0, 0.0, 0.0), is_refused: false }
    }
}

impl Obedience {
    /// The base is told to do this from now on.
    pub(crate) fn tell(&mut self, twist: Twist2) {
        if twist.is_finite() {
            self.told = twist;
        }
    }

    /// Whether the wheels do not answer.
    pub(crate) fn is_refused(&self) -> bool {
        self.is_refused
    }

    /// Whether a base without a tick is not at rest: it is told to roll.
    pub(crate) fn is_to_roll(&self, half_base: f64) -> bool {
        self.told.v.abs() + self.told.omega.abs() * half_base > ROLLS
    }

    /// Takes in what the wheels counted in the last `dt` s: anything (`rolled`) or nothing; what the base may have done that nobody
    /// counted.
    pub(crate) fn step(&mut self, half_base: f64, rolled: bool, dt: f64) -> Untold {
        self.pace.0 = self.told.v.abs().max(self.pace.0 - SLOWS.0 * dt).max(0.0);
        self.pace.1 = self.told.omega.abs().max(self.pace.1 - SLOWS.1 * dt).max(0.0);
        let was_refused = self.is_refused;
        if rolled {
            self.unanswered = (0.0, 0.0, 0.0);
            self.is_refused = false;
            return Untold::default();
        }
        if self.is_to_roll(half_base) {
            let (time, way, turn) = self.unanswered;
            self.unanswered = (time + dt, way + self.pace.0 * dt, turn + self.pace.1 * dt);
        }
        self.is_refused |= self.unanswered.0 > ANSWERS;
        match (was_refused, self.is_refused) {
            (false, true) => Untold::at_once(self.unanswered.1, self.unanswered.2),
            (true, _) => Untold::on_and_on(self.pace, dt),
            (false, false) => Untold::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_BASE: f64 = 0.115;
    const STEP: f64 = 0.02;

    fn steps(wheels: &mut Obedience, count: usize, rolled: bool) -> (f64, f64) {
        (0..count).fold((0.0, 0.0), |sum, _| {
            let untold = wheels.step(HALF_BASE, rolled, STEP);
            (sum.0 + untold.way_variance, sum.1 + untold.turn_variance)
        })
    }

    #[test]
    fn wheels_that_are_told_to_roll_and_count_nothing_are_not_believed() {
        let mut wheels = Obedience::default();
        assert_eq!(steps(&mut wheels, 1000, false), (0.0, 0.0), "nobody told it anything");
        wheels.tell(Twist2::new(0.3, 0.0));
        assert_eq!(steps(&mut wheels, 24, false), (0.0, 0.0), "motors answer late");
        let (way, turn) = steps(&mut wheels, 26, false);
        assert!(wheels.is_refused() && turn == 0.0);
        assert!((0.3..0.6).contains(&way.sqrt()), "0.3 m in a second: {}", way.sqrt());
        wheels.tell(Twist2::ZERO);
        steps(&mut wheels, 60, false);
        assert_eq!(steps(&mut wheels, 50, false), (0.0, 0.0), "it has come to rest");
        assert!(wheels.is_refused(), "that a robot at rest counts nothing makes its wheels no better");
        steps(&mut wheels, 1, true);
        assert!(!wheels.is_refused());
    }

    #[test]
    fn wheels_that_creep_or_answer_are_believed() {
        let mut wheels = Obedience::default();
        wheels.tell(Twist2::new(0.01, 0.1));
        assert_eq!(steps(&mut wheels, 1000, false), (0.0, 0.0));
        wheels.tell(Twist2::new(0.0, 1.0));
        for _ in 0..10 {
            assert_eq!(steps(&mut wheels, 20, false), (0.0, 0.0));
            steps(&mut wheels, 1, true);
        }
        assert!(!wheels.is_refused());
        let (way, turn) = steps(&mut wheels, 50, false);
        assert!(way == 0.0 && (1.0..2.0).contains(&turn.sqrt()), "{turn}");
    }
}
