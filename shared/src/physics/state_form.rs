//! The written form of a state: what is saved, sent and digested. What the scene does not need is not in it, neither as a
//! value nor as a mark of its absence; the needs themselves stand in front.
//!
//! | always | if needed |
//! |---|---|
//! | needs, tick, balls served; of each ball its id, the start, position and velocity of its flight, what it lies on, what is past | acceleration (`contact`: without, a ball only ever has the scene's own), spin and how it slides, kind, floor; flippers, plungers, targets, hinges, magnets, the cabinet |

use core::fmt;

use glam::DVec2;
use serde::de::{DeserializeSeed, Error, SeqAccess, Visitor};
use serde::ser::{SerializeSeq, SerializeTuple};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::ball::{Ball, Flight, Instant, Support};
use super::cabinet::CabinetState;
use super::needs::Needs;
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
        tuple.serialize_element(&Balls { needs, balls: &self.balls })?;
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
                Ok(WorldState {
                    needs,
                    tick: next(&mut seq, "tick")?,
                    served: next(&mut seq, "served")?,
                    balls: seq.next_element_seed(BallsSeed(needs))?.ok_or_else(|| A::Error::custom("no balls"))?,
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
    balls: &'a [Ball],
}

impl Serialize for Balls<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut seq = serializer.serialize_seq(Some(self.balls.len()))?;
        for ball in self.balls {
            seq.serialize_element(&OneBall { needs: self.needs, ball })?;
        }
        seq.end()
    }
}

struct OneBall<'a> {
    needs: Needs,
    ball: &'a Ball,
}

impl Serialize for OneBall<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (needs, Ball { id, kind, floor, flight, spin, support, slide, past }) = (self.needs, self.ball);
        let extra = [needs.contact, needs.spin, needs.slides(), needs.kinds, needs.floors];
        let extra = extra.into_iter().filter(|&needed| needed).count();
        let mut tuple = serializer.serialize_tuple(6 + extra)?;
        tuple.serialize_element(id)?;
        tuple.serialize_element(&flight.start)?;
        tuple.serialize_element(&flight.position)?;
        tuple.serialize_element(&flight.velocity)?;
        tuple.serialize_element(support)?;
        tuple.serialize_element(past)?;
        if needs.contact {
            tuple.serialize_element(&flight.acceleration)?;
        }
        if needs.spin {
            tuple.serialize_element(spin)?;
        }
        if needs.slides() {
            tuple.serialize_element(slide)?;
        }
        if needs.kinds {
            tuple.serialize_element(kind)?;
        }
        if needs.floors {
            tuple.serialize_element(floor)?;
        }
        tuple.end()
    }
}

#[derive(Clone, Copy)]
struct BallsSeed(Needs);

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
        while let Some(ball) = seq.next_element_seed(BallSeed(self.0))? {
            if balls.len() == MOST_BALLS {
                return Err(A::Error::invalid_length(MOST_BALLS + 1, &self));
            }
            balls.push(ball);
        }
        Ok(balls)
    }
}

struct BallSeed(Needs);

impl<'de> DeserializeSeed<'de> for BallSeed {
    type Value = Ball;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Ball, D::Error> {
        deserializer.deserialize_tuple(11, self)
    }
}

impl<'de> Visitor<'de> for BallSeed {
    type Value = Ball;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a ball")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Ball, A::Error> {
        let needs = self.0;
        let id = next(&mut seq, "id")?;
        let start: Instant = next(&mut seq, "start")?;
        let position: DVec2 = next(&mut seq, "position")?;
        let velocity: DVec2 = next(&mut seq, "velocity")?;
        let support: Support = next(&mut seq, "support")?;
        let past = next(&mut seq, "past")?;
        let acceleration = if needs.contact { next(&mut seq, "acceleration")? } else { DVec2::ZERO };
        let spin = if needs.spin { next(&mut seq, "spin")? } else { 0.0 };
        let slide = if needs.slides() { next(&mut seq, "slide")? } else { None };
        let kind = if needs.kinds { next(&mut seq, "kind")? } else { 0 };
        let floor = if needs.floors { next(&mut seq, "floor")? } else { 0 };
        let flight = Flight { start, position, velocity, acceleration };
        Ok(Ball { id, kind, floor, flight, spin, support, slide, past })
    }
}
