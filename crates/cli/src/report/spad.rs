//! What a characterisation of the diode found: tables, JSON and CSV.

use serde_json::{Map, Value, json};

use tofsim::scenario::Spad;
use tofsim::sim::free_running::Measured;
use tofsim::sim::free_running::afterpulses::Afterpulses;
use tofsim::sim::free_running::rates::Point;

use crate::text::table;

pub mod pictures;

/// All that was measured.
pub struct Characterisation<'a> {
    /// The keys of the diode.
    pub spad: &'a Spad,
    /// Its dark rate at its temperature [1/s].
    pub dark_hz: f64,
    /// Count rates.
    pub points: Vec<Point>,
    /// In faint light, if the dark counts allow it.
    pub afterpulses: Option<Afterpulses>,
    /// Dark rate as measured, if there is one [1/s].
    pub dark: Option<Measured>,
}

/// The tables.
pub fn text(found: &Characterisation) -> String {
    let header = ["incident/s", "fixed", "closed form", "off", "paralysable", "closed form", "off"];
    let rows = found.points.iter().map(|point| {
        let kind = |kind: usize| {
            let (counted, closed) = (point.counted_hz[kind], point.closed_form_hz[kind]);
            let off = format!("{:+.1} se", counted.deviations_from(closed));
            [rate(counted.value), rate(closed), off]
        };
        let [[a, b, c], [d, e, f]] = [kind(0), kind(1)];
        [rate(point.incident_hz), a, b, c, d, e, f]
    });
    let rates = table::table(header, rows, 0..);
    let dead = format!("{} ns", found.spad.dead_time_ns);
    let facts = table::facts(facts(found));
    format!("Counts per second, dead time {dead}, without afterpulses\n\n{rates}\n\n{facts}\n")
}

fn rate(hz: f64) -> String {
    format!("{hz:.4e}")
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
                let why = "not told by a mean over two time constants";
                facts.push(("afterpulse probability", why.to_owned()));
            }
            let tail = with_se(seen.tail_hz, 1, " 1/s", seen.incident_hz);
            facts.push(("tail of the intervals", tail));
        }
        None => facts.push(("afterpulses", "too many dark counts to tell".to_owned())),
    }
    let dark = match found.dark {
        Some(dark) => with_se(dark, 2, " 1/s", found.dark_hz),
        None => "none to tell".to_owned(),
    };
    facts.push(("dark rate", dark));
    facts
}

/// The same for scripts.
pub fn json(found: &Characterisation) -> Map<String, Value> {
    let measured = |measured: Measured| json!({ "value": measured.value, "se": measured.se });
    let maybe = |value: Option<Measured>| value.map_or(Value::Null, measured);
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
            "with_afterpulses_hz": maybe(point.own_hz),
        })
    };
    let faint = found.afterpulses.as_ref().map(|seen| {
        json!({
            "incident_hz": seen.incident_hz,
            "counts": seen.counts,
            "rate_hz": measured(seen.rate_hz),
            "window_s": seen.window_s,
            "tail_hz": measured(seen.tail_hz),
            "after_dead_time": measured(seen.after_dead_time),
            "expected_after_dead_time": seen.expected,
            "time_constant_s": maybe(seen.time_constant_s),
            "probability": maybe(seen.probability),
            "expected_probability": found.spad.afterpulse_probability,
            "expected_time_constant_s": seen.expected_time_s,
        })
    });
    let object = json!({
        "dead_time_ns": found.spad.dead_time_ns,
        "dead_time_kind": found.spad.dead_time_kind,
        "temperature_c": found.spad.temperature_c,
        "rates": found.points.iter().map(point).collect::<Vec<_>>(),
        "faint_light": faint,
        "dark_rate_hz": maybe(found.dark),
        "expected_dark_rate_hz": found.dark_hz,
    });
    object.as_object().cloned().unwrap_or_default()
}

/// The files of numbers, by name.
pub fn csv(found: &Characterisation) -> Vec<(&'static str, String)> {
    let point = |point: &Point| {
        let [fixed, paralysable] = point.counted_hz;
        let [fixed_closed, paralysable_closed] = point.closed_form_hz;
        let own = point.own_hz.map_or([String::new(), String::new()], |own| {
            [own.value, own.se].map(|hz| format!("{hz:.6e}"))
        });
        format!(
            "{:.6e},{:.6e},{:.6e},{fixed_closed:.6e},{:.6e},{:.6e},{paralysable_closed:.6e},{}\n",
            point.incident_hz,
            fixed.value,
            fixed.se,
            paralysable.value,
            paralysable.se,
            own.join(",")
        )
    };
    let header = "incident_hz,fixed_hz,fixed_se_hz,fixed_closed_form_hz,paralysable_hz,\
                  paralysable_se_hz,paralysable_closed_form_hz,with_afterpulses_hz,\
                  with_afterpulses_se_hz\n";
    let rates = header.to_owned() + &found.points.iter().map(point).collect::<String>();
    let Some(seen) = &found.afterpulses else { return vec![("rates.csv", rates)] };
    let ends = seen.interval_ends_s.windows(2).zip(&seen.intervals);
    let interval = ends.map(|(ends, count)| format!("{:.6e},{:.6e},{count}\n", ends[0], ends[1]));
    let intervals = "from_s,until_s,count\n".to_owned() + &interval.collect::<String>();
    let bin_s = seen.window_s / seen.pairs.len() as f64;
    let pair = |(k, pairs): (usize, &u64)| {
        let (from_s, expected) = (k as f64 * bin_s, seen.expected_pairs[k]);
        let chance = seen.chance_pairs;
        format!("{from_s:.6e},{:.6e},{pairs},{chance:.3},{expected:.3}\n", from_s + bin_s)
    };
    let pairs = seen.pairs.iter().enumerate().map(pair).collect::<String>();
    let autocorrelation = "from_s,until_s,pairs,by_chance,expected\n".to_owned() + &pairs;
    vec![
        ("rates.csv", rates),
        ("intervals.csv", intervals),
        ("autocorrelation.csv", autocorrelation),
    ]
}
