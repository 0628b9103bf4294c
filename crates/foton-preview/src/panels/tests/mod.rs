//! The panels driven as a person drives them, by accessible labels, pointer and keys; what they ask for is in the outbox.

mod bar;
mod contrast;
mod controls;
mod history;
mod inspector;
mod keys;
mod layout;
mod looking;
mod numbers;
mod outliner;
mod picture;
mod pointer;
mod stats;
mod unsaved;

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

use egui::accesskit::{Action, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, Node};
use foton_edit::{
    Control, Field, FieldId, Gizmo, Inspection, Item, MaterialUse, Property, Side, Target, Value,
};
use foton_film::{Image, ToneMap};
use foton_math::Rgb;
use foton_session::engine::{
    Activity, BuildProgress, BuildStep, Command, Configuration, Event, Frame, Picture, Region, RenderStats,
    SceneFacts, Selection, SensorFacts, Source, ViewMode,
};
use foton_session::{
    Alpha, DirectLight, Ledger, Method, Radii, RadiusFloor, RadiusRule, RenderSettings, SettingChange,
    StopRule,
};

use foton_session::snapshot::Look;

use crate::looking::BuiltIn;
use crate::preferences::Preferences;
use crate::state::State;

/// Width and height of the image in pixels.
const SIZE: [u32; 2] = [60, 40];

/// A frame of a render that has some passes.
fn frame() -> Frame {
    let sensor = |name: &str| SensorFacts {
        name: name.into(),
        fov_degrees: 40.0,
        width: None,
        lens: None,
        size: SIZE,
        xml: "<sensor type=\"perspective\"/>".into(),
    };
    let mut image = Image::black(SIZE[0], SIZE[1]);
    image.pixels.fill(Rgb::new(0.5, 0.25, 0.125));
    Frame {
        number: 7,
        render: 1,
        pictured: 1,
        activity: Activity::Rendering,
        opening: None,
        building: None,
        size: SIZE,
        window: Region { x: 0, y: 0, width: SIZE[0], height: SIZE[1] },
        region: None,
        picture: Some(Picture::Colour(Arc::new(image))),
        view: ViewMode::Radiance,
        stats: RenderStats {
            passes: 12,
            photons: 3_000_000,
            photons_in_pass: 262_144,
            elapsed: Duration::from_secs(9),
            photons_per_s: 1.5e6,
            hit_points: 2400,
            radii: Radii { smallest: 0.01, median: 0.02, largest: 0.1 },
            ledger: Ledger { emitted: 8.0, absorbed: 6.0, escaped: 1.9, truncated: 0.1, ..Ledger::default() },
            ..RenderStats::default()
        },
        kept_bytes: 0.0,
        pass_share: 0.4,
        collecting: None,
        settings: RenderSettings::default(),
        threads: None,
        stop: StopRule::default(),
        history: Arc::default(),
        turntable: None,
        checkpoint_age: None,
        scene: Arc::new(SceneFacts {
            name: "room.xml".into(),
            file: Some("/scenes/room.xml".into()),
            sensors: vec![sensor("front"), sensor("top")],
            title: "room.xml".into(),
            contents: Arc::new(contents()),
            shapes: 3,
            undo: Some("move ball".into()),
            ..SceneFacts::default()
        }),
        dots: Arc::default(),
        probe: None,
        selection: None,
        lights: Vec::new(),
    }
}

/// A floor, a hidden table, a ball that is glass, a lamp and two cameras.
fn contents() -> Vec<Item> {
    let item = |target, name: &str, kind: &str, is_light, is_hidden| Item {
        target,
        name: name.into(),
        kind: kind.into(),
        is_light,
        is_hidden,
    };
    vec![
        item(Target::Shape(0), "floor", "diffuse mesh", false, false),
        item(Target::Shape(1), "table", "plastic mesh", false, true),
        item(Target::Shape(2), "ball", "glass sphere", false, false),
        item(Target::Emitter(0), "lamp", "point light", true, false),
        item(Target::Sensor(0), "front", "camera, 60 × 40", false, false),
        item(Target::Sensor(1), "top", "camera, 60 × 40", false, false),
    ]
}

fn field(id: FieldId, label: &'static str, value: Value, control: Control) -> Field {
    Field { id, label, unit: "", help: "What it does.", value, control, is_advanced: false }
}

