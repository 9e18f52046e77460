//! The real server over loopback: one module a story.

#![forbid(unsafe_code)]

/// A server on a free port and clients that speak to it.
mod harness;

/// Who is let in, and in which words others are not.
mod handshake;
/// Nonsense, floods and silence: they cost their sender the connection and nobody else anything.
mod hostile;
/// A host's limits: each is kept, and whoever goes beyond it is told.
mod limits;
/// The three ways of playing against those who watch.
mod modes;
/// Nudging: the table moves for everybody, and a fit of nudges tilts the game.
mod nudge;
/// A pause, where a host allows it: the room stands still for everybody, and goes on as if nothing had been.
mod pause;
/// One player: from the first key to game over.
mod play;
/// A relay that does to bytes what networks do.
mod proxy;
/// Seats, turns and the line.
mod seats;
/// The end: a clean stop tells everybody.
mod stop;
/// Streams: state or inputs, how often, from where, and what happens when a copy is wrong.
mod streams;
/// Watching, joining late, lagging behind.
mod watch;
/// Bad networks: what they do to one client, they do to nobody else.
mod weather;
