//! What it takes to open a large mesh and to build its scene: seconds on the wall and of the processor, and the most memory.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use std::time::Instant;

use foton_format::Options;
use foton_scene::{BuildOptions, BuildStep, Scene};

use super::rig;

/// Squares along a side of the mesh; each is two triangles.
const SIDE: u32 = 1000;

/// Opens each kind of file, or one `file`, and builds its scene.
pub(crate) fn print(file: Option<&str>) {
    if let Some(file) = file {
        return measure(Path::new(file));
    }
    let folder = rig::target().join("bench-loading");
    fs::create_dir_all(&folder).expect("a folder");
    println!("{} triangles, {} threads", 2 * SIDE * SIDE, rayon::current_num_threads());
    println!("file                      MB   read s  (cpu s)  bytes/tri   build s  (cpu s)  bytes/tri");
    for (name, contents) in files() {
        let path = folder.join(name);
        fs::write(&path, contents()).expect("written");
        // A process of its own: what others took counts for none.
        let program = std::env::current_exe().expect("a program");
        let status = Command::new(program).arg("loading").arg(&path).status().expect("started");
        assert!(status.success(), "{name}: {status}");
        fs::remove_file(&path).expect("removed");
    }
}

fn measure(path: &Path) {
    let triangles = f64::from(2 * SIDE * SIDE);
    let bytes = fs::metadata(path).expect("there").len();
    let (xml, id) = (scene_of(path), std::process::id());
    let processor = || rig::processor_seconds(id).unwrap_or_default();
    let before = memory("VmRSS:");
    let read = |file: &Path| fs::read(file);
    let (clock, cpu) = (Instant::now(), processor());
    forget_peak();
    let opened = foton_format::read_str("bench.xml", &xml, &read, &Options::default()).expect("opens");
    let reading = (clock.elapsed().as_secs_f64(), processor() - cpu, (memory("VmHWM:") - before) / triangles);
    let (clock, cpu) = (Instant::now(), processor());
    forget_peak();
    let steps = Mutex::new(Vec::<(BuildStep, f64)>::new());
    let tell = |step, _| {
        let mut steps = steps.lock().expect("nobody panics");
        if steps.last().is_none_or(|(last, _)| *last != step) {
            steps.push((step, processor()));
        }
    };
    let options = BuildOptions { tell: Some(&tell), ..BuildOptions::default() };
    let scene = Scene::build_with(&opened.description, &options).expect("a sound scene");
    let building =
        (clock.elapsed().as_secs_f64(), processor() - cpu, (memory("VmHWM:") - before) / triangles);
    drop(scene);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    println!(
        "{name:24} {:5.0} {:8.2} {:8.2} {:9.0} {:9.2} {:8.2} {:9.0}",
        bytes as f64 / 1e6,
        reading.0,
        reading.1,
        reading.2,
        building.0,
        building.1,
        building.2
    );
    let steps = steps.into_inner().expect("nobody panics");
    let ends = steps.iter().skip(1).map(|(_, at)| *at).chain([cpu + building.1]);
    let steps: Vec<_> = steps
        .iter()
        .zip(ends)
        .map(|((step, begin), end)| format!("{} {:.2} s", step.text(), end - begin))
        .collect();
    println!("                         {}", steps.join(", "));
}

/// From now on the peak is that of what follows. Where the system lets nobody do so, the peak of all that came before counts.
fn forget_peak() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Bytes of the memory of this process, by the name in `/proc/self/status`.
fn memory(name: &str) -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(name));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok()).unwrap_or(f64::NAN) * 1024.0
}

fn scene_of(path: &Path) -> String {
    let plugin = path.extension().unwrap_or_default().to_string_lossy();
    format!(
        "<scene version='3.0.0'><sensor type='perspective'/><shape type='{plugin}'><string name='filename' value='{}'/></shape></scene>",
        path.display()
    )
}

type Contents = fn() -> Vec<u8>;

fn files() -> [(&'static str, Contents); 4] {
    [
        ("bare.obj", || obj(false)),
        ("whole.obj", || obj(true)),
        ("text.ply", || ply(true)),
        ("binary.ply", || ply(false)),
    ]
}

/// Corners of the mesh, a hilly square: position, normal and texture coordinate.
fn corners() -> impl Iterator<Item = ([f32; 3], [f32; 3], [f32; 2])> {
    let at = |i: u32| i as f32 / SIDE as f32;
    (0..=SIDE).flat_map(move |j| (0..=SIDE).map(move |i| (at(i), at(j)))).map(|(u, v)| {
        let height = 0.05 * (40.0 * u).sin() * (30.0 * v).cos();
        let slopes = [2.0 * (40.0 * u).cos() * (30.0 * v).cos(), -1.5 * (40.0 * u).sin() * (30.0 * v).sin()];
        let length = (1.0 + slopes[0] * slopes[0] + slopes[1] * slopes[1]).sqrt();
        let normal = [-slopes[0] / length, -slopes[1] / length, 1.0 / length];
        ([10.0 * u, 10.0 * v, 10.0 * height], normal, [u, v])
    })
}

fn triangles() -> impl Iterator<Item = [u32; 3]> {
    let row = SIDE + 1;
    (0..SIDE).flat_map(move |j| {
        (0..SIDE).flat_map(move |i| {
            let a = j * row + i;
            [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]
        })
    })
}

/// As Blender writes it: six digits, and normals and texture coordinates if wanted.
fn obj(is_whole: bool) -> Vec<u8> {
    let mut text = String::from("# a mesh\no hills\n");
    for (p, ..) in corners() {
        let _ = writeln!(text, "v {:.6} {:.6} {:.6}", p[0], p[1], p[2]);
    }
    if is_whole {
        corners()
            .for_each(|(_, n, _)| writeln!(text, "vn {:.4} {:.4} {:.4}", n[0], n[1], n[2]).expect("text"));
        corners().for_each(|(.., uv)| writeln!(text, "vt {:.6} {:.6}", uv[0], uv[1]).expect("text"));
    }
    text.push_str("s 1\n");
    for triangle in triangles() {
        let [a, b, c] = triangle.map(|i| i + 1);
        let _ = match is_whole {
            true => writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}"),
            false => writeln!(text, "f {a} {b} {c}"),
        };
    }
    text.into_bytes()
}

fn ply(is_text: bool) -> Vec<u8> {
    let format = if is_text { "ascii" } else { "binary_little_endian" };
    let (vertices, faces) = ((SIDE + 1) * (SIDE + 1), 2 * SIDE * SIDE);
    let names = ["x", "y", "z", "nx", "ny", "nz", "u", "v"];
    let properties: String = names.iter().map(|name| format!("property float {name}\n")).collect();
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\n{properties}element face {faces}\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for (p, n, uv) in corners() {
        let numbers = p.into_iter().chain(n).chain(uv);
        if is_text {
            let line = numbers.map(|x| format!("{x:.6}")).collect::<Vec<_>>().join(" ");
            bytes.extend_from_slice(line.as_bytes());
            bytes.push(b'\n');
        } else {
            numbers.for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
        }
    }
    for [a, b, c] in triangles() {
        if is_text {
            bytes.extend_from_slice(format!("3 {a} {b} {c}\n").as_bytes());
        } else {
            bytes.push(3);
            [a, b, c].iter().for_each(|i| bytes.extend_from_slice(&i.to_le_bytes()));
        }
    }
    bytes
}
