//! An item evaluated: its rows, pictures and verdict; and the object `tofsim.reproduce/1` of all.

use serde::Serialize;
use serde_json::json;
use strum::VariantArray;

use tofsim::error::{Input, Result};
use tofsim::scenario;

use crate::page::plot::Plot;
use crate::page::trace::Trace;

use super::measures::measure;
use super::study::Study;
use super::sweeps::{Line, Sweeps};
use super::table::{Item, LineSpec, Picture, RowSpec};
use super::values::{Drawing, Measured, Value, Values};
use super::verdict::{Number, RULE, Row, Side, Verdict};

/// A picture with words below it.
pub struct Figure {
    /// The picture.
    pub svg: String,
    /// Text below the picture.
    pub words: String,
    /// Whether the picture is drawn for a wide page.
    pub is_wide: bool,
}

/// Finding of an item.
#[derive(Serialize)]
pub struct Finding {
    /// Name on the command line.
    pub id: String,
    /// Title of the item.
    pub title: String,
    /// Verdict of all rows.
    pub verdict: Verdict,
    /// Why something differs, and how to read the rest.
    pub reason: String,
    /// The command that makes it alone.
    pub command: String,
    /// Commands of other verbs that show the same.
    #[serde(rename = "other_commands")]
    pub commands: Vec<String>,
    /// The comparison.
    pub rows: Vec<Row>,
    /// Plots and other pictures.
    #[serde(skip)]
    pub figures: Vec<Figure>,
    /// Timing diagrams: what each shows, and its samples.
    #[serde(skip)]
    pub traces: Vec<(String, Trace)>,
}

impl Finding {
    /// Evaluates an item.
    ///
    /// # Errors
    /// When it names what there is not, a scenario is refused, or the study is stopped.
    pub fn new(item: &Item, study: &Study) -> Result<Self> {
        study.begin_item();
        let measured = measure(&item.id).map(|measure| measure(study)).transpose()?;
        let Measured { values, drawings } = measured.unwrap_or_default();
        let sweeps = Sweeps::new(study, &item.plans)?;
        let mut rows = Rows { values: &values, sweeps: &sweeps, rows: Vec::new() };
        item.rows.iter().try_for_each(|spec| rows.add(spec))?;
        let mut rows = rows.rows;
        if study.is_reduced() {
            rows.iter_mut().for_each(Row::leave_open);
        }
        let commands = item.commands.iter().map(|command| values.fill(command));
        let mut commands = commands.collect::<Result<Vec<_>>>()?;
        commands.extend(sweeps.commands());
        let quick = if study.quick { " --quick" } else { "" };
        let mut finding = Finding {
            id: item.id.clone(),
            title: item.title.clone(),
            verdict: if item.cannot_be_reproduced {
                Verdict::CannotBeReproduced
            } else {
                of(&rows)
            },
            reason: values.fill(&item.reason)?,
            command: format!("tofsim reproduce {}{quick} --seed {}", item.id, study.seed),
            commands,
            rows,
            figures: Vec::new(),
            traces: Vec::new(),
        };
        for (picture, drawing) in item.pictures.iter().zip(drawings) {
            finding.show(picture, drawing, &values)?;
        }
        let plots = sweeps.pictures()?.into_iter();
        finding.figures.extend(plots.map(|(svg, words)| Figure { svg, words, is_wide: true }));
        Ok(finding)
    }

    fn show(&mut self, picture: &Picture, drawing: Drawing, values: &Values) -> Result<()> {
        let words = values.fill(&picture.words)?;
        match drawing {
            Drawing::Layers(layers) => {
                let title = values.fill(&picture.title)?;
                let plot = Plot { title: &title, axes: [&picture.x, &picture.y], layers };
                let svg = plot.svg()?;
                self.figures.push(Figure { svg, words, is_wide: false });
            }
            Drawing::Svg(svg) => self.figures.push(Figure { svg, words, is_wide: true }),
            Drawing::Trace(trace) => self.traces.push((words, trace)),
        }
        Ok(())
    }

