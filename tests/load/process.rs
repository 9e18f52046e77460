//! What a process took of the machine, as Linux tells it.

use std::fs;

/// Processor and memory of a process at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Usage {
    /// Seconds of processor time, in the kernel and outside, of all its threads that live.
    pub(crate) cpu_seconds: f64,
    /// Seconds for which its threads could have run and did not, because others did, each other included.
    pub(crate) waited_seconds: f64,
    /// Memory that it has, KiB.
    pub(crate) memory_kib: u64,
}

impl Usage {
    /// Of a process, or of this one; `None` where there is no such process or no `/proc`.
    pub(crate) fn of(process: Option<u32>) -> Option<Self> {
        let folder = process.map_or_else(|| "/proc/self".to_owned(), |process| format!("/proc/{process}"));
        // In nanoseconds, where `stat` counts hundredths of a second.
        let (mut ran, mut waited) = (0.0, 0.0);
        for thread in fs::read_dir(format!("{folder}/task")).ok()?.flatten() {
            let Ok(text) = fs::read_to_string(thread.path().join("schedstat")) else { continue };
            let mut numbers = text.split_whitespace().map_while(|number| number.parse::<f64>().ok());
            ran += numbers.next()?;
            waited += numbers.next()?;
        }
        let status = fs::read_to_string(format!("{folder}/status")).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
        let memory_kib = line.split_whitespace().next()?.parse().ok()?;
        Some(Self { cpu_seconds: ran / 1e9, waited_seconds: waited / 1e9, memory_kib })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_process_has_used_something() {
        if cfg!(target_os = "linux") {
            let usage = Usage::of(None).expect("a process has a folder");
            assert!(usage.cpu_seconds > 0.0 && usage.memory_kib > 100, "{usage:?}");
        }
        assert_eq!(Usage::of(Some(u32::MAX)), None);
    }
}
