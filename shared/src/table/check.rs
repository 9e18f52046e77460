//! Written form -> checked form: every number in range, every name known.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;
use ron::Options;
use ron::extensions::Extensions;

use super::error::TableError;
use super::format::{ElementFile, Point, TableFile};
use super::locate::line_of;
use super::{FORMAT_VERSION, MOST_TEXT, Table, rulebook, shapes};
use crate::math::Digest;
use crate::physics::{MOST_PARTS, PHYSICS_VERSION};

/// Most elements of a table.
const MOST_ELEMENTS: usize = 2000;

/// A table on its way through the checks.
pub(super) struct Context<'a> {
    name: &'a str,
    source: &'a str,
    pub(super) file: &'a TableFile,
    indices: BTreeMap<&'a str, u16>,
}

pub(super) fn parse(name: &str, source: &str) -> Result<Table, TableError> {
    let whole = |line, problem| TableError { file: name.to_owned(), line, element: None, field: None, problem };
    if source.len() > MOST_TEXT {
        return Err(whole(0, format!("{} bytes are more than the {MOST_TEXT} that a table may have", source.len())));
    }
    let extensions = Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME;
    let file: TableFile = Options::default()
        .with_default_extension(extensions)
        .from_str(source)
        .map_err(|error| whole(error.span.start.line, error.code.to_string()))?;
    let context = Context { name, source, file: &file, indices: BTreeMap::new() };
    context.versions()?;
    context.table_numbers()?;
    context.materials()?;
    let context = context.with_names()?;
    context.groups()?;
    let scene = shapes::build(&context)?;
    let rules = rulebook::resolve(&context, &file.rules)?;
    let mut digest = Digest::default();
    digest.update(source.as_bytes());
    Ok(Table {
        name: file.name.clone(),
        source: source.to_owned(),
        digest: digest.finish(),
        scene: Arc::new(scene),
        ball_start: vector(file.ball.start),
        rules,
        targets: context.all(|element| matches!(element, ElementFile::DropTarget(_))),
        lights: context.all(|element| matches!(element, ElementFile::Light(_))),
        file,
    })
}

/// A written point as a vector.
pub(super) fn vector(point: Point) -> DVec2 {
    DVec2::new(point.0, point.1)
}

impl<'a> Context<'a> {
    pub(super) fn error(&self, element: Option<&str>, field: Option<&str>, problem: String) -> TableError {
        TableError {
            file: self.name.to_owned(),
            line: line_of(self.source, element, field),
            element: element.map(str::to_owned),
            field: field.map(str::to_owned),
            problem,
        }
    }

    /// Refuses NaN, infinities and what is out of range.
    pub(super) fn in_range(
        &self,
        element: Option<&str>,
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
        Err(self.error(element, Some(field), problem))
    }

    /// A point on the table, or at most a tenth of its size beside it.
    pub(super) fn point(&self, element: &str, field: &str, point: Point) -> Result<DVec2, TableError> {
        let size = vector(self.file.size);
        let margin = 0.1 * if size.x > size.y { size.x } else { size.y };
        let fits = |value: f64, size: f64| value >= -margin && value <= size + margin;
        if fits(point.0, size.x) && fits(point.1, size.y) {
            return Ok(vector(point));
        }
        let problem = format!("{point:?} is not on the table, which is {} m wide and {} m high", size.x, size.y);
        Err(self.error(Some(element), Some(field), problem))
    }

    /// The place of an element in the file.
    pub(super) fn index_of(&self, name: &str) -> Option<u16> {
        self.indices.get(name).copied()
    }

    fn all(&self, is_wanted: impl Fn(&ElementFile) -> bool) -> Vec<u16> {
        (0..).zip(&self.file.elements).filter(|(_, element)| is_wanted(element)).map(|(index, _)| index).collect()
    }

    fn versions(&self) -> Result<(), TableError> {
        let versions = [("format", self.file.format, FORMAT_VERSION), ("physics", self.file.physics, PHYSICS_VERSION)];
        for (field, found, known) in versions {
            if found != known {
                let problem = format!("version {found} is not known here; this program knows version {known}");
                return Err(self.error(None, Some(field), problem));
            }
        }
        Ok(())
    }

