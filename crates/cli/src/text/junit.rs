//! JUnit XML, as continuous integration reads it.

use std::path::Path;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use tofsim::error::{Input, Result};
use tofsim::files::output::write_bytes;

/// A case of a suite.
pub struct JunitCase {
    /// Name of the case.
    pub name: String,
    /// How it came out.
    pub outcome: JunitOutcome,
}

/// Outcome of a case.
pub enum JunitOutcome {
    /// It is as it should be.
    Success,
    /// It failed: why in a line, and at length.
    Failure(String, String),
    /// It could not be checked, for this reason.
    Error(String),
    /// It was not run, for this reason.
    Skipped(String),
}

impl JunitOutcome {
    /// A failure, if there is one: why in a line, and at length.
    pub fn of(failure: Option<(String, String)>) -> Self {
        failure.map_or(JunitOutcome::Success, |(line, all)| JunitOutcome::Failure(line, all))
    }

    fn status(self) -> TestCaseStatus {
        let (mut status, reason) = match self {
            JunitOutcome::Success => return TestCaseStatus::success(),
            JunitOutcome::Failure(line, all) => {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_description(all);
                (status, line)
            }
            JunitOutcome::Error(reason) => {
                (TestCaseStatus::non_success(NonSuccessKind::Error), reason)
            }
            JunitOutcome::Skipped(reason) => (TestCaseStatus::skipped(), reason),
        };
        status.set_message(reason);
        status
    }
}

/// Writes one suite as a document of its own.
///
/// # Errors
/// When it cannot be put into XML, or the file cannot be written.
pub fn write(
    path: &Path,
    report: &str,
    suite: String,
    cases: impl IntoIterator<Item = JunitCase>,
) -> Result<()> {
    let mut suite = TestSuite::new(suite);
    for JunitCase { name, outcome } in cases {
        suite.add_test_case(TestCase::new(name, outcome.status()));
    }
    let mut report = Report::new(report);
    report.add_test_suite(suite);
    let fault = |error| Input::new(path.display(), format!("no XML: {error}"));
    write_bytes(path, report.to_string().map_err(fault)?)
}
