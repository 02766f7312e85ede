//! The sweeps behind an item: each a plan that comes with the program, evaluated once; and lines of their columns.

use std::collections::BTreeMap;

use tofsim::error::{Input, Result};
use tofsim_studies::header::header;
use tofsim_studies::plan::file::Plot as PlanPlot;
use tofsim_studies::table::{Cell, Field, Row as Point};
use tofsim_studies::{Plan, Shard, Sweep};

use crate::report::sweep_plot;

use super::study::Study;
use super::values::{Value, Values};

/// Frames of a point in a quick study [frames].
const QUICK_FRAMES: u64 = 200;

/// The plans of an item, by name, in the item's order.
pub struct Sweeps(Vec<Evaluated>);

/// A plan with its points.
struct Evaluated {
    plan: Plan,
    fields: Vec<Field>,
    points: Vec<Point>,
}

impl Sweeps {
    /// Evaluates plans; a quick study each point once, with fewer frames where there are many.
    ///
    /// # Errors
    /// When there is no such plan, or the study is stopped.
    pub fn new(study: &Study, names: &[String]) -> Result<Self> {
        let evaluate = |name: &String| {
            let mut plan = Plan::load(name, &[], Some(study.seed))?;
            if study.reduces() {
                plan.file.repeats = 1;
                plan.file.frames = plan.file.frames.min(QUICK_FRAMES);
            }
            let (about, comment) = (String::new(), String::new());
            let sweep = Sweep { plan: &plan, shard: Shard::WHOLE, about, comment };
            let points = sweep.in_memory(study.stop(), &|_| ())?.rows;
            Ok(Evaluated { fields: header(&plan), plan, points })
        };
        names.iter().map(evaluate).collect::<Result<_>>().map(Sweeps)
    }

    /// Returns column `y` over column `x` of a plan, at the points where other columns have the values `at`.
    ///
    /// # Errors
    /// When there is no such plan or column.
    pub fn line(&self, plan: &str, [x, y]: [&str; 2], at: &BTreeMap<&str, f64>) -> Result<Line> {
        let known = |other: &&Evaluated| plan.is_empty() || other.plan.name == plan;
        let sweep = self.0.iter().find(known);
        let sweep =
            sweep.ok_or_else(|| Input::new("plan", "the item has no such plan").value(plan))?;
        let place = |name: &str| {
            let place = sweep.fields.iter().position(|field| field.name == name);
            place.ok_or_else(|| Input::new(&sweep.plan.name, "no such column").value(name))
        };
        let (x, mean, error) = (place(x)?, place(y)?, place(&format!("{y}_se")).ok());
        let at = at.iter().map(|(name, value)| Ok((place(name)?, *value)));
        let at = at.collect::<Result<Vec<_>>>()?;
        let number = |point: &Point, place: usize| point.cells.get(place).and_then(Cell::as_number);
        let holds = |point: &&Point| at.iter().all(|(k, value)| number(point, *k) == Some(*value));
        let value = |point: &Point| {
            let error = error.and_then(|place| number(point, place));
            Some((number(point, x)?, number(point, mean)?, error))
        };
        Ok(Line::new(sweep.points.iter().filter(holds).filter_map(value)))
    }

    /// Returns the commands that evaluate the plans.
    pub fn commands(&self) -> impl Iterator<Item = String> {
        let plans = self.0.iter().map(|sweep| &sweep.plan);
        plans.map(|plan| format!("tofsim sweep {} --seed {} -o {0}", plan.name, plan.seed))
    }

    /// Draws the plans' pictures, each with the words below it.
    ///
    /// # Errors
    /// When no point has what a picture shows, or the plotting library fails.
    pub fn pictures(&self) -> Result<Vec<(String, String)>> {
        let plots = self.0.iter().filter_map(|sweep| Some((sweep, sweep.plan.file.plot.as_ref()?)));
        let picture = |(sweep, plot): (&Evaluated, &PlanPlot)| {
            let svg = sweep_plot::svg(plot, &sweep.fields, &sweep.points);
            let svg = svg.map_err(|fault| Input::new(&sweep.plan.name, fault))?;
            Ok((svg, sweep.plan.file.description.clone()))
        };
        plots.map(picture).collect()
    }
}

/// Standard errors by which a trend may be missed from one point to the next [1].
const SLACK: f64 = 3.0;
/// The same of a point that was evaluated once, and has no standard error, as a part of its value [1].
const ROUGHLY: f64 = 0.05;

/// Points along an axis: place, value, and standard error of the value.
pub struct Line(Vec<(f64, f64, Option<f64>)>);

impl Line {
    /// Sorts points by their place.
    pub fn new(points: impl IntoIterator<Item = (f64, f64, Option<f64>)>) -> Self {
        let mut points: Vec<_> = points.into_iter().collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Line(points)
    }

