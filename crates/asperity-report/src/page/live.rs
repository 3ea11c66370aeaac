//! The page of a run under way.

use web_time::{Duration, Instant};

use asperity_study::Results;

/// Part of the time of a run that its page may take.
const SHARE: f64 = 0.02;
/// What the first page is taken to cost.
const FIRST: Duration = Duration::from_millis(300);

/// When the page of a run under way is written again.
#[derive(Debug)]
pub struct LivePage {
    began: Instant,
    spent: Duration,
    last: Duration,
}

impl LivePage {
    /// The page of a run that begins now.
    pub fn begin() -> Self {
        Self { began: Instant::now(), spent: Duration::ZERO, last: FIRST }
    }

    /// Writes the page, if it may take its time. Errors are reported at the end of the run.
    pub fn refresh(&mut self, results: impl FnOnce() -> asperity_base::Result<Results>) {
        if !self.is_due(self.began.elapsed()) {
            return;
        }
        let began = Instant::now();
        if let Ok(results) = results() {
            let _ = super::write(&results, &super::path_of(&results));
        }
        self.took(began.elapsed());
    }

    /// Whether another page as dear as the last one keeps to the share after so much time.
    fn is_due(&self, elapsed: Duration) -> bool {
        (self.spent + self.last).as_secs_f64() <= SHARE * elapsed.as_secs_f64()
    }

    fn took(&mut self, time: Duration) {
        self.spent += time;
        self.last = time;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_keep_to_their_share_of_a_run_whatever_they_cost() {
        let mut page = LivePage::begin();
        let (mut written, mut cost) = (0, 0.05);
        for second in 1..=4000 {
            let elapsed = Duration::from_secs(second);
            if page.is_due(elapsed) {
                page.took(Duration::from_secs_f64(cost));
                written += 1;
                // Pages grow with what is there, and may not grow beyond what the last one suggests by much.
                cost *= 1.3;
            }
            assert!(
                page.spent.as_secs_f64() <= 1.3 * SHARE * second as f64,
                "{:?} of {second} s",
                page.spent
            );
        }
        assert!(written > 10, "{written}");
    }
}
