//! What signals do, counted by hand.

use std::fs;

use serde_json::{Value, json};

use crate::common;

fn stats(body: &str, args: &[&str]) -> Value {
    let folder = common::empty();
    let folder = folder.path();
    let head = "$timescale 100 ps $end\n$scope module t $end\n$var wire 1 ! clk $end\n\
        $var wire 4 # n [3:0] $end\n$var event 1 e e $end\n$upscope $end\n$enddefinitions $end\n";
    fs::write(folder.join("a.vcd"), format!("{head}{body}")).unwrap();
    common::json(folder, &[&["wave", "stats", "a.vcd", "--json"], args].concat())
}

#[test]
fn changes_pulses_and_frequency_are_counted() {
    // High for 4, 4 and 5 ns, low for 6 ns.
    let body = "#0\n0!\nb0 #\n#50\n1!\n#90\n0!\nb101 #\n1e\n#150\n1!\n0!\n1!\nb101 #\n#190\n0!\nb1x1 #\n\
        #250\n1!\n1e\n#300\n0!\nb11 #\n";
    let found = stats(body, &[]);
    assert_eq!(
        (&found["schema"], &found["end"]),
        (&"tofsim.wave_stats/1".into(), &30_000.0.into())
    );
    let [clk, n, event] = [0, 1, 2].map(|k| &found["signals"][k]);
    assert_eq!(
        (&clk["name"], &clk["changes"], &clk["toggles"]),
        (&"t.clk".into(), &6.into(), &6.into())
    );
    assert_eq!((&clk["first_change"], &clk["last_change"]), (&5000.0.into(), &30_000.0.into()));
    let third = 13_000.0 / 3.0;
    let high = json!({ "count": 3, "shortest": 4000.0, "mean": third, "longest": 5000.0 });
    assert_eq!(clk["high"], high);
    assert_eq!(
        clk["low"],
        json!({ "count": 2, "shortest": 6000.0, "mean": 6000.0, "longest": 6000.0 })
    );
    assert_eq!(clk["frequency_hz"], 1e8);
    // 0000, 0101, 01x1, 0011: two bits, none that is known, one.
    assert_eq!((&n["changes"], &n["toggles"], &n["high"]), (&3.into(), &3.into(), &Value::Null));
    assert_eq!(
        (&event["changes"], &event["type"], &event["width"]),
        (&2.into(), &"event".into(), &Value::Null)
    );
}

#[test]
fn a_part_is_counted_from_the_value_at_its_start() {
    let body = "#0\n0!\n#50\n1!\n#90\n0!\n#150\n1!\n#190\n0!\n#250\n";
    let found = stats(body, &["--after", "10ns", "--signals", "clk"]);
    let signals = found["signals"].as_array().unwrap();
    assert_eq!((signals.len(), &signals[0]["changes"]), (1, &2.into()));
    assert_eq!(signals[0]["high"]["count"], 1);
    assert_eq!(
        (&signals[0]["low"]["count"], &signals[0]["frequency_hz"]),
        (&0.into(), &Value::Null)
    );
    assert_eq!(signals[0]["first_change"], 15_000.0);
    assert_eq!(stats(body, &["--until", "9ns"])["signals"][0]["changes"], 1);
}
