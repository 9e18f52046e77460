//! Plain data for one frame: everything that drawing needs to know, and nothing of sockets, clocks or physics.
//!
//! Positions are metres on the table (y up), as `f32`: the picture needs no more.

use macroquad::math::{Quat, Vec2};

/// One frame's worth of the game.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct View {
    /// Balls in play.
    pub(crate) balls: Vec<BallView>,
    /// For each flipper, in the table's order: angle from +y towards its own side, radians.
    pub(crate) flippers: Vec<f32>,
    /// For each plunger, in the table's order: metres that the head is pulled back (0: at rest).
    pub(crate) plungers: Vec<f32>,
    /// How far the table is from its place, metres, since it was nudged.
    pub(crate) cabinet: Vec2,
    /// 1 at the moment of a nudge from the left, from the right and from below, falling to 0.
    pub(crate) slaps: [f32; 3],
    /// For each element of the table, by its place in the file: lit light, fallen target, turned plate.
    pub(crate) elements: Vec<ElementView>,
    /// Points that float up where they were made.
    pub(crate) popups: Vec<Popup>,
    /// Sparks that fly where balls hit something.
    pub(crate) bursts: Vec<Burst>,
    /// Seconds since the game tilted, as long as its lamps are out.
    pub(crate) tilt: Option<f32>,
    /// Seconds since something great was reached, for as long as it is cheered.
    pub(crate) cheer: Option<f32>,
    /// Lights play by themselves instead of by the rules: nobody is to read them.
    pub(crate) light_show: bool,
    /// What the display and the side panel say.
    pub(crate) hud: Hud,
    /// Somebody has dimmed the lights.
    pub(crate) dimmed: bool,
    /// The other boards of the room, to be drawn small.
    pub(crate) others: Vec<OtherBoard>,
    /// What the physics sees, while somebody wants to see it.
    pub(crate) overlay: Option<OverlayView>,
    /// Nothing strobes or shakes: what would, fades slowly instead.
    pub(crate) reduced_flashing: bool,
    /// Lit inserts carry a rim and a sign, so that nobody needs to tell colours apart.
    pub(crate) marked_lights: bool,
    /// How large text is, 1 to 1.6; below that 1.
    pub(crate) text_scale: f32,
    /// How far the film has come, if this is one.
    pub(crate) film: Option<FilmView>,
    /// Seconds since the client started: for blinking and attract-mode light shows, never for physics.
    pub(crate) clock: f32,
}

/// A board that is drawn small.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct OtherBoard {
    /// What is on it. Its words are not drawn.
    pub(crate) view: View,
    /// Who plays it.
    pub(crate) name: String,
    /// Points.
    pub(crate) score: u64,
    /// A word below that, such as `BALL 2`.
    pub(crate) state: String,
}

/// A ball.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct BallView {
    /// Centre.
    pub(crate) position: Vec2,
    /// Metres a second.
    pub(crate) velocity: Vec2,
    /// 0 is the playfield.
    pub(crate) floor: u8,
    /// It lies in a saucer.
    pub(crate) held: bool,
    /// How it is turned since it came into play: it rolls, and spins; x right, y up the table, z towards the eye.
    pub(crate) orientation: Quat,
}

/// Sparks that fly from where a ball hit something.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Burst {
    /// Where they come from.
    pub(crate) position: Vec2,
    /// The middle of the ways that they fly, of length 1; or zero: they fly in all directions.
    pub(crate) direction: Vec2,
    /// How hard the hit was, 0 to 1.
    pub(crate) strength: f32,
    /// Seconds since then.
    pub(crate) age: f32,
    /// What was hit.
    pub(crate) kind: BurstKind,
    /// Which of many bursts that look alike but are not the same.
    pub(crate) seed: u32,
}

/// What a ball hit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum BurstKind {
    /// A wall, a rail, a flipper.
    #[default]
    Solid,
    /// What kicks back: a bumper, a slingshot.
    Kicker,
    /// A target.
    Target,
}

/// What an element looks like just now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ElementView {
    /// A light that is lit, a magnet that is on.
    pub(crate) lit: bool,
    /// A light that is dark for a moment only, since it is about to go out.
    pub(crate) winks: bool,
    /// A drop target that has fallen.
    pub(crate) down: bool,
    /// A plate on a hinge: how far it is turned from hanging, radians; positive towards the left of its line.
    pub(crate) turn: f32,
    /// 1 at the moment of a hit (or pass), falling to 0 within about a third of a second.
    pub(crate) flash: f32,
}

/// Points that float up.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Popup {
    /// Where they were made.
    pub(crate) position: Vec2,
    /// For example `+500`.
    pub(crate) text: String,
    /// 0 when new, 1 when gone.
    pub(crate) age: f32,
}

