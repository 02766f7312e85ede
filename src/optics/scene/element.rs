//! Visible surface elements: cells of rows within a view.

use crate::optics::air::Air;

use super::outline::{Outline, Span, common, without};
use super::surface::{Kind, Surface};
use super::view::{View, axis_cos};

/// A visible surface element.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    pub kind: Kind,
    /// Length of the line of sight [m].
    pub sight_m: f64,
    /// Standard deviation of the length within the element, for a uniform distribution over sqrt(12) of it [m].
    pub spread_m: f64,
    /// Cosine of the angle between line of sight and surface normal [1].
    pub cos: f64,
    /// Cosine of the angle between line of sight and axis [1].
    pub axis_cos: f64,
    /// Solid angle [sr].
    pub sr: f64,
}

impl Element {
    /// Returns the projected solid angle, as far as its light passes through the air to the sensor [sr].
    pub fn seen_sr(&self, air: &Air) -> f64 {
        self.axis_cos * self.sr * air.passes(self.sight_m)
    }
}

/// A cell in the plane one metre in front of the sensor.
pub struct Cell {
    pub u: f64,
    pub v: f64,
    pub du: f64,
    pub dv: f64,
}

impl Cell {
    /// Returns the surface element that the cell shows.
    pub fn element(&self, kind: Kind, hit: impl Fn(f64, f64) -> [f64; 2]) -> Element {
        let &Cell { u, v, du, dv } = self;
        let [sight_m, cos] = hit(u, v);
        let across = |from: [f64; 2], to: [f64; 2]| from[0] - to[0];
        let along_u = across(hit(u + du / 2.0, v), hit(u - du / 2.0, v));
        let along_v = across(hit(u, v + dv / 2.0), hit(u, v - dv / 2.0));
        let axis_cos = axis_cos(u, v);
        Element {
            kind,
            sight_m,
            spread_m: along_u.hypot(along_v).min(sight_m) / 12f64.sqrt(),
            cos,
            axis_cos,
            sr: du * dv * axis_cos * axis_cos * axis_cos,
        }
    }
}

/// Passes the elements of a surface inside a view to `take`, with `cells` rows per band and `cells` cells per span. A
/// band ends where an occluding surface begins or ends.
pub fn elements(surface: &Surface, view: &View, cells: u32, mut take: impl FnMut(Element)) {
    let rows = view.rows().and_then(|rows| common(&surface.outline.rows(), &rows));
    for band in rows.iter().flat_map(|rows| bands(surface, *rows)) {
        for [v, dv] in view.rows_of(band, cells) {
            for span in seen(surface, v, view) {
                let du = (span[1] - span[0]) / f64::from(cells);
                for cell in 0..cells {
                    let u = span[0] + (f64::from(cell) + 0.5) * du;
                    let hit = |u, v| surface.body.hit(u, v);
                    take(Cell { u, v, du, dv }.element(surface.kind, hit));
                }
            }
        }
    }
}

/// Divides the rows into bands without an end of an occluding surface inside.
fn bands(surface: &Surface, rows: Span) -> Vec<Span> {
    let hidden = surface.hidden_by.iter().flat_map(Outline::rows);
    let within = hidden.filter(|row| (rows[0]..rows[1]).contains(row));
    let mut ends: Vec<_> = rows.into_iter().chain(within).collect();
    ends.sort_by(f64::total_cmp);
    ends.windows(2).map(|pair| [pair[0], pair[1]]).filter(|band| band[0] < band[1]).collect()
}

/// Returns the parts of a row that show the surface.
fn seen(surface: &Surface, v: f64, view: &View) -> Vec<Span> {
    let of_surface = surface.outline.spans(v);
    let within = |part: Span| of_surface.iter().filter_map(move |span| common(span, &part));
    let mut spans: Vec<_> = view.spans(v).into_iter().flat_map(within).collect();
    for other in surface.hidden_by.iter().flat_map(|other| other.spans(v)) {
        spans = spans.iter().flat_map(|span| without(span, &other)).collect();
    }
    spans
}
