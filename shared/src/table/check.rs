//! Written form -> checked form: every number in range, every name known.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;
use ron::Options;
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

use super::error::TableError;
use super::format::{ElementFile, Point, TableFile};
use super::locate::{Step, element_at, line_of};
use super::shapes::Bare;
use super::{FORMAT_VERSION, MOST_TEXT, Table, rulebook, scene_form, shapes};
use crate::math::Digest;
use crate::physics::scene::{Collider, Scene};
use crate::physics::shapes::{Shape, Side};
use crate::physics::{MOST_PARTS, PHYSICS_VERSION};

/// Most elements of a table, and of a scene.
const MOST_ELEMENTS: (usize, usize) = (2000, 20_000);

/// Largest coordinate of a scene, m.
pub(super) const MOST_COORDINATE: f64 = 1e12;
/// Share of a ball's radius by which it may overlap something at its start: what decimals leave.
const TOUCHING: f64 = 1e-6;

/// Longest name or message, characters.
const MOST_CHARACTERS: usize = 40;

/// What an error is about.
#[derive(Debug, Clone, Copy)]
pub(super) enum Spot<'a> {
    Table,
    Ball,
    Cabinet,
    Rules,
    BallSave,
    /// By its place among the rules.
    Rule(usize),
    Crowd,
    /// By its place among the crowd's actions.
    CrowdAction(usize),
    Material(&'a str),
    Group(&'a str),
    /// By its place among the elements.
    Element(u16),
    /// By its place among a scene's balls.
    StartBall(usize),
}

/// A table on its way through the checks.
pub(super) struct Context<'a> {
    name: &'a str,
    source: &'a str,
    pub(super) file: &'a TableFile,
    /// It is a bare scene, whose numbers have wider ranges.
    pub(super) is_scene: bool,
    indices: BTreeMap<&'a str, u16>,
}

pub(super) fn parse(name: &str, source: &str) -> Result<Table, TableError> {
    if scene_form::is_scene(source) {
        return scene_form::parse(name, source);
    }
    let file: TableFile = read(name, source, MOST_TEXT)?;
    let context = Context { name, source, file: &file, is_scene: false, indices: BTreeMap::new() };
    context.versions()?;
    context.table_numbers()?;
    context.materials()?;
    let context = context.with_names()?;
    context.has_a_drain()?;
    context.groups()?;
    let scene = shapes::build(&context, &Bare::of_table(&file))?;
    context.start_is_clear(Spot::Ball, "start", file.ball.start, file.ball.radius, &scene)?;
    let rules = rulebook::resolve(&context, &file.rules)?;
    Ok(Table {
        name: file.name.clone(),
        source: source.to_owned(),
        digest: digest(source),
        has_rules: true,
        accuracy: file.accuracy,
        scene: Arc::new(scene),
        ball_start: vector(file.ball.start),
        rules,
        acts: file.elements.iter().map(acts).collect(),
        targets: context.all(|element| matches!(element, ElementFile::DropTarget(_))),
        lights: context.all(|element| matches!(element, ElementFile::Light(_))),
        file,
    })
}

pub(super) fn digest(source: &str) -> u64 {
    let mut digest = Digest::default();
    digest.update(source.as_bytes());
    digest.finish()
}

/// The written form in a text of at most `most` bytes.
pub(super) fn read<T: DeserializeOwned>(name: &str, source: &str, most: usize) -> Result<T, TableError> {
    if source.len() > most {
        let problem = format!("{} bytes are more than the {most} that it may have", source.len());
        return Err(TableError { file: name.to_owned(), line: 0, element: None, field: None, problem });
    }
    let extensions = Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME;
    let options = Options::default().with_default_extension(extensions);
    options.from_str(source).map_err(|error| unreadable(name, source, &error))
}

/// What the parser complains of, with the element and the field that it is about.
fn unreadable(file: &str, source: &str, error: &ron::error::SpannedError) -> TableError {
    use ron::Error as E;
    let place = error.span.start;
    let field = match &error.code {
        E::NoSuchStructField { found, .. } => Some(found.clone()),
        E::MissingStructField { field, .. } | E::DuplicateStructField { field, .. } => Some((*field).to_owned()),
        _ => None,
    };
    TableError {
        file: file.to_owned(),
        line: place.line,
        element: element_at(source, place.line, place.col),
        field,
        problem: error.code.to_string(),
    }
}

pub(super) fn acts(element: &ElementFile) -> bool {
    use ElementFile as E;
    matches!(element, E::Bumper(_) | E::Slingshot(_) | E::DropTarget(_) | E::Target(_))
}

/// A written point as a vector.
pub(super) fn vector(point: Point) -> DVec2 {
    DVec2::new(point.0, point.1)
}

