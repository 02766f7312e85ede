//! The characterisation of a TDC: tables, CSV files and JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::Characterisation;
use tofsim_learn::characterisation::density::{CodeDensity, NARROW, Spread};
use tofsim_learn::characterisation::timing::TimeError;

use crate::text::table::{self, fixed, grouped, signed};

use super::sheet::Digits::{Fixed, Shortest};
use super::sheet::{NamedText, Sheet};
use super::tdc_plots;
use super::writer::Findings;

/// Patterns of bubbles that are shown.
const SHOWN: usize = 6;

/// A characterisation and the setup whose converter it is of.
pub struct TdcFindings<'a> {
    /// The characterisation.
    pub found: &'a Characterisation,
    /// Chain, decoder and calibration.
    pub setup: &'a Setup,
}

impl Findings for TdcFindings<'_> {
    const SCHEMA: &'static str = "tofsim.tdc/1";
    const FILE: Option<&'static str> = Some("tdc.json");

    fn json(&self) -> Value {
        let TdcFindings { found, setup } = self;
        let (density, tdc) = (&found.density, &setup.scenario.tdc);
        let of_widths = |widths: &[f64]| {
            let dnl = density.dnl(widths);
            let equivalent_ps = CodeDensity::equivalent_ps(widths);
            json!({
                "widest_ps": Spread::of(widths).largest,
                "dnl_lsb": Spread::of(&dnl),
                "inl_lsb": Spread::of(&density.inl(&dnl)),
                "equivalent_ps": equivalent_ps,
                "sigma_ps": equivalent_ps / 12f64.sqrt(),
            })
        };
        let [drift_ps_per_c, drift_ps_per_mv] = drift_ps(setup);
        json!({
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
            "times_equal_taps": found.raw,
            "times": found.calibrated,
            "code_precision_ps": found.transfer.code_precision_ps,
            "bubbles": found.bubbles,
            "edges": found.edges,
            "phases": found.phases,
            "table_6_3": found.stops,
        })
    }

    /// The tables, in 80 columns.
    fn text(&self) -> String {
        let TdcFindings { found, setup } = self;
        let tdc = &setup.scenario.tdc;
        let (profile, decoder) = (&tdc.profile, tdc.decoder.name());
        let sections = [
            format!("TDC with chain {profile}, decoder {decoder}, calibration {}", tdc.calibration),
            taps(found, setup),
            linearity(found),
            bubbles(found),
            edges(found, tdc.setup_window_ps),
            stops(found),
        ];
        sections.join("\n\n") + "\n"
    }

    fn sheets(&self) -> Vec<NamedText> {
        let (found, density) = (self.found, &self.found.density);
        let dnl = density.dnl(&density.measured_ps());
        let inl = density.inl(&dnl);
        let bins: Vec<_> = density.bins.iter().zip(dnl).zip(inl).collect();
        let bins = Sheet::of(&bins)
            .column("n", Shortest, |((bin, _), _)| bin.n)
            .column("count", Shortest, |((bin, _), _)| bin.count)
            .column("width_ps", Fixed(4), |((bin, _), _)| density.width_ps(bin).0)
            .column("width_se_ps", Fixed(4), |((bin, _), _)| density.width_ps(bin).1)
            .column("true_width_ps", Fixed(3), |((bin, _), _)| bin.true_width_ps)
            .column("dnl", Fixed(5), |((_, dnl), _)| *dnl)
            .column("inl", Fixed(5), |(_, inl)| *inl);
        let count =
            |n: usize| density.bins.iter().find(|bin| bin.n == n).map_or(0, |bin| bin.count);
        let counts: Vec<_> = (0..=found.taps).map(|n| (n, count(n))).collect();
        let counts = Sheet::of(&counts).column("n", Shortest, |(n, _)| *n).column(
            "count",
            Shortest,
            |(_, count)| *count,
        );
        let transfer = Sheet::of(&found.transfer.points)
            .column("delay_ps", Fixed(3), |at| at.delay_ps)
            .column("coarse", Shortest, |at| at.hit.coarse)
            .column("n", Shortest, |at| at.hit.n)
            .column("time_ps", Fixed(3), |at| at.time_ps)
            .column("equal_taps_time_ps", Fixed(3), |at| at.raw_time_ps)
            .column("code", Shortest, |at| at.code);
        vec![bins.file("bins.csv"), counts.file("counts.csv"), transfer.file("transfer.csv")]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        tdc_plots::all(self.found, &self.setup.scenario.tdc)
    }
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

