//! Light of all pixels of an array.

use crate::optics::pixels::Pixels;

use super::element::elements;
use super::view::View;
use super::{Ambient, Collected, PixelLight, Scene};

/// Fewest rows of a pixel within a band, and cells of a row.
const LEAST: u32 = 8;

impl Scene<'_> {
    /// Computes the ambient light and the returned laser light of each pixel, by row, then column.
    ///
    /// Each part of the light comes at its own distance. Surfaces are divided pixel by pixel; the raster of a mesh is
    /// made once, with whole cells in each pixel.
    pub fn of_pixels(&self, pixels: &Pixels) -> Vec<PixelLight> {
        let cone = View::cone(self.scenario.laser.field_of_illumination_deg);
        let count = pixels.rows * pixels.columns;
        let outline = |place: usize| pixels.outline(place / pixels.columns, place % pixels.columns);
        let views: Vec<_> = (0..count)
            .map(|place| [View::pixel(outline(place)), cone.within(outline(place))])
            .collect();
        let mut all: Vec<_> =
            (0..count).map(|_| (Ambient::default(), Collected::default())).collect();
        let longest = pixels.rows.max(pixels.columns) as u32;
        let cells = (2 * self.scenario.target.cells).div_ceil(longest).max(LEAST);
        for ([seen, lit], (ambient, collected)) in views.iter().zip(&mut all) {
            for surface in self.all_surfaces() {
                let shared = |element| self.shared(element);
                elements(surface, seen, cells, |one| ambient.add(&shared(one), &self.air));
                elements(surface, lit, cells, |one| collected.add(&shared(one), &self.air, None));
            }
        }
        if let Some(mesh) = &self.mesh {
            mesh.elements_of(pixels, self.scenario.target.cells, |[u, v], element| {
                let Some(place) = pixels.seeing(u, v) else { return };
                let (ambient, collected) = &mut all[place];
                let element = self.shared(element);
                ambient.add(&element, &self.air);
                if u.hypot(v) < cone.reach() {
                    collected.add(&element, &self.air, None);
                }
            });
        }
        let field = views.iter().map(|[seen, _]| seen.solid_angle(cells).sr);
        let field: Vec<_> = field.collect();
        let whole_sr: f64 = field.iter().sum();
        let complete =
            |(([seen, lit], (ambient, collected)), sr): ((&[View; 2], _), f64)| PixelLight {
                ambient: self.with_airlight(ambient, seen, cells),
                returned: self.with_air(collected, lit, cells),
                share: sr / whole_sr,
            };
        views.iter().zip(all).zip(field).map(complete).collect()
    }
}
