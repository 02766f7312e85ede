//! Directions that light comes from: a cone around the axis, or the part of it that a pixel sees.

use std::f64::consts::PI;

use super::outline::{Outline, Span, common};

/// A region in the plane one metre in front of the sensor.
#[derive(Clone, Debug)]
pub struct View {
    full_angle_deg: f64,
    /// Radius of the cone [m].
    reach: f64,
    /// What is seen of the cone; all of it if `None`.
    pixel: Option<Outline>,
}

/// Size of a region as seen from the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidAngle {
    /// Solid angle [sr].
    pub sr: f64,
    /// The same, projected along the axis [sr].
    pub projected_sr: f64,
}

/// Returns the cosine of the angle between the line of sight through (u, v, 1) and the axis.
pub fn axis_cos(u: f64, v: f64) -> f64 {
    1.0 / (1.0 + u * u + v * v).sqrt()
}

impl View {
    /// Creates a cone of the given full angle.
    pub fn cone(full_angle_deg: f64) -> Self {
        let reach = libm::tan((full_angle_deg / 2.0).to_radians());
        View { full_angle_deg, reach, pixel: None }
    }

    /// Creates the region inside an outline.
    pub fn pixel(outline: Outline) -> Self {
        View { full_angle_deg: 180.0, reach: f64::INFINITY, pixel: Some(outline) }
    }

    /// Returns the part of it inside an outline.
    pub fn within(&self, pixel: Outline) -> Self {
        View { pixel: Some(pixel), ..self.clone() }
    }

    /// Radius of the cone [m].
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns the range of rows that may intersect it; `None` if there are none.
    pub fn rows(&self) -> Option<Span> {
        let cone = [-self.reach, self.reach];
        self.pixel.as_ref().map_or(Some(cone), |pixel| common(&pixel.rows(), &cone))
    }

    /// Divides a band into rows: the middle of each, and its height.
    ///
    /// Those of a cone are denser towards the ends of a band, where circles end: they lie at the sines of equidistant
    /// angles, so that the error of the sum falls with the square of their number for any outline. Few circles end in a
    /// pixel, and its rows are even.
    pub fn rows_of(&self, band: Span, count: u32) -> impl Iterator<Item = [f64; 2]> {
        let (middle, half) = ((band[0] + band[1]) / 2.0, (band[1] - band[0]) / 2.0);
        let (step, is_pixel) = (PI / f64::from(count), self.pixel.is_some());
        (0..count).map(move |row| {
            if is_pixel {
                let height = 2.0 * half / f64::from(count);
                return [band[0] + (f64::from(row) + 0.5) * height, height];
            }
            let angle = (f64::from(row) + 0.5) * step - PI / 2.0;
            [middle + half * libm::sin(angle), half * libm::cos(angle) * step]
        })
    }

    /// Returns the parts of a row inside.
    pub fn spans(&self, v: f64) -> Vec<Span> {
        let end = (self.reach * self.reach - v * v).max(0.0).sqrt();
        let cone = [-end, end];
        match &self.pixel {
            None => vec![cone],
            Some(pixel) => pixel.spans(v).iter().filter_map(|span| common(span, &cone)).collect(),
        }
    }

    /// Returns its size: that of a pixel by as many rows and cells of a row as surfaces in it are divided into, so that
    /// nothing is left of it beside one that fills it.
    pub fn solid_angle(&self, cells: u32) -> SolidAngle {
        let Some(pixel) = &self.pixel else {
            let half = (self.full_angle_deg / 2.0).to_radians();
            let sin = libm::sin(half);
            let sr = 2.0 * PI * (1.0 - libm::cos(half));
            return SolidAngle { sr, projected_sr: PI * sin * sin };
        };
        let mut sum = SolidAngle { sr: 0.0, projected_sr: 0.0 };
        let Some(band) = common(&pixel.rows(), &[-self.reach, self.reach]) else { return sum };
        for [v, dv] in self.rows_of(band, cells) {
            for span in self.spans(v) {
                let du = (span[1] - span[0]) / f64::from(cells);
                for cell in 0..cells {
                    let cos = axis_cos(span[0] + (f64::from(cell) + 0.5) * du, v);
                    sum.sr += du * dv * cos * cos * cos;
                    sum.projected_sr += du * dv * cos * cos * cos * cos;
                }
            }
        }
        sum
    }
}
