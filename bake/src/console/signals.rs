//! Ctrl-C and SIGTERM. The first asks the work to stop and to remove what it made; the second ends the process at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Knows whether a signal came.
#[derive(Debug, Default)]
pub struct Signals {
    number: Arc<AtomicUsize>,
}

impl Signals {
    /// Starts to listen. If the system refuses, a signal ends the process at once, as without this.
    pub fn listen() -> Self {
        let signals = Self::default();
        for signal in [SIGINT, SIGTERM] {
            let again = Arc::new(AtomicBool::new(false));
            // In this order: the first signal checks `again` before it sets it.
            let _ = flag::register_conditional_shutdown(signal, exit_code(signal as usize).into(), again.clone());
            let _ = flag::register(signal, again);
            let _ = flag::register_usize(signal, signals.number.clone(), signal as usize);
        }
        signals
    }

    /// The exit code for the signal that came, if one did: 128 plus its number, as shells have it.
    pub fn exit_code(&self) -> Option<u8> {
        Some(self.number.load(Ordering::Relaxed)).filter(|&number| number != 0).map(exit_code)
    }
}

fn exit_code(signal: usize) -> u8 {
    128 + (signal & 0x7f) as u8
}