    fn table_numbers(&self) -> Result<(), TableError> {
        let file = self.file;
        self.printable(None, "name", &file.name)?;
        for length in [file.size.0, file.size.1] {
            self.in_range(None, "size", length, 1e-3, 1e3, "(0.514, 1.067) metres")?;
        }
        self.in_range(None, "tick_hz", f64::from(file.tick_hz), 50.0, 100_000.0, "1000")?;
        for pull in [file.gravity.0, file.gravity.1] {
            self.in_range(None, "gravity", pull, -1e4, 1e4, "(0.0, -0.793) m/s^2")?;
        }
        self.in_range(None, "rest_speed", file.rest_speed, 1e-6, 1.0, "0.02 m/s")?;
        let narrow = if file.size.0 < file.size.1 { file.size.0 } else { file.size.1 };
        self.in_range(None, "radius", file.ball.radius, 1e-5, 0.5 * narrow, "0.0135 m")?;
        self.in_range(None, "mass", file.ball.mass, 1e-6, 1e6, "0.08 kg")?;
        let start = vector(file.ball.start);
        if !(start.cmpge(DVec2::ZERO).all() && start.cmple(vector(file.size)).all()) {
            let problem = format!("{:?} is not on the table; a ball is served there", file.ball.start);
            return Err(self.error(None, Some("start"), problem));
        }
        Ok(())
    }

    fn materials(&self) -> Result<(), TableError> {
        for (name, material) in &self.file.materials {
            let name = Some(name.as_str());
            self.in_range(name, "restitution", material.restitution, 0.0, 1.0, "0.8")?;
            self.in_range(name, "falloff", material.falloff, 0.0, 1e3, "0.3 s/m")?;
            self.in_range(name, "friction", material.friction, 0.0, 10.0, "0.6")?;
        }
        Ok(())
    }

    fn with_names(mut self) -> Result<Self, TableError> {
        let elements = &self.file.elements;
        if elements.len() > MOST_ELEMENTS {
            let problem = format!("{} elements are more than {MOST_ELEMENTS}", elements.len());
            return Err(self.error(None, Some("elements"), problem));
        }
        for (index, element) in (0..).zip(elements) {
            let name = element.name();
            self.printable(Some(name), "name", name)?;
            if self.indices.insert(name, index).is_some() {
                return Err(self.error(Some(name), Some("name"), "two elements have this name".to_owned()));
            }
        }
        let count = |is_wanted: fn(&ElementFile) -> bool| elements.iter().filter(|element| is_wanted(element)).count();
        let kinds = [
            ("DropTarget", count(|element| matches!(element, ElementFile::DropTarget(_)))),
            ("Light", count(|element| matches!(element, ElementFile::Light(_)))),
            ("Flipper", count(|element| matches!(element, ElementFile::Flipper(_)))),
            ("Plunger", count(|element| matches!(element, ElementFile::Plunger(_)))),
        ];
        for (kind, found) in kinds {
            if found > MOST_PARTS {
                let problem = format!("{found} elements of the kind {kind} are more than {MOST_PARTS}");
                return Err(self.error(None, Some("elements"), problem));
            }
        }
        if count(|element| matches!(element, ElementFile::Drain(_))) == 0 {
            let problem = "there is no Drain, so that no ball would ever end".to_owned();
            return Err(self.error(None, Some("elements"), problem));
        }
        Ok(self)
    }

    fn groups(&self) -> Result<(), TableError> {
        for (name, members) in &self.file.groups {
            self.printable(None, "groups", name)?;
            if self.index_of(name).is_some() {
                let problem = format!("the group {name:?} has the name of an element");
                return Err(self.error(None, Some("groups"), problem));
            }
            let mut seen = BTreeSet::new();
            for member in members {
                if self.index_of(member).is_none() {
                    let problem = format!("the group {name:?} names {member:?}, which is no element");
                    return Err(self.error(None, Some("groups"), problem));
                }
                if !seen.insert(member) {
                    let problem = format!("the group {name:?} names {member:?} twice");
                    return Err(self.error(None, Some("groups"), problem));
                }
            }
        }
        Ok(())
    }

    fn printable(&self, element: Option<&str>, field: &str, text: &str) -> Result<(), TableError> {
        if text.is_empty() || text.chars().count() > 40 || text.chars().any(char::is_control) {
            let problem = format!("{text:?} is not 1 to 40 printable characters");
            return Err(self.error(element, Some(field), problem));
        }
        Ok(())
    }
}
