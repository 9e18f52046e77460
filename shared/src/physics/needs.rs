//! What a scene requires: worked out once, when it is built. A world runs, stores and sends that alone.

use super::scene::{Presence, Role, Scene};
use super::shapes::{Shape, Side};

/// Which parts of the physics a scene requires.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// A slope pulls free balls: flights are curved.
    pub gravity: bool,
    /// Some surface has friction.
    pub friction: bool,
    /// A ball's spin can change something: there is friction.
    pub spin: bool,
    /// A ball can be pressed against a surface, and so come to rest, slide or roll on it: by gravity, in a hollow, or by a
    /// moving body.
    pub contact: bool,
    /// Several balls are in play and can meet.
    pub ball_ball: bool,
    /// Balls differ in size or mass.
    pub kinds: bool,
    /// There are flippers.
    pub flippers: bool,
    /// There are plungers.
    pub plungers: bool,
    /// There are targets that fall.
    pub targets: bool,
    /// There is more than the playfield.
    pub floors: bool,
    /// Something notices a ball's centre passing: rollovers, plates, saucers, holes and drains.
    pub sensors: bool,
    /// There are plates on hinges: spinners and gates.
    pub hinges: bool,
    /// There are saucers.
    pub saucers: bool,
    /// There are magnets.
    pub magnets: bool,
    /// The table can be nudged.
    pub nudge: bool,
    /// There are so many shapes that a grid finds the ones near a flight faster than a look at all of them.
    pub broad_phase: bool,
}

/// Shapes from which on the grid is faster: with fewer, a look at each one's box costs less than the way through the
/// cells. Only cost depends on it.
const BROAD_PHASE_FROM: usize = 24;

impl Needs {
    /// How many there are.
    pub const COUNT: usize = 16;

    /// The names of all needs, in the order of [`Self::flags`].
    pub const NAMES: [&'static str; Self::COUNT] = [
        "gravity",
        "friction",
        "spin",
        "contact",
        "ball-ball",
        "kinds",
        "flippers",
        "plungers",
        "targets",
        "floors",
        "sensors",
        "broad phase",
        "hinges",
        "saucers",
        "magnets",
        "nudge",
    ];

    /// Everything.
    pub const ALL: Self = Self::from_flags([true; Self::COUNT]);

    /// What `scene` requires.
    pub(super) fn of(scene: &Scene) -> Self {
        let colliders = &scene.colliders;
        let friction = scene.ball_material.friction > 0.0
            || colliders.iter().any(|collider| collider.material.friction > 0.0)
            || scene.flippers.iter().any(|flipper| flipper.material.friction > 0.0)
            || scene.plungers.iter().any(|plunger| plunger.material.friction > 0.0);
        let pulls = |gravity: &glam::DVec2| *gravity != glam::DVec2::ZERO;
        let gravity = pulls(&scene.gravity) || scene.floors.iter().any(pulls);
        let movers = !scene.flippers.is_empty() || !scene.plungers.is_empty();
        let hollow =
            |collider: &super::scene::Collider| matches!(collider.shape, Shape::Arc(arc) if arc.side == Side::Inside);
        Self {
            gravity,
            friction,
            spin: friction,
            contact: gravity
                || movers
                || scene.cabinet.is_some()
                || !scene.magnets.is_empty()
                || colliders.iter().any(hollow),
            ball_ball: scene.start.len() > 1 || scene.multiball,
            kinds: scene.kinds.len() > 1,
            flippers: !scene.flippers.is_empty(),
            plungers: !scene.plungers.is_empty(),
            targets: colliders.iter().any(|collider| matches!(collider.presence, Presence::TargetUp(_))),
            floors: colliders.iter().any(|collider| collider.floor > 0 || matches!(collider.role, Role::Hole { .. })),
            sensors: colliders.iter().any(|collider| collider.role.is_passed()),
            hinges: !scene.hinges.is_empty(),
            saucers: !scene.saucers.is_empty(),
            magnets: !scene.magnets.is_empty(),
            nudge: scene.cabinet.is_some(),
            broad_phase: colliders.len() >= BROAD_PHASE_FROM,
        }
    }

    /// Whether a ball can slide along a surface that has friction.
    pub const fn slides(self) -> bool {
        self.spin && self.contact
    }

    /// Each need, in the order of [`Self::NAMES`].
    pub const fn flags(self) -> [bool; Self::COUNT] {
        [
            self.gravity,
            self.friction,
            self.spin,
            self.contact,
            self.ball_ball,
            self.kinds,
            self.flippers,
            self.plungers,
            self.targets,
            self.floors,
            self.sensors,
            self.broad_phase,
            self.hinges,
            self.saucers,
            self.magnets,
            self.nudge,
        ]
    }

    /// The reverse of [`Self::flags`].
    pub const fn from_flags(flags: [bool; Self::COUNT]) -> Self {
        let [
            gravity,
            friction,
            spin,
            contact,
            ball_ball,
            kinds,
            flippers,
            plungers,
            targets,
            floors,
            sensors,
            broad_phase,
            hinges,
            saucers,
            magnets,
            nudge,
        ] = flags;
        Self {
            gravity,
            friction,
            spin,
            contact,
            ball_ball,
            kinds,
            flippers,
            plungers,
            targets,
            floors,
            sensors,
            broad_phase,
            hinges,
            saucers,
            magnets,
            nudge,
        }
    }

    /// One bit a need, the first of [`Self::NAMES`] lowest: how a state says what it holds.
    pub fn bits(self) -> u16 {
        self.flags().iter().rev().fold(0, |bits, &flag| bits << 1 | u16::from(flag))
    }

    /// The reverse of [`Self::bits`]; bits beyond the last need are none.
    pub fn from_bits(bits: u16) -> Self {
        let mut flags = [false; Self::COUNT];
        for (place, flag) in flags.iter_mut().enumerate() {
            *flag = bits >> place & 1 == 1;
        }
        Self::from_flags(flags)
    }

    /// The names of what is needed.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        Self::NAMES.into_iter().zip(self.flags()).filter(|(_, flag)| *flag).map(|(name, _)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_and_flags_are_the_same_needs() {
        for place in 0..Needs::COUNT {
            let mut flags = [false; Needs::COUNT];
            flags[place] = true;
            let needs = Needs::from_flags(flags);
            assert_eq!(needs.bits(), 1 << place);
            assert_eq!(Needs::from_bits(needs.bits()), needs);
            assert_eq!(needs.names().collect::<Vec<_>>(), [Needs::NAMES[place]]);
        }
        assert_eq!(Needs::from_bits(u16::MAX), Needs::ALL);
    }
}