    /// Returns place and value of each point as `x` and `y`.
    pub fn points(&self) -> impl Iterator<Item = Values> {
        self.0.iter().map(|&(x, y, error)| {
            let mut point = Values::default();
            point.put("x", x);
            point.put_value("y", Value::Number(y, error));
            point
        })
    }

    /// Returns what a claim can compare: the values `y`, their `count`, the `first`, `previous` and `last` of them, `least`,
    /// `largest` and `furthest` from 0, `largest_step`, the standard error `last_se`, and whether it `rises` or `falls`.
    pub fn values(&self) -> Values {
        let of = |point: Option<&(f64, f64, Option<f64>)>| {
            point.map_or(Value::Number(f64::NAN, None), |&(_, y, error)| Value::Number(y, error))
        };
        let y = || self.0.iter().map(|point| point.1);
        let largest =
            |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(f64::NEG_INFINITY, f64::max);
        let mut steps = self.0.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
        let mut values = Values::default();
        values.put_value("y", Value::List(y().collect()));
        values.put("count", self.0.len() as f64);
        values.put_value("first", of(self.0.first()));
        values.put_value("previous", of(self.0.iter().nth_back(1)));
        values.put_value("last", of(self.0.last()));
        values.put("least", y().fold(f64::INFINITY, f64::min));
        values.put("largest", largest(&mut y()));
        values.put("furthest", largest(&mut y().map(f64::abs)));
        values.put("largest_step", largest(&mut steps));
        values.put("last_se", self.0.last().and_then(|point| point.2).unwrap_or_default());
        values.put("rises", f64::from(self.goes(1.0)));
        values.put("falls", f64::from(self.goes(-1.0)));
        values
    }

    /// Returns the part of the points at which the magnitude exceeds that of another line [1].
    pub fn leads(&self, other: &Line) -> f64 {
        let pairs = self.0.iter().zip(&other.0);
        let larger = pairs.filter(|(one, other)| one.1.abs() > other.1.abs()).count();
        larger as f64 / self.0.len() as f64
    }

    /// Returns whether values rise (`sign` 1) or fall (-1) from point to point, as far as their standard errors tell, and
    /// do so in all.
    fn goes(&self, sign: f64) -> bool {
        let steps = self.0.windows(2).all(|pair| {
            let ((_, before, one), (_, after, other)) = (pair[0], pair[1]);
            let slack = match one.zip(other) {
                Some((one, other)) => SLACK * one.hypot(other),
                None => ROUGHLY * before.abs(),
            };
            sign * (after - before) >= -slack
        });
        let ends = self.0.first().zip(self.0.last());
        steps
            && self.0.len() > 1
            && ends.is_some_and(|(first, last)| sign * (last.1 - first.1) > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(values: [f64; 3], error: Option<f64>) -> Line {
        Line::new(values.into_iter().enumerate().map(|(k, value)| (k as f64, value, error)))
    }

    #[test]
    fn a_trend_may_be_missed_by_noise_and_not_by_more() {
        assert!(line([1.0, 2.0, 3.0], Some(0.0)).goes(1.0));
        assert!(!line([1.0, 2.0, 3.0], Some(0.0)).goes(-1.0));
        assert!(line([1.0, 0.97, 3.0], Some(0.01)).goes(1.0));
        assert!(!line([1.0, 0.9, 3.0], Some(0.01)).goes(1.0));
        assert!(line([1.0, 0.97, 3.0], None).goes(1.0));
        assert!(!line([3.0, 3.0, 3.0], Some(0.1)).goes(1.0), "nothing moves");
    }

    #[test]
    fn claims_compare_what_a_line_has() {
        let values = line([1.0, -4.0, 2.0], Some(0.1)).values();
        for condition in [
            "count >= 3",
            "first <= 1",
            "previous < -3",
            "last > 1",
            "least < -3",
            "largest <= 2",
            "furthest >= 4",
            "largest_step >= 6",
            "last_se > 0",
        ] {
            assert!(values.holds(condition).unwrap(), "{condition}");
        }
        assert!(!values.holds("rises").unwrap() && !values.holds("falls").unwrap());
        let trends = |values| {
            ["rises", "falls"].map(|trend| line(values, None).values().holds(trend).unwrap())
        };
        assert_eq!(trends([3.0, 2.0, 1.0]), [false, true]);
        assert_eq!(trends([1.0, 2.0, 3.0]), [true, false]);
    }

    #[test]
    fn one_line_leads_another_by_magnitude() {
        let (one, other) = (line([-2.0, 0.0, 3.0], None), line([1.0, -1.0, 1.0], None));
        assert!((one.leads(&other) - 2.0 / 3.0).abs() < 1e-12);
    }
}
