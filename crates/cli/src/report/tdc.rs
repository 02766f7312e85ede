//! What a TDC is like: a table, CSV files, and the same for scripts.

use std::fmt::Write;

use serde_json::{Value, json};

use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::Characterisation;
use tofsim_learn::characterisation::density::{CodeDensity, NARROW, Spread};
use tofsim_learn::characterisation::timing::TimeError;

use crate::text::table::{self, grouped};

/// Patterns of bubbles that are shown.
const SHOWN: usize = 6;

/// The tables, in 80 columns.
pub fn text(found: &Characterisation, setup: &Setup) -> String {
    let tdc = &setup.scenario.tdc;
    let sections = [
        format!(
            "TDC with chain {}, decoder {}, calibration {}",
            tdc.profile,
            tdc.decoder.name(),
            tdc.calibration
        ),
        taps(found, setup),
        linearity(found),
        bubbles(found),
        edges(found, tdc.setup_window_ps),
        stops(found),
    ];
    sections.join("\n\n") + "\n"
}

fn part(count: usize, all: usize) -> String {
    format!("{count}, {:.1} %", 100.0 * count as f64 / all as f64)
}

fn taps(found: &Characterisation, setup: &Setup) -> String {
    let density = &found.density;
    let (bins, lsb_ps) = (density.bins.len(), density.lsb_ps());
    let widest = density.bins.iter().max_by(|a, b| a.true_width_ps.total_cmp(&b.true_width_ps));
    let widest = widest.map_or(String::new(), |bin| {
        let (ps, se_ps) = density.width_ps(bin);
        format!("n {}, {:.2} ps; by hits {ps:.2} +- {se_ps:.2} ps", bin.n, bin.true_width_ps)
    });
    let [true_ps, measured_ps] = [density.true_ps(), density.measured_ps()];
    let [equivalent_ps, by_hits_ps] =
        [&true_ps, &measured_ps].map(|widths| CodeDensity::equivalent_ps(widths));
    table::facts([
        (
            "taps",
            format!("{}, of which a period of {} ps uses {bins}", found.taps, density.period_ps),
        ),
        ("hits", grouped(density.hits)),
        ("mean bin (LSB)", format!("{lsb_ps:.3} ps")),
        ("widest bin", widest),
        ("empty bins", part(density.empty(), bins)),
        ("below a quarter LSB", part(density.narrow(), bins)),
        ("equivalent bin", format!("{equivalent_ps:.2} ps; by hits {by_hits_ps:.2} ps")),
        ("its sigma", format!("{:.2} ps", equivalent_ps / 12f64.sqrt())),
        ("drift of the oldest hit", drift(setup)),
    ])
}

/// By how much the age of the oldest hit drifts, with a degree and with a millivolt [ps, ps].
fn drift_ps(setup: &Setup) -> [f64; 2] {
    let tdc = &setup.scenario.tdc;
    let oldest = setup.params.tdc.delays.tap_0() + setup.cycle();
    [tdc.delay_per_c, tdc.delay_per_mv].map(|part| part * oldest.fs() as f64 * 1e-3)
}

fn drift(setup: &Setup) -> String {
    let [by_c, by_mv] = drift_ps(setup);
    format!("{by_c:+.2} ps for a degree, {by_mv:+.2} ps for a millivolt")
}

