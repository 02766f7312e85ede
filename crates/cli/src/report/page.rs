//! The report of an instrument: one HTML file with all in it, and no scripts.

pub mod accuracy;
pub mod facts;
pub mod sections;

use serde_json::Value;

use tofsim::error::Result;
use tofsim::scenario::Part;
use tofsim::sim::setup::Setup;

use crate::page::html::{Document, commands, section, table, tiles, wide_figure};
use crate::record::Record;
use crate::text::table::fixed;

/// Caption of the frame's picture.
const FRAME: &str = "Its histogram, by what caused each count. Its waveform, and save files for GTKWave and Surfer, are in frame/.";

/// Contents of the page; results are null where a step was not done.
pub struct Page<'a> {
    /// The instrument.
    pub setup: &'a Setup,
    /// Version, hash and seed.
    pub record: Record,
    /// Whether the build was a quick one.
    pub quick: bool,
    /// Notes on the validity of the results.
    pub notes: Vec<String>,
    /// Steps of the build.
    pub steps: Vec<StepRow>,
    /// Origin of the network.
    pub network: Value,
    /// `tofsim.evaluate/1`.
    pub evaluation: Value,
    /// Box plot of the errors, as SVG.
    pub errors: Option<String>,
    /// Histogram of the frame, as SVG.
    pub histogram: Option<String>,
    /// `tofsim.run/1`.
    pub frame: Value,
    /// `tofsim.cost/1`.
    pub cost: Value,
    /// `tofsim.verify/1`.
    pub verify: Value,
    /// `tofsim.cycle_counts/1`.
    pub cycles: Value,
}

/// A step of the build.
pub struct StepRow {
    pub name: &'static str,
    pub about: &'static str,
    pub passed: bool,
    pub summary: String,
}

impl Page<'_> {
    /// The whole page; an error only if the plotting library fails.
    pub fn html(&self) -> Result<String> {
        let quick = if self.quick {
            "<p class=\"bad\">This was a quick build: its network is poor, and its figures rest on few \
                 histograms and short vectors.</p>\n"
        } else {
            ""
        };
        let body = [
            quick.to_owned(),
            self.tiles(),
            section("What it is", &facts::section(self.setup, &self.network)),
            section("What it sees, how far and how exactly", &self.accuracy()?),
            section("A frame", &sections::frame(&self.frame, self.histogram.as_deref(), FRAME)),
            section("What it costs", &sections::cost(&self.cost)),
            section("What was verified", &sections::verified(&self.verify, &self.cycles)),
            section("Notes", &sections::notes(&self.notes)),
            section("What made it", &self.origin()),
        ];
        let name = &self.setup.name;
        let document = Document {
            title: &format!("{name}: an instrument"),
            heading: name,
            lead: &self.setup.scenario.description,
            body: body.concat(),
            record: &self.record,
        };
        Ok(document.html())
    }

    /// The numbers that a reader looks for first.
    fn tiles(&self) -> String {
        let all = &self.evaluation["estimators"][0]["all"];
        let mm = |key: &str| {
            all[key].as_f64().map_or("-".to_owned(), |mm| format!("{} mm", fixed(mm, 2)))
        };
        let (part, luts_of) = match self.setup.scenario.pll.part {
            Part::Kintex7 => ("kintex7", "LUTs of a Kintex-7"),
            Part::Ecp5 => ("ecp5", "LUTs of an ECP5"),
        };
        let luts = self.cost["parts"][part]["lut"].as_u64();
        let blocks = self.verify["blocks"].as_array();
        let verified = blocks.map_or("not run".to_owned(), |blocks| {
            let passed = blocks.iter().filter(|block| block["verdict"] == "pass").count();
            format!("{passed} of {}", blocks.len())
        });
        tiles([
            ("range", facts::range_m(self.setup)),
            ("2σ over the grid", mm("two_sd_mm")),
            ("mean error", mm("mean_mm")),
            ("frames", facts::frame_rate(self.setup)),
            (luts_of, luts.map_or("-".to_owned(), |luts| luts.to_string())),
            ("benches passed", verified),
        ])
    }

    fn accuracy(&self) -> Result<String> {
        if self.evaluation.is_null() {
            return Ok("<p class=\"bad\">This was not measured.</p>\n".to_owned());
        }
        Ok(accuracy::section(&self.evaluation)?
            + &wide_figure(
                self.errors.as_deref().unwrap_or_default(),
                "Errors by distance: boxes from quartile to quartile, with whiskers, and dots for what lies beyond. Black lines are what Table 5.2 of the thesis allows.",
            ))
    }

    fn origin(&self) -> String {
        let file = format!("{}.toml", self.setup.name);
        let rows = [
            ["tofsim", &self.record.version],
            ["scenario", &file],
            ["hash of the scenario", &self.record.hash],
            ["seed", &self.record.seed.to_string()],
        ];
        let rows = rows.map(|row| row.map(str::to_owned));
        let steps = self.steps.iter().map(|step| {
            let state = if step.passed { "done" } else { "NOT DONE OR FAILED" };
            [step.name.to_owned(), step.about.to_owned(), state.to_owned(), step.summary.clone()]
        });
        let quick = if self.quick { " --quick" } else { "" };
        let lines = [
            format!("tofsim build {file} -o again{quick}"),
            format!("tofsim run {file}"),
            format!("tofsim evaluate network.toml --scenario {file}"),
            format!("tofsim verify --rtl rtl --scenario {file}"),
            format!("tofsim verify --cycle-counts --rtl rtl --scenario {file}"),
        ];
        table(&["", ""], rows)
            + "<h3>Steps</h3>\n"
            + &table(&["step", "what it does", "state", "what it came to"], steps)
            + "<h3>By hand, in the folder of this page</h3>\n"
            + &commands(&lines)
    }
}
