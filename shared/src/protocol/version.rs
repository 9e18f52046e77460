//! The preamble: which protocol a side speaks, told in a form that never changes.

use std::sync::OnceLock;

use thiserror::Error;

use super::frame::{encode, encode_from_server};
use super::inputs::{BoardInput, Inputs};
use super::message::{ClientMessage, Hello, Mode, Role, Roster, ServerMessage, Tally, Welcome};
use super::snapshot::{BoardEvent, Change, Full, Patch};
use super::stream::{Form, Stream};
use crate::game::{Action, GameEvent, GameEventKind, GameState, HOUSE, Input, Nudge, Phase, Rescue, SEATS};
use crate::math::Digest;
use crate::physics::ball::{Ball, Flight, Instant, Slide, Support};
use crate::physics::cabinet::CabinetState;
use crate::physics::flipper::{FlipperRest, FlipperState};
use crate::physics::hinge::HingeState;
use crate::physics::needs::Needs;
use crate::physics::plunger::PlungerState;
use crate::physics::{TargetState, WorldState};

/// Version of the protocol. Raise it when a message changes its meaning; a change of its bytes is noticed anyway.
pub const VERSION: u32 = 2;

/// Bytes of a preamble: 8 of name, 4 of version, 8 of the samples' digest, all little-endian.
pub const PREAMBLE_LENGTH: usize = 20;

const NAME: [u8; 8] = *b"STARBALL";

/// Which protocol a side speaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preamble {
    /// Of the protocol.
    pub version: u32,
    /// Of the encoded samples of every message: two builds whose messages differ in a single byte differ in it.
    pub samples: u64,
}

/// Why the other side cannot be talked to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum PreambleError {
    /// It does not speak Starball at all.
    #[error("the other side does not speak the Starball protocol")]
    Foreign,
    /// It speaks another version.
    #[error("the other side speaks Starball protocol {theirs}, this side {VERSION}: use the same release on both")]
    Version {
        /// Of the other side.
        theirs: u32,
    },
    /// It says that it speaks the same version, but its messages have other bytes.
    #[error(
        "both sides speak Starball protocol {VERSION}, but their builds differ (messages {theirs:016x}, here {ours:016x}): use the same release on both"
    )]
    Build {
        /// Of the other side.
        theirs: u64,
        /// Of this side.
        ours: u64,
    },
}

impl Preamble {
    /// What this build speaks.
    pub fn ours() -> Self {
        static SAMPLES: OnceLock<u64> = OnceLock::new();
        Self { version: VERSION, samples: *SAMPLES.get_or_init(digest_of_samples) }
    }

    /// As sent.
    pub fn to_bytes(self) -> [u8; PREAMBLE_LENGTH] {
        let mut bytes = [0; PREAMBLE_LENGTH];
        bytes[..8].copy_from_slice(&NAME);
        bytes[8..12].copy_from_slice(&self.version.to_le_bytes());
        bytes[12..].copy_from_slice(&self.samples.to_le_bytes());
        bytes
    }

    /// From the start of a frame.
    ///
    /// # Errors
    /// If there is none.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PreambleError> {
        let (name, rest) = bytes.split_first_chunk::<8>().ok_or(PreambleError::Foreign)?;
        let (version, rest) = rest.split_first_chunk::<4>().ok_or(PreambleError::Foreign)?;
        let (samples, _) = rest.split_first_chunk::<8>().ok_or(PreambleError::Foreign)?;
        if *name != NAME {
            return Err(PreambleError::Foreign);
        }
        Ok(Self { version: u32::from_le_bytes(*version), samples: u64::from_le_bytes(*samples) })
    }

    /// Whether the side that sent it can be talked to.
    ///
    /// # Errors
    /// Why not.
    pub fn check(self) -> Result<(), PreambleError> {
        let ours = Self::ours();
        if self.version != ours.version {
            return Err(PreambleError::Version { theirs: self.version });
        }
        if self.samples != ours.samples {
            return Err(PreambleError::Build { theirs: self.samples, ours: ours.samples });
        }
        Ok(())
    }
}