fn linearity(found: &Characterisation) -> String {
    let density = &found.density;
    let row = |name: &str, spread: Spread, factor: f64| {
        let Spread { rms, least, largest } = spread;
        vec![
            name.to_owned(),
            format!("{:.3}", rms * factor),
            format!("{:.2} .. {:.2}", least * factor, largest * factor),
            format!("{:.2}", rms * factor * density.lsb_ps()),
            format!(
                "{:.1} .. {:.1}",
                least * factor * density.lsb_ps(),
                largest * factor * density.lsb_ps()
            ),
        ]
    };
    let dnl = density.dnl(&density.measured_ps());
    let inl = Spread::of(&density.inl(&dnl));
    let of_lsb = 1.0 / density.lsb_ps();
    let calibrated = &found.calibrated;
    let rows = [
        row("DNL of the bins, by hits", Spread::of(&dnl), 1.0),
        row("INL of the bins, by hits", inl, 1.0),
        row("DNL of times, equal taps", found.raw.dnl, of_lsb),
        row("INL of times, equal taps", found.raw.inl, of_lsb),
        row("DNL of times, calibrated", calibrated.dnl, of_lsb),
        row("INL of times, calibrated", calibrated.inl, of_lsb),
    ];
    let header = ["", "rms [LSB]", "range", "rms [ps]", "range"].map(str::to_owned);
    let linearity = table::table(header, rows, 1..);
    let precision = |error: &TimeError| format!("{:.2}", error.precision_ps);
    let precisions = [
        [
            "times, equal taps".to_owned(),
            precision(&found.raw),
            format!("{:.2}", found.raw.mean_ps),
        ],
        [
            "times, calibrated".to_owned(),
            precision(calibrated),
            format!("{:.2}", calibrated.mean_ps),
        ],
        ["codes".to_owned(), format!("{:.2}", found.transfer.code_precision_ps), "-".to_owned()],
    ];
    let header = ["single shot", "precision [ps]", "mean error [ps]"];
    format!("{linearity}\n\n{}", table::table(header, precisions, 1..))
}

fn bubbles(found: &Characterisation) -> String {
    let bubbles = &found.bubbles;
    let transitions = bubbles.transitions.iter();
    let transitions: Vec<_> =
        transitions.map(|(changes, share)| format!("{changes}: {:.1} %", 100.0 * share)).collect();
    let rows = bubbles.patterns.iter().take(SHOWN).map(|pattern| {
        let levels = if pattern.levels.is_empty() { "none" } else { &pattern.levels };
        [levels.to_owned(), format!("{:.2}", 100.0 * pattern.share), pattern.counts.to_string()]
    });
    let patterns = table::table(["bubble", "phases [%]", "taps reached"], rows, 1..);
    format!(
        "Bubbles at {:.1} % of the phases, {} taps long at most; changes from tap to tap:\n{}\n\n{patterns}",
        100.0 * bubbles.share,
        bubbles.longest,
        transitions.join(", ")
    )
}

fn edges(found: &Characterisation, window_ps: f64) -> String {
    let period_ps = found.density.period_ps;
    let largest = found.edges.iter().max_by(|a, b| a.largest_jump_ps.total_cmp(&b.largest_jump_ps));
    let mut text = String::new();
    if let Some(edge) = largest {
        let _ = writeln!(
            text,
            "Across {} edges of the clock the time jumps by {:.2} ps at most\n(at {:.1} ps), {:.2} % of a period.",
            found.edges.len(),
            edge.largest_jump_ps,
            edge.delay_ps,
            100.0 * edge.largest_jump_ps / period_ps
        );
    }
    let phases = &found.phases;
    let verdict = match phases.off {
        0 => "none is off by a period".to_owned(),
        off => format!("{} are off by half a period or more", grouped(off)),
    };
    let _ = write!(
        text,
        "Of {} hits at random times {verdict}; the largest\nerror is {:.2} ps, {:.2} ps rms.",
        grouped(phases.count),
        phases.largest_error_ps,
        phases.rms_error_ps
    );
    if window_ps > 0.0 {
        let _ = write!(
            text,
            " Their registers sample within {window_ps} ps about\nthe edge (tdc.setup_window_ps); all else here is of registers that \
             sample at it."
        );
    }
    text
}

fn stops(found: &Characterisation) -> String {
    let rows = found
        .stops
        .iter()
        .map(|stop| [stop.t2_ns.to_string(), stop.n.to_string(), format!("{}", stop.t1_ns)]);
    format!("Table 6.3\n{}", table::table(["stop [ns]", "n", "edge [ns]"], rows, 0..))
}

