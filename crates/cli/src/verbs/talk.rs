//! What the program says on standard error while it works.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// The voice, and how much it says.
#[derive(Debug, clap::Args)]
pub struct Talk {
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say what is read and written
    #[arg(short, long, global = true)]
    verbose: bool,
}

impl Talk {
    /// Something worth knowing.
    pub fn note(&self, text: impl std::fmt::Display) {
        if !self.quiet {
            eprintln!("{text}");
        }
    }

    /// Something for who asked for it.
    pub fn detail(&self, text: impl std::fmt::Display) {
        if self.verbose {
            eprintln!("{text}");
        }
    }

    /// Whether more is to be said.
    pub fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// A progress bar over `count` of `things`, visible on a terminal only.
    pub fn progress(&self, count: u64, things: &str) -> ProgressBar {
        let target = match self.quiet || count < 2 {
            true => ProgressDrawTarget::hidden(),
            false => ProgressDrawTarget::stderr(),
        };
        let bar = ProgressBar::with_draw_target(Some(count), target);
        let template = format!("{{bar:40}} {{pos}}/{{len}} {things}, {{eta}} to go");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}
