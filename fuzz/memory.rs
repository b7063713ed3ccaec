//! The memory of this process, as Linux tells it; 0 elsewhere.

/// Resident memory, MiB.
pub fn resident() -> f64 {
    status("VmRSS:")
}

/// The most that was ever asked for, MiB: what is never touched counts too.
pub fn peak() -> f64 {
    status("VmPeak:")
}

fn status(line: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let value = text.lines().find_map(|l| l.strip_prefix(line)?.trim().strip_suffix(" kB")?.trim().parse::<f64>().ok());
    value.unwrap_or_default() / 1024.0
}