    /// Returns how many rows are the same, and how many are compared.
    pub fn score(&self) -> (usize, usize) {
        let judged: Vec<_> = self.rows.iter().filter_map(|row| row.verdict).collect();
        (judged.iter().filter(|verdict| **verdict == Verdict::Same).count(), judged.len())
    }
}

/// The verdict of rows: the same if all are, of which there is one at least.
fn of(rows: &[Row]) -> Verdict {
    let has = |verdict| rows.iter().any(|row| row.verdict == Some(verdict));
    let verdicts = [Verdict::Differs, Verdict::Undecided, Verdict::Same];
    verdicts.into_iter().find(|&verdict| has(verdict)).unwrap_or(Verdict::NothingToReproduce)
}

/// Returns how many items have each verdict.
pub fn tally(findings: &[Finding]) -> impl Iterator<Item = (Verdict, usize)> {
    let count = |verdict| findings.iter().filter(|one| one.verdict == verdict).count();
    Verdict::VARIANTS.iter().map(move |&verdict| (verdict, count(verdict)))
}

/// Rows of an item, as far as they are evaluated.
struct Rows<'a> {
    values: &'a Values,
    sweeps: &'a Sweeps,
    rows: Vec<Row>,
}

impl Rows<'_> {
    /// Evaluates a row, or one for each point of its line.
    fn add(&mut self, spec: &RowSpec) -> Result<()> {
        let mut values = self.values.clone();
        let Some(at) = &spec.line else {
            self.rows.push(row(spec, &values)?);
            return Ok(());
        };
        let line = self.line(at)?;
        values.put_all("", line.values());
        if let Some(other) = &spec.other {
            let other = self.line(other)?;
            values.put_all("other.", other.values());
            values.put("leads", line.leads(&other));
        }
        if !spec.points {
            self.rows.push(row(spec, &values)?);
            return Ok(());
        }
        for point in line.points() {
            values.put_all("", point);
            self.rows.push(row(spec, &values)?);
        }
        Ok(())
    }

    fn line(&self, spec: &LineSpec) -> Result<Line> {
        let at = spec.at.iter().map(|assignment| {
            let pair = assignment.split_once('=');
            let pair = pair.and_then(|(key, value)| Some((key, value.parse().ok()?)));
            pair.ok_or_else(|| Input::new("at", "expected key=number").value(assignment))
        });
        let at = at.collect::<std::result::Result<_, Input>>()?;
        self.sweeps.line(&spec.plan, [&spec.x, &spec.y], &at)
    }
}

/// Evaluates a row by values.
fn row(spec: &RowSpec, values: &Values) -> Result<Row> {
    let what = values.fill(&spec.what)?;
    if let Some(assignment) = &spec.sets {
        let is_key = scenario::load(scenario::DEFAULT, std::slice::from_ref(assignment)).is_ok();
        return Ok(Row::claim(what, is_key, format!("-s {assignment}")));
    }
    let Some(ours) = &spec.ours else {
        let mut holds = true;
        for condition in &spec.holds {
            holds &= values.holds(condition)?;
        }
        return Ok(Row::claim(what, holds, values.fill(&spec.seen)?));
    };
    let side = |text: &str, decimals: usize| -> Result<Side> {
        Ok(match values.get(text) {
            _ if text.contains('{') => Side::Words(values.fill(text)?),
            Ok(Value::Words(words)) => Side::Words(words.clone()),
            _ => {
                let (value, standard_error) = values.figure(text)?;
                Side::Number(Number { value, decimals, standard_error })
            }
        })
    };
    let printed = spec.thesis.as_deref();
    // A number that is printed has its own digits.
    let digits = printed.filter(|printed| printed.parse::<f64>().is_ok());
    let digits = digits.map(|printed| printed.split_once('.').map_or(0, |parts| parts.1.len()));
    let decimals = spec.decimals.or(digits).unwrap_or(0);
    let ours = side(ours, decimals)?;
    let thesis = printed.map(|printed| match ours {
        Side::Words(_) if !values.has(printed) => Ok(Side::Words(printed.to_owned())),
        _ => side(printed, digits.unwrap_or(decimals)),
    });
    Ok(Row::new(what, &spec.unit, thesis.transpose()?, ours))
}

