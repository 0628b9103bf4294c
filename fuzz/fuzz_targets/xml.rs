//! libFuzzer's way into [`foton_fuzz::Target`] "xml".
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    foton_fuzz::check("xml", data);
});
