//! What is found, and where. The command line's tests compare the texts.

use std::sync::Arc;

use foton_integrator::{Cancel, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;

use super::*;
use crate::test_scene::discs;

#[test]
fn a_scene_is_searched_for_what_its_image_does_not_tell() {
    let found = of_scene(&discs(None), 0);
    let hidden = found.iter().find(|f| f.kind == FindingKind::HiddenShape).expect("the letter");
    assert_eq!(hidden.place.as_deref(), Some("letter"));
    assert!(found.iter().any(|f| f.kind == FindingKind::NoEmitter && f.place.is_none()));
    assert!(found.iter().all(|f| !f.kind.is_note()));
}

#[test]
fn findings_name_settings_as_their_reader_knows_them() {
    let settings = RenderSettings {
        max_depth: Some(2),
        ppm: PpmSettings { radius: Some(1e6), ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let scene = Arc::new(discs(Some(Rgb::WHITE)));
    let cancel = Cancel::default();
    let mut render = Render::start(scene, settings, &mut |_| {}, &cancel).expect("not cancelled");
    render.advance(&mut |_| {}, &cancel).expect("not cancelled");
    for (names, radius) in
        [(SettingNames::OPTIONS, "--radius is"), (SettingNames::CONTROLS, "First radius is")]
    {
        let found = of_render(&render, &names);
        let text = |kind| found.iter().find(|f| f.kind == kind).map(|f| f.text.as_str());
        assert!(text(FindingKind::RadiusBeyondScene).is_some_and(|t| t.starts_with(radius)), "{found:?}");
        let cut_off = text(FindingKind::PowerCutOff);
        assert!(cut_off.is_none_or(|t| t.ends_with(&format!("{} sets it", names.max_depth))), "{found:?}");
    }
}
