//! The depth's error over time, with a TDC calibrated once and again and again.

use plotters::prelude::RED;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim_learn::drift::{Drift, Point};
use tofsim_learn::evaluation::Spread;

use crate::text::table::{number_or_dash, signed};

use super::sheet::Digits::{Fixed, Shortest};
use super::sheet::{NamedText, Sheet, evenly};
use super::tdc_plots::{BLUE, PlotLine, lines};
use super::writer::Findings;

/// Rows of the table; the files have all.
const SHOWN: usize = 25;

/// Depths over time, and the setup that they are of.
pub struct DriftFindings<'a> {
    /// Depths at each moment.
    pub found: &'a Drift,
    /// Target and chain.
    pub setup: &'a Setup,
}

impl Findings for DriftFindings<'_> {
    const SCHEMA: &'static str = "tofsim.drift/1";
    const FILE: Option<&'static str> = Some("drift.json");

    fn json(&self) -> Value {
        json!(self.found)
    }

    /// The table, in 80 columns.
    fn text(&self) -> String {
        let DriftFindings { found, setup } = self;
        let tdc = &setup.scenario.tdc;
        format!(
            "Depth by {} over time, target at {} m\n\
             Chain {}, {} histograms each\n\
             Delays of the chain: {} % per degree, {} % per millivolt\n\n{}\n\n\
             once: calibrated at the first moment. again: every {} s. none: without a depth.\n",
            found.estimator,
            setup.scenario.target.distance_m,
            tdc.profile,
            found.repeats,
            signed(100.0 * tdc.delay_per_c, 3),
            signed(100.0 * tdc.delay_per_mv, 3),
            self.sheet().table_of(evenly(found.points.len(), SHOWN)),
            found.every_s,
        )
    }

    fn sheets(&self) -> Vec<NamedText> {
        vec![self.sheet().file("drift.csv")]
    }

    /// Draws mean errors over time.
    fn plots(&self) -> Result<Vec<NamedText>> {
        let DriftFindings { found, setup } = self;
        let line = |name: &str, colour, of: fn(&Point) -> &Spread| -> PlotLine {
            let points = found.points.iter();
            let points = points.filter_map(|point| Some((point.moment.time_s, of(point).mean_mm?)));
            (name.to_owned(), colour, points.collect())
        };
        let [first, last] =
            [0, found.points.len() - 1].map(|k| found.points[k].moment.temperature_c);
        let title = format!(
            "{} at {} m, {first} to {last} degC, chain {}",
            found.estimator, setup.scenario.target.distance_m, setup.scenario.tdc.profile
        );
        let again = format!("calibrated every {} s", found.every_s);
        let drawn = [
            line("calibrated once", RED, |point| &point.once),
            line(&again, BLUE, |point| &point.repeated),
        ];
        let svg = lines(&title, ["time [s]", "mean error [mm]"], &drawn)?;
        Ok(vec![("drift.svg".to_owned(), svg)])
    }
}

impl DriftFindings<'_> {
    /// A row for each moment.
    fn sheet(&self) -> Sheet<'_, Point> {
        let sheet = Sheet::of(&self.found.points)
            .column("time_s", Shortest, |at| at.moment.time_s)
            // To the microsecond, without the zeros at its end.
            .words("t [s]", |at| (at.moment.time_s * 1e6).round() / 1e6)
            .both(("temperature_c", Shortest), ("degC", Fixed(2)), |at| at.moment.temperature_c)
            .column("supply_mv", Shortest, |at| at.moment.supply_mv)
            .column("calibrated_s", Shortest, |at| at.calibrated_s);
        let sheet = spread(sheet, ["once", "once"], |at| &at.once);
        spread(sheet, ["repeated", "again"], |at| &at.repeated)
    }
}

/// Adds the columns of a spread, whose names begin with the first word in the file and with the other in the table.
fn spread<'a>(
    sheet: Sheet<'a, Point>,
    [name, heading]: [&str; 2],
    of: fn(&Point) -> &Spread,
) -> Sheet<'a, Point> {
    let mean = |at: &Point| {
        let mean = number_or_dash(of(at).mean_mm, 2);
        of(at).mean_se_mm.map_or(mean.clone(), |se| format!("{mean} +-{se:.2}"))
    };
    sheet
        .words(format!("{heading} [mm]"), mean)
        .column(format!("{name}_mean_mm"), Shortest, move |at| of(at).mean_mm)
        .column(format!("{name}_mean_se_mm"), Shortest, move |at| of(at).mean_se_mm)
        .both((&format!("{name}_two_sd_mm"), Shortest), ("2 sigma", Fixed(2)), move |at| {
            of(at).two_sd_mm
        })
        .both((&format!("{name}_failures"), Shortest), ("none", Shortest), move |at| {
            of(at).failures
        })
}
