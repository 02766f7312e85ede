//! Setups for viewers: numbers with their units, curves, and names of states.

use std::fs;

use crate::common;

fn views(args: &[&str]) -> [String; 2] {
    let folder = tempfile::tempdir().unwrap();
    let run = ["run", "--window", "shot:0..2", "--window", "estimation", "-o", "."];
    common::stdout(folder.path(), &[&run, args].concat());
    ["gtkw", "sucl"].map(|ending| {
        fs::read_to_string(folder.path().join("kc705").with_extension(ending)).unwrap()
    })
}

#[test]
fn gtkwave_shows_numbers_in_their_units_and_some_as_curves() {
    let [save, _] = views(&["--waves", "fst", "-s", "estimator.kind=likelihood"]);
    for lines in [
        "@40000420\n[fpshift_count] 29\n+{depth [m]} tof_top.depth[35:0]\n",
        "@40000024\n[fpshift_count] 29\n+{likelihood_estimator/sigma [m]} tof_top.likelihood_estimator.sigma[35:0]\n",
        "@40000420\n[fpshift_count] 4\n+{tdc_decoder/t [25 ps]} tof_top.tdc.tdc_decoder.t[16:0]\n",
        "@24\n+{tdc_code [25 ps]} tof_top.tdc_code[7:0]\n",
        "@24\n+{hist_count [hits]} tof_top.hist_count[15:0]\n",
        "@88024\n+{histogram_builder/hit_word (curve)} tof_top.histogram_builder.hit_word[15:0]\n",
        "@88420\n+{depth (curve)} tof_top.depth[35:0]\n",
        "@100000028\n+{frame_ctrl/state} tof_top.frame_ctrl.state[1:0]\n",
    ] {
        assert!(save.contains(lines), "{lines}{save}");
    }
    assert!(save.contains("residual (curve)} "), "{save}");
    let fractions = save.lines().filter_map(|line| line.strip_prefix("[fpshift_count] "));
    assert!(fractions.clone().count() > 10);
    assert!(
        fractions.map(|bits| bits.parse::<u32>().unwrap()).all(|bits| (1..=30).contains(&bits))
    );
}

#[test]
fn surfer_shows_integers_with_the_worth_of_their_last_bit() {
    let [_, commands] = views(&["--waves", "vcd"]);
    for lines in [
        "item_set_format Signed\nitem_rename depth [2^-29 m]\nitem_unfocus\n",
        "item_set_format Unsigned\nitem_rename tdc_code [25 ps]\nitem_unfocus\n",
        "item_set_format Unsigned\nitem_rename hist_count [hits]\nitem_unfocus\n",
    ] {
        assert!(commands.contains(lines), "{lines}{commands}");
    }
}

#[test]
fn lengths_of_bins_are_those_of_the_scenario() {
    let half = ["-s", "tdc.bin_ps=12.5", "-s", "tdc.bins=512", "-s", "estimator.kind=centroid"];
    let [save, _] = views(&half);
    assert!(save.contains("+{tdc_code [12.5 ps]} "), "{save}");
}
