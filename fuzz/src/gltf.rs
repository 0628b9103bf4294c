//! glTF files: as they are, or made of a genuine one by edits of its values, which random bytes cannot make without breaking the
//! text around them.
//!
//! After a first byte of 1 the rest is edits: the number of a genuine file, then for each four bytes: which value of its description, and
//! what becomes of it; after four bytes of 255 those of its buffer that change. After any other byte the rest is the file itself.

use std::fmt::Write;

use foton_format::{Opened, Options, open};
use foton_scene::Scene;
use serde_json::{Value, json};

/// Genuine files, which `tests/scenes/gltf/make.py` makes.
const GENUINE: [&[u8]; 9] = [
    include_bytes!("../../tests/scenes/gltf/alpha.glb"),
    include_bytes!("../../tests/scenes/gltf/cameras.gltf"),
    include_bytes!("../../tests/scenes/gltf/colours.glb"),
    include_bytes!("../../tests/scenes/gltf/emissive.glb"),
    include_bytes!("../../tests/scenes/gltf/instances.glb"),
    include_bytes!("../../tests/scenes/gltf/normal-map.glb"),
    include_bytes!("../../tests/scenes/gltf/packed.glb"),
    include_bytes!("../../tests/scenes/gltf/pose.glb"),
    include_bytes!("../../tests/scenes/gltf/textures.gltf"),
];

/// The memory that reading may take. Building what was read takes more, within the bound that all inputs have.
const MEMORY: u64 = 8 << 20;

/// A description of more values is not edited further: edits may double it, and what that takes is not the reader's.
const MAX_VALUES: usize = 2000;

/// Edits after which the rest of the input is left alone.
const MAX_EDITS: usize = 64;

/// The inputs that mutation begins with: each genuine file, and each with an edit that changes nothing.
pub(crate) fn seeds() -> Vec<Vec<u8>> {
    let whole = GENUINE.iter().map(|file| [&[0], *file].concat());
    let edited = (0..GENUINE.len() as u8).flat_map(|i| {
        let edits = (0..16_u8).map(move |edit| vec![1, i, 16 * i + edit, 7 * edit, edit, i]);
        edits.chain([vec![1, i]])
    });
    whole.chain(edited).collect()
}

/// Reads a glTF file, and builds the scene if it is one.
pub(crate) fn read(data: &[u8]) -> String {
    let Some((first, rest)) = data.split_first() else { return "empty".into() };
    let file = if *first == 1 { edited(rest) } else { rest.to_vec() };
    let path = crate::scratch(if file.starts_with(b"glTF") { "glb" } else { "gltf" });
    if std::fs::write(&path, file).is_err() {
        return "no place to write".into();
    }
    let options = Options { memory: Some(MEMORY), allow_missing: first % 2 == 1, ..Options::default() };
    let mut said = String::new();
    match open(&path, &options) {
        Ok(Opened { description, warnings, .. }) => {
            let built = Scene::build(&description).map(|s| format!("{:?}", s.census()));
            let warnings: Vec<String> = warnings.into_iter().map(|warning| warning.message).collect();
            let _ = write!(said, "{built:?} {}", warnings.join(" "));
        }
        Err(error) => {
            let faults: Vec<&str> = error.diagnostics().iter().map(|fault| fault.message.as_str()).collect();
            said.push_str(&faults.join(" "));
        }
    }
    said.chars().filter(|c| !c.is_ascii_digit()).take(400).collect()
}

/// A genuine file with edits.
fn edited(data: &[u8]) -> Vec<u8> {
    let Some((number, mut rest)) = data.split_first() else { return Vec::new() };
    let (mut description, mut binary) = parts(GENUINE[usize::from(*number) % GENUINE.len()]);
    for _ in 0..MAX_EDITS {
        let Some((&[low, high, what, with], behind)) = rest.split_first_chunk() else { break };
        rest = behind;
        if [low, high, what, with] == [255; 4] {
            break;
        }
        let count = count(&description);
        if count > MAX_VALUES {
            break;
        }
        let mut at = usize::from(u16::from_le_bytes([low, high])) % count;
        edit(&mut description, &mut at, what, with);
    }
    while let Some((&[low, high, value], behind)) = rest.split_first_chunk() {
        rest = behind;
        let at = usize::from(u16::from_le_bytes([low, high])) % binary.len().max(1);
        binary.get_mut(at).into_iter().for_each(|byte| *byte = value);
    }
    let text = description.to_string();
    if binary.is_empty() { text.into_bytes() } else { joined(text.as_bytes(), &binary) }
}

