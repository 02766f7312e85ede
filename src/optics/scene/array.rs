//! Light of all pixels of an array.

use crate::optics::pixels::Pixels;

use super::element::elements;
use super::view::View;
use super::{Collected, PixelLight, Scene};

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
        let mut all: Vec<_> = (0..count).map(|_| (0.0, Collected::default())).collect();
        let longest = pixels.rows.max(pixels.columns) as u32;
        let cells = (2 * self.scenario.target.cells).div_ceil(longest).max(LEAST);
        for (views, (seen_sr, collected)) in views.iter().zip(&mut all) {
            for surface in &self.surfaces {
                let [seen, lit] = views;
                elements(surface, seen, cells, |element| *seen_sr += element.seen_sr(&self.air));
                elements(surface, lit, cells, |element| collected.add(&element, &self.air, None));
            }
        }
        if let Some(mesh) = &self.mesh {
            mesh.elements_of(pixels, self.scenario.target.cells, |[u, v], element| {
                let Some(place) = pixels.seeing(u, v) else { return };
                let (seen_sr, collected) = &mut all[place];
                *seen_sr += element.seen_sr(&self.air);
                if u.hypot(v) < cone.reach() {
                    collected.add(&element, &self.air, None);
                }
            });
        }
        let complete = |([seen, lit], (seen_sr, collected)): (&[View; 2], _)| PixelLight {
            ambient: self.with_airlight(seen_sr, seen, cells),
            returned: self.with_air(collected, lit, cells),
        };
        views.iter().zip(all).map(complete).collect()
    }
}
