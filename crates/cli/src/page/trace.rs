//! Samples of a run, as a logic analyser takes them, for a timing diagram and for WaveDrom.

use std::iter;
use std::ops::Range;
use std::sync::atomic::AtomicBool;

use bitvec::field::BitField;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::kernel::signals::Signal;
use tofsim::sim::Run;
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, Capture, Probe, Radix, capture};

/// Signals over time, sampled at even steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Interval between samples [ns].
    pub step_ns: f64,
    /// Instant of the first sample [ns].
    pub begin_ns: f64,
    pub waves: Vec<Wave>,
    /// Instants that are marked, and what they are [ns].
    pub marks: Vec<(f64, String)>,
    /// Spans of time below the waves, and what they are [ns].
    pub spans: Vec<(Range<f64>, String)>,
}

/// A signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    pub name: String,
    /// A word, whose values are shown, and no level.
    pub is_word: bool,
    /// Value of each sample; a level is `0` or `1`.
    pub samples: Vec<String>,
}

impl Wave {
    /// Each stretch of equal samples.
    pub fn stretches(&self) -> Vec<(Range<usize>, &str)> {
        let mut stretches: Vec<(Range<usize>, &str)> = Vec::new();
        for (k, value) in self.samples.iter().enumerate() {
            match stretches.last_mut() {
                Some((range, last)) if *last == value => range.end = k + 1,
                _ => stretches.push((k..k + 1, value)),
            }
        }
        stretches
    }
}

impl Trace {
    /// Samples `range` of a capture, whose clock has that period; time begins with the range [ns].
    pub fn of_capture(capture: &Capture, range: Range<usize>, step_ns: f64) -> Self {
        Trace::of_signals(capture, &[], range, step_ns)
    }

    /// Samples `range` of a capture as [`Trace::of_capture`] does, with the numbers of those of its probes' `signals` that
    /// have a unit.
    pub fn of_signals(
        capture: &Capture,
        signals: &[Option<Signal>],
        range: Range<usize>,
        step_ns: f64,
    ) -> Self {
        let range = range.start..range.end.min(capture.samples());
        let signals = signals.iter().map(Option::as_ref).chain(iter::repeat(None));
        let wave = |((probe, place), signal): ((&Probe, Range<usize>), Option<&Signal>)| {
            let signal = signal.filter(|signal| !signal.number_unit().is_empty());
            let value = |k: usize| {
                let word: u64 = capture.sample(k)[place.clone()].load_le();
                let as_radix = || shown(word, probe.width, probe.radix);
                signal.map_or_else(as_radix, |signal| signal.number_text(word))
            };
            let with_unit = |signal: &Signal| format!("{} [{}]", probe.name, signal.number_unit());
            Wave {
                name: signal.map_or_else(|| probe.head(), with_unit),
                is_word: probe.width > 1,
                samples: range.clone().map(value).collect(),
            }
        };
        let waves = capture.probes.iter().zip(capture.places()).zip(signals).map(wave).collect();
        Trace { step_ns, waves, ..Trace::default() }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.waves.iter().map(|wave| wave.samples.len()).max().unwrap_or(0)
    }

    /// Time of the end of the trace [ns].
    pub fn end_ns(&self) -> f64 {
        self.begin_ns + self.samples() as f64 * self.step_ns
    }

    /// The samples at which a signal rises [ns].
    pub fn rises_ns(&self, name: &str) -> Vec<f64> {
        let wave = self.waves.iter().find(|wave| wave.name == name);
        let pairs = wave.map_or(&[][..], |wave| &wave.samples).windows(2).enumerate();
        let rises = pairs.filter(|(_, pair)| pair[0] == "0" && pair[1] == "1");
        rises.map(|(k, _)| self.begin_ns + (k + 1) as f64 * self.step_ns).collect()
    }

    /// For how many samples in all a signal is high.
    pub fn high(&self, name: &str) -> usize {
        let wave = self.waves.iter().find(|wave| wave.name == name);
        wave.map_or(0, |wave| wave.samples.iter().filter(|value| *value == "1").count())
    }
}

/// A word in its radix; bits stay as they are.
fn shown(word: u64, width: u32, radix: Radix) -> String {
    let digits = |bits: u32| width.div_ceil(bits) as usize;
    match radix {
        _ if width == 1 => word.to_string(),
        Radix::Unsigned => word.to_string(),
        Radix::Signed => (((word << (64 - width)) as i64) >> (64 - width)).to_string(),
        Radix::Hex => format!("{word:0digits$x}", digits = digits(4)),
        Radix::Octal => format!("{word:0digits$o}", digits = digits(3)),
        Radix::Binary => format!("{word:0digits$b}", digits = digits(1)),
    }
}

/// The samples of a set-up in a run of `setup`; nothing if it never triggers.
///
/// # Errors
/// When the set-up is not for the design, or the run is stopped.
pub fn captured(
    setup: &Setup,
    set_up: &AnalyserSetup,
    stop: Option<&AtomicBool>,
) -> Result<Option<Capture>> {
    let plan = AnalyserPlan { stop_when_full: true, ..AnalyserPlan::new(set_up, setup)? };
    let mut analyser = Analyser::new(&plan, setup);
    capture(Run::new(setup), set_up.file.frames, &mut analyser, stop)?;
    let is_triggered = !analyser.triggers().is_empty();
    Ok(is_triggered.then(|| analyser.finish()))
}

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

    fn level(name: &str, samples: &str) -> Wave {
        let samples = samples.chars().map(String::from).collect();
        Wave { name: name.to_owned(), is_word: false, samples }
    }

    #[test]
    fn rises_and_stretches_by_hand() {
        let trace = Trace { step_ns: 4.0, waves: vec![level("a", "0110010")], ..Trace::default() };
        assert_eq!(trace.rises_ns("a"), [4.0, 20.0]);
        assert_eq!((trace.high("a"), trace.high("b"), trace.end_ns()), (3, 0, 28.0));
        let stretches = trace.waves[0].stretches();
        assert_eq!(stretches[1], (1..3, "1"));
        assert_eq!(stretches.len(), 5);
    }

    #[test]
    fn words_are_shown_in_their_radix() {
        assert_eq!(shown(0x01013c199, 36, Radix::Hex), "01013c199");
        assert_eq!(shown(0b110, 3, Radix::Signed), "-2");
        assert_eq!(shown(5, 4, Radix::Binary), "0101");
        assert_eq!(shown(1, 1, Radix::Hex), "1");
    }

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
