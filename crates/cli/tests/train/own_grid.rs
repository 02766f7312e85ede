//! Training for scenes of one's own.

use tofsim::network::Network;

use crate::common::{json, refused};

use super::{END, SMALL};

#[test]
fn a_network_is_trained_for_a_grid_of_one_s_own_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let grid = [
        "--grid",
        "target.distance_m=0.3..0.9:0.02",
        "--grid",
        "target.reflectance=0.2..0.8:0.2",
        "-s",
        "firmware.shots_per_frame=15000",
        "--with",
        "limits.penalty=50",
    ];
    let report = json(folder, &[&SMALL[..], &END, &grid, &["-o", "own", "--json"]].concat());
    let numbers = |key: &str| -> Vec<f64> {
        report[key].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
    };
    let (distances, line) = (numbers("distances_m"), numbers("line_mm"));
    assert_eq!((distances.len(), distances[0], distances[30]), (31, 0.3, 0.9));
    // The line follows the bound, which is larger far away.
    assert!(line[30] > 2.0 * line[0], "{line:?}");
    assert_eq!(report["set"][0], "firmware.shots_per_frame=15000");
    let network = Network::load(&folder.join("own/network.toml")).unwrap();
    let command = network.training.command.clone().unwrap();
    assert!(command.contains("--grid target.distance_m=0.3..0.9:0.02 --grid"), "{command}");
    let domain = network.domain.unwrap();
    assert_eq!(domain.ranges["target.distance_m"], [0.3, 0.9]);
    assert_eq!(domain.ranges["target.reflectance"], [0.2, 0.8]);
    assert_eq!(domain.ranges["ambient.irradiance_w_m2_nm"], [0.2, 0.2]);
    assert_eq!(domain.ranges["firmware.shots_per_frame"], [15_000.0; 2]);

    // Inside nothing is said, and outside what it is.
    let evaluate = |grid: &str| {
        let shots = ["-s", "firmware.shots_per_frame=15000"];
        let args = ["evaluate", "own/network.toml", "--check", "0", "--json", "--grid", grid];
        let report = json(folder, &[&args[..], &shots].concat());
        let notes = report["notes"].as_array().unwrap().clone();
        notes.iter().map(|note| note["key"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(evaluate("target.distance_m=0.3..0.9:0.1"), [""; 0]);
    assert_eq!(evaluate("target.distance_m=0.1..0.9:0.1"), ["target.distance_m"]);
    assert_eq!(evaluate("target.distance_m=0.3..1.0:0.1").len(), 2, "past the last bin too");

    // The training goes on for these scenes only.
    let again = ["--resume", "-o", "own"];
    let error = refused(folder, &[&SMALL[..], &END, &again].concat());
    assert!(error.contains("of another training"), "{error}");
    for (more, expected) in [
        (&["-s", "target.distance_m=0.9"][..], "-s target.distance_m=0.9: the grid has"),
        (&["--grid", "test"], "expected thesis, which has a grid for training and one for tests"),
        (&["--grid", "target.reflectance=0.1,0.2"], "target.distance_m: one value, expected two"),
        (
            &["--grid", "target.distance_m=0.1,0.2", "-s", "laser.average_power_w=0"],
            "a scene there tells nothing of its distance",
        ),
    ] {
        let error = refused(folder, &[&["train", "--quick"], more].concat());
        assert!(error.contains(expected), "{error}");
    }
}
