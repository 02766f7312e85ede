//! Sweeps of arrays of pixels.

use serde_json::Value;

use crate::common::{empty, json, refused, stdout};

const PLAN: &str = r#"
scenario = "array"
set = ["array.rows=6", "array.columns=8"]
fidelity = "shot"
frames = 3

[[axis]]
key = "firmware.shots_per_frame"
values = [1000, 10000]
"#;

fn number(row: &Value, column: &str) -> f64 {
    row[column].as_f64().unwrap_or_else(|| panic!("{column} of {row}"))
}

#[test]
fn a_point_has_the_images_of_its_seed() {
    let folder = empty();
    std::fs::write(folder.path().join("plan.toml"), PLAN).unwrap();
    let found = json(folder.path(), &["sweep", "plan.toml", "--json"]);
    let rows = found["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for row in rows {
        let shots = format!("firmware.shots_per_frame={}", number(row, "firmware.shots_per_frame"));
        let seed = row["seed"].as_u64().unwrap().to_string();
        let sizes = ["-s", "array.rows=6", "-s", "array.columns=8", "-s", &shots];
        let images = ["image", "--json", "--images", "3", "--seed", &seed];
        let images = json(folder.path(), &[&images[..], &sizes].concat());
        let of_images = images["images"].as_array().unwrap();
        let mean = |of: &dyn Fn(&Value) -> f64| of_images.iter().map(of).sum::<f64>() / 3.0;
        let near = |column: &str, expected: f64| {
            let found = number(row, column);
            assert!(
                (found - expected).abs() <= 1e-9 * expected.abs(),
                "{column}: {found} for {expected}"
            );
        };
        near("fill_rate", mean(&|image| number(image, "fill_rate")));
        near("root_mse_mm", mean(&|image| number(image, "rms_error_mm").powi(2)).sqrt());
        near("median_sigma_mm", 1e3 * mean(&|image| number(image, "median_sigma_m")));
        near("images_per_s", number(&images["firmware"], "images_per_s"));
        near("signal_hits", number(&images["signal_hits"], "median"));
        near("ambient_hits", number(&images["ambient_hits"], "median"));
        assert_eq!(row["notes"], "estimator-outside-model");
        assert!(number(row, "root_mse_mm_se") > 0.0 && row.get("images_per_s_se").is_none());
        assert!((0.0..0.2).contains(&number(row, "flying_rate")), "{row}");
    }
    let [few, many] = [&rows[0], &rows[1]];
    assert!(number(many, "sd_by_pixel_mm") < 0.6 * number(few, "sd_by_pixel_mm"));
    assert!(number(many, "images_per_s") < number(few, "images_per_s"));
}

#[test]
fn a_table_of_images_is_the_same_for_any_number_of_threads() {
    let folder = empty();
    std::fs::write(folder.path().join("plan.toml"), PLAN).unwrap();
    let table = |threads: &str| {
        let options = ["--threads", threads, "-o", threads];
        stdout(folder.path(), &[&["sweep", "plan.toml"], &options[..]].concat());
        let text = std::fs::read_to_string(folder.path().join(threads).join("sweep.csv")).unwrap();
        text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n")
    };
    let one = table("1");
    assert!(one.contains("fill_rate,fill_rate_se,flying_rate"), "{one}");
    assert_eq!(one, table("2"));
}

#[test]
fn what_images_do_not_have_is_refused_by_its_key() {
    let folder = empty();
    for (lines, said) in [
        ("fidelity = \"budget\"", "fidelity"),
        ("estimators = [\"network\"]", "estimators"),
        ("outputs = [\"network.bias_mm\"]", "expected one of images_per_s"),
        ("set = [\"array.rows=0\"]", "array.rows"),
    ] {
        let plan = format!(
            "scenario = \"array\"\n{lines}\n[[axis]]\nkey = \"spad.pdp\"\nvalues = [0.02]\n"
        );
        std::fs::write(folder.path().join("plan.toml"), plan).unwrap();
        let text = refused(folder.path(), &["sweep", "plan.toml"]);
        assert!(text.contains("plan.toml:") && text.contains(said), "{lines}: {text}");
    }
    let columns = stdout(folder.path(), &["sweep", "columns", "--array"]);
    assert!(columns.contains("flying_rate") && !columns.contains("hits_per_frame"), "{columns}");
    let columns = stdout(folder.path(), &["sweep", "columns"]);
    assert!(!columns.contains("flying_rate"), "{columns}");
}
