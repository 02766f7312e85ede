//! A timing diagram as SVG, in the colour of the text around it.

use std::fmt::Write;
use std::ops::Range;

use super::html::escaped;
use super::trace::{Trace, Wave};

/// Width of the picture, and of the names at its left [px].
const WIDTH: f64 = 540.0;
const NAMES: f64 = 134.0;
/// Height of a signal, and of its wave within that [px].
const ROW: f64 = 30.0;
const WAVE: f64 = 18.0;
/// Height of the words above, where instants are marked [px].
const HEAD: f64 = 22.0;
/// Height of the axis below [px].
const AXIS: f64 = 34.0;
/// A value that is there for less is not told apart [px].
const FAST: f64 = 3.5;
/// Width of a letter [px].
const LETTER: f64 = 7.9;

/// The picture as SVG text.
pub fn svg(trace: &Trace) -> String {
    let diagram = Diagram { trace, head: if trace.marks.is_empty() { 6.0 } else { HEAD } };
    let rows = trace.waves.len() + trace.spans.len();
    let height = diagram.head + rows as f64 * ROW + AXIS;
    let mut text = format!(
        "<svg class=\"ink\" viewBox=\"0 0 {WIDTH} {height:.0}\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" \
         font-family=\"ui-monospace, 'Liberation Mono', monospace\" font-size=\"13\" fill=\"currentColor\" \
         stroke-width=\"1.5\">\n"
    );
    diagram.axis(&mut text, height);
    for (row, wave) in trace.waves.iter().enumerate() {
        diagram.wave(&mut text, row, wave);
    }
    for (k, (span, name)) in trace.spans.iter().enumerate() {
        diagram.span(&mut text, trace.waves.len() + k, span, name);
    }
    diagram.marks(&mut text, height - AXIS);
    text + "</svg>\n"
}

struct Diagram<'a> {
    trace: &'a Trace,
    head: f64,
}

