//! Figures 1, 3 and 4 of the manual's chapter on movement, run by every motion model, as one picture: what a ball comes
//! through, and what it meets first. As in the tests of the manual a tick is a second and a pixel a metre.

use std::sync::Arc;
use std::time::Duration;

use glam::DVec2;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use shared::physics::motion::Motion;
use shared::physics::scene::Scene;
use shared::physics::shapes::Shape;
use shared::physics::{EventKind, World};
use shared::table::Table;

use super::contender::{Contender, Setting};
use super::real::{Real, Wide};
use super::trajectory::{Piece, crosses};

/// A figure: its number in the manual, what it shows, and its scene. A ball has a free tick before the one that counts.
struct Figure {
    number: u32,
    shows: &'static str,
    scene: &'static str,
}

const FIGURES: [Figure; 3] = [
    Figure {
        number: 1,
        shows: "problem 1: the ball is clear of a thin wall before a tick and after it",
        scene: FIGURE_1,
    },
    Figure {
        number: 3,
        shows: "problem 2: two walls lie in the way of a tick, and only the near one counts",
        scene: FIGURE_3,
    },
    Figure {
        number: 4,
        shows: "problem 2: two walls lie in the way of a tick, and the near one sends the ball to the far one",
        scene: FIGURE_4,
    },
];

/// A wall thinner than a step is long: the ball stands at x = 0 before the tick and at x = 10 after it.
const FIGURE_1: &str = r#"Scene(
    name: "figure 1", tick_hz: 1, pixel: 1.0, gravity: (0.0, 0.0), bounds: (-1e3, -1e3, 1e3, 1e3),
    balls: [(position: (-10.0, -5.5), velocity: (10.0, 5.5), radius: 1.0)],
    elements: [
        Wall(name: "wall", points: [(4.8, -7.0), (5.2, -7.0), (5.2, 7.0), (4.8, 7.0), (4.8, -7.0)]),
    ],
)"#;

/// Parallel walls: at the near one, which is written last, the ball turns round.
const FIGURE_3: &str = r#"Scene(
    name: "figure 3", tick_hz: 1, pixel: 1.0, gravity: (0.0, 0.0), bounds: (-1e3, -1e3, 1e3, 1e3),
    balls: [(position: (-10.0, 0.0), velocity: (10.0, 0.0), radius: 1.0)],
    elements: [
        Wall(name: "far wall", points: [(7.0, -7.0), (8.0, 7.0)]),
        Wall(name: "near wall", points: [(4.0, -7.0), (5.0, 7.0)]),
    ],
)"#;

/// A corner: the near wall sends the ball up, where the far one lies across.
const FIGURE_4: &str = r#"Scene(
    name: "figure 4", tick_hz: 1, pixel: 1.0, gravity: (0.0, 0.0), bounds: (-1e3, -1e3, 1e3, 1e3),
    balls: [(position: (-10.0, 0.0), velocity: (10.0, 0.0), radius: 1.0)],
    elements: [
        Wall(name: "far wall", points: [(7.5, 0.5), (1.0, 6.0)]),
        Wall(name: "near wall", points: [(2.0, -3.0), (6.0, 1.0)]),
    ],
)"#;

/// Ticks that are run.
const TICKS: u32 = 2;
/// Ticks a second.
const HZ: u32 = 1;
/// A run of some ticks takes microseconds.
const PATIENCE: Duration = Duration::from_secs(10);

/// What a model made of a figure.
struct Run {
    scene: Arc<Scene>,
    /// Corners of the ball's way, in order: where a model notices an impact late and puts the ball back, it goes back.
    way: Vec<DVec2>,
    /// The ball's centre at the start and at the end of each tick.
    places: Vec<DVec2>,
    /// Its centre at each impact.
    impacts: Vec<DVec2>,
    verdict: String,
}

impl Run {
    fn of(table: &Table, motion: Motion) -> Result<Self, String> {
        let setting = Setting { motion, tick_hz: HZ, pixel: None };
        let scene = setting.scene(&table.scene);
        let told = setting.play(&table.scene, f64::from(TICKS), PATIENCE)?;
        let end = Wide::of(f64::from(TICKS) / f64::from(HZ));
        let pieces: Vec<Piece> =
            told.balls.first().into_iter().flatten().filter(|piece| piece.start < end).copied().collect();
        if pieces.is_empty() {
            return Err(format!("{}: there is no ball", table.name));
        }
        let ends = || pieces.iter().skip(1).map(|piece| piece.start).chain([end]);
        let at = |piece: &Piece, time: Wide| piece.position + piece.way(time);

        // No figure has gravity: a piece is straight.
        let mut way = Vec::new();
        for (piece, end) in pieces.iter().zip(ends()) {
            way.extend([piece.position, at(piece, end)]);
        }
        let places = (0..=TICKS).map(|tick| {
            let time = Wide::of(f64::from(tick) / f64::from(HZ));
            let next = pieces.partition_point(|piece| piece.start <= time);
            at(&pieces[next.max(1) - 1], time)
        });
        let places = places.collect();

        // Trajectories do not say what was met.
        let (mut world, mut impacts, mut hit) = (World::new(scene.clone()), Vec::new(), Vec::new());
        for _ in 0..TICKS {
            for event in world.step() {
                if let EventKind::Touched { element, .. } = event.kind {
                    impacts.push(event.position);
                    hit.push(element);
                }
            }
        }
        let came_through = |element: u16| {
            let sides = || scene.colliders.iter().filter(|collider| collider.element == element);
            pieces.iter().zip(ends()).any(|(piece, end)| {
                let length = (end - piece.start).to_f64();
                sides().any(|side| crosses(piece, length, &side.shape))
            })
        };
        let passed: Vec<u16> = (0..).take(table.file.elements.len()).filter(|&element| came_through(element)).collect();
        let verdict = verdict(table, &hit, &passed, !told.escaped.is_empty());
        Ok(Self { scene, way, places, impacts, verdict })
    }
}

