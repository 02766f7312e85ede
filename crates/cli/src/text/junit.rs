//! JUnit XML, as continuous integration reads it.

use std::path::Path;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use tofsim::error::{Input, Result};
use tofsim::files::output::write_bytes;

/// A case of a suite.
pub struct JunitCase {
    /// Name of the case.
    pub name: String,
    /// If it failed: why in a line, and at length.
    pub failure: Option<(String, String)>,
    /// If it was not run: why.
    pub skipped: Option<String>,
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
    for JunitCase { name, failure, skipped } in cases {
        let mut status = match (&failure, &skipped) {
            (Some(_), _) => TestCaseStatus::non_success(NonSuccessKind::Failure),
            (None, Some(_)) => TestCaseStatus::skipped(),
            (None, None) => TestCaseStatus::success(),
        };
        if let Some((message, description)) = failure {
            status.set_message(message).set_description(description);
        } else if let Some(reason) = skipped {
            status.set_message(reason);
        }
        suite.add_test_case(TestCase::new(name, status));
    }
    let mut report = Report::new(report);
    report.add_test_suite(suite);
    let fault = |error| Input::new(path.display(), format!("no XML: {error}"));
    write_bytes(path, report.to_string().map_err(fault)?)
}
