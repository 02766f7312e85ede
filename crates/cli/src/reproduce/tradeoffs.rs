//! The studies of chapter 4, each a plan that comes with the program.

use tofsim::error::Result;
use tofsim_studies::header::header;
use tofsim_studies::table::{Cell, Field, Row as Point};
use tofsim_studies::{Plan, Shard, Sweep};

use crate::page::plot::{GREY, Layer, Plot, Shape};
use crate::report::sweep_plot::lines::lines;
use crate::text::svg::COLOURS;

use super::item::Finding;
use super::study::Study;

/// Standard errors by which a trend may be missed from one point to the next [1].
const SLACK: f64 = 3.0;
/// The same where a point was worked out once, and has none [1].
const ROUGHLY: f64 = 0.05;

/// A plan's points, worked out.
pub struct TradeOff {
    /// The plan's name.
    pub name: &'static str,
    plan: Plan,
    fields: Vec<Field>,
    points: Vec<Point>,
}

/// Values along an axis, each with its standard error.
pub type Line = Vec<(f64, f64, Option<f64>)>;

impl TradeOff {
    /// Works a plan out; a quick study each point once, with fewer frames where there are many.
    ///
    /// # Errors
    /// When it is stopped.
    pub fn of(study: &Study, name: &'static str) -> Result<Self> {
        let mut plan = Plan::load(name, &[], Some(study.seed))?;
        if study.quick {
            plan.file.repeats = 1;
            plan.file.frames = plan.file.frames.min(200);
        }
        let (about, comment) = (String::new(), String::new());
        let sweep = Sweep { plan: &plan, shard: Shard::WHOLE, about, comment };
        let points = sweep.in_memory(study.stop(), &|_| ())?.rows;
        Ok(TradeOff { name, fields: header(&plan), plan, points })
    }

    /// Values of a column over another, at the points where other columns have those values.
    pub fn line(&self, x: &str, y: &str, at: &[(&str, f64)]) -> Line {
        let number = |point: &Point, name: &str| {
            let place = self.fields.iter().position(|field| field.name == name)?;
            point.cells.get(place).and_then(Cell::as_number)
        };
        let holds =
            |point: &&Point| at.iter().all(|(name, value)| number(point, name) == Some(*value));
        let value = |point: &Point| {
            let se = number(point, &format!("{y}_se"));
            Some((number(point, x)?, number(point, y)?, se))
        };
        let mut line: Line = self.points.iter().filter(holds).filter_map(value).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        line
    }

    /// Adds the plan's picture and the command that makes it.
    ///
    /// # Errors
    /// When the plotting library fails.
    pub fn shown_in(&self, finding: Finding) -> Result<Finding> {
        let finding = finding
            .shown_by(format!("tofsim sweep {} --seed {} -o {0}", self.name, self.plan.seed));
        let Some(plan) = &self.plan.file.plot else { return Ok(finding) };
        let lines = lines(plan, &self.fields, &self.points);
        let points = || lines.iter().flat_map(|line| &line.points);
        let across = ends(points().map(|point| point.0));
        let up = ends(points().map(|point| point.1));
        let mut layers = Vec::new();
        for (line, colour) in lines.iter().zip(COLOURS.into_iter().cycle()) {
            let points: Vec<_> = line.points.iter().map(|&(x, y, _)| (x, y)).collect();
            layers.push(Layer::new(short(&line.name), colour, Shape::Line, points.clone()));
            layers.push(Layer::new("", colour, Shape::Dots, points));
            let ends =
                line.points.iter().filter_map(|&(x, y, se)| Some([(x, y - se?), (x, y + se?)]));
            layers.push(Layer::new("", colour, Shape::Whiskers, ends.flatten()));
        }
        for limit in &plan.limits {
            let along = limit.y.map(|y| across.map(|x| (x, y)));
            let upright = limit.x.map(|x| up.map(|y| (x, y)));
            for ends in along.into_iter().chain(upright) {
                layers.push(Layer::between(limit.label.clone(), GREY, ends));
            }
        }
        let y = plan.y_label.clone().unwrap_or(plan.y.join(", "));
        let axes = [plan.x_label.as_deref().unwrap_or(&plan.x), &y];
        let has_errors = lines.iter().flat_map(|line| &line.points).any(|point| point.2.is_some());
        let errors = if has_errors { "; bars are standard errors" } else { "" };
        let picture = Plot { title: &plan.title, axes, layers };
        finding.with_plot(&picture, format!("{}{errors}", self.plan.file.description))
    }
}

/// The least and the largest of numbers.
fn ends(numbers: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    [numbers.clone().fold(f64::INFINITY, f64::min), numbers.fold(f64::NEG_INFINITY, f64::max)]
}

/// A name without what stands before the last point of each key in it.
fn short(name: &str) -> String {
    let parts = name.split(", ").map(|part| {
        let (key, value) =
            part.split_once(" = ").map_or((part, None), |(key, value)| (key, Some(value)));
        let key = key.rsplit('.').next().unwrap_or(key);
        value.map_or(key.to_owned(), |value| format!("{key} {value}"))
    });
    parts.collect::<Vec<_>>().join(", ")
}

/// Whether values rise (`sign` 1) or fall (-1) along a line, as far as their standard errors tell, and do so in all.
pub fn goes(line: &Line, sign: f64) -> bool {
    let steps = line.windows(2).all(|pair| {
        let ((_, before, one), (_, after, other)) = (pair[0], pair[1]);
        let slack = match one.zip(other) {
            Some((one, other)) => SLACK * one.hypot(other),
            None => ROUGHLY * before.abs(),
        };
        sign * (after - before) >= -slack
    });
    let ends = line.first().zip(line.last());
    steps && line.len() > 1 && ends.is_some_and(|(first, last)| sign * (last.1 - first.1) > 0.0)
}

/// The values of a line in words.
pub fn words(line: &Line, decimals: usize) -> String {
    let value = |&(_, value, _): &(f64, f64, Option<f64>)| format!("{value:.decimals$}");
    line.iter().map(value).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trend_may_be_missed_by_noise_and_not_by_more() {
        let line = |values: [f64; 3], se| -> Line {
            values.iter().enumerate().map(|(k, value)| (k as f64, *value, se)).collect()
        };
        assert!(goes(&line([1.0, 2.0, 3.0], Some(0.0)), 1.0));
        assert!(!goes(&line([1.0, 2.0, 3.0], Some(0.0)), -1.0));
        assert!(goes(&line([1.0, 0.97, 3.0], Some(0.01)), 1.0));
        assert!(!goes(&line([1.0, 0.9, 3.0], Some(0.01)), 1.0));
        assert!(goes(&line([1.0, 0.97, 3.0], None), 1.0));
        assert!(!goes(&line([3.0, 3.0, 3.0], Some(0.1)), 1.0), "nothing moves");
    }

    #[test]
    fn names_in_a_legend_are_short() {
        assert_eq!(short("peak.sd_mm, target.distance_m = 0.4"), "sd_mm, distance_m 0.4");
        assert_eq!(short("spad.pdp = 0.01"), "pdp 0.01");
    }
}
