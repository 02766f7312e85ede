//! Readers take any text without a panic: a value or an error, never more.

use proptest::prelude::*;

use tofsim::files::csv::CsvInput;
use tofsim::network::Network;
use tofsim::network::histogram_csv;
use tofsim::scenario;
use tofsim::scenario::drift::Profile;
use tofsim::scenario::mesh;
use tofsim::scenario::window::Window;
use tofsim::sensor::photon_list::PhotonList;

/// Text that is nearly right: pieces of the formats, shuffled.
fn nearly(pieces: &'static [&'static str]) -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        4 => proptest::sample::select(pieces).prop_map(str::to_owned),
        1 => any::<String>(),
        1 => any::<f64>().prop_map(|number| number.to_string()),
        1 => any::<i64>().prop_map(|number| number.to_string()),
    ];
    proptest::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn photon_lists(text in nearly(&["shot,arrival_ps", "\n", "0", ",", "12.5", "#", "\r\n", "-", "\""])) {
        let _ = PhotonList::parse("p", &format!("shot,arrival_ps\n{text}"));
        let _ = PhotonList::parse("p", &text);
    }

    #[test]
    fn histograms(text in nearly(&["bin,count", "\n", "0,", "1,5\n", "65535", "#x\n", "\"", " "])) {
        let _ = histogram_csv::parse("h", &text, &Default::default());
        let _ = CsvInput::new("h", &text, &["bin", "count"]);
    }

    #[test]
    fn conditions(text in nearly(&["time_s,temperature_c,supply_mv", "\n", "0,", "25,", "1\n", "1e-3", "-", "\"", "#"])) {
        let _ = Profile::parse("p", &format!("time_s,temperature_c,supply_mv\n{text}"));
        let _ = Profile::parse("p", &text);
    }

    #[test]
    fn meshes(text in nearly(&[
        "v ", "f ", "1 ", "-1", "/", "\n", "\\\n", "0 0 0\n", "1 0 0\n", "0 1 0\n", "#", "nan", "vn 0 0 1\n",
        "solid\n", "facet normal 0 0 1\n", "outer loop\n", "vertex ", "endloop\n", "endfacet\n", "endsolid",
    ])) {
        let _ = mesh::parse("m.obj", text.as_bytes());
        let _ = mesh::parse("m.stl", text.as_bytes());
        let _ = mesh::parse("m.stl", format!("solid {text}").as_bytes());
    }

    #[test]
    fn binary_meshes(bytes in proptest::collection::vec(any::<u8>(), 0..400), count in 0u8..8) {
        let header = [vec![b'x'; 80], vec![count, 0, 0, 0]].concat();
        let _ = mesh::parse("m.stl", &[header, bytes.clone()].concat());
        let length = bytes.len() / 50 * 50;
        let header = [vec![b'x'; 80], vec![(length / 50) as u8, 0, 0, 0]].concat();
        let _ = mesh::parse("m.stl", &[&header, &bytes[..length]].concat());
    }

    #[test]
    fn windows(text in nearly(&["shot:", "..", "10", "us", "ns", "1e9", "ps", "estimation", "-"])) {
        if let Ok(window) = text.parse::<Window>() {
            prop_assert_eq!(window.to_string().parse::<Window>(), Ok(window));
        }
    }

    #[test]
    fn overrides(text in nearly(&[
        "target", ".", "distance_m", "=", "[", "]", "{", "}", "control", "at_us", "\n", "\"", "nan", "1",
        "firmware", "shots_per_frame", "pll", "multiply", "divide", "output_divide", "input_hz",
    ])) {
        let _ = scenario::load("kc705", &[text]);
    }

    #[test]
    fn networks(text in nearly(&[
        "schema = \"tofsim.network/1\"\n", "[formats]\n", "[integers]\n", "w1 = ", "[", "]", ",", "1", "\n",
        "[training]\n", "origin = \"x\"\n", "b2 = 3\n", "{", "}", "=",
    ])) {
        let _ = Network::parse(&text, "n");
    }
}