impl Diagram<'_> {
    /// Place of an instant [px].
    fn x(&self, ns: f64) -> f64 {
        let (begin, end) = (self.trace.begin_ns, self.trace.end_ns());
        NAMES + (WIDTH - NAMES - 6.0) * (ns - begin) / (end - begin).max(1e-12)
    }

    /// Place of a sample [px].
    fn at(&self, sample: usize) -> f64 {
        self.x(self.trace.begin_ns + sample as f64 * self.trace.step_ns)
    }

    /// Upper and lower end of a wave [px].
    fn levels(&self, row: usize) -> (f64, f64) {
        let top = self.head + row as f64 * ROW + (ROW - WAVE) / 2.0;
        (top, top + WAVE)
    }

    fn words(&self, text: &mut String, (x, y): (f64, f64), anchor: &str, words: &str) {
        let words = escaped(words);
        let _ = writeln!(
            text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>"
        );
    }

    fn wave(&self, text: &mut String, row: usize, wave: &Wave) {
        let (top, bottom) = self.levels(row);
        // The last part of a path says what it is.
        let name = wave.name.rsplit('/').next().unwrap_or_default();
        self.words(text, (NAMES - 8.0, bottom - 4.0), "end", name);
        if wave.is_word {
            return self.word(text, (top, bottom), wave);
        }
        let mut path = String::new();
        for (range, value) in wave.stretches() {
            let y = if value == "1" { top } else { bottom };
            let step = if path.is_empty() { 'M' } else { 'L' };
            let _ = write!(
                path,
                "{step}{:.1} {y:.1}L{:.1} {y:.1}",
                self.at(range.start),
                self.at(range.end)
            );
        }
        let _ = writeln!(text, "<path d=\"{path}\" fill=\"none\" stroke=\"currentColor\"/>");
    }

    /// A box for each value, which is written in it if there is room; a grey one where values change too fast to tell.
    fn word(&self, text: &mut String, (top, bottom): (f64, f64), wave: &Wave) {
        let mut fast: Option<(f64, f64)> = None;
        let grey = |text: &mut String, (from, to): (f64, f64)| {
            let (width, height) = (to - from, bottom - top);
            let _ = writeln!(
                text,
                "<rect x=\"{from:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" opacity=\"0.35\"/>"
            );
        };
        for (range, value) in wave.stretches() {
            let (from, to) = (self.at(range.start), self.at(range.end));
            if to - from < FAST {
                fast = Some((fast.map_or(from, |(begin, _)| begin), to));
                continue;
            }
            fast.take().into_iter().for_each(|span| grey(text, span));
            self.boxed(text, [from, to, top, bottom], value);
        }
        fast.into_iter().for_each(|span| grey(text, span));
    }

    fn boxed(&self, text: &mut String, [from, to, top, bottom]: [f64; 4], value: &str) {
        let (lean, middle) = (((to - from) / 4.0).min(3.0), (top + bottom) / 2.0);
        let (left, right) = (from + lean, to - lean);
        let _ = writeln!(
            text,
            "<path d=\"M{from:.1} {middle:.1}L{left:.1} {top:.1}L{right:.1} {top:.1}L{to:.1} {middle:.1}L{right:.1} \
             {bottom:.1}L{left:.1} {bottom:.1}Z\" fill=\"none\" stroke=\"currentColor\"/>"
        );
        if to - from > LETTER * value.len() as f64 + 4.0 {
            self.words(text, ((from + to) / 2.0, bottom - 5.0), "middle", value);
        }
    }

    /// An arrow over a span of time.
    fn span(&self, text: &mut String, row: usize, span: &Range<f64>, name: &str) {
        let (top, bottom) = self.levels(row);
        let (from, to, middle) = (self.x(span.start), self.x(span.end), (top + bottom) / 2.0);
        let _ = writeln!(
            text,
            "<path d=\"M{from:.1} {top:.1}V{bottom:.1}M{to:.1} {top:.1}V{bottom:.1}M{from:.1} {middle:.1}H{to:.1}\" fill=\"none\" stroke=\"currentColor\"/>"
        );
        self.words(text, (NAMES - 8.0, bottom - 4.0), "end", name);
    }

    fn marks(&self, text: &mut String, bottom: f64) {
        for (ns, name) in &self.trace.marks {
            let x = self.x(*ns);
            let _ = writeln!(
                text,
                "<path d=\"M{x:.1} {HEAD}V{bottom:.1}\" fill=\"none\" stroke=\"currentColor\" stroke-dasharray=\"3 3\" opacity=\"0.6\"/>"
            );
            let half = LETTER * name.len() as f64 / 2.0;
            let place = x.clamp(NAMES.min(WIDTH - half) + half, WIDTH - half);
            self.words(text, (place, HEAD - 7.0), "middle", name);
        }
    }

    fn axis(&self, text: &mut String, height: f64) {
        let (begin, end) = (self.trace.begin_ns, self.trace.end_ns());
        let step = round_step((end - begin) / 8.0);
        let (in_us, per) = if end - begin > 5000.0 { ("us", 1e3) } else { ("ns", 1.0) };
        let y = height - AXIS;
        let first = (begin / step).ceil() as i64;
        for k in first..=(end / step).floor() as i64 {
            let ns = k as f64 * step;
            let x = self.x(ns);
            let _ = writeln!(
                text,
                "<path d=\"M{x:.1} {:.1}V{y:.1}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1\" opacity=\"0.15\"/>",
                self.head
            );
            let number = format!("{}", (1e6 * ns / per).round() / 1e6);
            self.words(text, (x.min(WIDTH - 14.0), y + 15.0), "middle", &number);
        }
        self.words(text, (NAMES - 8.0, y + 15.0), "end", &format!("time [{in_us}]"));
    }
}

/// 1, 2 or 5 times a power of ten, no less than a length.
fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.max(1e-9).log10().floor());
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().find(|digit| digit * power >= least);
    digit.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_the_axis_are_round() {
        for (least, step) in [(0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (3.0, 5.0), (70.0, 100.0)] {
            assert!((round_step(least) - step).abs() < 1e-9, "{least}");
        }
    }

    #[test]
    fn names_values_marks_and_spans_are_shown_and_are_no_markup() {
        let wave = |name: &str, is_word, samples: &[&str]| Wave {
            name: name.to_owned(),
            is_word,
            samples: samples.iter().map(|value| value.to_string()).collect(),
        };
        let trace = Trace {
            step_ns: 8.0,
            waves: vec![wave("a<b", false, &["0", "1", "0"]), wave("w", true, &["1f", "1f", "2"])],
            marks: vec![(8.0, "edge".to_owned())],
            spans: vec![(0.0..8.0, "T1".to_owned())],
            ..Trace::default()
        };
        let svg = svg(&trace);
        for text in ["a&lt;b", ">1f<", ">edge<", ">T1<", "time [ns]", "viewBox"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert!(!svg.contains("a<b"));
    }
}
