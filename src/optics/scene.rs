//! Light from targets other than a plain rectangle, and from the air in front of them.
//!
//! Laser and sensor share one point. A surface element of solid angle `dw`, at the end of a line of sight `r` with
//! the cosine `c` to its normal, returns `c / r^2 dw` of the laser light, which is the summand `cos^2 / r^4 dA` of
//! eq. 3.13. A retroreflective patch, whose coefficient refers to its own area, returns `1 / (c r^2) dw`. Air returns
//! `beta / r^2 dr dw` of the lidar equation up to the first surface. All of it passes through the air twice, `exp(-2
//! alpha r)`.

mod element;
mod outline;
mod raster;
mod surface;

use std::f64::consts::PI;

use crate::scenario::Scenario;
use crate::scenario::effects::Effect;
use crate::scenario::mesh::Mesh;

use super::air::Air;
use super::returned::{Haze, Returned};
use element::{Element, elements};
use raster::Placed;
use surface::{Kind, Surface, surfaces};

/// A target and the air in front of it.
pub struct Scene<'a> {
    scenario: &'a Scenario,
    air: Air,
    surfaces: Vec<Surface>,
    mesh: Option<Placed>,
}

/// Received ambient light, as projected solid angles of a white target with equal effect [sr].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambient {
    /// Part reflected by the target.
    pub target_sr: f64,
    /// Part scattered by the air.
    pub air_sr: f64,
}

impl<'a> Scene<'a> {
    /// Creates the scene of a scenario, with its mesh if it names one.
    pub fn new(scenario: &'a Scenario, mesh: Option<&Mesh>) -> Self {
        let target = &scenario.target;
        Scene {
            scenario,
            air: Air::of(scenario),
            surfaces: surfaces(target),
            mesh: mesh.map(|mesh| Placed::new(mesh, target)),
        }
    }

    /// Passes the elements inside a cone of the given full angle to `take`.
    fn elements(&self, full_angle_deg: f64, mut take: impl FnMut(Element)) {
        let cells = self.scenario.target.cells;
        for surface in &self.surfaces {
            // A quadrant has that many.
            elements(surface, full_angle_deg, 2 * cells, &mut take);
        }
        if let Some(mesh) = &self.mesh {
            mesh.elements(full_angle_deg, cells, take);
        }
    }

    /// Whether all light of the target comes after the way along the axis.
    fn is_plain(&self) -> bool {
        Effect::Target.occurrence(self.scenario).is_none()
    }

    /// Whether there is nothing in the air.
    fn is_clear(&self) -> bool {
        Effect::Air.occurrence(self.scenario).is_none()
    }

    /// Computes the ambient light: that from the target, attenuated on its way to the sensor, and that scattered by
    /// the air (Koschmieder).
    pub fn ambient(&self) -> Ambient {
        let full_angle_deg = self.scenario.spad.field_of_view_deg;
        let (mut target_sr, mut hidden_sr) = (0.0, 0.0);
        self.elements(full_angle_deg, |element| {
            let projected_sr = element.axis_cos * element.sr;
            let passes = self.air.passes(element.sight_m);
            target_sr += projected_sr * passes;
            hidden_sr += projected_sr * passes;
        });
        if self.is_clear() {
            return Ambient { target_sr, air_sr: 0.0 };
        }
        let sin = libm::sin((full_angle_deg / 2.0).to_radians());
        let air_sr = self.air.airlight * (PI * sin * sin - hidden_sr).max(0.0);
        Ambient { target_sr, air_sr }
    }

    /// Computes the returned laser light.
    pub fn returned(&self) -> Returned {
        let (laser, spad) = (&self.scenario.laser, &self.scenario.spad);
        let full_angle_deg = laser.field_of_illumination_deg.min(spad.field_of_view_deg);
        let target = &self.scenario.target;
        let together = self.is_plain().then_some(target.distance_m);
        let mut returned = Returned::default();
        let mut hidden = Vec::new();
        self.elements(full_angle_deg, |element| {
            let Element { kind, sight_m, cos, sr, .. } = element;
            let passes = self.air.passes(2.0 * sight_m);
            let square = sight_m * sight_m;
            let (weight, of) = match kind {
                Kind::Diffuse => (cos / square * sr, &mut returned.diffuse),
                Kind::Retro => (sr / (square * cos), &mut returned.retro),
            };
            let (at_m, spread_m) = match together {
                Some(distance_m) => (distance_m, 0.0),
                None => (sight_m, element.spread_m),
            };
            of.add(at_m, spread_m, weight * passes, weight);
            hidden.push([sight_m, sr]);
        });
        if !self.is_clear() {
            let cone_sr = 2.0 * PI * (1.0 - libm::cos((full_angle_deg / 2.0).to_radians()));
            returned.air = Some(Haze::new(self.air, cone_sr, hidden));
        }
        returned
    }
}

#[cfg(test)]
mod tests;