impl<'a> Context<'a> {
    pub(super) fn error(&self, spot: Spot<'_>, field: Option<&str>, problem: String) -> TableError {
        self.error_at(spot, field, None, problem)
    }

    /// An error about one item of a field that is a list.
    pub(super) fn error_at(
        &self,
        spot: Spot<'_>,
        field: Option<&str>,
        item: Option<usize>,
        problem: String,
    ) -> TableError {
        let spot_way: &[Step<'_>] = match spot {
            Spot::Table => &[],
            Spot::Ball => &[Step::Field("ball")],
            Spot::Cabinet => &[Step::Field("cabinet")],
            Spot::Rules => &[Step::Field("rules")],
            Spot::BallSave => &[Step::Field("rules"), Step::Field("ball_save")],
            Spot::Rule(place) => &[Step::Field("rules"), Step::Field("on"), Step::Item(place)],
            Spot::Crowd => &[Step::Field("rules"), Step::Field("crowd")],
            Spot::CrowdAction(place) => {
                &[Step::Field("rules"), Step::Field("crowd"), Step::Field("actions"), Step::Item(place)]
            }
            Spot::Material(name) => &[Step::Field("materials"), Step::Key(name)],
            Spot::Group(name) => &[Step::Field("groups"), Step::Key(name)],
            Spot::Element(place) => &[Step::Field("elements"), Step::Item(usize::from(place))],
            Spot::StartBall(place) => &[Step::Field("balls"), Step::Item(place)],
        };
        let way: Vec<_> = spot_way.iter().copied().chain(field.map(Step::Field)).chain(item.map(Step::Item)).collect();
        let element = match spot {
            Spot::Table => None,
            Spot::Ball => Some("ball".to_owned()),
            Spot::Cabinet => Some("cabinet".to_owned()),
            Spot::Rules => Some("rules".to_owned()),
            Spot::BallSave => Some("ball save".to_owned()),
            Spot::Rule(place) => Some(format!("rule {}", place + 1)),
            Spot::Crowd => Some("crowd".to_owned()),
            Spot::CrowdAction(place) => Some(format!("crowd action {}", place + 1)),
            Spot::StartBall(place) => Some(format!("ball {}", place + 1)),
            Spot::Material(name) | Spot::Group(name) => Some(name.to_owned()),
            Spot::Element(place) => Some(self.file.elements[usize::from(place)].name().to_owned()),
        };
        TableError {
            file: self.name.to_owned(),
            line: line_of(self.source, &way),
            element: element.filter(|name| !name.is_empty()),
            field: field.map(str::to_owned),
            problem,
        }
    }

