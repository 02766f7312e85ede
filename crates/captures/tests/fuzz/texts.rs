//! Fuzz tests of maps, probe configurations and conditions.

use proptest::prelude::*;
use proptest::sample::select;

use tofsim_captures::compare::SignalMap;
use tofsim_captures::condition::{Condition, Level, Operand};
use tofsim_captures::ila::AnalyserSetup;

use super::edit::{edited, edits};
use super::fuzz;

const TOML: [&str; 16] = [
    "\n",
    "\"",
    "=",
    "[",
    "]",
    "[[signal]]\n",
    "[[probe]]\n",
    "a = [\"x\"]\n",
    "latency = -9e9\n",
    "true",
    "-1",
    "1e308",
    "nan",
    "pattern = \"(\"\n",
    "dont_care = \"0x\"\n",
    "\u{feff}",
];

const MAP: &str = "clock = \"clk\"\nafter_us = 1.5\nignore = [\"a*\"]\n[[rename]]\nside = \"b\"\n\
    pattern = \"^a\"\nby = \"$1\"\n[[signal]]\na = [\"x\"]\nb = [\"y[7:4]\", \"z\"]\nsigned = true\n\
    dont_care = \"0xf0\"\nlatency = 2\n";

const SET_UP: &str = "clock = \"100MHz + 1ns\"\ndepth = 2048\nwindows = 3\ntrigger = \"rst rising\"\n\
    arm_at_us = 2\n[[probe]]\nsignal = \"rst\"\nname = \"R\"\nradix = \"hex\"\n";

const WORDS: [&str; 24] = [
    "a",
    "b[3]",
    "b[7:4]",
    "b[",
    "\"",
    " ",
    "==",
    "!=",
    "<",
    "<=",
    ">",
    ">=",
    "&&",
    "||",
    "!",
    "(",
    ")",
    "rising",
    "changed",
    "0x1f",
    "0b1x0",
    "-129",
    "340282366920938463463374607431768211456",
    "and",
];

#[test]
fn maps_that_are_nearly_right() {
    fuzz(edits(&TOML), |edits| {
        let text = String::from_utf8_lossy(&edited(MAP.into(), &edits)).into_owned();
        if let Err(error) = SignalMap::parse("map.toml", &text) {
            let error = error.to_string();
            prop_assert!(error.starts_with("map.toml"), "{}", error);
        }
        Ok(())
    });
}

#[test]
fn set_ups_that_are_nearly_right() {
    fuzz(edits(&TOML), |edits| {
        let text = String::from_utf8_lossy(&edited(SET_UP.into(), &edits)).into_owned();
        if let Err(error) = AnalyserSetup::parse("t", "t.toml", &text) {
            let error = error.to_string();
            prop_assert!(error.starts_with("t.toml"), "{}", error);
        }
        Ok(())
    });
}

#[test]
fn conditions_of_words_in_any_order() {
    let words = prop::collection::vec(select(&WORDS[..]), 0..12);
    fuzz((words, any::<bool>()), |(words, spaced)| {
        let text = words.join(if spaced { " " } else { "" });
        let place = |name: &str| match name {
            "a" => Ok(Operand { index: 0, width: 1, signed: false }),
            "b" => Ok(Operand { index: 1, width: 8, signed: true }),
            _ => Err(tofsim::error::Input::new("names", "no such signal").value(name).into()),
        };
        let bound = Condition::parse("--trigger", &text).and_then(|c| c.bind(&mut { place }));
        match bound {
            Ok(mut bound) => (0..20u128).for_each(|k| {
                bound.sample(|index| Level { value: k * 7 % [2, 256][index], unknown: k % 2 });
            }),
            Err(error) => prop_assert!(error.to_string().contains(": "), "{}", error),
        }
        Ok(())
    });
}
