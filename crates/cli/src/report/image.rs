//! Depth images: tables, JSON, arrays, pictures and point clouds.

mod arrays;
mod cloud;
mod firmware;
mod picture;
mod readings;
mod statistics;

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::sim::image::{Pixel, ends_and_median};

use crate::text::table::{facts, fixed, grouped, number_or_dash};

use super::sheet::Digits::{Fixed, Shortest};
use super::sheet::{NamedBytes, NamedText, Sheet};
use super::writer::Findings;

use firmware::FirmwareTiming;
use statistics::{ImageStatistics, SHOWN};

pub use arrays::{ArrayValues, ImageArray};
pub use readings::{DepthImages, ImagePixel};

impl DepthImages<'_> {
    fn statistics(&self) -> Vec<ImageStatistics> {
        let depths = self.depths();
        (0..self.images as usize).map(|image| ImageStatistics::of(&depths, image)).collect()
    }

    /// Returns the image rate of the firmware, if it can scan the array.
    fn firmware(&self) -> Option<FirmwareTiming> {
        FirmwareTiming::of(self.array)
    }

    /// Returns the least, the median and the largest number of hits that pixels can expect, where shots do not depend
    /// on each other.
    fn expected(&self, hits: impl Fn(&Pixel) -> Option<f64>) -> Option<[f64; 3]> {
        ends_and_median(self.pixels.iter().filter_map(|pixel| hits(&pixel.measured)))
    }

    fn signal_hits(&self) -> Option<[f64; 3]> {
        self.expected(|pixel| pixel.expected.signal_hits)
    }

    fn ambient_hits(&self) -> Option<[f64; 3]> {
        self.expected(|pixel| pixel.expected.ambient_hits)
    }

    /// Returns the table of a single pixel.
    fn pixel_table(&self) -> String {
        let readings: Vec<_> = self.readings().into_iter().take(SHOWN).collect();
        let mm = |metres: Option<f64>| number_or_dash(metres.map(|metres| 1e3 * metres), 3);
        Sheet::of(&readings)
            .words("image", |one| one.image as u64)
            .words("depth [m]", |one| number_or_dash(one.radial_m(), 6))
            .words("error [mm]", move |one| mm(one.error_m()))
            .words("sigma [mm]", move |one| mm(one.sigma_m()))
            .words("hits", |one| grouped(one.frame.hits))
            .words("status", |one| match one.frame.status.is_empty() {
                true => "-".to_owned(),
                false => one.frame.status.to_string(),
            })
            .table()
    }

    /// Returns the first lines: what the images are of.
    fn facts(&self) -> Vec<(&'static str, String)> {
        let (setup, [rows, columns]) = (self.array.common(), self.array.size());
        let mut facts = vec![
            ("scenario", format!("{}, seed {}", setup.name, setup.scenario.seed)),
            ("array", format!("{rows} x {columns} pixels")),
        ];
        if let Some(pixels) = self.array.pixels() {
            let [across, up] = pixels.field_of_view_deg().map(|full_deg| fixed(full_deg, 2));
            facts.push(("field of view", format!("{across} x {up} deg (across, up)")));
        }
        if !self.is_whole() {
            let pixel = |pixel: &ImagePixel| format!("row {}, column {}", pixel.row, pixel.column);
            facts.extend(self.pixels.first().map(|one| ("pixel", pixel(one))));
        }
        facts.push(("estimator", setup.params.estimator.estimator().to_owned()));
        facts.push(("fidelity", self.fidelity.to_owned()));
        facts.extend(self.firmware().map(|firmware| ("firmware", firmware.to_string())));
        facts.extend(self.waves.clone().map(|path| ("waveform", path)));
        let range = |[least, median, most]: [f64; 3]| {
            let [least, median, most] = [least, median, most].map(|hits| fixed(hits, 1));
            if self.is_whole() {
                format!("{least} to {most} a pixel, median {median}")
            } else {
                format!("{median}, expected")
            }
        };
        facts.extend(self.signal_hits().map(|hits| ("signal hits", range(hits))));
        facts.extend(self.ambient_hits().map(|hits| ("ambient hits", range(hits))));
        facts
    }
}

impl Findings for DepthImages<'_> {
    const SCHEMA: &'static str = "tofsim.image/1";
    const FILE: Option<&'static str> = Some("image.json");

    fn json(&self) -> Value {
        let (setup, [rows, columns]) = (self.array.common(), self.array.size());
        let ends = |hits: Option<[f64; 3]>| {
            hits.map(
                |[least, median, most]| json!({ "least": least, "median": median, "most": most }),
            )
        };
        let mut object = json!({
            "fidelity": self.fidelity,
            "estimator": setup.params.estimator.estimator(),
            "rows": rows,
            "columns": columns,
            "geometry": self.array.camera(),
            "firmware": self.firmware(),
            "waves": self.waves,
            "signal_hits": ends(self.signal_hits()),
            "ambient_hits": ends(self.ambient_hits()),
            "images": self.statistics(),
        });
        if let Some(pixel) = self.pixels.first().filter(|_| !self.is_whole()) {
            object["pixel"] = json!([pixel.row, pixel.column]);
            object["pixel_seed"] = self.array.pixel(pixel.row, pixel.column).seed().into();
        }
        object
    }

    fn text(&self) -> String {
        let facts = facts(self.facts());
        let table = if self.is_whole() {
            statistics::table(&self.statistics())
        } else {
            self.pixel_table()
        };
        let more = match self.images.saturating_sub(SHOWN as u64) {
            0 => String::new(),
            more => format!("\n... and {} more", grouped(more)),
        };
        format!("{facts}\n\n{table}{more}\n")
    }

    fn sheets(&self) -> Vec<NamedText> {
        let readings = self.readings();
        let sheet = Sheet::of(&readings)
            .column("image", Shortest, |one| one.image as u64)
            .column("row", Shortest, |one| one.pixel.row as u64)
            .column("column", Shortest, |one| one.pixel.column as u64)
            .column("depth_radial_m", Shortest, |one| one.radial_m())
            .column("depth_perpendicular_m", Shortest, |one| one.perpendicular_m())
            .column("sigma_m", Shortest, |one| one.sigma_m())
            .column("valid", Shortest, |one| u64::from(one.frame.valid))
            .column("status", Shortest, |one| u64::from(one.frame.status.bits()))
            .column("hits", Shortest, |one| one.frame.hits)
            .column("true_radial_m", Fixed(9), |one| one.pixel.measured.expected.radial_m)
            .column("signal", Fixed(6), |one| one.pixel.measured.expected.signal_hits)
            .column("ambient", Fixed(6), |one| one.pixel.measured.expected.ambient_hits);
        let sheet = if self.looks_for_two() {
            sheet.column("second_radial_m", Shortest, |one| one.second_radial_m()).column(
                "second_sigma_m",
                Shortest,
                |one| one.second_sigma_m(),
            )
        } else {
            sheet
        };
        vec![sheet.file("pixels.csv")]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        if !self.is_whole() {
            return Ok(Vec::new());
        }
        Ok(vec![("image.svg".to_owned(), picture::svg(self)?)])
    }

    fn other_files(&self, record: &str) -> Result<Vec<NamedBytes>> {
        if !self.is_whole() {
            return Ok(Vec::new());
        }
        let arrays = arrays::all(self)?;
        Ok(arrays
            .into_iter()
            .chain(cloud::all(self, record))
            .chain(picture::pngs(self, record)?)
            .collect())
    }
}
