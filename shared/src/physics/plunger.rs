//! The plunger: a hand pulls a head back against a spring and lets go.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::numbers::Numbers;
use super::scene::Material;

/// What is fixed about a plunger.
#[derive(Debug, Clone, PartialEq)]
pub struct PlungerSpec {
    /// The table's element.
    pub element: u16,
    /// One end of the head's face at home, m.
    pub from: DVec2,
    /// Unit vector along the face.
    pub along: DVec2,
    /// Width of the face, m.
    pub width: f64,
    /// Unit vector towards the ball.
    pub normal: DVec2,
    /// How far it can be pulled, m.
    pub stroke: f64,
    /// Of rod and head, kg.
    pub mass: f64,
    /// Of the spring, N/m.
    pub stiffness: f64,
    /// How fast a hand moves it, m/s.
    pub hand_speed: f64,
    /// Its face.
    pub material: Material,
}

/// What changes about a plunger.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "PlungerForm", into = "PlungerForm")]
pub struct PlungerState {
    /// Whether the head rests at home.
    pub home: bool,
    /// How far the head is pulled back, m.
    pub pull: f64,
    /// Its rate, m/s.
    pub speed: f64,
    /// Where the hand wants it, as a share of the stroke; `None`: nobody holds it.
    pub hand: Option<f64>,
}

impl Default for PlungerState {
    fn default() -> Self {
        Self { home: true, pull: 0.0, speed: 0.0, hand: None }
    }
}

impl PlungerState {
    /// Whether the head lies at home with nothing that would move it.
    pub fn stays_home(&self) -> bool {
        self.pull == 0.0 && self.speed == 0.0 && self.hand.is_none_or(|hand| hand == 0.0)
    }
}

/// As it is written.
#[derive(Serialize, Deserialize)]
struct PlungerForm(bool, Option<f64>, Numbers<2>);

impl From<PlungerState> for PlungerForm {
    fn from(PlungerState { home, pull, speed, hand }: PlungerState) -> Self {
        Self(home, hand, Numbers([speed, pull]))
    }
}

impl From<PlungerForm> for PlungerState {
    fn from(PlungerForm(home, hand, Numbers([speed, pull])): PlungerForm) -> Self {
        Self { home, pull, speed, hand }
    }
}

/// A head's motion within a tick: constant acceleration from some moment of it on.
#[derive(Debug, Clone, Copy)]
pub struct PlungerMotion {
    /// Offset within the tick from which this holds, seconds.
    pub from: f64,
    /// Pull then, m.
    pub pull: f64,
    /// Speed then, m/s; positive: away from the ball.
    pub speed: f64,
    /// Throughout, m/s^2.
    pub acceleration: f64,
}

impl PlungerMotion {
    /// Pull at an offset within the tick.
    pub fn pull_at(&self, offset: f64) -> f64 {
        let t = offset - self.from;
        self.pull + (self.speed + 0.5 * self.acceleration * t) * t
    }

    /// Speed at an offset within the tick.
    pub fn speed_at(&self, offset: f64) -> f64 {
        self.speed + self.acceleration * (offset - self.from)
    }
}

impl PlungerSpec {
    /// The head's motion for a tick of `dt` seconds that carries `load` kg of ball.
    pub fn motion(&self, state: &PlungerState, load: f64, dt: f64) -> PlungerMotion {
        match state.hand {
            Some(hand) => {
                // A hand moves it steadily to where it wants it.
                let missing = hand * self.stroke - state.pull;
                let most = self.hand_speed * dt;
                let speed = missing.clamp(-most, most) / dt;
                PlungerMotion { from: 0.0, pull: state.pull, speed, acceleration: 0.0 }
            }
            None => PlungerMotion {
                from: 0.0,
                pull: state.pull,
                speed: state.speed,
                // The spring's force in the middle of the tick: an error of third order in its length.
                acceleration: -self.stiffness * (state.pull + 0.5 * dt * state.speed) / (self.mass + load),
            },
        }
    }

    /// Distance from a point to the face when it is pulled back by `pull`; infinite beside it.
    pub fn distance(&self, pull: f64, point: DVec2) -> f64 {
        let offset = point - self.from;
        let along = offset.dot(self.along);
        if (0.0..=self.width).contains(&along) { offset.dot(self.normal) + pull } else { f64::INFINITY }
    }

    /// No more metres than a ball of `radius` around a point has to go to meet the face pulled back by `pull`; 0 or less beyond it.
    pub fn way_to_face(&self, pull: f64, point: DVec2, radius: f64) -> f64 {
        let offset = point - self.from;
        let (along, across) = (offset.dot(self.along), offset.dot(self.normal));
        let ways = [-along, along - self.width];
        ways.into_iter().fold(across + pull - radius, |most, way| if way > most { way } else { most })
    }

    /// No more metres than from a point to the places that the face can take; 0 or less between them.
    pub fn way_to_stroke(&self, point: DVec2) -> f64 {
        let offset = point - self.from;
        let (along, across) = (offset.dot(self.along), offset.dot(self.normal));
        let ways = [-along, along - self.width, -across - self.stroke];
        ways.into_iter().fold(across, |most, way| if way > most { way } else { most })
    }
}