fn digest_of_samples() -> u64 {
    let mut digest = Digest::default();
    for bytes in sample_frames() {
        digest.update(&(bytes.len() as u64).to_le_bytes());
        digest.update(&bytes);
    }
    digest.finish()
}

/// One encoded sample of every message, with every variant of everything that messages hold.
pub(super) fn sample_frames() -> Vec<Vec<u8>> {
    let stream = Stream { form: Form::Inputs, hz: 30 };
    let hellos = [Role::Play, Role::Watch].map(|role| encode(&Hello { name: "sample".to_owned(), role, stream }));
    let actions = [
        Action::Sit,
        Action::Stand,
        Action::Start,
        Action::Flipper { right: true, pressed: false },
        Action::Pull(300),
        Action::Nudge(Nudge::FromLeft),
        Action::Nudge(Nudge::FromRight),
        Action::Nudge(Nudge::Forward),
        Action::Release,
        Action::Forfeit,
        Action::Crowd(3),
    ];
    let acts = actions.map(|action| encode(&ClientMessage::Act { tick: 70_000, action }));
    let others = [
        ClientMessage::Play,
        ClientMessage::Leave,
        ClientMessage::Ping { nonce: 1 },
        ClientMessage::Stream(Stream { form: Form::State, hz: 60 }),
        ClientMessage::Differs { tick: 70_000, digest: 3 },
        ClientMessage::Vote { action: 2 },
        ClientMessage::Pause(true),
    ];
    let welcome = |mode| {
        let (room, table) = ("room".to_owned(), "()".to_owned());
        ServerMessage::Welcome(Welcome { room, mode, places: 4, physics: 2, table_digest: 3, table })
    };
    let mut places = <[Option<String>; SEATS]>::default();
    places[0] = Some("a".to_owned());
    let line = vec!["b".to_owned()];
    let input = |tick, seat, action| BoardInput { board: 1, input: Input { tick, seat, action } };
    let inputs = vec![input(70_000, 1, Action::Pull(300)), input(70_002, HOUSE, Action::Release)];
    let from_server = [
        welcome(Mode::Challenge),
        welcome(Mode::Crowd),
        welcome(Mode::HeadToHead),
        ServerMessage::Refused { reason: "full".to_owned() },
        ServerMessage::Full(Box::new(sample_full())),
        ServerMessage::Change(Box::new(sample_change())),
        ServerMessage::Roster(Roster { places, line, waiting: 1, spectators: 3, champion: Some((0, 2)) }),
        ServerMessage::Tally(Tally { votes: vec![3, 300], closes: Some(70_000) }),
        ServerMessage::You { client: 300, place: Some(1), line: Some(2) },
        ServerMessage::Pong { nonce: 1, tick: 2 },
        ServerMessage::Bye { reason: "end".to_owned() },
        ServerMessage::Paused(true),
        ServerMessage::Inputs(Inputs { from: 70_000, to: 70_017, digest: Some(5), inputs: inputs.clone() }),
        ServerMessage::Inputs(Inputs { from: 70_000, to: 70_100, digest: None, inputs }),
    ];
    let mut frames = Vec::new();
    frames.extend(hellos);
    frames.extend(acts);
    frames.extend(others.iter().map(encode));
    frames.extend(from_server.iter().map(encode_from_server));
    // What the samples above have no place for: the other phases, and nothing where something may be.
    frames.extend([Phase::Idle, Phase::Over].iter().map(encode));
    frames.push(encode(&GameEventKind::Points { seat: 0, points: 1, place: None }));
    frames.push(encode(&ServerMessage::You { client: 1, place: None, line: None }));
    frames.push(encode(&PlungerState::default()));
    // And a world that needs nothing of it all.
    let ball = Ball { past: None, ..sample_state().world.balls[0] };
    let bare = WorldState { needs: Needs::default(), balls: vec![ball], ..sample_state().world };
    frames.push(encode(&bare));
    frames
}

pub(super) fn sample_full() -> Full {
    let boards = vec![sample_state()];
    Full { room: "room".to_owned(), protocol: VERSION, physics: 3, table_digest: 4, boards }
}

