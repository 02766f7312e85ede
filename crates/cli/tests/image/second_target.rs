//! Second targets of pixels, where the firmware looks for them.

use crate::common::{empty, json, stdout};

use super::{SMALL, array, image, rows};

#[test]
fn a_second_target_of_a_pixel_is_in_its_files() {
    let folder = empty();
    let path = folder.path();
    let two = ["-s", "estimator.targets=2", "-s", "firmware.shots_per_frame=10000"];
    stdout(path, &image(&[&two[..], &["-q", "-o", "out"]].concat()));
    let [(shape, first), (_, second), (_, sigma)] =
        ["depth_radial_m", "second_radial_m", "second_sigma_m"]
            .map(|name| array::<f64>(&path.join(format!("out/{name}.npy"))));
    assert_eq!(shape, [6, 8]);
    let found: Vec<_> = (0..48).filter(|pixel| !second[*pixel].is_nan()).collect();
    assert!((3..40).contains(&found.len()), "{found:?}");
    assert!(found.iter().all(|&pixel| first[pixel] < second[pixel] && sigma[pixel] > 0.0));
    let pixel = format!("{},{}", found[0] / 8, found[0] % 8);
    let words = ["run", "--json", "--waves", "none", "--fidelity", "shot"];
    let run = json(path, &[&words, &SMALL[..], &two, &["--pixel", &pixel]].concat());
    assert_eq!(run["frames"][0]["second"]["depth_m"].as_f64(), Some(second[found[0]]), "{run}");
    let rows = rows(&path.join("out/pixels.csv"));
    let of_csv = rows.iter().map(|row| row["second_radial_m"].parse().unwrap_or(f64::NAN));
    assert!(of_csv.zip(&second).all(|(csv, npy): (f64, _)| csv.to_bits() == npy.to_bits()));
}
