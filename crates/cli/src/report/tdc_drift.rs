//! The depth's error over time, with a TDC calibrated once and again and again.

use std::fmt::Write;

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim_learn::drift::{Drift, Point};
use tofsim_learn::evaluation::Spread;

use plotters::prelude::RED;

use super::tdc_plots::{BLUE, Line, lines};
use crate::text::table::{number_or_dash, table};

/// Rows of the table; the files have all.
const SHOWN: usize = 25;

/// A mean error with its standard error.
fn mean(spread: &Spread) -> String {
    let mean = number_or_dash(spread.mean_mm, 2);
    spread.mean_se_mm.map_or(mean.clone(), |se| format!("{mean} +-{se:.2}"))
}

fn cells(point: &Point) -> Vec<String> {
    let moment = &point.moment;
    let cells = |spread: &Spread| {
        [mean(spread), number_or_dash(spread.two_sd_mm, 2), spread.failures.to_string()]
    };
    // To the microsecond, without the zeros at its end.
    let seconds = (moment.time_s * 1e6).round() / 1e6;
    let conditions = [seconds.to_string(), format!("{:.2}", moment.temperature_c)];
    conditions.into_iter().chain(cells(&point.once)).chain(cells(&point.repeated)).collect()
}

/// The table, in 80 columns.
pub fn text(found: &Drift, setup: &Setup) -> String {
    let tdc = &setup.scenario.tdc;
    let header = ["t [s]", "degC", "once [mm]", "2 sd", "none", "again [mm]", "2 sd", "none"]
        .map(str::to_owned);
    // Evenly chosen, with the first and the last.
    let last = found.points.len() - 1;
    let rows = last.min(SHOWN - 1);
    let places = (0..=rows).map(|k| (k * last).checked_div(rows).unwrap_or(0));
    let rows: Vec<_> = places.map(|place| cells(&found.points[place])).collect();
    format!(
        "Depth by {} over time, target at {} m\n\
         Chain {}, {} histograms each\n\
         Delays of the chain: {:+.3} % for a degree, {:+.3} % for a millivolt\n\n{}\n\n\
         once: calibrated at the first moment. again: every {} s. none: without a depth.\n",
        found.estimator,
        setup.scenario.target.distance_m,
        tdc.profile,
        found.repeats,
        100.0 * tdc.delay_per_c,
        100.0 * tdc.delay_per_mv,
        table(header, rows, 0..),
        found.every_s,
    )
}

/// All of it for scripts.
pub fn json(found: &Drift) -> Value {
    let mut object = json!({ "schema": "tofsim.drift/1" });
    if let (Some(object), Ok(Value::Object(own))) =
        (object.as_object_mut(), serde_json::to_value(found))
    {
        object.extend(own);
    }
    object
}

/// A row for each moment.
pub fn csv(found: &Drift) -> String {
    let mut text = String::from(
        "time_s,temperature_c,supply_mv,calibrated_s,once_mean_mm,once_mean_se_mm,once_two_sd_mm,once_failures,\
         repeated_mean_mm,repeated_mean_se_mm,repeated_two_sd_mm,repeated_failures\n",
    );
    for point in &found.points {
        let moment = &point.moment;
        let _ = write!(text, "{},{},{}", moment.time_s, moment.temperature_c, moment.supply_mv);
        let _ = write!(text, ",{}", point.calibrated_s);
        for spread in [&point.once, &point.repeated] {
            for value in [spread.mean_mm, spread.mean_se_mm, spread.two_sd_mm] {
                let _ = write!(text, ",{}", value.map_or(String::new(), |value| value.to_string()));
            }
            let _ = write!(text, ",{}", spread.failures);
        }
        text.push('\n');
    }
    text
}

/// Mean errors over time.
///
/// # Errors
/// When the plotting library fails.
pub fn svg(found: &Drift, setup: &Setup) -> Result<String> {
    let line = |name: &str, colour, of: fn(&Point) -> &Spread| -> Line {
        let points = found.points.iter();
        let points = points.filter_map(|point| Some((point.moment.time_s, of(point).mean_mm?)));
        (name.to_owned(), colour, points.collect())
    };
    let [first, last] = [0, found.points.len() - 1].map(|k| found.points[k].moment.temperature_c);
    let title = format!(
        "{} at {} m, {first} to {last} degC, chain {}",
        found.estimator, setup.scenario.target.distance_m, setup.scenario.tdc.profile
    );
    let again = format!("calibrated every {} s", found.every_s);
    let drawn = [
        line("calibrated once", RED, |point| &point.once),
        line(&again, BLUE, |point| &point.repeated),
    ];
    lines(&title, ["time [s]", "mean error [mm]"], &drawn)
}
