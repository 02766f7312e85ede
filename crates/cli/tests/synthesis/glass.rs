//! Resources of the likelihood estimator that knows of a cover glass.

use std::fs;

use super::cells::Cells;
use super::recorded::MAKER;
use super::yosys;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cover-glass.md");

#[test]
#[ignore = "long: ./check --full"]
fn an_estimator_that_knows_a_glass_has_four_multipliers_more() {
    let mut sources = yosys::rtl_ref();
    let parts = (0..256).map(|bin| format!("{:05x}\n", if bin < 40 { 3277 + bin } else { 0 }));
    sources.insert("glass.mem".to_owned(), parts.collect());
    let top = "likelihood_estimator";
    let command = format!(
        "chparam -set GlassBins 40 -set GlassLight 8192 -set GlassFile \"rtl_ref/glass.mem\" {top}"
    );
    let [usual, glass] = [("", top.to_owned()), (&*command, format!("{top}.glass"))]
        .map(|(command, name)| Cells::with(&sources, top, &name, command));
    assert!(glass.odd().is_empty(), "{:?}", glass.odd());
    assert_eq!((usual.count("DSP48E1"), glass.count("DSP48E1")), (8, 12));
    assert_eq!(glass.count("RAMB18E1"), usual.count("RAMB18E1") + 1, "the template's ROM");
    assert!(glass.count("LUT") <= 5500, "{}", glass.count("LUT"));
    if glass.maker == MAKER {
        let row = format!("| with a template |{}", glass.row());
        assert!(
            fs::read_to_string(PAGE).unwrap().contains(&row),
            "docs/cover-glass.md has no {row}"
        );
    }
}
