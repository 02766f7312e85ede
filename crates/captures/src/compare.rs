//! Comparison of any two waveforms, captures and simulations.
//!
//! Signals are matched by name or by a map ([`map`]), and samples by an alignment. Both sides are read as streams in
//! bounded memory, as many times as necessary.

mod align;
mod beats;
mod both;
mod by_changes;
mod by_samples;
mod delay;
mod diagnose;
mod differences;
mod find;
pub mod map;
mod matching;
mod operands;
mod pair;
mod parts;
mod plan;
mod probed;
mod remarks;
mod result;
mod samples;
mod selection;
mod show;
mod states;

use std::path::PathBuf;
use std::str::FromStr;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use crate::choice::SignalChoice;
use crate::condition::Condition;
use crate::source::{Signal, Source};

pub use align::Align;
pub use align::{Survey, survey};
pub use map::SignalMap;
pub use matching::{Unmatched, UnmatchedReason};
pub use pair::{MatchedBy, Unknowns};
pub(crate) use probed::{Probed, pulse};
pub use result::{
    BeatDifference, BeatKind, BeatPlace, Beats, Compared, Comparison, Described, Difference,
    Finding,
};
pub use samples::SampleClock;
pub use samples::time;

use both::Both;
use differences::Differences;
use matching::matching;
use plan::{Plan, Terms};

/// Options of a comparison.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Explicit matching of names and values.
    pub map: SignalMap,
    /// Selection of the signals to compare.
    pub choice: SignalChoice,
    /// Sampling clock of a waveform; overrides the map's.
    pub clock: Option<SampleClock>,
    /// Alignment of the sides; overrides the map's.
    pub align: Option<Align>,
    /// Trigger condition for a waveform; overrides the map's.
    pub trigger: Option<Condition>,
    /// Condition under which samples were stored; overrides the map's.
    pub qualified_by: Option<Condition>,
    /// Signal of a capture that counts clock cycles; overrides the map's.
    pub time_from: Option<String>,
    /// Start of the comparison; overrides the map's.
    pub after: Option<Time>,
    /// End of the comparison.
    pub until: Option<Time>,
    /// Treatment of unknown bits.
    pub unknowns: Unknowns,
    /// Whether a signal without a partner is a difference.
    pub all: bool,
    /// Condition under which a bus accepts a word; overrides the map's. The accepted words are then compared,
    /// regardless of their times.
    pub beats: Option<Condition>,
    /// Path for a waveform of both sides.
    pub waves: Option<PathBuf>,
}

/// Compares two sources: the first is the reference, the second is under test.
///
/// # Errors
/// If a source cannot be read, no signals match, or the alignment is ambiguous.
pub fn compare(a: &Source, b: &Source, options: &Options) -> Result<Comparison> {
    let resolved = states::resolve([a, b], &options.map, &options.choice)?;
    let sources = resolved.sources.as_ref().map_or([a, b], |[a, b]| [a, b]);
    let nothing = |expected: &str| {
        Input::new("compare", expected).value(format_args!("{} and {}", a.name, b.name))
    };
    let mut matching = matching(sources, &options.map, &options.choice, Signal::fits)?;
    resolved.mark(&mut matching);
    if matching.pairs.is_empty() {
        let expected = "no signal of one has a partner in the other; give a map (--map)";
        return Err(nothing(expected).into());
    }
    if sources.iter().all(|source| source.is_capture())
        && (options.until.is_some() || options.after.is_some())
    {
        let expected = "expected a waveform: captures have no times";
        return Err(Input::new("--after or --until", expected).into());
    }
    let mut terms = terms(options)?;
    let beats = given(&options.beats, &options.map.beats, |text| Condition::parse("beats", text))?;
    if let Some(condition) = beats {
        return by_beats(sources, matching, terms, &condition, options, resolved.notes);
    }
    let align = align(sources, options, &terms)?;
    if align != Align::Trigger {
        terms.trigger = None;
    }
    let sampled = sources.iter().any(|source| source.is_capture()) || terms.sampling.is_some();
    let plan = Plan::new(sources, matching, terms, sampled)?;
    let axes = sources.map(|source| source.axis);
    let create = |path| Both::create(path, &plan.matching.pairs, axes);
    let both = options.waves.as_deref().map(create);
    let mut differences = Differences::new(&plan.matching, options.unknowns, both.transpose()?);
    let mut result = if sampled {
        let time_from = options.time_from.as_deref().or(options.map.time_from.as_deref());
        let alignment = align::alignment(&plan, &align, time_from)?;
        let mut result = by_samples::compare(&plan, &align, &alignment, &mut differences)?;
        conclude(&plan, &differences, options.all, &mut result);
        if !result.is_same() {
            result.findings = diagnose::samples(&plan, &alignment, &result)?;
            result.notes.extend(alignment.doubts);
        }
        result
    } else {
        let mut result = by_changes::compare(&plan, &align, &mut differences)?;
        conclude(&plan, &differences, options.all, &mut result);
        if !result.is_same() {
            result.findings = diagnose::changes(&plan, align::shift(&plan, &align)?.0, &result)?;
        }
        result
    };
    result.skipped.extend(resolved.notes.iter().cloned());
    result.notes.extend(resolved.notes);
    if result.compared == 0 && result.is_same() {
        let expected = "nothing to compare: there is no place that both sides have";
        return Err(nothing(expected).into());
    }
    if let Some(both) = differences.both.take() {
        both.finish(&result)?;
    }
    Ok(result)
}

