//! Mutates seeds for so many seconds and feeds them to a target: `mutate TARGET SECONDS [SEED [CORPUS]]`, or a folder's files:
//! `mutate TARGET FOLDER`. Some of the inputs that it kept go to the folder CORPUS, evenly from all of them.
//!
//! It keeps inputs that make the reader say something new, so that it works its way inwards; nothing here depends on a nightly
//! compiler. An input that breaks a bound is written to `artifacts/` and counted, and the run goes on.

use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use foton_fuzz::{TIME_LIMIT, check_with_time, seeds};

/// Inputs do not grow beyond this.
const LARGEST: usize = 1 << 16;

/// Inputs kept at most.
const MAX_KEPT: usize = 4000;

/// The input under way, for the watchdog.
static UNDER_WAY: Mutex<(Vec<u8>, Option<Instant>)> = Mutex::new((Vec::new(), None));

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

fn mutate(input: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(input.len() + 1);
        let end = (at + 1 + random.below(24)).min(input.len());
        match random.below(10) {
            0 if at < input.len() => input[at] ^= 1 << random.below(8),
            1 if at < input.len() => input[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
            2 => drop(input.drain(at.min(end)..end)),
            3 => {
                let piece = input[at.min(end)..end].repeat(1 + random.below(3));
                input.splice(at..at, piece);
            }
            4 => {
                let word = seeds::WORDS[random.below(seeds::WORDS.len())].bytes();
                input.splice(at..at, word);
            }
            5 => {
                // A number for a number.
                let first = (at..input.len()).find(|&i| input[i].is_ascii_digit());
                if let Some(first) = first {
                    let last =
                        (first..input.len()).find(|&i| !input[i].is_ascii_digit()).unwrap_or(input.len());
                    let word = seeds::WORDS[random.below(12)].bytes();
                    input.splice(first..last, word);
                }
            }
            6 => input.truncate(at),
            7 if !other.is_empty() => {
                let from = random.below(other.len());
                let to = (from + 1 + random.below(64)).min(other.len());
                input.splice(at..at, other[from..to].iter().copied());
            }
            8 if at + 4 <= input.len() => {
                let value =
                    [u32::MAX, i32::MAX as u32, 1 << 16, f32::NAN.to_bits(), f32::INFINITY.to_bits(), 0]
                        [random.below(6)];
                let bytes = if random.below(2) == 0 { value.to_le_bytes() } else { value.to_be_bytes() };
                input[at..at + 4].copy_from_slice(&bytes);
            }
            9 if at + 8 <= input.len() => {
                let value =
                    [u64::MAX, f64::NAN.to_bits(), f64::INFINITY.to_bits(), 1 << 63, (-1f64).to_bits()]
                        [random.below(5)];
                input[at..at + 8].copy_from_slice(&value.to_le_bytes());
            }
            _ => {}
        }
    }
    input.truncate(LARGEST);
}

/// Ends the program when an input takes four times too long, which no other thread can end.
fn watch(target: String) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let under_way = UNDER_WAY.lock().expect("not poisoned");
            if under_way.1.is_some_and(|since| since.elapsed() > 4 * TIME_LIMIT) {
                keep(&target, "hang", &under_way.0);
                eprintln!("{target}: an input hangs");
                std::process::exit(1);
            }
        }
    });
}

fn keep(target: &str, what: &str, input: &[u8]) {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let folder = Path::new("artifacts");
    let _ = std::fs::create_dir_all(folder);
    let n = NUMBER.fetch_add(1, Ordering::Relaxed);
    if n < 200 {
        let _ = std::fs::write(folder.join(format!("{target}-{what}-{}-{n}", std::process::id())), input);
    }
}

/// Writes some of the inputs that were kept.
fn write_corpus(folder: &Path, kept: &[Vec<u8>]) {
    const MOST: usize = 100;
    std::fs::create_dir_all(folder).expect("a folder");
    for (i, input) in kept.iter().step_by(kept.len().div_ceil(MOST)).enumerate() {
        std::fs::write(folder.join(format!("{i:03}")), input).expect("written");
    }
}

/// One input; what the reader said, or the panic's message.
fn run(target: &str, input: &[u8]) -> Result<String, String> {
    *UNDER_WAY.lock().expect("not poisoned") = (input.to_vec(), Some(Instant::now()));
    let outcome = catch_unwind(AssertUnwindSafe(|| check_with_time(target, input)));
    UNDER_WAY.lock().expect("not poisoned").1 = None;
    outcome.map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic").to_owned()
    })
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (target, how_long) = (arguments[0].clone(), &arguments[1]);
    watch(target.clone());
    if Path::new(how_long).is_dir() {
        let mut entries: Vec<_> =
            std::fs::read_dir(how_long).expect("a folder").flatten().map(|e| e.path()).collect();
        entries.sort();
        for path in entries {
            println!("{}: {:?}", path.display(), run(&target, &std::fs::read(&path).expect("a file")));
        }
        return;
    }
    let seconds: u64 = how_long.parse().expect("seconds");
    let mut random = Random(arguments.get(2).map_or(1, |s| s.parse().expect("a seed")));
    std::panic::set_hook(Box::new(|_| {}));
    let mut kept = seeds::of(&target);
    let mut said: HashSet<String> = HashSet::new();
    let mut faults: HashSet<String> = HashSet::new();
    let (mut tried, mut broken) = (0u64, 0u64);
    let begin = Instant::now();
    for seed in kept.clone() {
        match run(&target, &seed) {
            Ok(text) => println!("seed: {}", text.chars().take(120).collect::<String>()),
            Err(fault) => println!("SEED FAILS: {fault}"),
        }
    }
    while begin.elapsed() < Duration::from_secs(seconds) {
        let mut input = kept[random.below(kept.len())].clone();
        let other = kept[random.below(kept.len())].clone();
        mutate(&mut input, &other, &mut random);
        tried += 1;
        match run(&target, &input) {
            Ok(text) => {
                if kept.len() < MAX_KEPT && said.insert(text) {
                    kept.push(input);
                }
            }
            Err(fault) => {
                broken += 1;
                let shape: String = fault.chars().filter(|c| !c.is_ascii_digit()).take(80).collect();
                if faults.insert(shape) {
                    println!("FAULT: {fault}");
                    keep(&target, "fault", &input);
                }
            }
        }
    }
    if let Some(corpus) = arguments.get(3) {
        write_corpus(Path::new(corpus), &kept);
    }
    println!(
        "{target}: {tried} inputs in {:.0} s, {} kinds of outcome, {broken} faults",
        begin.elapsed().as_secs_f64(),
        said.len()
    );
}
