//! The balls' ways through one tick, for models that look no farther: a sweep along x that finds the ones near each other.

use super::shapes::Bounds;

/// The boxes around the ways of all balls in a tick, in the order of their left sides.
#[derive(Debug, Clone, Default)]
pub(super) struct Ways {
    boxes: Vec<Bounds>,
    /// Left sides, ascending, and whose they are.
    order: Vec<(f64, usize)>,
    /// Balls whose way has changed since they were put in order.
    moved: Vec<usize>,
    widest: f64,
}

impl Ways {
    pub(super) fn with_capacity(balls: usize) -> Self {
        Self {
            boxes: Vec::with_capacity(balls),
            order: Vec::with_capacity(balls),
            moved: Vec::with_capacity(balls),
            widest: 0.0,
        }
    }

    /// Nothing is known.
    pub(super) fn forget(&mut self) {
        self.boxes.clear();
    }

    /// Whether the ways of this tick are known.
    pub(super) fn is_known(&self) -> bool {
        !self.boxes.is_empty()
    }

    /// All ways of a tick.
    pub(super) fn learn(&mut self, boxes: impl Iterator<Item = Bounds>) {
        self.boxes.clear();
        self.boxes.extend(boxes);
        self.moved.clear();
        self.order.clear();
        self.order.extend(self.boxes.iter().enumerate().map(|(ball, around)| (around.low.x, ball)));
        self.order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let width = |around: &Bounds| around.high.x - around.low.x;
        self.widest =
            self.boxes.iter().map(width).fold(0.0, |widest, width| if width > widest { width } else { widest });
    }

    /// A ball goes another way from now on.
    pub(super) fn change(&mut self, ball: usize, around: Bounds) {
        self.boxes[ball] = around;
        if !self.moved.contains(&ball) {
            self.moved.push(ball);
        }
    }

    /// Calls `visit` with every other ball whose way comes near that of `ball`, perhaps twice.
    pub(super) fn near(&self, ball: usize, mut visit: impl FnMut(usize)) {
        let own = self.boxes[ball];
        let first = self.order.partition_point(|&(left, _)| left < own.low.x - self.widest);
        let in_reach = self.order[first..].iter().take_while(|&&(left, _)| left <= own.high.x).map(|&(_, other)| other);
        for other in in_reach.chain(self.moved.iter().copied()) {
            if other != ball && own.meets(&self.boxes[other]) {
                visit(other);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::math::Rng;

    #[test]
    fn every_pair_of_boxes_that_meet_is_found_also_after_some_have_moved() {
        let mut rng = Rng::new(3);
        let mut any = || {
            let low = DVec2::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0));
            Bounds { low, high: low + DVec2::new(rng.between(0.0, 0.3), rng.between(0.0, 0.3)) }
        };
        let mut boxes: Vec<Bounds> = (0..60).map(|_| any()).collect();
        let mut ways = Ways::with_capacity(60);
        ways.learn(boxes.iter().copied());
        for round in 0..30 {
            for ball in 0..60 {
                let mut found = Vec::new();
                ways.near(ball, |other| found.push(other));
                found.sort_unstable();
                found.dedup();
                let meets = |&other: &usize| other != ball && boxes[other].meets(&boxes[ball]);
                assert_eq!(found, (0..60).filter(meets).collect::<Vec<_>>(), "round {round}");
            }
            let (ball, around) = (round * 7 % 60, any());
            boxes[ball] = around;
            ways.change(ball, around);
        }
    }
}
