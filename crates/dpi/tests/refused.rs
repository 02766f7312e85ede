//! Tests of the errors for a bench that does not match.

use super::common::{compile, design, root, run, write};

/// Returns the output of the reference's frame controller with its checker, after a change of the checker's package.
fn said(scenario: (&str, &[&str]), change: impl Fn(String) -> String) -> String {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), scenario, Some(&["frame_ctrl"]));
    let package = folder.path().join("tofsim_pkg.sv");
    let text = std::fs::read_to_string(&package).unwrap();
    std::fs::write(&package, change(text)).unwrap();
    let files = [design(), vec![root().join("examples/bench/tb.sv")]].concat();
    let run = run(&compile(folder.path(), "tb", &files, &[]), &root(), &[]);
    assert!(!run.is_fine, "{}", run.text);
    run.text
}

#[test]
#[ignore = "long: ./check --full"]
fn a_width_that_is_not_the_scenario_s_is_named() {
    let text = said(("long", &[]), |text| text);
    let wanted = "tofsim_port: frame_ctrl.clear_addr: the design has 8 bits, the scenario 10";
    assert!(text.contains(wanted), "{text}");
}

#[test]
#[ignore = "long: ./check --full"]
fn another_version_is_named() {
    let own = env!("CARGO_PKG_VERSION");
    let change =
        |text: String| text.replace(&format!("Version = \"{own}\""), "Version = \"9.8.7\"");
    let text = said(("kc705", &[]), change);
    let wanted = format!("the SystemVerilog is of tofsim 9.8.7, this library of {own}");
    assert!(text.contains(&wanted), "{text}");
}

#[test]
#[ignore = "long: ./check --full"]
fn a_scenario_that_is_not_there_is_named() {
    let text = said(("kc705", &[]), |text| text.replace("\"kc705", "\"kc706"));
    assert!(
        text.contains("scenario: kc706: no such file or built-in scenario (`kc705`?)"),
        "{text}"
    );
}
