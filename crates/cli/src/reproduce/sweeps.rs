//! The sweeps behind an item: each a plan that comes with the program, evaluated once.

use std::collections::BTreeMap;

use tofsim::error::{Input, Result};
use tofsim_studies::header::header;
use tofsim_studies::plan::file::Plot as PlanPlot;
use tofsim_studies::table::{Cell, Field, Row as Point};
use tofsim_studies::{Plan, Shard, Sweep};

use crate::report::sweep_plot;

use super::line::Line;
use super::study::Study;

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
            if study.quick {
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
