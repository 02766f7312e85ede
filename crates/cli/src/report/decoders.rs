//! Decoders of a TDC side by side: a table, CSV, a picture, and the same for scripts.

use std::fmt::Write;

use plotters::prelude::*;
use serde_json::{Value, json};

use tofsim::error::{Input, Result};
use tofsim::scenario::Decoder;
use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::decoders::{Comparison, DecoderFigures};

use crate::text::svg::{COLOURS, legend, picture};
use crate::text::table::{self, grouped};

/// Patterns that are shown.
const SHOWN: usize = 8;
/// Codes of the picture.
const DRAWN: usize = 96;

/// The tables, in 80 columns.
pub fn text(found: &Comparison, setup: &Setup) -> String {
    let decoders = &found.decoders;
    let hits = decoders.first().map_or(0, |one| one.density.hits);
    let row = |one: &DecoderFigures| {
        vec![
            one.name.to_owned(),
            one.codes.to_string(),
            one.empty.to_string(),
            format!("{:.3}", one.density.lsb_ps()),
            format!("{:.3}", one.dnl.rms),
            format!("{:.2} .. {:.2}", one.dnl.least, one.dnl.largest),
            format!("{:.1}", one.widest_ps),
            format!("{:.2}", one.equivalent_ps),
        ]
    };
    let header = [
        "decoder",
        "codes",
        "empty",
        "LSB [ps]",
        "DNL rms",
        "range [LSB]",
        "widest",
        "equiv. [ps]",
    ];
    let widths = table::table(header, decoders.iter().map(row), 1..);
    let row = |one: &DecoderFigures| {
        let [raw, own] = one.off.map(|part| format!("{:.2}", 100.0 * part));
        let cost = |value: Option<u64>| value.map_or("-".to_owned(), |value| value.to_string());
        vec![
            one.name.to_owned(),
            format!("{:.2}", one.raw.precision_ps),
            format!("{:.2}", one.calibrated.precision_ps),
            raw,
            own,
            cost(one.cost.map(|cost| cost.luts)),
            cost(one.cost.map(|cost| cost.ffs)),
        ]
    };
    let header =
        ["decoder", "equal taps [ps]", "calibrated", "off [%]", "calibrated", "LUTs", "FFs"];
    let times = table::table(header, decoders.iter().map(row), 1..);
    let rows = found.patterns.iter().take(SHOWN).map(|read| {
        let levels = if read.levels.is_empty() { "none" } else { &read.levels };
        let [ones, leading, reordered] = read.numbers.map(|number| format!("+{number}"));
        [levels.to_owned(), format!("{:.2}", 100.0 * read.share), ones, leading, reordered]
    });
    let header = ["bubble", "phases [%]", "ones", "leading", "reordered"];
    let patterns = table::table(header, rows, 1..);
    format!(
        "Decoders of the chain {}, {} hits\n\n{widths}\n\nSingle-shot precision; hits that are off by more \
         than {} ps, a bin\n{times}\nLUTs and FFs: of 800 taps on a Kintex-7, \
         by Yosys\n\nn, less the ones below the first zero\n{patterns}\n",
        setup.scenario.tdc.profile,
        grouped(hits),
        found.bin_ps,
    )
}