/// How far a film has come.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct FilmView {
    /// Of the whole, 0 to 1.
    pub(crate) share: f32,
    /// The same in minutes and seconds.
    pub(crate) time: String,
    /// Whether it runs, and how fast; or what is wrong.
    pub(crate) state: String,
    /// It is not what was recorded.
    pub(crate) is_wrong: bool,
}

/// What the display and the side panel say.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Hud {
    /// Name of the table.
    pub(crate) table: String,
    /// How it is played, such as `HEAD TO HEAD`.
    pub(crate) title: String,
    /// What the crowd has and may do, where it plays.
    pub(crate) crowd: Option<CrowdView>,
    /// Two short lines that whoever plays must see at once, or empty.
    pub(crate) alarm: Option<[String; 2]>,
    /// One line for each player, and for the crowd where it plays.
    pub(crate) seats: Vec<SeatView>,
    /// Ball that is played, from 1; 0 outside a game.
    pub(crate) ball: u32,
    /// Balls in a game.
    pub(crate) balls: u32,
    /// Points waiting for the end of the ball.
    pub(crate) bonus: u64,
    /// Times which the bonus is paid.
    pub(crate) multiplier: u32,
    /// The one line on the display that matters most now, such as `BANK DOWN` or `GAME OVER`.
    pub(crate) message: String,
    /// What can be pressed now, such as (`ENTER`, `PLAY`).
    pub(crate) keys: Vec<(String, String)>,
    /// How many watch.
    pub(crate) spectators: u32,
    /// Who waits for a seat, first in line first; the first of them.
    pub(crate) queue: Vec<String>,
    /// How many wait.
    pub(crate) waiting: u32,
    /// A big line over the playfield (the title of the attract screen, `GAME OVER`, a lost connection), or empty.
    pub(crate) banner: String,
    /// A smaller line under the banner, or empty.
    pub(crate) sub_banner: String,
}

/// One player's line.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct SeatView {
    /// The player's name.
    pub(crate) name: String,
    /// Points.
    pub(crate) score: u64,
    /// Whose turn it is.
    pub(crate) active: bool,
    /// The person at this window.
    pub(crate) you: bool,
    /// Games won in a row.
    pub(crate) wins: u32,
}

/// What the crowd has and may do.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct CrowdView {
    /// What it has to spend, and how much that can grow to.
    pub(crate) energy: (u32, u32),
    /// What it may do, in order.
    pub(crate) actions: Vec<CrowdActionView>,
    /// Seconds until votes are counted.
    pub(crate) closes_in: Option<f32>,
    /// The person at this window may vote.
    pub(crate) can_vote: bool,
}

/// Something that the crowd may do.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct CrowdActionView {
    /// What it is.
    pub(crate) name: String,
    /// Energy that it takes.
    pub(crate) cost: u32,
    /// How it stands.
    pub(crate) state: CrowdActionState,
    /// Votes for it.
    pub(crate) votes: u32,
    /// One of them is from this window.
    pub(crate) yours: bool,
}

/// How something that the crowd may do stands.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) enum CrowdActionState {
    /// It can be had.
    #[default]
    Ready,
    /// There is not enough energy.
    TooDear,
    /// It is announced: seconds until then.
    Announced(f32),
    /// It is at work: for so many seconds more.
    AtWork(f32),
    /// It cools down: seconds until it can be had again.
    CoolsDown(f32),
}

/// What the physics sees, in lines and words.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct OverlayView {
    /// Shapes, normals, arrows, flights.
    pub(crate) lines: Vec<OverlayLine>,
    /// Balls, and points.
    pub(crate) circles: Vec<OverlayCircle>,
    /// Words on the table.
    pub(crate) labels: Vec<OverlayLabel>,
    /// Words beside it, line by line.
    pub(crate) words: Vec<(Mark, String)>,
}

/// What a part of the overlay stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A surface.
    Solid,
    /// One that stops balls from one side only.
    OneWay,
    /// What balls pass.
    Passed,
    /// Any of these on a floor that no ball is on.
    OtherFloor,
    /// A surface on its way.
    Moving,
    /// The side of a surface that balls meet.
    Normal,
    /// What a ball lies on.
    Support,
    /// A ball.
    Ball,
    /// Its velocity.
    Velocity,
    /// Its way to come.
    Flight,
    /// What it meets at the end of that.
    Impact,
}

/// A line through points.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OverlayLine {
    /// What it is.
    pub(crate) mark: Mark,
    /// Two or more, or one where a way has no length.
    pub(crate) points: Vec<Vec2>,
}

/// A circle, or with radius 0 a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OverlayCircle {
    /// What it is.
    pub(crate) mark: Mark,
    /// Its centre.
    pub(crate) center: Vec2,
    /// Metres.
    pub(crate) radius: f32,
}

/// Words beside a place.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OverlayLabel {
    /// What they are about.
    pub(crate) mark: Mark,
    /// The place.
    pub(crate) place: Vec2,
    /// The words.
    pub(crate) text: String,
}