/// What happened, in words: what was hit, in that order, and what the ball's centre came through.
fn verdict(table: &Table, hit: &[u16], passed: &[u16], escaped: bool) -> String {
    let elements = &table.file.elements;
    let names = |list: &[u16], between: &str| {
        let names: Vec<&str> = list.iter().map(|&element| elements[usize::from(element)].name()).collect();
        names.join(between)
    };
    let mut parts = Vec::new();
    if !hit.is_empty() {
        parts.push(format!("hit {}", names(hit, ", then ")));
    }
    if !passed.is_empty() {
        let all = passed.len() == elements.len();
        parts.push(match (all, passed.len()) {
            (true, 1) => "came through".to_owned(),
            (true, 2) => "came through both".to_owned(),
            _ => format!("came through {}", names(passed, " and ")),
        });
    }
    if escaped {
        parts.push("escaped".to_owned());
    }
    if parts.is_empty() { "met nothing".to_owned() } else { parts.join(", ") }
}

/// A figure by every model.
type Row = (&'static Figure, Vec<(Motion, Run)>);

/// Every figure.
fn runs() -> Result<Vec<Row>, String> {
    let row = |figure: &'static Figure| {
        let table = Table::parse(&format!("figure {}", figure.number), figure.scene).map_err(|e| e.to_string())?;
        let row: Result<Vec<_>, String> =
            Motion::ALL.into_iter().map(|motion| Ok((motion, Run::of(&table, motion)?))).collect();
        Ok((figure, row?))
    };
    FIGURES.iter().map(row).collect()
}

/// Pixels of a metre, in both directions.
const SCALE: f64 = 14.0;
/// Half of what a panel shows, m; (0, 0) is in its middle.
const HALF: DVec2 = DVec2::new(11.5, 7.5);
/// Pixels of a panel.
const PANEL: (i32, i32) = ((2.0 * HALF.x * SCALE) as i32, (2.0 * HALF.y * SCALE) as i32);
/// Pixels around the panels.
const GAP: i32 = 14;
/// Pixels of what is written above all, above a row, and above a panel.
const HEAD: i32 = 40;
const ROW_HEAD: i32 = 28;
const TITLE: i32 = 22;

const WALL: RGBColor = RGBColor(0x26, 0x26, 0x26);
const WAY: RGBColor = RGBColor(0x2b, 0x7b, 0xba);
const BALL: RGBColor = RGBColor(0x8a, 0xbc, 0xe0);
const IMPACT: RGBColor = RGBColor(0xc0, 0x1f, 0x3a);
const FRAME: RGBColor = RGBColor(0xc8, 0xc8, 0xc8);

/// Figures 1, 3 and 4 of the manual, a row each, run by every motion model, a column each, as a picture in SVG.
///
/// # Errors
/// If a figure cannot be run, or the drawing fails.
pub fn picture() -> Result<String, String> {
    let runs = runs()?;
    let mut text = String::new();
    draw(&mut text, &runs).map_err(|error| format!("cannot draw the picture: {error}"))?;
    Ok(text)
}

