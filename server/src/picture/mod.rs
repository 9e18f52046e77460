//! `simulate --svg`: one picture of a table at the end of a simulation, with the last way of each ball and the next.
//!
//! What is drawn on the table is written in metres, as `shared::outline` gives it, so that a program can read it as well;
//! one transform makes pixels of it. Axes and words stand outside of that.

mod frame;
#[cfg(test)]
mod tests;

use std::fmt::Write as _;

use glam::DVec2;
use shared::outline::foresight::{Foresight, foresee};
use shared::outline::track::{Impact, Track, Tracks};
use shared::outline::{Kind, Outline, Part, outlines, support_elements};
use shared::physics::ball::Instant;
use shared::physics::shapes::Bounds;
use shared::physics::{EventKind, World};
use shared::table::Table;

use self::frame::{Frame, nice_step};

/// World time for which a ball's next impact is looked for, seconds.
const FORESIGHT: f64 = 1.0;
/// Arrows are at most this share of the picture's longer side.
const LONGEST_ARROW: f64 = 0.12;
/// A color for each ball, in turn.
const BALLS: [&str; 6] = ["#1f5fbf", "#b0409a", "#0b8a7a", "#c06a00", "#5b50c8", "#7a7a00"];
/// Most balls that get a line of words.
const MOST_WORDS: usize = 12;
const STYLE: &str = "
.shape { fill: none; stroke: #30343a; stroke-linecap: round }
.other { stroke: #b8bcc4 }
.oneway { stroke: #c06a00 }
.passed { stroke: #2a9d55 }
.mover { stroke: #d03a2a }
.support { stroke: #ff9d00 }
.point { fill: #30343a; stroke: none }
.other.point { fill: #b8bcc4 }
.normal { fill: none; stroke: #7f8a99 }
.path, .flight { fill: none; stroke-linejoin: round }
.impact { fill: #d03a2a; stroke: none }
.bounce { fill: none; stroke: #d03a2a }
.after { fill: none; stroke: #2a9d55 }
.ball { fill-opacity: 0.18 }
.velocity, .cross { fill: none }
text { font-family: sans-serif; font-size: 12px; fill: #30343a }
.title { font-size: 16px }
.axis { stroke: #d8dce2; stroke-width: 1 }
";

/// The picture of a world, as SVG. `tracks` are the last ways of its balls, `over` how many seconds of them.
pub fn svg(table: &Table, world: &World, tracks: &[Track], over: f64) -> String {
    let now = Instant::start_of(world.state().tick);
    let shapes = outlines(world);
    let flights = foresee(world, now, FORESIGHT);
    let frame = Frame::around(&extent(world, &shapes, tracks), world.scene().origin);
    let picture = Picture { table, world, frame, arrow: arrow_seconds(world, tracks, &frame), now };
    let words = picture.words(over, &flights);
    let mut text = picture.frame.open(&picture.style(), words.len());
    picture.frame.axes(&mut text);
    text.push_str(&picture.frame.open_metres());
    picture.shapes(&mut text, &shapes);
    picture.tracks(&mut text, tracks);
    picture.flights(&mut text, &flights);
    picture.balls(&mut text);
    text.push_str("</g>\n");
    picture.frame.words(&mut text, &words);
    text.push_str("</svg>\n");
    text
}

/// What the picture shows: the shapes; where there are none, the balls and their ways.
fn extent(world: &World, shapes: &[Outline], tracks: &[Track]) -> Bounds {
    let now = Instant::start_of(world.state().tick);
    let balls = world.state().balls.iter().map(|ball| ball.at(now, world.scene().tick_seconds).0);
    let ways = tracks.iter().flat_map(|track| &track.points).copied();
    let points: Vec<DVec2> = if shapes.is_empty() {
        balls.chain(ways).collect()
    } else {
        shapes.iter().flat_map(|shape| &shape.points).copied().collect()
    };
    let first = points.first().copied().unwrap_or_default();
    let around = points
        .iter()
        .fold(Bounds { low: first, high: first }, |around, &point| around.joined(Bounds { low: point, high: point }));
    around.grown(world.scene().largest_radius())
}

/// Arrows are the way of a ball in this time, seconds: one, two or five of a power of ten.
fn arrow_seconds(world: &World, tracks: &[Track], frame: &Frame) -> f64 {
    let now = Instant::start_of(world.state().tick);
    let balls = world.state().balls.iter().map(|ball| ball.at(now, world.scene().tick_seconds).1);
    let after = tracks.iter().flat_map(|track| &track.impacts).map(|impact| impact.event.velocity);
    let fastest = balls.chain(after).map(DVec2::length).fold(0.0, f64::max);
    if fastest > 0.0 { nice_step(LONGEST_ARROW * frame.extent() / fastest) } else { 1.0 }
}

/// What is drawn, and how.
struct Picture<'a> {
    table: &'a Table,
    world: &'a World,
    frame: Frame,
    /// See [`arrow_seconds`].
    arrow: f64,
    now: Instant,
}

impl Picture<'_> {
    /// Dashes are in the units of what is drawn, which are metres.
    fn style(&self) -> String {
        let dashes = |class: &str, on: f64, off: f64| {
            format!("{class} {{ stroke-dasharray: {} {} }}\n", self.frame.metres(on), self.frame.metres(off))
        };
        format!("{STYLE}{}{}", dashes(".passed", 4.0, 3.0), dashes(".flight", 6.0, 5.0))
    }

    fn shapes(&self, text: &mut String, shapes: &[Outline]) {
        let balls = &self.world.state().balls;
        let in_play = |floor: u8| balls.is_empty() || balls.iter().any(|ball| ball.floor == floor);
        let dot = self.frame.metres(1.5);
        text.push_str("<g id=\"shapes\">\n");
        for shape in shapes {
            let mut class = String::from("shape");
            let supports = balls.iter().any(|ball| shape.part.supports(ball.support));
            let marks = [
                (" passed", shape.kind == Kind::Passed),
                (" oneway", shape.kind == Kind::OneWay),
                (" mover", matches!(shape.part, Part::Flipper(_) | Part::Plunger(_))),
                (" other", !in_play(shape.floor)),
                (" support", supports),
            ];
            marks.iter().filter(|(_, is_so)| *is_so).for_each(|(mark, _)| class.push_str(mark));
            let name = escaped(self.name(shape.element));
            let width = self.frame.metres(if supports { 4.0 } else { 1.6 });
            let _ = match shape.points.as_slice() {
                [point] => writeln!(
                    text,
                    "<circle class=\"{class} point\" cx=\"{}\" cy=\"{}\" r=\"{dot}\"><title>{name}</title></circle>",
                    point.x, point.y
                ),
                points => writeln!(
                    text,
                    "<polyline class=\"{class}\" stroke-width=\"{width}\" points=\"{}\"><title>{name}</title></polyline>",
                    list(points)
                ),
            };
        }
        text.push_str("</g>\n<g id=\"normals\">\n");
        for shape in shapes.iter().filter(|shape| in_play(shape.floor)) {
            let (length, width) = if shape.kind == Kind::OneWay { (14.0, 1.6) } else { (6.0, 0.8) };
            for normal in &shape.normals {
                let tip = normal.at + normal.towards * self.frame.metres(length);
                self.line(text, "normal", "", width, &[normal.at, tip]);
            }
        }
        text.push_str("</g>\n");
    }

    fn tracks(&self, text: &mut String, tracks: &[Track]) {
        text.push_str("<g id=\"paths\">\n");
        for track in tracks {
            self.line(text, "path", color(track.ball), 1.4, &track.points);
        }
        for impact in tracks.iter().flat_map(|track| &track.impacts) {
            self.impact(text, impact);
        }
        text.push_str("</g>\n");
    }

    /// A dot where a ball's centre was, the normal, and the velocity after.
    fn impact(&self, text: &mut String, Impact { event, normal }: &Impact) {
        let (at, radius) = (event.position, self.frame.metres(2.5));
        let what = escaped(&self.what(event.kind));
        let _ = writeln!(
            text,
            "<circle class=\"impact\" cx=\"{}\" cy=\"{}\" r=\"{radius}\"><title>{what}</title></circle>",
            at.x, at.y
        );
        if let Some(normal) = normal {
            self.line(text, "bounce", "", 1.2, &[at, at + *normal * self.frame.metres(14.0)]);
            self.arrow(text, "after", "", at, event.velocity);
        }
    }

    /// Dashed, with a cross and the normal where it ends at something.
    fn flights(&self, text: &mut String, flights: &[Foresight]) {
        text.push_str("<g id=\"flights\">\n");
        for flight in flights {
            let color = color(flight.ball);
            self.line(text, "flight", color, 1.6, &flight.points);
            let Some(Impact { event, normal }) = flight.impact else { continue };
            let arm = self.frame.metres(5.0);
            for across in [DVec2::new(arm, arm), DVec2::new(arm, -arm)] {
                self.line(text, "cross", color, 1.8, &[event.position - across, event.position + across]);
            }
            if let Some(normal) = normal {
                self.line(
                    text,
                    "bounce",
                    "",
                    1.2,
                    &[event.position, event.position + normal * self.frame.metres(14.0)],
                );
            }
        }
        text.push_str("</g>\n");
    }

    fn balls(&self, text: &mut String) {
        text.push_str("<g id=\"balls\">\n");
        for ball in &self.world.state().balls {
            let (at, velocity) = ball.at(self.now, self.world.scene().tick_seconds);
            // To scale, as long as it is to be seen.
            let (color, radius) = (color(ball.id), self.world.scene().radius(ball.kind).max(self.frame.metres(2.0)));
            let _ = writeln!(
                text,
                "<circle class=\"ball\" fill=\"{color}\" stroke=\"{color}\" stroke-width=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{radius}\"/>",
                self.frame.metres(1.6),
                at.x,
                at.y
            );
            self.arrow(text, "velocity", color, at, velocity);
        }
        text.push_str("</g>\n");
    }

    fn line(&self, text: &mut String, class: &str, color: &str, width: f64, points: &[DVec2]) {
        let stroke = if color.is_empty() { String::new() } else { format!(" stroke=\"{color}\"") };
        let width = self.frame.metres(width);
        let _ = writeln!(
            text,
            "<polyline class=\"{class}\"{stroke} stroke-width=\"{width}\" points=\"{}\"/>",
            list(points)
        );
    }

    fn arrow(&self, text: &mut String, class: &str, color: &str, from: DVec2, velocity: DVec2) {
        let way = velocity * self.arrow;
        let Some(ahead) = way.try_normalize() else { return };
        let (tip, head) = (from + way, ahead * self.frame.metres(6.0).min(way.length()));
        let barb = |side: f64| tip - head + head.perp() * (0.5 * side);
        self.line(text, class, color, 1.4, &[from, tip, barb(1.0), tip, barb(-1.0)]);
    }

    /// Title, what the arrows mean, and a line for each ball.
    fn words(&self, over: f64, flights: &[Foresight]) -> Vec<String> {
        let (scene, state) = (self.world.scene(), self.world.state());
        let seconds = self.now.since(Instant::start_of(0), scene.tick_seconds);
        let mut words = vec![format!("{}: {seconds:.3} s, tick {}", self.table.name, state.tick)];
        words.push(format!("where balls were in the last {over} s; dashed: where they go until they meet something"));
        words.push(format!("arrows: the way of a ball in {} s; green arrows: after an impact", self.arrow));
        for ball in state.balls.iter().take(MOST_WORDS) {
            let (_, velocity) = ball.at(self.now, scene.tick_seconds);
            let mut line = format!("ball {}: {:.3} m/s", ball.id, velocity.length());
            let spin = ball.spin_at(self.now, scene);
            if spin != 0.0 {
                let _ = write!(line, ", spin {spin:.1} rad/s");
            }
            if ball.floor != 0 {
                let _ = write!(line, ", floor {}", ball.floor);
            }
            let on: Vec<&str> = support_elements(self.world, ball.support).iter().map(|on| self.name(*on)).collect();
            if !on.is_empty() {
                let _ = write!(line, ", lies on {}", on.join(" and "));
            }
            let flight = flights.iter().find(|flight| flight.ball == ball.id);
            match flight.and_then(|flight| flight.impact) {
                Some(Impact { event, .. }) => {
                    let wait = event.at.since(self.now, scene.tick_seconds);
                    let _ = write!(line, "; in {wait:.4} s {}", self.what(event.kind));
                }
                None => {
                    let _ = write!(line, "; meets nothing for {FORESIGHT} s");
                }
            }
            words.push(line);
        }
        if state.balls.len() > MOST_WORDS {
            words.push(format!("and {} balls more", state.balls.len() - MOST_WORDS));
        }
        words.iter().map(|line| escaped(line)).collect()
    }

    fn name(&self, element: u16) -> &str {
        self.table.file.elements.get(usize::from(element)).map_or("?", |element| element.name())
    }

    /// An event in words.
    fn what(&self, kind: EventKind) -> String {
        match kind {
            EventKind::Touched { element, speed } => format!("touches {} at {speed:.3} m/s", self.name(element)),
            EventKind::Kicked { element, speed } => format!("is kicked by {} at {speed:.3} m/s", self.name(element)),
            EventKind::Felled { element, speed } => format!("fells {} at {speed:.3} m/s", self.name(element)),
            EventKind::Met { other, speed } => format!("meets ball {other} at {speed:.3} m/s"),
            EventKind::Struck { element, speed } => format!("strikes {} at {speed:.3} m/s", self.name(element)),
            EventKind::Spun { element } => format!("turns {}", self.name(element)),
            EventKind::Held { element } => format!("is held by {}", self.name(element)),
            EventKind::Ejected { element } => format!("is thrown out by {}", self.name(element)),
            EventKind::Passed { element } => format!("passes {}", self.name(element)),
            EventKind::Stalled { .. } => "stalls".to_owned(),
            EventKind::Drained => "drains".to_owned(),
            EventKind::Escaped => "escapes".to_owned(),
        }
    }
}

fn color(ball: u32) -> &'static str {
    BALLS[ball as usize % BALLS.len()]
}

/// Points as SVG lists them, with every digit.
fn list(points: &[DVec2]) -> String {
    let mut text = String::with_capacity(points.len() * 40);
    for point in points {
        let _ = write!(text, "{},{} ", point.x, point.y);
    }
    text.truncate(text.trim_end().len());
    text
}

/// Names come from files.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The ways of the last `seconds` of a simulation of `ticks` ticks, taken while it runs.
#[derive(Debug)]
pub struct Recent {
    from: u64,
    tracks: Option<Tracks>,
}

impl Recent {
    /// Begins to look `seconds` before the end.
    pub fn new(table: &Table, ticks: u64, seconds: f64) -> Self {
        // A cast saturates.
        Self { from: ticks.saturating_sub((seconds / table.scene.tick_seconds).round() as u64), tracks: None }
    }

    /// Is shown the world before the first step, and after each.
    pub fn look(&mut self, world: &World) {
        let tick = world.state().tick;
        match &mut self.tracks {
            Some(tracks) => tracks.after_step(world),
            None if tick >= self.from => self.tracks = Some(Tracks::begin(world, Instant::start_of(tick), false)),
            None => {}
        }
    }

    /// The ways, at the end.
    pub fn finish(self, world: &World) -> Vec<Track> {
        self.tracks.map(|tracks| tracks.finish(world)).unwrap_or_default()
    }
}
