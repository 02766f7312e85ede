//! `new`: a scenario to begin with.

use crate::common::{empty, refused, stdout};

#[test]
fn a_starter_has_twenty_keys_is_fine_and_is_not_overwritten() {
    let folder = empty();
    let folder = folder.path();
    let file = folder.join("mine.toml");
    assert_eq!(stdout(folder, &["new", "mine.toml"]), "");
    let text = std::fs::read_to_string(&file).unwrap();
    let keys = text.lines().filter(|line| !line.starts_with('#') && line.contains(" = "));
    assert_eq!(keys.count(), 20, "{text}");
    assert_eq!(stdout(folder, &["scenario", "check", "mine.toml"]), "mine: ok\n");
    let quick = ["--fidelity", "histogram", "--json"];
    let depth = |name: &str| {
        let found = stdout(folder, &[&["run", name], &quick[..]].concat());
        let found: serde_json::Value = serde_json::from_str(&found).unwrap();
        found["frames"][0]["depth_m"].clone()
    };
    assert_eq!(depth("mine.toml"), depth("kc705"));

    std::fs::write(&file, text.replace("distance_m = 0.5", "distance_m = 0.3")).unwrap();
    let error = refused(folder, &["new", "mine.toml"]);
    assert!(error.contains("mine.toml: exists already"), "{error}");
    assert!(std::fs::read_to_string(&file).unwrap().contains("distance_m = 0.3"));
    stdout(folder, &["new", "mine.toml", "--force"]);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text);
}
