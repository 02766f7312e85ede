//! The page of a scenario: light, waveform, histogram, TDC, errors, accuracy, cycles, verification.

use serde_json::Value;

use tofsim::sim::setup::Setup;

use crate::page::html::{Document, commands, escaped, figure, section, table, tiles, wide_figure};
use crate::page::timing;
use crate::page::trace::Trace;
use crate::record::Record;

use super::page::{accuracy, facts, sections};

/// A part of the page, or why it is not there.
pub type ReportPart<T> = Result<T, String>;

/// Contents of the page.
pub struct ScenarioPage<'a> {
    pub setup: &'a Setup,
    pub record: &'a Record,
    pub notes: Vec<String>,
    /// Rows of the link budget: quantity, value and meaning.
    pub budget: Vec<[String; 3]>,
    /// The first shots.
    pub waveform: ReportPart<Trace>,
    /// `tofsim.run/1`, and its histogram as SVG.
    pub run: ReportPart<(Value, String)>,
    /// `tofsim.tdc/1`, and its pictures.
    pub tdc: ReportPart<(Value, Vec<String>)>,
    /// `tofsim.error_budget/1`, its picture, and its tables.
    pub errors: ReportPart<(String, String)>,
    /// `tofsim.evaluate/1`.
    pub evaluation: ReportPart<Value>,
    /// `tofsim.verify/1` and `tofsim.cycle_counts/1`, null where they were not asked for.
    pub verified: ReportPart<(Value, Value)>,
    /// Commands that make the parts by themselves.
    pub commands: Vec<String>,
}

impl ScenarioPage<'_> {
    /// The whole page; an error only if the plotting library fails.
    pub fn html(&self) -> tofsim::error::Result<String> {
        let evaluation = self.evaluation.as_ref().map(accuracy::section);
        let evaluation = evaluation.unwrap_or_else(|why| Ok(without(why)))?;
        let body = [
            self.tiles(),
            section("What it is", &facts::section(self.setup, &Value::Null)),
            section("Light", &table(&["", "", ""], self.budget.iter().cloned())),
            section("Waveform", &self.waveform()),
            section("A frame", &self.frame()),
            section("Clock cycles", &self.cycles()),
            section("TDC", &self.tdc()),
            section("Depth error budget", &self.errors()),
            section("Accuracy over the range", &evaluation),
            section("What was verified", &self.verified()),
            section("Notes", &sections::notes(&self.notes)),
            section("By hand", &commands(&self.commands)),
        ];
        let name = &self.setup.name;
        let document = Document {
            title: &format!("{name}: a report"),
            heading: name,
            lead: &self.setup.scenario.description,
            body: body.concat(),
            record: self.record,
        };
        Ok(document.html())
    }

    fn tiles(&self) -> String {
        let frame = self.run.as_ref().map(|(run, _)| run["frames"][0].clone()).unwrap_or_default();
        let m = |key: &str| frame[key].as_f64().map_or("-".to_owned(), |m| format!("{m:.4} m"));
        let all = self.evaluation.as_ref().map(|of| of["estimators"][0]["all"].clone());
        let two_sd = all.unwrap_or_default()["two_sd_mm"].as_f64();
        tiles([
            ("true distance", m("true_depth_m")),
            ("depth of one frame", m("depth_m")),
            ("range", facts::range_m(self.setup)),
            ("2σ over the range", two_sd.map_or("-".to_owned(), |mm| format!("{mm:.2} mm"))),
            ("frames", facts::frame_rate(self.setup)),
        ])
    }

    fn waveform(&self) -> String {
        let words = "The first shots, as an analyser at clk_laser samples them. waveform.json beside is the same for WaveDrom.";
        shown(&self.waveform, |trace| figure(&timing::svg(trace), words))
    }

    fn frame(&self) -> String {
        let words = "Its histogram, by what caused each count.";
        shown(&self.run, |(run, histogram)| sections::frame(run, Some(histogram), words))
    }

    /// Returns the expected and the simulated duration of a frame.
    fn cycles(&self) -> String {
        let (setup, run) = (self.setup, self.run.as_ref().ok());
        let counted = |key: &str| {
            let frame = run.map(|(run, _)| &run["frames"][0][key]);
            frame.and_then(Value::as_u64).map_or("-".to_owned(), |n| n.to_string())
        };
        let rows = [
            [
                "estimator".to_owned(),
                setup.params.estimator_cycles().to_string(),
                counted("estimator_cycles"),
            ],
            [
                "frame, undisturbed".to_owned(),
                setup.frame_cycles(setup.laser_period()).to_string(),
                counted("frame_cycles"),
            ],
        ];
        table(&["cycles of clk_sys", "by the formula", "counted in the run"], rows)
    }

    fn tdc(&self) -> String {
        let (tdc, pictures) = match &self.tdc {
            Err(why) => return without(why),
            Ok(both) => both,
        };
        let number = |path: &str, decimals: usize| {
            let value = tdc.pointer(path).and_then(Value::as_f64);
            value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
        };
        let rows = [
            ["taps".to_owned(), number("/taps", 0)],
            ["mean bin (LSB) [ps]".to_owned(), number("/lsb_ps", 3)],
            ["DNL, rms [LSB]".to_owned(), number("/bins/dnl_lsb/rms", 3)],
            ["INL, rms [LSB]".to_owned(), number("/bins/inl_lsb/rms", 3)],
            ["precision of one shot [ps]".to_owned(), number("/times/precision_ps", 2)],
        ];
        let rows = rows.into_iter().filter(|row| row[1] != "-");
        let pictures = pictures.iter().zip([
            "Widths of the bins.",
            "Differential, and",
            "integral nonlinearity.",
        ]);
        let pictures = pictures.map(|(svg, words)| wide_figure(svg, words));
        table(&["", ""], rows) + &pictures.collect::<String>()
    }

    fn errors(&self) -> String {
        let words =
            "What each effect alone adds to bias and variance; the line is what all together are.";
        shown(&self.errors, |(picture, text)| {
            wide_figure(picture, words) + &format!("<pre>{}</pre>\n", escaped(text))
        })
    }

    fn verified(&self) -> String {
        shown(&self.verified, |(verify, cycles)| sections::verified(verify, cycles))
    }
}

/// Returns a part as HTML, or why it is not there.
fn shown<T>(part: &ReportPart<T>, html: impl FnOnce(&T) -> String) -> String {
    part.as_ref().map_or_else(|why| without(why), html)
}

fn without(why: &str) -> String {
    format!("<p class=\"reason\">Not shown: {}</p>\n", escaped(why))
}