fn by_beats(
    sources: [&Source; 2],
    matching: matching::Matching,
    terms: Terms,
    condition: &Condition,
    options: &Options,
    notes: Vec<String>,
) -> Result<Comparison> {
    without_order(options)?;
    // When samples were stored and what triggered is of no matter.
    let terms = Terms { trigger: None, qualifier: None, ..terms };
    let mut plan = Plan::new(sources, matching, terms, true)?;
    let mut result = beats::compare(&mut plan, condition, &options.choice.only)?;
    let mut differences = Differences::new(&plan.matching, options.unknowns, None);
    differences.counts.iter_mut().for_each(|count| count.compared = result.compared);
    conclude(&plan, &differences, options.all, &mut result);
    let Comparison { pairs, beats, .. } = &mut result;
    pairs.retain(|pair| beats.as_ref().is_none_or(|found| found.signals.contains(&pair.name)));
    result.skipped.extend(notes.iter().cloned());
    result.notes.extend(notes);
    Ok(result)
}

/// Checks that no option was given that does not apply to beats.
///
/// # Errors
/// The first such option.
fn without_order(options: &Options) -> Result<()> {
    let in_order = "the words themselves say what belongs together";
    let given = [
        ("--align", options.align.is_some(), in_order),
        ("--trigger", options.trigger.is_some(), in_order),
        ("--time-from", options.time_from.is_some(), in_order),
        ("--qualified-by", options.qualified_by.is_some(), in_order),
        ("--waves", options.waves.is_some(), "the sides have no time in common"),
        ("--x any", options.unknowns == Unknowns::Any, "words are looked for as they are"),
    ];
    match given.into_iter().find(|(_, is_given, _)| *is_given) {
        Some((option, _, reason)) => {
            Err(Input::new(option, format!("cannot go with --beats: {reason}")).into())
        }
        None => Ok(()),
    }
}

/// Stores the counts and remarks in the result.
fn conclude(plan: &Plan, differences: &Differences, all: bool, result: &mut Comparison) {
    result.pairs = differences.results(result.compared);
    remarks::add(plan, &differences.counts, all, result);
}

/// Returns an option, or else the parsed value of the map's key.
fn given<T: Clone>(
    option: &Option<T>,
    text: &Option<String>,
    parse: impl FnOnce(&str) -> Result<T>,
) -> Result<Option<T>> {
    match option {
        Some(option) => Ok(Some(option.clone())),
        None => text.as_deref().map(parse).transpose(),
    }
}

/// Parses the value of a key in the map.
fn parse<T: FromStr<Err = String>>(key: &str, text: &str) -> Result<T> {
    Ok(text.parse().map_err(|expected: String| Input::new(key, expected).value(text))?)
}

fn terms(options: &Options) -> Result<Terms> {
    let map = &options.map;
    let condition = |given: &Option<Condition>, key: &str, text: &Option<String>| {
        self::given(given, text, |text| Condition::parse(key, text))
    };
    Ok(Terms {
        sampling: given(&options.clock, &map.clock, |text| parse("clock", text))?,
        trigger: condition(&options.trigger, "trigger", &map.trigger)?,
        qualifier: condition(&options.qualified_by, "qualified_by", &map.qualified_by)?,
        stages: map.input_stages,
        after: options.after.unwrap_or(Time::from_ps_f64(map.after_us * 1e6)),
        until_fs: options.until.map_or(u128::MAX >> 32, |until| until.fs() as u128),
    })
}

/// Chooses the default alignment: by trigger for two captures; by trigger condition or else by correlation for a
/// capture and a waveform, per window if there are several; and by time for two waveforms.
fn align(sources: [&Source; 2], options: &Options, terms: &Terms) -> Result<Align> {
    if let Some(align) = given(&options.align, &options.map.align, |text| parse("align", text))? {
        return Ok(align);
    }
    match sources.map(Source::is_capture) {
        [true, true] => {
            let mut triggered = true;
            for source in sources {
                triggered &= survey(source)?.windows.iter().any(|window| window.trigger.is_some());
            }
            Ok(if triggered { Align::Trigger } else { Align::Start })
        }
        [false, false] if terms.trigger.is_none() || terms.sampling.is_none() => Ok(Align::Start),
        _ if terms.trigger.is_some() => Ok(Align::Trigger),
        captures => {
            let capture = sources[usize::from(captures[1])];
            match survey(capture)?.windows.len() {
                0 | 1 => Ok(Align::Correlation(Vec::new())),
                _ => Ok(Align::Windows(Vec::new())),
            }
        }
    }
}
