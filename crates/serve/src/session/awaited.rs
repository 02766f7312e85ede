//! A number of images that a request waits for.

use tofsim::error::{Input, Result};

/// A number of images, after which the run stops, and the outcome until the request has its answer.
#[derive(Debug, Default)]
pub struct Awaited {
    /// Images in all and that have ended.
    batch: Option<(u32, u32)>,
    outcome: Option<Result<()>>,
}

impl Awaited {
    /// Begins a number of images.
    pub fn begin(&mut self, count: u32) {
        self.batch = Some((count, 0));
    }

    /// Counts an image; returns whether it is the last one of the batch.
    pub fn count(&mut self) -> bool {
        let Some((count, done)) = &mut self.batch else { return false };
        *done += 1;
        let is_last = done == count;
        if is_last {
            self.end(Ok(()));
        }
        is_last
    }

    /// Ends a batch because of another request; returns whether there was one.
    pub fn interrupt(&mut self, what: &str) -> bool {
        let Some((count, done)) = self.batch else { return false };
        let expected = format!("stopped by another request after {done} of {count} {what}");
        self.end(Err(Input::new("run", expected).into()));
        true
    }

    /// Ends a batch, if there is one.
    pub fn end(&mut self, outcome: Result<()>) {
        if self.batch.take().is_some() {
            self.outcome = Some(outcome);
        }
    }

    /// Returns whether a request waits.
    pub fn is_waiting(&self) -> bool {
        self.batch.is_some()
    }

    /// Returns the outcome of a batch that has ended, once.
    pub fn take_outcome(&mut self) -> Option<Result<()>> {
        self.outcome.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_batch_ends_with_its_last_image_or_by_another_request() {
        let mut awaited = Awaited::default();
        assert!(!awaited.count() && !awaited.interrupt("images"));
        awaited.begin(2);
        assert_eq!([awaited.count(), awaited.count(), awaited.count()], [false, true, false]);
        assert!(matches!(awaited.take_outcome(), Some(Ok(()))));
        assert!(awaited.take_outcome().is_none());
        awaited.begin(3);
        awaited.count();
        assert!(awaited.interrupt("images") && !awaited.is_waiting());
        let fault = awaited.take_outcome().unwrap().unwrap_err().to_string();
        assert_eq!(fault, "run: stopped by another request after 1 of 3 images");
    }
}
