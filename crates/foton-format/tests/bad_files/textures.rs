//! Textures and spectra.

use super::*;

#[test]
fn textures_that_cannot_be_are_errors() {
    let bitmap = |inside: &str| format!("<texture type='bitmap'>{inside}</texture>");
    let file = |name: &str| bitmap(&format!("<string name='filename' value='{name}'/>"));
    assert_all(&[
        ("<texture type='bitmop'/>", &["s.xml:2:16: unknown texture \"bitmop\", did you mean \"bitmap\"?"]),
        ("<texture type='volume'/>", &["s.xml:2:16: texture \"volume\" is not supported yet"]),
        (&bitmap(""), &["s.xml:2:1: a bitmap texture needs a \"filename\""]),
        (&file("gone.png"), &["s.xml:2:55: cannot read gone.png: no such file"]),
        (
            &file("good.obj"),
            &[
                "s.xml:2:55: cannot read good.obj: it is no PNG, JPEG, WebP, BMP, TGA, PNM, PFM, Radiance HDR or EXR image",
            ],
        ),
        (&file("empty.exr"), &["s.xml:2:55: cannot read empty.exr: invalid: reference to missing bytes"]),
        (&file("wide.png"), &["s.xml:2:55: cannot read wide.png: 65536 × 65536 pixels are none or too many"]),
        (
            &file("lying.png"),
            &["s.xml:2:55: cannot read lying.png: 16384 × 16384 pixels cannot be in 72 bytes"],
        ),
        ("<include filename='latin.xml'/>", &["s.xml:2:20: cannot read latin.xml: the text is not UTF-8"]),
        (
            &file("nan.hdr"),
            &[
                "s.xml:2:55: cannot read nan.hdr: Format error decoding Hdr: Dimensions line too short: have 2 elements, expected 4",
            ],
        ),
        (
            &bitmap("<string name='filter_type' value='cubic'/><string name='filename' value='red.png'/>"),
            &["s.xml:2:58: \"filter_type\" must be bilinear or nearest"],
        ),
        (&bitmap("<string name='filter_type' value='ewa'/><string name='filename' value='red.png'/>"), &[]),
        (
            &bitmap("<string name='wrap_mode' value='zero'/><string name='filename' value='red.png'/>"),
            &["warning: s.xml:2:56: wrap mode \"zero\" is not supported, clamp is taken"],
        ),
        (
            "<texture type='checkerboard'><rgb name='color0' value='2'/></texture>",
            &["s.xml:2:56: \"color0\" of \"checkerboard\" must lie between 0 and 1"],
        ),
        (
            "<shape type='cube'><emitter type='area'><texture name='radiance' type='checkerboard'/></emitter></shape>",
            &[],
        ),
    ]);
}

#[test]
fn spectra_that_cannot_be_are_errors() {
    let spectrum =
        |value: &str| format!("<bsdf type='diffuse'><spectrum name='reflectance' value='{value}'/></bsdf>");
    assert_all(&[
        (&spectrum("400:0.1, x:0.2"), &["s.xml:2:58: \"x\" is not a number"]),
        (
            &spectrum("400:0.1, 0.2"),
            &["s.xml:2:58: \"0.2\" is not a wavelength with its value, such as 550:0.5"],
        ),
        (&spectrum("400:0.1"), &["s.xml:2:58: a spectrum needs two wavelengths or more, not 1"]),
        (&spectrum("500:0.1 400:0.2"), &["s.xml:2:58: wavelengths must grow: 400 comes after 500"]),
        (&spectrum("400:0.1 500:-0.2"), &["s.xml:2:58: a spectrum must not be negative"]),
        (&spectrum("400:9 700:9"), &["s.xml:2:58: \"reflectance\" of \"diffuse\" must lie between 0 and 1"]),
        (
            "<bsdf type='diffuse'><spectrum name='reflectance'/></bsdf>",
            &["s.xml:2:22: a <spectrum> has a \"value\" or a \"filename\""],
        ),
        (
            "<bsdf type='diffuse'><spectrum name='reflectance' filename='good.obj'/></bsdf>",
            &["s.xml:2:61: cannot read good.obj: it is no spectrum: line 1 is not a wavelength and a value"],
        ),
    ]);
}
