//! Ctrl-C, and the signal at the limit of the size of a file.

use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::report::note;

/// Whether a stop was requested.
#[derive(Clone)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Handles Ctrl-C from now on. If `patient`, the first one requests a stop and the second one ends the
    /// process; otherwise the first one ends it. Files are complete at any moment, because every file is
    /// written under a temporary name.
    pub(crate) fn at_ctrl_c(patient: bool) -> Self {
        let stop = Self(Arc::new(AtomicBool::new(false)));
        let heard = stop.clone();
        let listens = ctrlc::set_handler(move || {
            if heard.0.swap(true, Ordering::Relaxed) || !patient {
                note("error: interrupted");
                exit(130);
            }
        });
        if let Err(error) = listens {
            note(&format!("note: Ctrl-C ends this run at once: {error}"));
        }
        stop
    }

    pub(crate) fn asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Turns a write beyond the file size limit of the process into an error, instead of the end of the process.
#[cfg(unix)]
pub fn survive_size_limit() {
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// Turns a write beyond the file size limit of the process into an error, on systems with such limits.
#[cfg(not(unix))]
pub fn survive_size_limit() {}