/// A glass ball that shares its material, in a square of 20 to 40 by 10 to 30 pixels.
fn selection() -> Selection {
    let material = |p| FieldId::Material(Side::Front, p);
    let number = |min, max, logarithmic| Control::Number { min, max, logarithmic };
    let kinds = ["diffuse", "glass"].map(str::to_owned).to_vec();
    let corners = [[20.0, 10.0], [40.0, 10.0], [40.0, 30.0], [20.0, 30.0]];
    Selection {
        target: Target::Shape(2),
        inspection: Inspection {
            title: "ball".into(),
            kind: "glass sphere".into(),
            material: Some(MaterialUse { name: "glass".into(), shapes: 2 }),
            notes: vec!["The material \"glass\" is shared by 2 shapes.".into()],
            fields: vec![
                field(FieldId::Position(0), "X", Value::Number(0.5), number(-1e6, 1e6, false)),
                field(FieldId::Radius, "Radius", Value::Number(1.0), number(0.01, 100.0, true)),
                field(
                    material(Property::Parameter("int_ior")),
                    "IOR inside",
                    Value::Number(1.5),
                    number(1.0, 3.0, false),
                ),
                field(
                    material(Property::Parameter("specular_transmittance")),
                    "Transmission",
                    Value::Colour([1.0; 3]),
                    Control::Colour,
                ),
                field(material(Property::Kind), "Kind", Value::Choice(1), Control::Choice(kinds)),
                field(material(Property::Rough), "Rough", Value::Toggle(false), Control::Toggle),
            ],
            can_aim: false,
            is_light: false,
        },
        outline: (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect(),
        gizmo: Some(Gizmo::sample(SIZE[0], SIZE[1])),
        drag: None,
    }
}

/// Two scenes, of which one has a picture.
fn built_in() -> Vec<BuiltIn> {
    let scene = |name: &str, thumbnail| BuiltIn { name: name.into(), thumbnail };
    let picture = include_bytes!("../../../../../assets/ring/thumbnail.png");
    vec![scene("pool", &[]), scene("ring", picture)]
}

/// A window of 1280 × 800 points.
fn window(change: impl FnOnce(&mut State)) -> Harness<'static, State> {
    // The picker of colours has a sign that no font here knows.
    let mut state = State::new(Preferences::default(), built_in());
    state.frame = Some(frame());
    change(&mut state);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1280.0, 800.0))
        .allow_missing_glyphs()
        .build_ui_state(super::show, state);
    crate::themes::dress(&harness.ctx);
    settle(&mut harness);
    harness
}

/// A few frames: a live view never asks for none.
fn settle(harness: &mut Harness<'_, State>) {
    harness.run_steps(4);
}

/// What was asked for since the last time, in words, which are easier to compare than commands.
fn asked(harness: &mut Harness<'_, State>) -> Vec<String> {
    settle(harness);
    harness.state_mut().outbox.drain(..).map(|command| format!("{command:?}")).collect()
}

/// Fails unless exactly this was asked for, once or while frames did not answer several times.
#[track_caller]
fn assert_asked(harness: &mut Harness<'_, State>, expected: &Command) {
    let (asked, expected) = (asked(harness), format!("{expected:?}"));
    assert!(!asked.is_empty() && asked.iter().all(|a| *a == expected), "{asked:?} is not {expected}");
}

fn find<'a>(harness: &'a Harness<'_, State>, role: Role, label: &'a str) -> Node<'a> {
    harness.get_by_role_and_label(role, label)
}

fn click(harness: &mut Harness<'_, State>, role: Role, label: &str) {
    find(harness, role, label).click_accesskit();
    settle(harness);
}

/// Types a number into the box beside a slider, or one alone.
fn type_number(harness: &mut Harness<'_, State>, label: &str, text: &str) {
    type_into(harness, label, text);
    harness.key_press(egui::Key::Enter);
    settle(harness);
}

/// The same without the end of it.
fn type_into(harness: &mut Harness<'_, State>, label: &str, text: &str) {
    find(harness, Role::SpinButton, label).focus();
    settle(harness);
    harness.event(egui::Event::Text(text.into()));
    settle(harness);
}

