//! libFuzzer's way into [`foton_fuzz::TARGETS`]: "gltf".
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    foton_fuzz::check_with_time("gltf", data);
});