/// Name and text of each CSV file, but for the record.
pub fn tables(found: &Characterisation) -> [(&'static str, String); 3] {
    let density = &found.density;
    let dnl = density.dnl(&density.measured_ps());
    let inl = density.inl(&dnl);
    let mut bins = "n,count,width_ps,width_se_ps,true_width_ps,dnl,inl\n".to_owned();
    for ((bin, dnl), inl) in density.bins.iter().zip(&dnl).zip(&inl) {
        let (ps, se_ps) = density.width_ps(bin);
        let true_ps = bin.true_width_ps;
        let _ = writeln!(
            bins,
            "{},{},{ps:.4},{se_ps:.4},{true_ps:.3},{dnl:.5},{inl:.5}",
            bin.n, bin.count
        );
    }
    let mut counts = "n,count\n".to_owned();
    for n in 0..=found.taps {
        let bin = density.bins.iter().find(|bin| bin.n == n);
        let _ = writeln!(counts, "{n},{}", bin.map_or(0, |bin| bin.count));
    }
    let mut transfer = "delay_ps,coarse,n,time_ps,equal_taps_time_ps,code\n".to_owned();
    for at in &found.transfer.points {
        let code = at.code.map_or(String::new(), |code| code.to_string());
        let _ = writeln!(
            transfer,
            "{:.3},{},{},{:.3},{:.3},{code}",
            at.delay_ps, at.hit.coarse, at.hit.n, at.time_ps, at.raw_time_ps
        );
    }
    [("bins.csv", bins), ("counts.csv", counts), ("transfer.csv", transfer)]
}

fn spread(spread: Spread) -> Value {
    json!({ "rms": spread.rms, "least": spread.least, "largest": spread.largest })
}

/// The same for scripts.
pub fn json(found: &Characterisation, setup: &Setup) -> Value {
    let density = &found.density;
    let of_widths = |widths: &[f64]| {
        let dnl = density.dnl(widths);
        let equivalent_ps = CodeDensity::equivalent_ps(widths);
        json!({
            "widest_ps": Spread::of(widths).largest,
            "dnl_lsb": spread(Spread::of(&dnl)),
            "inl_lsb": spread(Spread::of(&density.inl(&dnl))),
            "equivalent_ps": equivalent_ps,
            "sigma_ps": equivalent_ps / 12f64.sqrt(),
        })
    };
    let of_times = |error: &TimeError| {
        json!({
            "mean_error_ps": error.mean_ps,
            "precision_ps": error.precision_ps,
            "dnl_ps": spread(error.dnl),
            "inl_ps": spread(error.inl),
        })
    };
    let patterns = found.bubbles.patterns.iter().map(|pattern| {
        json!({ "levels": pattern.levels, "share": pattern.share, "counts": pattern.counts })
    });
    let transitions = found.bubbles.transitions.iter();
    let transitions =
        transitions.map(|(changes, share)| json!({ "changes": changes, "share": share }));
    let edges = found.edges.iter().map(|edge| {
        json!({
            "coarse": edge.coarse,
            "delay_ps": edge.delay_ps,
            "jump_ps": edge.jump_ps,
            "largest_jump_ps": edge.largest_jump_ps,
        })
    });
    let stops = found.stops.iter();
    let stops = stops.map(|stop| json!({ "t2_ns": stop.t2_ns, "n": stop.n, "t1_ns": stop.t1_ns }));
    let tdc = &setup.scenario.tdc;
    let [drift_ps_per_c, drift_ps_per_mv] = drift_ps(setup);
    json!({
        "schema": "tofsim.tdc/1",
        "profile": tdc.profile,
        "decoder": tdc.decoder.name(),
        "calibration": tdc.calibration.to_string(),
        "hits": density.hits,
        "period_ps": density.period_ps,
        "taps": found.taps,
        "taps_used": density.bins.len(),
        "lsb_ps": density.lsb_ps(),
        "empty": density.empty(),
        "narrow": density.narrow(),
        "narrow_below_lsb": NARROW,
        "drift_ps_per_c": drift_ps_per_c,
        "drift_ps_per_mv": drift_ps_per_mv,
        "bins_by_hits": of_widths(&density.measured_ps()),
        "bins": of_widths(&density.true_ps()),
        "times_equal_taps": of_times(&found.raw),
        "times": of_times(&found.calibrated),
        "code_precision_ps": found.transfer.code_precision_ps,
        "bubbles": {
            "share": found.bubbles.share,
            "longest": found.bubbles.longest,
            "transitions": transitions.collect::<Vec<_>>(),
            "patterns": patterns.collect::<Vec<_>>(),
        },
        "edges": edges.collect::<Vec<_>>(),
        "phases": {
            "count": found.phases.count,
            "off_by_a_period": found.phases.off,
            "largest_error_ps": found.phases.largest_error_ps,
            "rms_error_ps": found.phases.rms_error_ps,
        },
        "table_6_3": stops.collect::<Vec<_>>(),
    })
}
