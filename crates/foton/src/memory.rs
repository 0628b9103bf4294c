//! How much memory a render may take: what was asked for, or a share of what is free, and never more than the system's limits on
//! the program leave it.

#[cfg(test)]
mod tests;

use std::fmt;
use std::fs;
use std::path::Path;

use foton_integrator::MemoryEstimate;

/// Share of the free memory that is used unless `--memory` says otherwise.
const SHARE: f64 = 0.8;

/// Address space that the C library keeps for each thread, if there is any, whether the thread uses it or not.
#[cfg(target_os = "linux")]
const HEAP_OF_THREAD: f64 = (64 << 20) as f64;

/// Bytes that a render may take: what was asked for, else 80 % of what is free, and no more than the limit on address space leaves;
/// `None` where the system does not say.
pub(crate) fn limit(asked: Option<u64>) -> Option<f64> {
    let confined = Confined::of_system();
    let asked = asked.map(|bytes| bytes as f64);
    let wanted = asked.or_else(|| free().map(|bytes| bytes * SHARE));
    let room = confined.map(|confined| match asked {
        // Whoever asks for an amount, and keeps the C library from its heaps, knows what there is.
        Some(_) if confined.reserved == 0.0 => confined.limit,
        Some(_) => confined.room(),
        None => confined.room() * SHARE,
    });
    wanted.into_iter().chain(room).reduce(f64::min)
}

/// A limit of the system on address space or data, which ends a program that goes beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Confined {
    /// Bytes.
    limit: f64,
    /// Bytes that it has of them.
    used: f64,
    /// Bytes that the C library will reserve.
    reserved: f64,
    /// How a shell sets it.
    option: &'static str,
}

impl Confined {
    /// The tightest limit that was set on this program.
    #[cfg(target_os = "linux")]
    pub(crate) fn of_system() -> Option<Self> {
        use rustix::process::{Resource, getrlimit};
        let status = fs::read_to_string("/proc/self/status").ok()?;
        let reserved = if cfg!(target_env = "gnu") && std::env::var_os("MALLOC_ARENA_MAX").is_none() {
            HEAP_OF_THREAD * foton_session::threads::count(None) as f64
        } else {
            0.0
        };
        let limits = [(Resource::As, "VmSize:", "ulimit -v"), (Resource::Data, "VmData:", "ulimit -d")];
        let set = limits.into_iter().filter_map(|(resource, name, option)| {
            let limit = getrlimit(resource).current? as f64;
            Some(Self { limit, used: kibibytes(&status, name)?, reserved, option })
        });
        set.reduce(|a, b| if b.room() < a.room() { b } else { a })
    }

    /// Elsewhere nobody asks.
    #[cfg(not(target_os = "linux"))]
    pub(crate) fn of_system() -> Option<Self> {
        None
    }

    /// Bytes for a render, the program's own included, as estimates have it.
    fn room(&self) -> f64 {
        (self.limit - self.reserved - (self.used - MemoryEstimate::PROGRAM_BYTES).max(0.0)).max(0.0)
    }
}

impl fmt::Display for Confined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mebibytes = |bytes: f64| bytes / f64::from(1 << 20);
        write!(
            f,
            "the system confines the program to {:.0} MiB ({}), of which it has {:.0} MiB already",
            mebibytes(self.limit),
            self.option,
            mebibytes(self.used)
        )?;
        if self.reserved > 0.0 {
            write!(
                f,
                " and the C library keeps up to {:.0} MiB for threads (none with MALLOC_ARENA_MAX=1)",
                mebibytes(self.reserved)
            )?;
        }
        Ok(())
    }
}

/// A number of kB in a text of lines such as `VmSize:  1234 kB`, in bytes.
fn kibibytes(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? * 1024.0)
}

/// Free bytes on Linux: of the machine, or of the control groups that the program is in.
fn free() -> Option<f64> {
    let machine = kibibytes(&fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")?;
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let confined = left_in_groups(&groups, Path::new("/sys/fs/cgroup"));
    Some(confined.map_or(machine, |left| left.clamp(0.0, machine)))
}

/// Bytes that control groups leave: the least of a group and of those around it, by `/proc/self/cgroup`. In a container the group
/// may be mounted as if it were the outermost. `None` where none is limited.
fn left_in_groups(groups: &str, root: &Path) -> Option<f64> {
    let mut least: Option<f64> = None;
    for line in groups.lines() {
        let mut fields = line.splitn(3, ':');
        let (Some(_), Some(controllers), Some(path)) = (fields.next(), fields.next(), fields.next()) else {
            continue;
        };
        let (root, max, current, unused) = match controllers {
            "" => (root.to_owned(), "memory.max", "memory.current", "inactive_file "),
            _ if controllers.split(',').any(|c| c == "memory") => (
                root.join("memory"),
                "memory.limit_in_bytes",
                "memory.usage_in_bytes",
                "total_inactive_file ",
            ),
            _ => continue,
        };
        for group in Path::new(path.trim_start_matches('/')).ancestors() {
            let folder = root.join(group);
            let read = |name: &str| fs::read_to_string(folder.join(name)).ok();
            let number = |name: &str| read(name)?.trim().parse::<f64>().ok();
            let (Some(max), Some(current)) = (number(max), number(current)) else { continue };
            // What was read from files and is not looked at any more counts, but makes room.
            let statistics = read("memory.stat").unwrap_or_default();
            let unused =
                statistics.lines().find_map(|line| line.strip_prefix(unused)?.trim().parse::<f64>().ok());
            let left = max - current + unused.unwrap_or(0.0);
            least = Some(least.map_or(left, |least| least.min(left)));
        }
    }
    least
}
