//! A trace as WaveJSON, which WaveDrom draws.

use serde_json::{Value, json};

use super::trace::{Trace, Wave};

/// The object; `head` says what it shows.
pub fn wavejson(trace: &Trace, head: &str) -> Value {
    let signals: Vec<_> = trace.waves.iter().map(signal).collect();
    let foot = format!("{} ns a step, from {} ns", trace.step_ns, trace.begin_ns);
    json!({ "signal": signals, "head": { "text": head }, "foot": { "text": foot } })
}

fn signal(wave: &Wave) -> Value {
    let mut shape = String::with_capacity(wave.samples.len());
    let mut data = Vec::new();
    for (range, value) in wave.stretches() {
        if wave.is_word {
            shape.push('=');
            data.push(value.to_owned());
        } else {
            shape += value
        }
        shape.extend(range.skip(1).map(|_| '.'));
    }
    let mut signal = json!({ "name": wave.name, "wave": shape });
    if wave.is_word {
        signal["data"] = json!(data);
    }
    signal
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_and_words_by_hand() {
        let wave = |name: &str, is_word, samples: &[&str]| Wave {
            name: name.to_owned(),
            is_word,
            samples: samples.iter().map(|value| value.to_string()).collect(),
        };
        let waves = vec![
            wave("start", false, &["0", "1", "1", "0"]),
            wave("code[7:0]", true, &["00", "00", "7f", "80"]),
        ];
        let object = wavejson(&Trace { step_ns: 8.0, waves, ..Trace::default() }, "a shot");
        assert_eq!(object["signal"][0], json!({ "name": "start", "wave": "01.0" }));
        assert_eq!(object["signal"][1]["wave"], "=.==");
        assert_eq!(object["signal"][1]["data"], json!(["00", "7f", "80"]));
    }
}
