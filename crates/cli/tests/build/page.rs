//! The page that a colleague is sent.

use std::fs;

use roxmltree::Document;

use super::{ALONE, build, journal, small};

#[test]
fn the_page_is_well_formed_and_shows_what_was_measured() {
    let folder = small();
    let path = folder.path();
    let (status, said) = build(path, &["--steps", ALONE]);
    assert_eq!(status, 0, "{said}");
    let page = fs::read_to_string(path.join("out/report.html")).unwrap();
    let body = page.strip_prefix("<!DOCTYPE html>\n").unwrap();
    let document = Document::parse(body).unwrap();
    let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).collect();
    let shows = |text: &str| texts.iter().any(|found| found.contains(text));
    let steps = &journal(path)["steps"];
    let evaluation = &steps["accuracy"]["result"];
    let group = &evaluation["estimators"][0]["by_distance_m"][1];
    let number = |value: &serde_json::Value| format!("{:.2}", value.as_f64().unwrap());
    let frame = &steps["frame"]["result"]["frames"][0];
    for text in [
        "A small <instrument> & its page".to_owned(),
        "16 of 400 ps, 59.96 mm each; bin 0 begins at 0 ps".to_owned(),
        "network of 2 neurons".to_owned(),
        "24 taps over 9.6 ns".to_owned(),
        number(&group["two_sd_mm"]),
        number(&group["mean_mm"]),
        number(&evaluation["cramer_rao_two_sd_mm"][1]),
        number(&evaluation["estimators"][0]["all"]["two_sd_mm"]),
        format!("{:.6} m", frame["depth_m"].as_f64().unwrap()),
        frame["frame_cycles"].to_string(),
        steps["frame"]["result"]["hash"].as_str().unwrap().to_owned(),
        "This was a quick build".to_owned(),
    ] {
        assert!(shows(&text), "{text}");
    }
    let named = |name: &str| document.descendants().filter(|node| node.has_tag_name(name)).count();
    let svgs = document.descendants().filter(|node| node.tag_name().name() == "svg").count();
    assert_eq!((named("script"), named("link"), named("img"), svgs), (0, 0, 0, 4));
    assert!(!page.contains("src=") && !page.contains("href="), "nothing is fetched");
}