/// Returns the drift of the oldest hit's age for a degree and for a millivolt [ps, ps].
fn drift_ps(setup: &Setup) -> [f64; 2] {
    let tdc = &setup.scenario.tdc;
    let oldest = setup.params.tdc.delays.tap_0() + setup.cycle();
    [tdc.delay_per_c, tdc.delay_per_mv].map(|part| part * oldest.fs() as f64 * 1e-3)
}

fn drift(setup: &Setup) -> String {
    let [by_c, by_mv] = drift_ps(setup);
    format!("{} ps per degree, {} ps per millivolt", signed(by_c, 2), signed(by_mv, 2))
}

fn linearity(found: &Characterisation) -> String {
    let density = &found.density;
    let lsb_ps = density.lsb_ps();
    let dnl = density.dnl(&density.measured_ps());
    let (raw, calibrated) = (&found.raw, &found.calibrated);
    // Each in LSB.
    let spreads = [
        ("DNL of the bins, by hits", Spread::of(&dnl), 1.0),
        ("INL of the bins, by hits", Spread::of(&density.inl(&dnl)), 1.0),
        ("DNL of times, uncalibrated", raw.dnl, 1.0 / lsb_ps),
        ("INL of times, uncalibrated", raw.inl, 1.0 / lsb_ps),
        ("DNL of times, calibrated", calibrated.dnl, 1.0 / lsb_ps),
        ("INL of times, calibrated", calibrated.inl, 1.0 / lsb_ps),
    ];
    let range = |of: &Spread, factor: f64, decimals: usize| {
        [of.least, of.largest].map(|end| fixed(end * factor, decimals)).join(" .. ")
    };
    let linearity = Sheet::of(&spreads)
        .words("", |(name, ..)| *name)
        .words("rms [LSB]", |(_, of, unit)| format!("{:.3}", of.rms * unit))
        .words("range", |(_, of, unit)| range(of, *unit, 2))
        .words("rms [ps]", |(_, of, unit)| format!("{:.2}", of.rms * unit * lsb_ps))
        .words("range", |(_, of, unit)| range(of, unit * lsb_ps, 1));
    let of = |error: &TimeError| (error.precision_ps, Some(error.mean_ps));
    let precisions = [
        ("times, uncalibrated", of(raw)),
        ("times, calibrated", of(calibrated)),
        ("codes", (found.transfer.code_precision_ps, None)),
    ];
    let precisions = Sheet::of(&precisions)
        .words("single shot", |(name, _)| *name)
        .words("precision [ps]", |(_, (precision_ps, _))| format!("{precision_ps:.2}"))
        .words("mean error [ps]", |(_, (_, mean_ps))| mean_ps.map(|ps| fixed(ps, 2)));
    format!("{}\n\n{}", linearity.table(), precisions.table())
}

/// Returns the levels of a pattern, or a word for a pattern without a bubble.
pub(super) fn named(levels: &str) -> &str {
    if levels.is_empty() { "none" } else { levels }
}

fn bubbles(found: &Characterisation) -> String {
    let bubbles = &found.bubbles;
    let transitions = bubbles.transitions.iter();
    let transitions: Vec<_> =
        transitions.map(|(changes, share)| format!("{changes}: {:.1} %", 100.0 * share)).collect();
    let patterns = Sheet::of(&bubbles.patterns[..bubbles.patterns.len().min(SHOWN)])
        .words("bubble", |pattern| named(&pattern.levels))
        .words("phases [%]", |pattern| format!("{:.2}", 100.0 * pattern.share))
        .words("taps reached", |pattern| pattern.counts)
        .table();
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
    let stops = Sheet::of(&found.stops)
        .words("stop [ns]", |stop| stop.t2_ns)
        .words("n", |stop| stop.n)
        .words("edge [ns]", |stop| stop.t1_ns);
    format!("Table 6.3\n{}", stops.table())
}