/// Returns the object, without the record.
pub fn json(findings: &[Finding], quick: bool) -> serde_json::Value {
    let mut object = json!({ "schema": "tofsim.reproduce/1", "quick": quick, "rule": RULE });
    tally(findings).for_each(|(verdict, count)| object[verdict.key()] = json!(count));
    object["items"] = json!(findings);
    object
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values() -> Values {
        let mut values = Values::default();
        values.put_figure("a", (12.776, 0.01));
        values.put("n", 7.0);
        values.put_words("word", "0f");
        values.put_figure("printed", (12.7, 0.02));
        values
    }

    fn made(text: &str) -> Row {
        row(&toml::from_str(text).unwrap(), &values()).unwrap()
    }

    #[test]
    fn a_row_is_of_the_kind_that_its_keys_say() {
        let verdict = |text: &str| made(text).verdict;
        assert_eq!(verdict("ours = 'n'"), None);
        assert_eq!(verdict("ours = 'n'\nthesis = '7'"), Some(Verdict::Same));
        assert_eq!(verdict("ours = 'n - 1'\nthesis = '7'"), Some(Verdict::Differs));
        assert_eq!(verdict("ours = 'word'\nthesis = '0f'"), Some(Verdict::Same));
        assert_eq!(verdict("ours = '{n}, {word}'\nthesis = '7, 0f'"), Some(Verdict::Same));
        assert_eq!(verdict("holds = ['n > 6', 'n > 7']"), Some(Verdict::Differs));
        assert_eq!(verdict("holds = ['n > 6', 'n < 8']"), Some(Verdict::Same));
        assert_eq!(verdict("sets = 'tdc.bin_ps=50'"), Some(Verdict::Same));
        assert_eq!(verdict("sets = 'tdc.bin=50'"), Some(Verdict::Differs));
        assert!(row(&toml::from_str("ours = 'b'").unwrap(), &values()).is_err());
    }

    #[test]
    fn standard_errors_of_both_sides_and_the_printed_digits_decide() {
        let verdict = |text: &str| made(text).verdict.unwrap();
        assert_eq!(verdict("ours = 'a'\nthesis = '12.76'"), Verdict::Same);
        assert_eq!(verdict("ours = 'a + 0'\nthesis = '12.76'"), Verdict::Differs);
        assert_eq!(verdict("ours = 'a'\nthesis = '12.75'"), Verdict::Differs);
        assert_eq!(verdict("ours = 'a'\nthesis = '12.7'"), Verdict::Differs);
        assert_eq!(verdict("ours = 'a'\nthesis = '13'"), Verdict::Same);
        assert_eq!(verdict("ours = 'a'\nthesis = 'printed'\ndecimals = 1"), Verdict::Same);
        assert_eq!(verdict("ours = 'a'\nthesis = 'printed'\ndecimals = 3"), Verdict::Differs);
    }

    #[test]
    fn one_row_that_differs_is_enough_and_none_is_nothing() {
        let (same, other) = (made("ours = 'n'\nthesis = '7'"), made("ours = 'n'\nthesis = '8'"));
        let beside = made("ours = 'n'");
        assert_eq!(of(&[same.clone(), beside.clone()]), Verdict::Same);
        let mut open = same.clone();
        open.leave_open();
        assert_eq!(of(&[same.clone(), open.clone(), beside.clone()]), Verdict::Undecided);
        assert_eq!(of(&[same, other, open, beside.clone()]), Verdict::Differs);
        assert_eq!(of(&[beside]), Verdict::NothingToReproduce);
    }
}
