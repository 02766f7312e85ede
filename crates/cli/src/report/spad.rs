//! The characterisation of the diode: tables, CSV files, pictures and JSON.

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::scenario::Spad;
use tofsim::sim::free_running::Measured;
use tofsim::sim::free_running::afterpulses::Afterpulses;
use tofsim::sim::free_running::rates::Point;

use crate::text::table;

use super::sheet::Digits::{Fixed, Scientific, Shortest};
use super::sheet::{NamedText, Sheet};
use super::writer::Findings;

mod pictures;

/// All that was measured.
pub struct Characterisation<'a> {
    /// Number of counts per measurement.
    pub counts: u64,
    /// The keys of the diode.
    pub spad: &'a Spad,
    /// Its dark rate at its temperature [1/s].
    pub dark_hz: f64,
    /// Count rates.
    pub points: Vec<Point>,
    /// Measurement in faint light, if the dark counts allow it.
    pub afterpulses: Option<Afterpulses>,
    /// Dark rate as measured, if there is one [1/s].
    pub dark: Option<Measured>,
}

impl Findings for Characterisation<'_> {
    const SCHEMA: &'static str = "tofsim.spad/1";
    const FILE: Option<&'static str> = Some("spad.json");

    fn json(&self) -> Value {
        let point = |point: &Point| {
            let kind = |kind: usize| {
                let (counted, closed) = (point.counted_hz[kind], point.closed_form_hz[kind]);
                json!({
                    "counted_hz": counted.value,
                    "counted_se_hz": counted.se,
                    "closed_form_hz": closed,
                    "off_se": counted.deviations_from(closed),
                })
            };
            json!({
                "incident_hz": point.incident_hz,
                "fixed": kind(0),
                "paralysable": kind(1),
                "with_afterpulses_hz": point.own_hz,
            })
        };
        let mut faint = json!(self.afterpulses);
        if self.afterpulses.is_some() {
            faint["expected_probability"] = self.spad.afterpulse_probability.into();
        }
        json!({
            "counts": self.counts,
            "dead_time_ns": self.spad.dead_time_ns,
            "dead_time_kind": self.spad.dead_time_kind,
            "temperature_c": self.spad.temperature_c,
            "rates": self.points.iter().map(point).collect::<Vec<_>>(),
            "faint_light": faint,
            "dark_rate_hz": self.dark,
            "expected_dark_rate_hz": self.dark_hz,
        })
    }

    fn text(&self) -> String {
        let dead = format!("{} ns", self.spad.dead_time_ns);
        let (rates, facts) = (rates(&self.points).table(), table::facts(facts(self)));
        format!("Counts per second, dead time {dead}, without afterpulses\n\n{rates}\n\n{facts}\n")
    }

    fn sheets(&self) -> Vec<NamedText> {
        let rates = rates(&self.points).file("rates.csv");
        let Some(seen) = &self.afterpulses else { return vec![rates] };
        let fine = Scientific(6);
        let ends = seen.interval_ends_s.windows(2).zip(&seen.intervals);
        let intervals: Vec<_> = ends.collect();
        let intervals = Sheet::of(&intervals)
            .column("from_s", fine, |(ends, _)| ends[0])
            .column("until_s", fine, |(ends, _)| ends[1])
            .column("count", Shortest, |(_, count)| **count);
        let bin_s = seen.window_s / seen.pairs.len() as f64;
        let pairs = seen.pairs.iter().zip(&seen.expected_pairs).enumerate();
        let pairs: Vec<_> =
            pairs.map(|(k, (pairs, expected))| (k as f64 * bin_s, pairs, expected)).collect();
        let autocorrelation = Sheet::of(&pairs)
            .column("from_s", fine, |(from_s, ..)| *from_s)
            .column("until_s", fine, |(from_s, ..)| from_s + bin_s)
            .column("pairs", Shortest, |(_, pairs, _)| **pairs)
            .column("by_chance", Fixed(3), |_| seen.chance_pairs)
            .column("expected", Fixed(3), |(.., expected)| **expected);
        vec![rates, intervals.file("intervals.csv"), autocorrelation.file("autocorrelation.csv")]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        pictures::svg(self.spad.dead_time_ns, &self.points, self.afterpulses.as_ref())
    }
}

/// Count rates with a fixed and with a paralysable dead time, with their closed forms.
fn rates(points: &[Point]) -> Sheet<'_, Point> {
    let fine = Scientific(6);
    let mut sheet =
        Sheet::of(points)
            .both(("incident_hz", fine), ("incident/s", Scientific(4)), |at| at.incident_hz);
    for (k, kind) in ["fixed", "paralysable"].into_iter().enumerate() {
        sheet = sheet
            .both((&format!("{kind}_hz"), fine), (kind, Scientific(4)), move |at| {
                at.counted_hz[k].value
            })
            .column(format!("{kind}_se_hz"), fine, move |at| at.counted_hz[k].se)
            .both(
                (&format!("{kind}_closed_form_hz"), fine),
                ("closed form", Scientific(4)),
                move |at| at.closed_form_hz[k],
            )
            .words("off", move |at| {
                let off = at.counted_hz[k].deviations_from(at.closed_form_hz[k]);
                format!("{} se", table::signed(off, 1))
            });
    }
    sheet.column("with_afterpulses_hz", fine, |at| at.own_hz.map(|own| own.value)).column(
        "with_afterpulses_se_hz",
        fine,
        |at| at.own_hz.map(|own| own.se),
    )
}

fn facts(found: &Characterisation) -> Vec<(&'static str, String)> {
    let with_se = |measured: Measured, decimals: usize, unit: &str, expected: f64| {
        let Measured { value, se } = measured;
        format!("{value:.decimals$} +- {se:.decimals$}{unit}, expected {expected:.decimals$}")
    };
    let mut facts = Vec::new();
    match &found.afterpulses {
        Some(seen) => {
            let q = with_se(seen.after_dead_time, 5, "", seen.expected);
            facts.push(("afterpulses after the dead time", q));
            if let (Some(constant), Some(probability)) = (seen.time_constant_s, seen.probability) {
                let ns = Measured { value: 1e9 * constant.value, se: 1e9 * constant.se };
                facts.push(("time constant", with_se(ns, 2, " ns", 1e9 * seen.expected_time_s)));
                let expected = found.spad.afterpulse_probability;
                facts.push(("afterpulse probability", with_se(probability, 5, "", expected)));
            } else if let Some(mean) = seen.time_constant_s {
                let ns = Measured { value: 1e9 * mean.value, se: 1e9 * mean.se };
                facts.push((
                    "mean time after it",
                    with_se(ns, 2, " ns", 1e9 * seen.expected_time_s),
                ));
                let why = "unknown: the mean is over two time constants";
                facts.push(("afterpulse probability", why.to_owned()));
            }
            let tail = with_se(seen.tail_hz, 1, " 1/s", seen.incident_hz);
            facts.push(("tail of the intervals", tail));
        }
        None => facts.push(("afterpulses", "unknown: too many dark counts".to_owned())),
    }
    let dark = match found.dark {
        Some(dark) => with_se(dark, 2, " 1/s", found.dark_hz),
        None => "none".to_owned(),
    };
    facts.push(("dark rate", dark));
    facts
}
