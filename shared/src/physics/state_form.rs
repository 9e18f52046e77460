//! The written form of a state: what is saved, sent and digested. What the scene does not need is not in it, neither as a
//! value nor as a mark of its absence; the needs themselves stand in front.
//!
//! | always | if needed |
//! |---|---|
//! | needs, tick, balls served; of each ball its id, the age, position and velocity of its flight, what it lies on, what is past | acceleration (`contact`: without, a ball only ever has the scene's own), spin and how it slides, kind, floor; flippers, plungers, targets, hinges, magnets, the cabinet |
//!
//! A number that is zero, as many of them are most of the time, is a bit: see `numbers.rs`.

use core::fmt;

use glam::DVec2;
use serde::de::{DeserializeSeed, Error, SeqAccess, Visitor};
use serde::ser::{SerializeSeq, SerializeTuple};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::ball::{Ball, Flight, Instant, Slide, Support};
use super::cabinet::CabinetState;
use super::needs::Needs;
use super::numbers::Numbers;
use super::state::{MOST_BALLS, MOST_PARTS, WorldState};
use crate::math::bounded;

impl Serialize for WorldState {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let needs = self.needs;
        let parts = [needs.flippers, needs.plungers, needs.targets, needs.hinges, needs.magnets, needs.nudge];
        let parts = parts.into_iter().filter(|&needed| needed).count();
        let mut tuple = serializer.serialize_tuple(4 + parts)?;
        tuple.serialize_element(&needs.bits())?;
        tuple.serialize_element(&self.tick)?;
        tuple.serialize_element(&self.served)?;
        tuple.serialize_element(&Balls { needs, tick: self.tick, balls: &self.balls })?;
        if needs.flippers {
            tuple.serialize_element(&self.flippers)?;
        }
        if needs.plungers {
            tuple.serialize_element(&self.plungers)?;
        }
        if needs.targets {
            tuple.serialize_element(&self.targets)?;
        }
        if needs.hinges {
            tuple.serialize_element(&self.hinges)?;
        }
        if needs.magnets {
            tuple.serialize_element(&self.magnets)?;
        }
        if needs.nudge {
            tuple.serialize_element(&self.cabinet)?;
        }
        tuple.end()
    }
}

impl<'de> Deserialize<'de> for WorldState {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct State;

        impl<'de> Visitor<'de> for State {
            type Value = WorldState;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the state of a world")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<WorldState, A::Error> {
                let bits: u16 = next(&mut seq, "needs")?;
                let needs = Needs::from_bits(bits);
                if needs.bits() != bits {
                    return Err(A::Error::custom("a need that is not known here"));
                }
                let tick = next(&mut seq, "tick")?;
                let served = next(&mut seq, "served")?;
                let balls = BallsSeed { needs, tick };
                Ok(WorldState {
                    needs,
                    tick,
                    served,
                    balls: seq.next_element_seed(balls)?.ok_or_else(|| A::Error::custom("no balls"))?,
                    flippers: parts(&mut seq, needs.flippers)?,
                    plungers: parts(&mut seq, needs.plungers)?,
                    targets: parts(&mut seq, needs.targets)?,
                    hinges: parts(&mut seq, needs.hinges)?,
                    magnets: parts(&mut seq, needs.magnets)?,
                    cabinet: if needs.nudge { next(&mut seq, "cabinet")? } else { CabinetState::default() },
                })
            }
        }

        // How many elements follow is known once the first of them is read.
        deserializer.deserialize_tuple(10, State)
    }
}

fn next<'de, T: Deserialize<'de>, A: SeqAccess<'de>>(seq: &mut A, what: &str) -> Result<T, A::Error> {
    seq.next_element()?.ok_or_else(|| A::Error::custom(format!("no {what}")))
}

/// A list that is there if it is needed.
fn parts<'de, T: Deserialize<'de>, A: SeqAccess<'de>>(seq: &mut A, needed: bool) -> Result<Vec<T>, A::Error> {
    struct Parts<T>(core::marker::PhantomData<T>);

    impl<'de, T: Deserialize<'de>> DeserializeSeed<'de> for Parts<T> {
        type Value = Vec<T>;

        fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<T>, D::Error> {
            bounded::list::<_, _, MOST_PARTS>(deserializer)
        }
    }

    if !needed {
        return Ok(Vec::new());
    }
    seq.next_element_seed(Parts(core::marker::PhantomData))?.ok_or_else(|| A::Error::custom("a list is missing"))
}

struct Balls<'a> {
    needs: Needs,
    tick: u64,
    balls: &'a [Ball],
}

impl Serialize for Balls<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut seq = serializer.serialize_seq(Some(self.balls.len()))?;
        let mut before = DVec2::ZERO;
        for ball in self.balls {
            seq.serialize_element(&OneBall { needs: self.needs, tick: self.tick, before, ball })?;
            before = ball.flight.acceleration;
        }
        seq.end()
    }
}

struct OneBall<'a> {
    needs: Needs,
    tick: u64,
    /// Acceleration of the ball before.
    before: DVec2,
    ball: &'a Ball,
}