/// Chooses from a list.
fn choose(harness: &mut Harness<'_, State>, list: &str, option: &str) {
    click(harness, Role::ComboBox, list);
    harness.get_by_role_and_label(Role::Button, option).click_accesskit();
}

fn alpha(value: f64) -> Command {
    Command::Steer(SettingChange::Alpha(Alpha::new(value).expect("an alpha")))
}

#[test]
fn every_control_has_an_accessible_name() {
    for with_everything in [false, true] {
        let harness = window(|state| {
            if with_everything {
                state.frame.as_mut().expect("there").selection = Some(selection());
                state.frame.as_mut().expect("there").opening = Some("slow.xml".into());
                state.frame.as_mut().expect("there").building =
                    Some(BuildProgress { step: Some(BuildStep::Tree), share: 0.25 });
                state.frame.as_mut().expect("there").stop = StopRule::passes(9);
                state.error("room.xml:1:1: wrong");
                state.changed_on_disk = true;
                state.show_help = true;
            }
        });
        harness.check_accessibility();
        // A unit is no name.
        assert_eq!(harness.query_all_by_label("%").count(), 0);
        for node in harness.root().children_recursive() {
            let node = node.accesskit_node();
            let is_named = node.label().is_some_and(|name| !name.is_empty());
            assert!(is_named || !node.data().supports_action(Action::Focus), "{:?}", node.data());
        }
        let count = harness.query_all_by_role(Role::Slider).count();
        assert_eq!(count, if with_everything { 9 } else { 7 });
    }
    let mut empty = window(|state| state.frame = None);
    empty.check_accessibility();
    assert_eq!(asked(&mut empty), [""; 0]);
}

#[test]
fn nothing_is_asked_for_until_someone_asks() {
    // Values that sliders would round, and some beyond their ranges.
    let mut harness = window(|state| {
        let frame = state.frame.as_mut().expect("there");
        frame.settings.ppm.photons_per_pass = NonZeroU32::new(40).expect("not zero");
        frame.settings.samples_per_pixel = NonZeroU32::new(1000).expect("not zero");
        let mut scene = SceneFacts::clone(&frame.scene);
        scene.sensors[0].fov_degrees = 37.123_456;
        frame.scene = Arc::new(scene);
        frame.stop = StopRule::time(Duration::from_millis(12_345));
        let mut selection = selection();
        selection.inspection.fields[1].value = Value::Number(1.0 / 3.0);
        frame.selection = Some(selection);
    });
    assert_eq!(asked(&mut harness), [""; 0]);
}

#[test]
fn controls_say_what_they_do_to_speed_and_accuracy() {
    let mut harness = window(|_| ());
    // So that all of them are in sight.
    harness.get_by_label("Scene").click_accesskit();
    harness.run_steps(20);
    for (role, label, help) in [
        (Role::Slider, "α", "Share of new photons"),
        (Role::Slider, "Photons/pass", "answers sooner"),
        (Role::Slider, "Samples/pixel", "Memory and gathering grow"),
        (Role::ComboBox, "Direct light", "How direct light is estimated"),
        (Role::CheckBox, "First radius", "pixel's footprint"),
        (Role::SpinButton, "Seed", "the same light"),
        (Role::Button, "Snapshot", "EXR and PNG"),
        (Role::Button, "Pin", "to compare with"),
        (Role::Slider, "Exposure", "nothing is rendered again"),
    ] {
        let at = find(&harness, role, label).rect().center();
        harness.hover_at(at);
        harness.run_steps(20);
        assert!(harness.query_by_label_contains(help).is_some(), "{label}: {help}");
        harness.hover_at(egui::pos2(1279.0, 799.0));
        harness.run_steps(20);
    }
}

#[test]
fn scripts_are_told_where_controls_are() {
    let harness = window(|_| ());
    let places = &harness.state().places;
    for name in ["canvas", "alpha", "photons per pass", "pause", "snapshot", "photons"] {
        let rect = places.iter().find(|(n, _)| *n == name).map(|(_, rect)| *rect);
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 800.0));
        assert!(rect.is_some_and(|r| window.contains_rect(r) && r.area() > 100.0), "{name}: {rect:?}");
    }
    let slider = find(&harness, Role::Slider, "α").rect();
    let place = places.iter().find(|(n, _)| *n == "alpha").expect("just seen").1;
    assert!(place.contains(slider.center()));
}