pub(super) fn sample_change() -> Change {
    let patch = Patch(vec![1, 2, 3]);
    Change { from: 9, to: 10, boards: vec![patch], events: sample_events() }
}

fn sample_state() -> GameState {
    let flight = Flight {
        start: Instant { tick: 9, offset: 0.25 },
        position: glam::DVec2::new(0.1, 0.2),
        velocity: glam::DVec2::new(-1.0, 2.0),
        acceleration: glam::DVec2::new(0.0, -0.8),
    };
    let supports = [
        Support::None,
        Support::Line(1),
        Support::Arc(2),
        Support::Stalled,
        Support::Wedge(3, 4),
        Support::Flipper(0),
        Support::Plunger(0),
        Support::Held(1),
        Support::Released(2),
    ];
    let balls = supports.map(|support| Ball {
        id: 7,
        kind: 1,
        floor: 1,
        flight,
        spin: 1.5,
        support,
        slide: Some(Slide { until: Some(0.5), spin_rate: 2.5 }),
        past: Some((0.5, 3)),
    });
    let rests = [FlipperRest::AtRest, FlipperRest::Raised, FlipperRest::Moving];
    let world = WorldState {
        needs: Needs::ALL,
        tick: 10,
        served: 8,
        balls: balls.to_vec(),
        flippers: rests.map(|rest| FlipperState { rest, ..FlipperState::default() }).to_vec(),
        plungers: vec![PlungerState { hand: Some(0.5), ..PlungerState::default() }],
        targets: vec![TargetState::Up, TargetState::Down, TargetState::Rising],
        magnets: vec![true, false],
        cabinet: CabinetState { push: glam::DVec2::new(0.5, 0.25), ..CabinetState::default() },
        hinges: vec![HingeState { start: Instant { tick: 9, offset: 0.25 }, angle: -0.5, speed: 20.0 }],
    };
    let phase = Phase::Play {
        seat: 1,
        ball: 2,
        serve_in: 3,
        untouched: true,
        still: 4,
        watched: 7,
        quiet: 5,
        searches: 1,
        extra: 6,
    };
    GameState { world, play: crate::game::sample_play(phase) }
}

/// One of each.
fn sample_events() -> Vec<BoardEvent> {
    let kinds = [
        GameEventKind::Touched { element: 1, speed: 0.5 },
        GameEventKind::Kicked { element: 1, speed: 0.5 },
        GameEventKind::Felled { element: 1, speed: 0.5 },
        GameEventKind::Passed { element: 1 },
        GameEventKind::Struck { element: 1, speed: 0.5 },
        GameEventKind::Spun { element: 1 },
        GameEventKind::Held { element: 1 },
        GameEventKind::Ejected { element: 1 },
        GameEventKind::Points { seat: 0, points: 500, place: Some((0.1, 0.2)) },
        GameEventKind::Message { place: 1 },
        GameEventKind::Flipped { right: true },
        GameEventKind::SatDown { seat: 0 },
        GameEventKind::StoodUp { seat: 0 },
        GameEventKind::Started,
        GameEventKind::Served { seat: 0, ball: 1 },
        GameEventKind::Added { seat: 0 },
        GameEventKind::Saved { seat: 0 },
        GameEventKind::ExtraBall { seat: 0 },
        GameEventKind::Again { seat: 0 },
        GameEventKind::Lost { seat: 0 },
        GameEventKind::Forfeited { seat: 0 },
        GameEventKind::Announced { action: 0 },
        GameEventKind::Acted { action: 0 },
        GameEventKind::Undone { action: 0 },
        GameEventKind::Rescued { by: Rescue::Kickers },
        GameEventKind::Rescued { by: Rescue::Relaunch },
        GameEventKind::Over,
        GameEventKind::Nudged { nudge: Nudge::Forward },
        GameEventKind::Warned { seat: 1 },
        GameEventKind::Tilted { seat: 1 },
        GameEventKind::Met { speed: 0.5, place: (0.1, 0.2) },
    ];
    kinds.map(|kind| BoardEvent { board: 1, event: GameEvent { tick: 9, kind } }).to_vec()
}
