//! Decoders of a TDC side by side: tables, CSV files, a picture and JSON.

use plotters::prelude::*;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::decoders::{Comparison, DecoderFigures, Read};

use crate::text::svg::{COLOURS, legend, picture};
use crate::text::table::{fixed, grouped};

use super::sheet::Digits::{Fixed, Shortest};
use super::sheet::{NamedText, Sheet};
use super::tdc::named;
use super::writer::Findings;

/// Patterns that are shown.
const SHOWN: usize = 8;
/// Codes of the picture.
const DRAWN: usize = 96;

/// Decoders on one chain, and the setup that has the chain.
pub struct DecoderFindings<'a> {
    /// Figures of each decoder for the same hits.
    pub found: &'a Comparison,
    /// The chain.
    pub setup: &'a Setup,
}

impl Findings for DecoderFindings<'_> {
    const SCHEMA: &'static str = "tofsim.tdc-decoders/1";
    const FILE: Option<&'static str> = Some("decoders.json");

    fn json(&self) -> Value {
        let mut object = json!(self.found);
        object["profile"] = json!(self.setup.scenario.tdc.profile);
        object["hits"] = json!(self.hits());
        object
    }

    /// The tables, in 80 columns.
    fn text(&self) -> String {
        let patterns = &self.found.patterns;
        format!(
            "Decoders of the chain {}, {} hits\n\n{}\n\nSingle-shot precision; hits that are off by more \
             than {} ps, a bin\n{}\nLUTs and FFs: of 800 taps on a Kintex-7, \
             by Yosys\n\nn, less the ones below the first zero\n{}\n",
            self.setup.scenario.tdc.profile,
            grouped(self.hits().unwrap_or(0)),
            widths(&self.found.decoders).table(),
            self.found.bin_ps,
            times(&self.found.decoders).table(),
            read(patterns).table_of(0..patterns.len().min(SHOWN)),
        )
    }

    fn sheets(&self) -> Vec<NamedText> {
        let decoders = widths(&self.found.decoders).and(times(&self.found.decoders));
        vec![decoders.file("decoders.csv"), read(&self.found.patterns).file("patterns.csv")]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        Ok(vec![("decoders.svg".to_owned(), svg(self.found, self.setup)?)])
    }
}

impl DecoderFindings<'_> {
    fn hits(&self) -> Option<u64> {
        self.found.decoders.first().map(|one| one.density.hits)
    }
}

/// The widths of the codes.
fn widths(decoders: &[DecoderFigures]) -> Sheet<'_, DecoderFigures> {
    Sheet::of(decoders)
        .both(("decoder", Shortest), ("decoder", Shortest), |one| one.name)
        .both(("codes", Shortest), ("codes", Shortest), |one| one.codes)
        .both(("empty", Shortest), ("empty", Shortest), |one| one.empty)
        .both(("lsb_ps", Fixed(4)), ("LSB [ps]", Fixed(3)), |one| one.lsb_ps)
        .both(("dnl_rms_lsb", Fixed(5)), ("DNL rms", Fixed(3)), |one| one.dnl.rms)
        .column("dnl_least_lsb", Fixed(5), |one| one.dnl.least)
        .column("dnl_largest_lsb", Fixed(5), |one| one.dnl.largest)
        .words("range [LSB]", |one| {
            [one.dnl.least, one.dnl.largest].map(|end| fixed(end, 2)).join(" .. ")
        })
        .both(("widest_ps", Fixed(3)), ("widest", Fixed(1)), |one| one.widest_ps)
        .both(("equivalent_ps", Fixed(4)), ("equiv. [ps]", Fixed(2)), |one| one.equivalent_ps)
}

/// The times that they give, and the logic that they cost.
fn times(decoders: &[DecoderFigures]) -> Sheet<'_, DecoderFigures> {
    Sheet::of(decoders)
        .words("decoder", |one| one.name)
        .both(("raw_precision_ps", Fixed(4)), ("uncalibrated [ps]", Fixed(2)), |one| {
            one.raw_precision_ps
        })
        .both(("precision_ps", Fixed(4)), ("calibrated", Fixed(2)), |one| one.precision_ps)
        .column("raw_off", Fixed(6), |one| one.raw_off_by_a_bin)
        .words("off [%]", |one| format!("{:.2}", 100.0 * one.raw_off_by_a_bin))
        .column("off", Fixed(6), |one| one.off_by_a_bin)
        .words("calibrated", |one| format!("{:.2}", 100.0 * one.off_by_a_bin))
        .both(("luts", Shortest), ("LUTs", Shortest), |one| one.luts)
        .both(("ffs", Shortest), ("FFs", Shortest), |one| one.ffs)
}

/// The number that each decoder reads from a pattern.
fn read(patterns: &[Read]) -> Sheet<'_, Read> {
    let sheet = Sheet::of(patterns)
        .column("bubble", Shortest, |read| read.levels.as_str())
        .words("bubble", |read| named(&read.levels))
        .column("share", Fixed(6), |read| read.share)
        .words("phases [%]", |read| format!("{:.2}", 100.0 * read.share));
    let decoders = ["ones", "leading", "reordered"].into_iter().enumerate();
    decoders.fold(sheet, |sheet, (k, name)| {
        sheet
            .column(name, Shortest, move |read| read.numbers[k])
            .words(name, move |read| format!("+{}", read.numbers[k]))
    })
}

/// Draws the widths of each decoder's codes over a stretch of time.
fn svg(found: &Comparison, setup: &Setup) -> Result<String> {
    let profile = &setup.scenario.tdc.profile;
    let title = format!("What decoders make of the chain {profile}: widths of the first codes");
    let first: Vec<_> = found.decoders.iter().map(steps).collect();
    let until = first.iter().filter_map(|points| points.last()).map(|at| at.0);
    let until = until.fold(f64::INFINITY, f64::min).max(1e-6);
    let widths = first.iter().flatten().filter(|at| at.0 <= until).map(|at| at.1);
    let widest = widths.fold(0.0, f64::max).max(1e-6);
    picture(|canvas| {
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
    })
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
