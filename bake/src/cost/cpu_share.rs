//! Share of the cores' time that this process gets. On a busy machine, measured seconds are longer than on an idle one.

use std::time::Instant;

/// Clock ticks a second in which Linux counts process times, on all architectures.
const TICKS_PER_SECOND: f64 = 100.0;
/// Seconds below which clock ticks are too coarse.
const LEAST_S: f64 = 0.1;

/// Wall-clock seconds, and the seconds that all threads of this process ran.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CpuShare {
    clock: Option<Instant>,
    clock_s: f64,
    run_s: Option<f64>,
}

impl CpuShare {
    /// Both counts at this moment.
    pub fn now() -> Self {
        let run_s = std::fs::read_to_string("/proc/self/stat").ok().and_then(|text| run_s(&text));
        Self { clock: Some(Instant::now()), clock_s: 0.0, run_s }
    }

    /// Adds the time between two moments, if it is long enough.
    pub fn add(&mut self, from: &Self, to: &Self) {
        let Some(clock_s) = to.clock.zip(from.clock).map(|(to, from)| (to - from).as_secs_f64()) else { return };
        if let (Some(from), Some(to)) = (from.run_s, to.run_s.filter(|_| clock_s >= LEAST_S)) {
            self.clock_s += clock_s;
            self.run_s = Some(self.run_s.unwrap_or(0.0) + to - from);
        }
    }

    /// Share of this many threads' time, 0 to 1; none where the system does not tell.
    pub fn share(&self, threads: usize) -> Option<f64> {
        let share = self.run_s? / (self.clock_s * threads.max(1) as f64);
        Some(share.clamp(0.0, 1.0)).filter(|share| share.is_finite())
    }
}

/// Seconds in user and system mode: the 14th and 15th field; the second, a name in brackets, may hold anything.
fn run_s(stat: &str) -> Option<f64> {
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / TICKS_PER_SECOND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_in_processes_is_read_behind_any_name() {
        let stat = "77 (a (b) c) R 1 2 3 4 5 6 7 8 9 10 250 50 13 14";
        assert_eq!(run_s(stat), Some(3.0));
        assert_eq!([run_s(""), run_s("1 (x) R 1")], [None, None]);
    }

    #[test]
    fn a_share_is_of_all_threads() {
        let used = CpuShare { clock: None, clock_s: 10.0, run_s: Some(10.0) };
        assert_eq!([used.share(1), used.share(2), CpuShare::default().share(2)], [Some(1.0), Some(0.5), None]);
    }
}
