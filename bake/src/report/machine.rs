//! The machine on which times were measured.

use serde::{Deserialize, Serialize};

/// A machine, as far as the system describes it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Machine {
    /// Model of its processor; `unknown` where the system does not say.
    pub cpu: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// Threads that did the work.
    pub threads: usize,
    /// Operating system and architecture, as `linux x86_64`.
    pub os: String,
}

impl Machine {
    /// This machine, with this many working threads; 0 means one per core.
    pub fn here(threads: usize) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { cores } else { threads };
        Self { cpu: cpu(), cores, threads, os: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH) }
    }

    /// The machine in a few words.
    pub fn text(&self) -> String {
        let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        let Self { cpu, cores, threads, os } = self;
        format!("{cpu}, {} ({} used), {os}", count(*cores, "core"), count(*threads, "thread"))
    }
}

/// The processor's model, where Linux tells it.
fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    model(&text).unwrap_or_else(|| "unknown".into())
}

fn model(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name") || line.starts_with("Model"))?;
    let name = line.split_once(':')?.1.trim();
    (!name.is_empty()).then(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_read_where_it_is_given() {
        let text = "processor\t: 0\nmodel\t\t: 143\nmodel name\t: Intel(R) Xeon(R)\nmodel name\t: other\n";
        assert_eq!(model(text).as_deref(), Some("Intel(R) Xeon(R)"));
        assert_eq!([model(""), model("model name\t:\n")], [None, None]);
    }

    #[test]
    fn this_machine_has_a_core_and_says_how_many_threads_work() {
        let here = Machine::here(3);
        assert!(here.cores >= 1 && here.threads == 3 && here.text().contains("3 threads"), "{here:?}");
        assert_eq!(Machine::here(0).threads, here.cores);
    }
}
