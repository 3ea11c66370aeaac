//! Ctrl-C, and the signal of a file that grows too large.

use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::report::note;

/// Whether someone asked to stop.
#[derive(Clone)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// From now on Ctrl-C is heard. `patient`: the first one asks, a second one ends the process; else the first one
    /// does. At whatever moment it ends, files are whole: every one is written under a temporary name.
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

/// Makes the write of a file beyond the size limit of the process an error, instead of the end of the process.
#[cfg(unix)]
pub fn survive_size_limit() {
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// Makes the write of a file beyond the size limit of the process an error, where the system has such limits.
#[cfg(not(unix))]
pub fn survive_size_limit() {}