fn draw(text: &mut String, runs: &[Row]) -> Result<(), Box<dyn std::error::Error>> {
    let row_height = ROW_HEAD + TITLE + PANEL.1 + GAP;
    let columns = Motion::ALL.len() as i32;
    let size = (GAP + columns * (PANEL.0 + GAP), HEAD + runs.len() as i32 * row_height);
    let root = SVGBackend::with_string(text, (size.0 as u32, size.1 as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    legend(&root)?;
    let row_style = written(16);
    let title_style = written(14);
    for (row, (figure, panels)) in (0..).zip(runs) {
        let top = HEAD + row * row_height;
        root.draw(&Text::new(figure.shows, (GAP, top + ROW_HEAD / 2), row_style.clone()))?;
        for (column, (motion, run)) in (0..).zip(panels) {
            let corner = (GAP + column * (PANEL.0 + GAP), top + ROW_HEAD + TITLE);
            let title = format!("figure {}, {motion}: {}", figure.number, run.verdict);
            root.draw(&Text::new(title, (corner.0, corner.1 - TITLE / 2), title_style.clone()))?;
            panel(&root, corner, run)?;
        }
    }
    root.present()?;
    Ok(())
}

/// A font that is set from its left, in the middle of its height.
fn written(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&WALL).pos(Pos::new(HPos::Left, VPos::Center))
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// What the marks mean, in a line above all.
fn legend(root: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
    let (y, style) = (HEAD / 2, written(14));
    root.draw(&PathElement::new([(GAP, y), (GAP + 24, y)], WALL.stroke_width(3)))?;
    root.draw(&Text::new("wall", (GAP + 32, y), style.clone()))?;
    root.draw(&PathElement::new([(GAP + 90, y), (GAP + 114, y)], WAY.stroke_width(2)))?;
    root.draw(&Text::new("way of the ball's centre", (GAP + 122, y), style.clone()))?;
    let radius = SCALE as i32;
    root.draw(&Circle::new((GAP + 320, y), radius, BALL.mix(0.4).filled()))?;
    root.draw(&Circle::new((GAP + 320, y), radius, BALL.stroke_width(1)))?;
    root.draw(&Text::new("the ball at the start and at the end of each tick", (GAP + 342, y), style.clone()))?;
    root.draw(&Circle::new((GAP + 700, y), radius, IMPACT.stroke_width(1)))?;
    root.draw(&Circle::new((GAP + 700, y), 4, IMPACT.filled()))?;
    root.draw(&Text::new("the ball at an impact, as the model has it", (GAP + 722, y), style))?;
    Ok(())
}

fn panel(root: &Area<'_>, (left, top): (i32, i32), run: &Run) -> Result<(), Box<dyn std::error::Error>> {
    let pixel = |place: DVec2| {
        let way = DVec2::new(HALF.x + place.x, HALF.y - place.y) * SCALE;
        (left + way.x.round() as i32, top + way.y.round() as i32)
    };
    let radius = run.scene.start.first().map_or(0.0, |ball| run.scene.kinds[usize::from(ball.kind)].radius);
    let radius = (radius * SCALE).round() as i32;
    root.draw(&Rectangle::new([(left, top), (left + PANEL.0, top + PANEL.1)], FRAME))?;
    for &place in &run.places {
        root.draw(&Circle::new(pixel(place), radius, BALL.mix(0.4).filled()))?;
        root.draw(&Circle::new(pixel(place), radius, BALL.stroke_width(1)))?;
    }
    for collider in &run.scene.colliders {
        if let Shape::Segment(side) = &collider.shape {
            root.draw(&PathElement::new([pixel(side.a), pixel(side.b)], WALL.stroke_width(3)))?;
        }
    }
    let way: Vec<(i32, i32)> = run.way.iter().map(|&place| pixel(place)).collect();
    root.draw(&PathElement::new(way, WAY.stroke_width(2)))?;
    for &place in &run.impacts {
        root.draw(&Circle::new(pixel(place), radius, IMPACT.stroke_width(1)))?;
        root.draw(&Circle::new(pixel(place), 4, IMPACT.filled()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdicts(number: u32) -> Vec<String> {
        let runs = runs().expect("scenes of our own");
        let (_, row) = runs.into_iter().find(|(figure, _)| figure.number == number).expect("one of them");
        row.into_iter().map(|(_, run)| run.verdict).collect()
    }

    #[test]
    fn only_the_discrete_model_comes_through_the_wall_of_figure_1() {
        assert_eq!(verdicts(1), ["came through", "hit wall", "hit wall", "hit wall"]);
    }

    #[test]
    fn the_others_meet_the_walls_of_figures_3_and_4_in_order() {
        assert_eq!(verdicts(3)[0], "came through both");
        assert_eq!(verdicts(3)[2..], ["hit near wall"; 2]);
        assert_eq!(verdicts(4)[2..], ["hit near wall, then far wall"; 2]);
    }

    #[test]
    fn every_figure_has_a_panel_for_every_model_and_lies_within_it() {
        let text = picture().expect("a picture");
        for figure in &FIGURES {
            for motion in Motion::ALL {
                let title = format!("figure {}, {motion}: ", figure.number);
                assert_eq!(text.matches(&title).count(), 1, "{title}");
            }
        }
        let frame = "fill=\"none\" stroke=\"#C8C8C8\"";
        assert_eq!(text.matches(frame).count(), FIGURES.len() * Motion::ALL.len());
        for (figure, row) in runs().expect("scenes of our own") {
            for (motion, run) in row {
                let all = run.way.iter().chain(&run.places).chain(&run.impacts);
                // The ball's radius is 1 m.
                let inside = |place: &DVec2| place.abs().cmple(HALF - 1.0).all();
                assert!(all.copied().all(|place| inside(&place)), "figure {}, {motion}", figure.number);
            }
        }
    }
}
