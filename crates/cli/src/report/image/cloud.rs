//! The first image as a point cloud: PLY (Stanford) and PCD (Point Cloud Library), as text.

use std::fmt::Write;

use crate::report::sheet::NamedBytes;

use super::readings::{DepthImages, Reading};

/// Meaning of a point's numbers.
const MEANING: &str =
    "x right, y down, z forward, sigma along the line of sight [m]; signal: hits that are expected";

/// Returns the point cloud in each format.
pub fn all(images: &DepthImages, record: &str) -> [NamedBytes; 2] {
    let [rows, columns] = images.array.size();
    let readings: Vec<_> = images.image(0).collect();
    let named = |name: &str, text: String| (name.to_owned(), text.into_bytes());
    [
        named("cloud.ply", ply(&readings, record)),
        named("cloud.pcd", pcd(&readings, [rows, columns], record)),
    ]
}

/// Returns the valid points.
fn ply(readings: &[Reading], record: &str) -> String {
    let points: Vec<_> = readings.iter().filter(|one| one.point().is_some()).map(numbers).collect();
    let mut text = format!(
        "ply\nformat ascii 1.0\ncomment {record}\ncomment {MEANING}\nelement vertex {}\n",
        points.len()
    );
    for name in ["x", "y", "z", "sigma", "signal"] {
        let _ = writeln!(text, "property float {name}");
    }
    text + "property ushort status\nend_header\n" + &points.concat()
}

/// Returns all points by row, then column; invalid ones have no place.
fn pcd(readings: &[Reading], [rows, columns]: [usize; 2], record: &str) -> String {
    let points: String = readings.iter().map(numbers).collect();
    format!(
        "# .PCD v0.7 - Point Cloud Data file format\n# {record}\n# {MEANING}\nVERSION 0.7\n\
         FIELDS x y z sigma signal status\nSIZE 4 4 4 4 4 2\nTYPE F F F F F U\nCOUNT 1 1 1 1 1 1\n\
         WIDTH {columns}\nHEIGHT {rows}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA ascii\n{points}",
        readings.len()
    )
}

/// Returns the line of a point.
fn numbers(reading: &Reading) -> String {
    let [x, y, z] = reading.point().unwrap_or([f64::NAN; 3]);
    let signal = reading.pixel.measured.expected.signal_hits;
    let numbers = [Some(x), Some(y), Some(z), reading.sigma_m(), signal];
    let number = |value: Option<f64>| match value.filter(|value| value.is_finite()) {
        Some(value) => format!("{} ", value as f32),
        None => "nan ".to_owned(),
    };
    let line: String = numbers.into_iter().map(number).collect();
    line + &format!("{}\n", reading.frame.status.bits())
}
