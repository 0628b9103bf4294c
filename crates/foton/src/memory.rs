//! How much memory a render may take.

use std::fs;

use foton_integrator::MemoryEstimate;
use foton_scene::description::SceneDescription;

use crate::talk::Failure;

/// Share of the free memory that is used unless `--memory` says otherwise.
const SHARE: f64 = 0.8;

/// Bytes that a render may take: what was asked for, else 80 % of what is free; `None` where the system does not say.
pub(crate) fn limit(asked: Option<u64>) -> Option<f64> {
    asked.map(|b| b as f64).or_else(|| free().map(|b| b * SHARE))
}

/// Refuses a scene whose building alone would take more than may be used: bytes asked for, or the system's.
pub(crate) fn refuse_to_build(description: &SceneDescription, asked: Option<u64>) -> Result<(), Failure> {
    let takes = description.build_bytes() as f64 + MemoryEstimate::PROGRAM_BYTES;
    match limit(asked) {
        Some(limit) if takes > limit => Err(Failure::BuildMemory { takes, limit }),
        _ => Ok(()),
    }
}

/// Free bytes on Linux: of the machine, or of the control group that a container confines the program to.
fn free() -> Option<f64> {
    let meminfo = fs::read_to_string("/proc/meminfo").ok()?;
    let line = meminfo.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let machine = line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? * 1024.0;
    let group = |name: &str| {
        fs::read_to_string(format!("/sys/fs/cgroup/memory.{name}")).ok()?.trim().parse::<f64>().ok()
    };
    let confined = group("max").zip(group("current")).map(|(max, current)| max - current);
    Some(confined.map_or(machine, |c| c.clamp(0.0, machine)))
}