/// The description of a genuine file, and the bytes behind it.
fn parts(file: &[u8]) -> (Value, Vec<u8>) {
    if !file.starts_with(b"glTF") {
        return (serde_json::from_slice(file).expect("a genuine file"), Vec::new());
    }
    let length = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize;
    let end = 20 + length(12);
    let description = serde_json::from_slice(&file[20..end]).expect("a genuine file");
    (description, file[end + 8..].to_vec())
}

fn joined(text: &[u8], binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (text, binary) = (padded(text, b' '), padded(binary, 0));
    let word = |n: usize| (n as u32).to_le_bytes();
    let total = word(28 + text.len() + binary.len());
    let parts: [&[u8]; 9] = [
        b"glTF",
        &word(2),
        &total,
        &word(text.len()),
        b"JSON",
        &text,
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ];
    parts.concat()
}

/// How many values there are, inner ones and this one.
fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(items) => items.values().map(count).sum(),
        _ => 0,
    }
}

/// Changes the value of that number, counting down; whether it was there.
fn edit(value: &mut Value, at: &mut usize, what: u8, with: u8) -> bool {
    if *at == 0 {
        change(value, what, with);
        return true;
    }
    *at -= 1;
    match value {
        Value::Array(items) => items.iter_mut().any(|item| edit(item, at, what, with)),
        Value::Object(items) => items.values_mut().any(|item| edit(item, at, what, with)),
        _ => false,
    }
}

fn change(value: &mut Value, what: u8, with: u8) {
    let small = i64::from(with);
    match (what % 12, &mut *value) {
        (0, _) => *value = json!(small),
        (1, _) => {
            *value = [json!(-1), json!(1_u64 << 31), json!(u64::MAX), json!(0)][usize::from(with) % 4].clone()
        }
        (2, _) => {
            *value = json!([1e300, -1e300, 1e38, 1e-300, 0.5, -0.5, 1e10, 1e-10][usize::from(with) % 8])
        }
        (3, _) => {
            *value =
                [json!(null), json!(""), json!([]), json!({}), json!(true)][usize::from(with) % 5].clone()
        }
        (4, Value::Array(items)) => items.truncate(usize::from(with) % (items.len() + 1)),
        (5, Value::Array(items)) if !items.is_empty() => {
            let again = items[usize::from(with) % items.len()].clone();
            items.push(again);
        }
        (6, Value::Array(items)) if !items.is_empty() => {
            let length = items.len();
            items.swap(0, usize::from(with) % length);
        }
        (4 | 5, Value::Object(items)) if !items.is_empty() => {
            let name = items.keys().nth(usize::from(with) % items.len()).cloned();
            name.and_then(|name| items.remove(&name));
        }
        (6, Value::Object(items)) if !items.is_empty() => {
            let values: Vec<Value> = items.values().cloned().collect();
            let other = values[usize::from(with) % values.len()].clone();
            items.values_mut().next().into_iter().for_each(|first| *first = other.clone());
        }
        (7, Value::Number(n)) => *value = json!(n.as_f64().unwrap_or(0.0) + small as f64 - 128.0),
        (8, Value::Number(n)) => *value = json!(n.as_i64().unwrap_or(0) + small),
        (9, _) => {
            *value = json!(
                [0, 1, 2, 3, 4, 5, 6, 5120, 5121, 5122, 5123, 5125, 5126, 9728, 33071, 33648]
                    [usize::from(with) % 16]
            )
        }
        (10, _) => {
            let words = [
                "SCALAR",
                "VEC2",
                "VEC4",
                "MAT4",
                "MASK",
                "BLEND",
                "orthographic",
                "spot",
                "data:,%00",
                "a.png",
            ];
            *value = json!(words[usize::from(with) % words.len()]);
        }
        _ => *value = json!([value.clone(), value.clone()]),
    }
}