    /// Refuses NaN, infinities and what is out of range.
    pub(super) fn in_range(
        &self,
        spot: Spot<'_>,
        field: &str,
        value: f64,
        low: f64,
        high: f64,
        example: &str,
    ) -> Result<(), TableError> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let problem = format!("{value} is not within {low} to {high}; {example} would be right");
        Err(self.error(spot, Some(field), problem))
    }

    /// A point on the table, or at most a tenth of its size beside it. `item`: its place in a field that is a list.
    pub(super) fn point(
        &self,
        spot: Spot<'_>,
        field: &str,
        item: Option<usize>,
        point: Point,
    ) -> Result<DVec2, TableError> {
        if self.is_scene {
            // Each for itself: the larger one of a number and NaN is the number.
            let fits = |value: f64| value.abs() <= MOST_COORDINATE;
            return if fits(point.0) && fits(point.1) {
                Ok(vector(point))
            } else {
                let problem = format!(
                    "{point:?} is no place; coordinates in metres of at most {MOST_COORDINATE:e} would be right"
                );
                Err(self.error_at(spot, Some(field), item, problem))
            };
        }
        let size = vector(self.file.size);
        let margin = 0.1 * if size.x > size.y { size.x } else { size.y };
        let fits = |value: f64, size: f64| value >= -margin && value <= size + margin;
        if fits(point.0, size.x) && fits(point.1, size.y) {
            return Ok(vector(point));
        }
        let problem = format!(
            "{point:?} is not on the table; (x, y) within (0, 0) to {:?} metres would be right",
            self.file.size
        );
        Err(self.error_at(spot, Some(field), item, problem))
    }

    /// The place of an element in the file.
    pub(super) fn index_of(&self, name: &str) -> Option<u16> {
        self.indices.get(name).copied()
    }

    fn all(&self, is_wanted: impl Fn(&ElementFile) -> bool) -> Vec<u16> {
        (0..).zip(&self.file.elements).filter(|(_, element)| is_wanted(element)).map(|(index, _)| index).collect()
    }

    pub(super) fn new(name: &'a str, source: &'a str, file: &'a TableFile) -> Self {
        Self { name, source, file, is_scene: true, indices: BTreeMap::new() }
    }

    fn versions(&self) -> Result<(), TableError> {
        let versions = [("format", self.file.format, FORMAT_VERSION), ("physics", self.file.physics, PHYSICS_VERSION)];
        for (field, found, known) in versions {
            if found != known {
                let problem = format!("version {found} is not known here; this program knows version {known}");
                return Err(self.error(Spot::Table, Some(field), problem));
            }
        }
        Ok(())
    }

    /// An accuracy that can be asked for, and nothing that it would decide.
    pub(super) fn accuracy(&self) -> Result<(), TableError> {
        let Some(accuracy) = self.file.accuracy else { return Ok(()) };
        if let Some(problem) = accuracy.problem() {
            return Err(self.error(Spot::Table, Some("accuracy"), problem));
        }
        for field in ["motion", "tick_hz"] {
            if line_of(self.source, &[Step::Field(field)]) > 0 {
                let problem = "`accuracy` decides it; either of them would be right".to_owned();
                return Err(self.error(Spot::Table, Some(field), problem));
            }
        }
        Ok(())
    }

    fn table_numbers(&self) -> Result<(), TableError> {
        let file = self.file;
        self.printable(Spot::Table, Some("name"), &file.name)?;
        for length in [file.size.0, file.size.1] {
            self.in_range(Spot::Table, "size", length, 1e-3, 1e3, "(0.514, 1.067) metres")?;
        }
        self.accuracy()?;
        self.in_range(Spot::Table, "tick_hz", f64::from(file.tick_hz), 1.0, 1e6, "1000")?;
        self.in_range(Spot::Table, "pixel", file.pixel, 1e-6, 1.0, "0.001 m")?;
        for pull in [file.gravity.0, file.gravity.1] {
            self.in_range(Spot::Table, "gravity", pull, -1e4, 1e4, "(0.0, -0.793) m/s^2")?;
        }
        for floor in &file.floors {
            for pull in [floor.0, floor.1] {
                self.in_range(Spot::Table, "floors", pull, -1e4, 1e4, "[(0.0, -2.5)] m/s^2")?;
            }
        }
        self.cabinet()?;
        self.in_range(Spot::Table, "rest_speed", file.rest_speed, 1e-6, 1.0, "0.02 m/s")?;
        let narrow = if file.size.0 < file.size.1 { file.size.0 } else { file.size.1 };
        self.in_range(Spot::Ball, "radius", file.ball.radius, 1e-5, 0.5 * narrow, "0.0135 m")?;
        self.in_range(Spot::Ball, "mass", file.ball.mass, 1e-6, 1e6, "0.08 kg")?;
        let start = vector(file.ball.start);
        if !(start.cmpge(DVec2::ZERO).all() && start.cmple(vector(file.size)).all()) {
            let problem = format!("{:?} is not on the table; a ball is served there", file.ball.start);
            return Err(self.error(Spot::Ball, Some("start"), problem));
        }
        Ok(())
    }

    fn cabinet(&self) -> Result<(), TableError> {
        let Some(cabinet) = self.file.cabinet else { return Ok(()) };
        let check = |field, value, low, high, example| self.in_range(Spot::Cabinet, field, value, low, high, example);
        check("nudge", cabinet.nudge, 0.0, 1.0, "0.06 m/s")?;
        for (frequency, damping) in [(cabinet.frequency.0, cabinet.damping.0), (cabinet.frequency.1, cabinet.damping.1)]
        {
            check("frequency", frequency, 0.1, 100.0, "(9.3, 5.8) Hz")?;
            check("damping", damping, 1e-3, 0.99, "(0.052, 0.055)")?;
        }
        check("bob_length", cabinet.bob_length, 1e-3, 10.0, "0.1 m")?;
        check("bob_damping", cabinet.bob_damping, 1e-3, 0.99, "0.05")?;
        check("tilt", cabinet.tilt, 0.01, 45.0, "1 degree")
    }

    fn materials(&self) -> Result<(), TableError> {
        for (name, material) in &self.file.materials {
            let spot = Spot::Material(name);
            self.printable(spot, None, name)?;
            self.in_range(spot, "restitution", material.restitution, 0.0, 1.0, "0.8")?;
            self.in_range(spot, "falloff", material.falloff, 0.0, 1e3, "0.3 s/m")?;
            self.in_range(spot, "friction", material.friction, 0.0, 10.0, "0.6")?;
            self.in_range(spot, "tangential", material.tangential, 0.0, 1.0, "1 or, of the manual's own lines, 0.9")?;
        }
        Ok(())
    }

    pub(super) fn with_names(mut self) -> Result<Self, TableError> {
        let elements = &self.file.elements;
        let most = if self.is_scene { MOST_ELEMENTS.1 } else { MOST_ELEMENTS.0 };
        if elements.len() > most {
            let problem = format!("{} elements are more than {most}", elements.len());
            return Err(self.error(Spot::Table, Some("elements"), problem));
        }
        for (index, element) in (0..).zip(elements) {
            let name = element.name();
            self.printable(Spot::Element(index), Some("name"), name)?;
            if let Some(first) = self.indices.insert(name, index) {
                let problem = format!("element {} of the list has this name, too; names must differ", first + 1);
                return Err(self.error(Spot::Element(index), Some("name"), problem));
            }
        }
        let count = |is_wanted: fn(&ElementFile) -> bool| elements.iter().filter(|element| is_wanted(element)).count();
        let kinds = [
            ("DropTarget", count(|element| matches!(element, ElementFile::DropTarget(_)))),
            ("Light", count(|element| matches!(element, ElementFile::Light(_)))),
            ("Flipper", count(|element| matches!(element, ElementFile::Flipper(_)))),
            ("Plunger", count(|element| matches!(element, ElementFile::Plunger(_)))),
            ("Spinner or Gate", count(|element| matches!(element, ElementFile::Spinner(_) | ElementFile::Gate(_)))),
            ("Saucer", count(|element| matches!(element, ElementFile::Saucer(_)))),
            ("Magnet", count(|element| matches!(element, ElementFile::Magnet(_)))),
        ];
        for (kind, found) in kinds {
            if found > MOST_PARTS {
                let problem = format!("{found} elements of the kind {kind} are more than {MOST_PARTS}");
                return Err(self.error(Spot::Table, Some("elements"), problem));
            }
        }
        Ok(self)
    }

    fn has_a_drain(&self) -> Result<(), TableError> {
        if self.file.elements.iter().any(|element| matches!(element, ElementFile::Drain(_))) {
            return Ok(());
        }
        let problem = "there is no Drain, so that no ball would ever end".to_owned();
        Err(self.error(Spot::Table, Some("elements"), problem))
    }

    /// A ball begins beside things, not in them.
    pub(super) fn start_is_clear(
        &self,
        spot: Spot<'_>,
        field: &str,
        start: Point,
        radius: f64,
        scene: &Scene,
    ) -> Result<(), TableError> {
        let place = vector(start);
        // What touches by the decimals of the file does not overlap.
        let reach = radius * (1.0 - TOUCHING);
        let is_in = |collider: &Collider| match &collider.shape {
            // The whole disc of a post is in the way, not its rim alone.
            Shape::Arc(arc) if arc.span.is_none() && arc.side == Side::Outside => {
                (place - arc.center).length() < arc.radius + reach
            }
            shape => shape.distance(place) < reach,
        };
        let in_the_way = |collider: &&Collider| !collider.role.is_passed() && collider.floor == 0;
        match scene.colliders.iter().filter(in_the_way).find(|collider| is_in(collider)) {
            None => Ok(()),
            Some(collider) => {
                let name = self.file.elements[usize::from(collider.element)].name();
                let place = place + scene.origin;
                let problem = format!(
                    "a ball at ({}, {}) would overlap {name:?}; a place that is a ball's radius from everything would be right",
                    place.x, place.y
                );
                Err(self.error(spot, Some(field), problem))
            }
        }
    }

    fn groups(&self) -> Result<(), TableError> {
        for (name, members) in &self.file.groups {
            let spot = Spot::Group(name);
            self.printable(spot, None, name)?;
            if self.index_of(name).is_some() {
                let problem = "a group has the name of an element; names must differ".to_owned();
                return Err(self.error(spot, None, problem));
            }
            let mut seen = BTreeSet::new();
            for (place, member) in members.iter().enumerate() {
                if self.index_of(member).is_none() {
                    let problem = format!("{member:?} is no element; a group has names of elements");
                    return Err(self.error_at(spot, None, Some(place), problem));
                }
                if !seen.insert(member) {
                    let problem = format!("{member:?} is in the group twice; once would be right");
                    return Err(self.error_at(spot, None, Some(place), problem));
                }
            }
        }
        Ok(())
    }

    /// Refuses text that does not fit a display, or would break a line of a log.
    pub(super) fn printable(&self, spot: Spot<'_>, field: Option<&str>, text: &str) -> Result<(), TableError> {
        if is_printable(text) { Ok(()) } else { Err(self.error(spot, field, unprintable(text))) }
    }
}

/// Whether a name or message is one that can be shown.
pub(crate) fn is_printable(text: &str) -> bool {
    !text.is_empty() && text.chars().count() <= MOST_CHARACTERS && !text.chars().any(char::is_control)
}

/// What is wrong with a text that cannot be shown.
pub(crate) fn unprintable(text: &str) -> String {
    format!("{text:?} is not 1 to {MOST_CHARACTERS} printable characters")
}
