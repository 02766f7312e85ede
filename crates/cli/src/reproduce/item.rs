//! A table or figure of the thesis, and what is found of it.

use tofsim::error::{Input, Result};

use crate::page::plot::Plot;
use crate::page::trace::Trace;

use super::study::Study;
use super::verdict::{Row, Verdict};

/// A table, a figure or another place of the thesis with something to make again.
pub struct Item {
    /// Its name on the command line: `table-4.3`, `fig-6.21`.
    pub id: &'static str,
    /// What it shows.
    pub title: &'static str,
    pub kind: Kind,
}

/// How an item is made.
pub enum Kind {
    Made(fn(&Study) -> Result<Finding>),
    /// Not at all, and why.
    Nothing(&'static str),
}

/// A picture with words below it.
pub struct Figure {
    pub svg: String,
    pub words: String,
    /// Drawn for a wide page.
    pub is_wide: bool,
}

/// What was found of an item.
#[derive(Default)]
pub struct Finding {
    pub rows: Vec<Row>,
    pub figures: Vec<Figure>,
    /// Timing diagrams: what each shows, and its samples.
    pub traces: Vec<(String, Trace)>,
    /// Why something differs, and how to read the rest.
    pub reason: String,
    /// A verdict that the rows do not give.
    pub overruled: Option<Verdict>,
    /// Commands of other verbs that show the same, beside the item's own.
    pub commands: Vec<String>,
}

impl Finding {
    pub fn of(rows: impl IntoIterator<Item = Row>) -> Self {
        Finding { rows: rows.into_iter().collect(), ..Finding::default() }
    }

    /// Why something differs, or how it is to be read.
    pub fn because(self, reason: impl Into<String>) -> Self {
        Finding { reason: reason.into(), ..self }
    }

    /// A command of another verb that shows the same.
    pub fn shown_by(mut self, command: impl Into<String>) -> Self {
        self.commands.push(command.into());
        self
    }

    /// A plot with words below it.
    ///
    /// # Errors
    /// When the plotting library fails.
    pub fn with_plot(self, plot: &Plot, words: impl Into<String>) -> Result<Self> {
        let svg = plot.svg().map_err(|fault| Input::new(plot.title, fault))?;
        Ok(self.with_figure(svg, words, false))
    }

    /// A picture with words below it.
    pub fn with_figure(mut self, svg: String, words: impl Into<String>, is_wide: bool) -> Self {
        self.figures.push(Figure { svg, words: words.into(), is_wide });
        self
    }

    /// A timing diagram, and what it shows.
    pub fn with_trace(mut self, words: impl Into<String>, trace: Trace) -> Self {
        self.traces.push((words.into(), trace));
        self
    }

    /// That of the rows: the same if all are, of which there is one at least.
    pub fn verdict(&self) -> Verdict {
        let judged: Vec<_> = self.rows.iter().filter_map(|row| row.verdict).collect();
        match self.overruled {
            Some(verdict) => verdict,
            None if judged.is_empty() => Verdict::CannotBeReproduced,
            None if judged.iter().all(|verdict| *verdict == Verdict::Same) => Verdict::Same,
            None => Verdict::Differs,
        }
    }

    /// Rows that are the same, and all that are compared.
    pub fn score(&self) -> (usize, usize) {
        let judged: Vec<_> = self.rows.iter().filter_map(|row| row.verdict).collect();
        (judged.iter().filter(|verdict| **verdict == Verdict::Same).count(), judged.len())
    }
}

impl Item {
    /// One that is made by a function.
    pub const fn made(
        id: &'static str,
        title: &'static str,
        make: fn(&Study) -> Result<Finding>,
    ) -> Self {
        Item { id, title, kind: Kind::Made(make) }
    }

    /// One that cannot be made, and why.
    pub const fn nothing(id: &'static str, title: &'static str, why: &'static str) -> Self {
        Item { id, title, kind: Kind::Nothing(why) }
    }

    /// Makes it.
    ///
    /// # Errors
    /// When it cannot be made, or is stopped.
    pub fn find(&self, study: &Study) -> Result<Finding> {
        match self.kind {
            Kind::Made(make) => make(study),
            Kind::Nothing(why) => Ok(Finding::default().because(why)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::verdict::Number;
    use super::*;

    #[test]
    fn one_row_that_differs_is_enough_and_none_is_nothing() {
        let (same, other) = (Row::words("a", "1", "1"), Row::words("b", "1", "2"));
        let beside = Row::ours_alone("c", "", Number::new(1.0, 0));
        assert_eq!(Finding::of([same.clone(), beside.clone()]).verdict(), Verdict::Same);
        let both = Finding::of([same, other, beside.clone()]);
        assert_eq!((both.verdict(), both.score()), (Verdict::Differs, (1, 2)));
        assert_eq!(Finding::of([beside]).verdict(), Verdict::CannotBeReproduced);
    }
}
