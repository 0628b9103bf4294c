//! Writes the seeds of a target to a folder, for libFuzzer to begin with: `seeds TARGET FOLDER`.

use std::path::Path;

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [target, folder] = &arguments[..] else { panic!("seeds TARGET FOLDER") };
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    for (n, seed) in foton_fuzz::seeds::of(target).iter().enumerate() {
        std::fs::write(folder.join(format!("seed-{n}")), seed)?;
    }
    let words = foton_fuzz::seeds::WORDS.iter().map(|word| {
        let escaped: String = word.bytes().map(|byte| format!("\\x{byte:02x}")).collect();
        format!("\"{escaped}\"\n")
    });
    std::fs::write(folder.with_extension("dict"), words.collect::<String>())
}
