//! JUnit XML, as continuous integration reads it.

use quick_junit::{NonSuccessKind, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};

/// A case of a suite.
pub struct JunitCase {
    /// What was tested.
    pub name: String,
    /// If it failed: why in a line, and at length.
    pub failure: Option<(String, String)>,
}

/// One suite as a document of its own.
///
/// # Errors
/// When it cannot be put into XML.
pub fn junit(
    report: &str,
    suite: String,
    cases: impl IntoIterator<Item = JunitCase>,
) -> Result<String, SerializeError> {
    let mut suite = TestSuite::new(suite);
    for JunitCase { name, failure } in cases {
        let status = match failure {
            None => TestCaseStatus::success(),
            Some((message, description)) => {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message(message).set_description(description);
                status
            }
        };
        suite.add_test_case(TestCase::new(name, status));
    }
    let mut report = Report::new(report);
    report.add_test_suite(suite);
    report.to_string()
}
