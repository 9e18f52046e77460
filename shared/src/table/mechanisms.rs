//! Targets, spinners, gates and saucers -> colliders.

use super::check::{Spot, vector};
use super::error::TableError;
use super::format::{GateFile, SaucerFile, SpinnerFile, TargetFile};
use super::shapes::{Builder, point};
use crate::physics::constants::{MOST_LIFT, PRESSED};
use crate::physics::hinge::HingeSpec;
use crate::physics::saucer::SaucerSpec;
use crate::physics::scene::{Material, Presence, Role};
use crate::physics::shapes::{Arc, Segment, Shape, Side};

impl Builder<'_> {
    /// A target's face and its two ends.
    pub(super) fn face(
        &mut self,
        index: u16,
        target: &TargetFile,
        role: Role,
        presence: Presence,
    ) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        let material = self.material(spot, &target.material)?;
        self.floor = target.floor;
        let segment = self.segment(spot, target.from, target.to)?;
        self.push(index, Shape::Segment(segment), material, role, presence);
        for end in [target.from, target.to] {
            self.push(index, point(vector(end)), material, role, presence);
        }
        Ok(())
    }

    pub(super) fn target(&mut self, index: u16, target: &TargetFile) -> Result<(), TableError> {
        self.speed(Spot::Element(index), "threshold", target.threshold)?;
        if target.down {
            let problem = "a Target always stands; a DropTarget would be right".to_owned();
            return Err(self.context.error(Spot::Element(index), Some("down"), problem));
        }
        self.face(index, target, Role::Standing { threshold: target.threshold }, Presence::Always)
    }

    pub(super) fn spinner(&mut self, index: u16, spinner: &SpinnerFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        self.context.in_range(spot, "friction", spinner.friction, 0.1, 1e6, "30 rad/s^2")?;
        self.floor = spinner.floor;
        let segment = self.segment(spot, spinner.from, spinner.to)?;
        let plate = HingeSpec {
            element: index,
            middle: segment.middle,
            lever: spinner.lever,
            inertia: spinner.inertia,
            friction: Some(spinner.friction),
            restitution: spinner.restitution,
            lift: spinner.lift,
        };
        self.plate(segment, plate)
    }

    pub(super) fn gate(&mut self, index: u16, gate: &GateFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        self.floor = gate.floor;
        let mut segment = self.segment(spot, gate.from, gate.to)?;
        segment.one_way = gate.one_way;
        let plate = HingeSpec {
            element: index,
            middle: segment.middle,
            lever: gate.lever,
            inertia: gate.inertia,
            friction: None,
            restitution: gate.restitution,
            lift: gate.lift,
        };
        self.plate(segment, plate)?;
        if gate.one_way {
            let material = Material::bouncing(gate.restitution);
            self.push(index, Shape::Segment(segment), material, Role::Solid, Presence::Always);
        }
        Ok(())
    }

    /// What spinners and gates have in common.
    fn plate(&mut self, segment: Segment, plate: HingeSpec) -> Result<(), TableError> {
        let spot = Spot::Element(plate.element);
        self.length(spot, "lever", plate.lever)?;
        self.context.in_range(spot, "inertia", plate.inertia, 1e-12, 1e6, "2e-6 kg m^2")?;
        // A ball that is not thrown back at all would stay at the plate.
        self.context.in_range(spot, "restitution", plate.restitution, 0.05, 1.0, "0.3")?;
        self.context.in_range(spot, "lift", plate.lift, 0.0, 1e3, "0.0001 J")?;
        self.no_ball_lies_on(&segment, &plate)?;
        let index = self.scene.hinges.len() as u16;
        self.scene.hinges.push(plate);
        let none = Material::bouncing(0.0);
        self.push(plate.element, Shape::Segment(segment), none, Role::Hinge { index }, Presence::Always);
        Ok(())
    }

    /// A ball that gravity presses against a plate must get through by that alone: otherwise it would lie on it for ever.
    fn no_ball_lies_on(&self, segment: &Segment, plate: &HingeSpec) -> Result<(), TableError> {
        let gravity = self.scene.gravity_on(self.floor);
        let across = gravity.dot(segment.normal);
        let is_pressed = across.abs() > PRESSED * gravity.length();
        // On the closed side of a one-way gate a ball may lie as on a wall.
        if !is_pressed || (segment.one_way && across > 0.0) {
            return Ok(());
        }
        let most = MOST_LIFT * self.scene.mass(0) * across.abs() * plate.lever;
        if plate.lift <= most {
            return Ok(());
        }
        let problem = format!(
            "a ball could lie on the plate, since {} J are more than its weight does over the lever; at most {most:.2e} J would be right",
            plate.lift
        );
        Err(self.context.error(Spot::Element(plate.element), Some("lift"), problem))
    }

    pub(super) fn saucer(&mut self, index: u16, saucer: &SaucerFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        let center = self.context.point(spot, "center", None, saucer.center)?;
        self.length(spot, "radius", saucer.radius)?;
        self.context.in_range(spot, "capture", saucer.capture, 1e-3, 100.0, "0.8 m/s")?;
        // Slower than this a ball would not get out.
        let kick = vector(saucer.kick).length();
        if !(0.05..=100.0).contains(&kick) {
            let problem = format!("{:?} is no kick of 0.05 to 100 m/s; (0.3, -1.2) would be right", saucer.kick);
            return Err(self.context.error(spot, Some("kick"), problem));
        }
        if let Some(hold) = saucer.hold {
            self.context.in_range(spot, "hold", hold, 0.0, 60.0, "0.8 s")?;
        }
        self.floor = saucer.floor;
        let place = self.scene.saucers.len() as u16;
        self.scene.saucers.push(SaucerSpec {
            element: index,
            center,
            capture: saucer.capture,
            kick: vector(saucer.kick),
            hold: saucer.hold,
        });
        let circle = Shape::Arc(Arc { center, radius: saucer.radius, side: Side::Outside, span: None });
        self.push(index, circle, Material::bouncing(0.0), Role::Saucer { index: place }, Presence::Always);
        Ok(())
    }
}
