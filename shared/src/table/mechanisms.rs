//! Targets, spinners, gates and saucers -> colliders.

use super::check::{Spot, vector};
use super::error::TableError;
use super::format::{GateFile, SaucerFile, SpinnerFile, TargetFile};
use super::shapes::{Builder, point};
use crate::physics::scene::{Material, Presence, Role};
use crate::physics::shapes::Shape;

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
        self.face(index, target, Role::Solid, Presence::Always)
    }

    pub(super) fn spinner(&mut self, index: u16, spinner: &SpinnerFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        self.plate(spot, spinner.lever, spinner.inertia, spinner.restitution, spinner.lift)?;
        self.context.in_range(spot, "friction", spinner.friction, 0.1, 1e6, "30 rad/s^2")?;
        self.floor = spinner.floor;
        self.sensor(index, spinner.from, spinner.to, Role::Sensor)
    }

    pub(super) fn gate(&mut self, index: u16, gate: &GateFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        self.plate(spot, gate.lever, gate.inertia, gate.restitution, gate.lift)?;
        self.floor = gate.floor;
        if gate.one_way {
            let mut segment = self.segment(spot, gate.from, gate.to)?;
            segment.one_way = true;
            let material = Material::bouncing(gate.restitution);
            self.push(index, Shape::Segment(segment), material, Role::Solid, Presence::Always);
        }
        self.sensor(index, gate.from, gate.to, Role::Sensor)
    }

    /// The numbers that every hinged plate has.
    fn plate(&self, spot: Spot<'_>, lever: f64, inertia: f64, restitution: f64, lift: f64) -> Result<(), TableError> {
        self.length(spot, "lever", lever)?;
        self.context.in_range(spot, "inertia", inertia, 1e-12, 1e6, "2e-6 kg m^2")?;
        // A ball that is not thrown back at all would stay at the plate.
        self.context.in_range(spot, "restitution", restitution, 0.05, 1.0, "0.3")?;
        self.context.in_range(spot, "lift", lift, 0.0, 1e3, "0.0001 J")
    }

    pub(super) fn saucer(&mut self, index: u16, saucer: &SaucerFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        self.context.point(spot, "center", None, saucer.center)?;
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
        Ok(())
    }
}