/// Name and text of each CSV file, but for the record.
pub fn tables(found: &Comparison) -> [(&'static str, String); 2] {
    let mut rows =
        "decoder,codes,empty,lsb_ps,dnl_rms_lsb,dnl_least_lsb,dnl_largest_lsb,widest_ps,\
        equivalent_ps,raw_precision_ps,precision_ps,raw_off,off,luts,ffs\n"
            .to_owned();
    for one in &found.decoders {
        let cost = one.cost.map_or(",".to_owned(), |cost| format!("{},{}", cost.luts, cost.ffs));
        let _ = writeln!(
            rows,
            "{},{},{},{:.4},{:.5},{:.5},{:.5},{:.3},{:.4},{:.4},{:.4},{:.6},{:.6},{cost}",
            one.name,
            one.codes,
            one.empty,
            one.density.lsb_ps(),
            one.dnl.rms,
            one.dnl.least,
            one.dnl.largest,
            one.widest_ps,
            one.equivalent_ps,
            one.raw.precision_ps,
            one.calibrated.precision_ps,
            one.off[0],
            one.off[1],
        );
    }
    let mut patterns = "bubble,share,ones,leading,reordered\n".to_owned();
    for read in &found.patterns {
        let [ones, leading, reordered] = read.numbers;
        let _ =
            writeln!(patterns, "{},{:.6},{ones},{leading},{reordered}", read.levels, read.share);
    }
    [("decoders.csv", rows), ("patterns.csv", patterns)]
}

/// The same for scripts.
pub fn json(found: &Comparison, setup: &Setup) -> Value {
    let decoders = found.decoders.iter().map(|one| {
        json!({
            "decoder": one.name,
            "codes": one.codes,
            "empty": one.empty,
            "lsb_ps": one.density.lsb_ps(),
            "dnl_lsb": { "rms": one.dnl.rms, "least": one.dnl.least, "largest": one.dnl.largest },
            "widest_ps": one.widest_ps,
            "equivalent_ps": one.equivalent_ps,
            "raw_precision_ps": one.raw.precision_ps,
            "precision_ps": one.calibrated.precision_ps,
            "raw_off_by_a_bin": one.off[0],
            "off_by_a_bin": one.off[1],
            "luts": one.cost.map(|cost| cost.luts),
            "ffs": one.cost.map(|cost| cost.ffs),
        })
    });
    let patterns = found.patterns.iter().map(|read| {
        let numbers = Decoder::ALL.into_iter().zip(read.numbers);
        let numbers: serde_json::Map<_, _> =
            numbers.map(|(decoder, n)| (decoder.name().to_owned(), n.into())).collect();
        json!({ "levels": read.levels, "share": read.share, "n_above_first_zero": numbers })
    });
    json!({
        "schema": "tofsim.tdc-decoders/1",
        "profile": setup.scenario.tdc.profile,
        "hits": found.decoders.first().map(|one| one.density.hits),
        "bin_ps": found.bin_ps,
        "decoders": decoders.collect::<Vec<_>>(),
        "patterns": patterns.collect::<Vec<_>>(),
    })
}

/// Widths of the codes of each decoder over a stretch of time.
///
/// # Errors
/// When the plotting library fails.
pub fn svg(found: &Comparison, setup: &Setup) -> Result<String> {
    let profile = &setup.scenario.tdc.profile;
    let title = format!("What decoders make of the chain {profile}: widths of the first codes");
    let first: Vec<_> = found.decoders.iter().map(steps).collect();
    let until = first.iter().filter_map(|points| points.last()).map(|at| at.0);
    let until = until.fold(f64::INFINITY, f64::min).max(1e-6);
    let widths = first.iter().flatten().filter(|at| at.0 <= until).map(|at| at.1);
    let widest = widths.fold(0.0, f64::max).max(1e-6);
    let drawn = picture(|canvas| {
        let panels = canvas.titled(&title, ("sans-serif", 18))?;
        let panels = panels.split_evenly((found.decoders.len(), 1));
        for (place, one) in found.decoders.iter().enumerate() {
            let (points, colour) = (&first[place], COLOURS[place % COLOURS.len()]);
            let is_last = place + 1 == found.decoders.len();
            let mut chart = ChartBuilder::on(&panels[place]);
            chart.margin(6).x_label_area_size(if is_last { 36 } else { 18 }).y_label_area_size(56);
            let mut chart = chart.build_cartesian_2d(0.0..until, 0.0..1.15 * widest)?;
            chart
                .configure_mesh()
                .label_style(("sans-serif", 11))
                .axis_desc_style(("sans-serif", 13))
                .x_desc(if is_last { "age of the hit, from the first code on [ps]" } else { "" })
                .y_desc("width [ps]")
                .y_labels(4)
                .light_line_style(TRANSPARENT)
                .bold_line_style(BLACK.mix(0.08))
                .draw()?;
            let style = colour.stroke_width(2);
            let shown = points.iter().copied().filter(|at| at.0 <= until);
            chart
                .draw_series(LineSeries::new(shown, style))?
                .label(format!("{}: DNL {:.2} LSB rms", one.name, one.dnl.rms))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], style));
            legend(&mut chart, SeriesLabelPosition::UpperRight)?;
        }
        Ok(())
    });
    drawn.map_err(|text| Input::new("picture", text).into())
}

/// Ages, each with the width of the code that a hit has then, as a line of steps.
fn steps(one: &DecoderFigures) -> Vec<(f64, f64)> {
    let seen = one.density.bins.iter().map(|bin| bin.true_width_ps).filter(|ps| *ps > 0.0);
    let mut begin = 0.0;
    seen.take(DRAWN)
        .flat_map(|ps| {
            let edges = [(begin, ps), (begin + ps, ps)];
            begin += ps;
            edges
        })
        .collect()
}