/// What a ball has that it may as well not have: bits of a byte.
const HAS_PAST: u8 = 1;
const HAS_SLIDE: u8 = 2;
const HAS_SLIDE_END: u8 = 4;
/// It falls like the ball before, bit for bit: as free balls do.
const FALLS_ALIKE: u8 = 8;

impl Serialize for OneBall<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (needs, Ball { id, kind, floor, flight, spin, support, slide, past }) = (self.needs, *self.ball);
        let slide = slide.filter(|_| needs.slides());
        let slide_end = slide.and_then(|slide| slide.until);
        let bits = |vector: DVec2| vector.to_array().map(f64::to_bits);
        let falls_alike = needs.contact && bits(flight.acceleration) == bits(self.before);
        let has = u8::from(past.is_some()) * HAS_PAST
            + u8::from(slide.is_some()) * HAS_SLIDE
            + u8::from(slide_end.is_some()) * HAS_SLIDE_END
            + u8::from(falls_alike) * FALLS_ALIKE;
        let acceleration = if needs.contact && !falls_alike { flight.acceleration } else { DVec2::ZERO };
        let numbers = Numbers([
            past.map_or(0.0, |(t, _)| t),
            acceleration.x,
            flight.start.offset,
            if needs.spin { spin } else { 0.0 },
            slide_end.unwrap_or(0.0),
            slide.map_or(0.0, |slide| slide.spin_rate),
            acceleration.y,
            flight.velocity.x,
            flight.velocity.y,
            flight.position.x,
            flight.position.y,
        ]);
        let extra = [past.is_some(), needs.kinds, needs.floors];
        let mut tuple = serializer.serialize_tuple(5 + extra.into_iter().filter(|&there| there).count())?;
        tuple.serialize_element(&id)?;
        // No flight begins later than now, but nothing may come to harm of one that did.
        tuple.serialize_element(&self.tick.wrapping_sub(flight.start.tick))?;
        tuple.serialize_element(&support)?;
        tuple.serialize_element(&has)?;
        if let Some((_, collider)) = past {
            tuple.serialize_element(&collider)?;
        }
        tuple.serialize_element(&numbers)?;
        if needs.kinds {
            tuple.serialize_element(&kind)?;
        }
        if needs.floors {
            tuple.serialize_element(&floor)?;
        }
        tuple.end()
    }
}

#[derive(Clone, Copy)]
struct BallsSeed {
    needs: Needs,
    tick: u64,
}

impl<'de> DeserializeSeed<'de> for BallsSeed {
    type Value = Vec<Ball>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<Ball>, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for BallsSeed {
    type Value = Vec<Ball>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at most {MOST_BALLS} balls")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<Ball>, A::Error> {
        if let Some(length) = seq.size_hint().filter(|&length| length > MOST_BALLS) {
            return Err(A::Error::invalid_length(length, &self));
        }
        let mut balls = Vec::new();
        let mut before = DVec2::ZERO;
        while let Some(ball) = seq.next_element_seed(BallSeed { of: self, before })? {
            if balls.len() == MOST_BALLS {
                return Err(A::Error::invalid_length(MOST_BALLS + 1, &self));
            }
            before = ball.flight.acceleration;
            balls.push(ball);
        }
        Ok(balls)
    }
}

struct BallSeed {
    of: BallsSeed,
    before: DVec2,
}

impl<'de> DeserializeSeed<'de> for BallSeed {
    type Value = Ball;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Ball, D::Error> {
        // How many elements follow is known once the first of them is read.
        deserializer.deserialize_tuple(8, self)
    }
}

impl<'de> Visitor<'de> for BallSeed {
    type Value = Ball;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a ball")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Ball, A::Error> {
        let BallsSeed { needs, tick } = self.of;
        let id = next(&mut seq, "id")?;
        let age: u64 = next(&mut seq, "age")?;
        let support: Support = next(&mut seq, "support")?;
        let has: u8 = next(&mut seq, "mark")?;
        let has = |bit: u8| has & bit != 0;
        let collider: Option<u16> = if has(HAS_PAST) { Some(next(&mut seq, "past")?) } else { None };
        let Numbers([past, pull_x, offset, spin, slide_end, spin_rate, pull_y, speed_x, speed_y, x, y]) =
            next(&mut seq, "flight")?;
        let kind = if needs.kinds { next(&mut seq, "kind")? } else { 0 };
        let floor = if needs.floors { next(&mut seq, "floor")? } else { 0 };
        let flight = Flight {
            start: Instant { tick: tick.wrapping_sub(age), offset },
            position: DVec2::new(x, y),
            velocity: DVec2::new(speed_x, speed_y),
            acceleration: if has(FALLS_ALIKE) { self.before } else { DVec2::new(pull_x, pull_y) },
        };
        let slide = Slide { until: has(HAS_SLIDE_END).then_some(slide_end), spin_rate };
        let slide = has(HAS_SLIDE).then_some(slide);
        Ok(Ball { id, kind, floor, flight, spin, support, slide, past: collider.map(|collider| (past, collider)) })
    }
}
