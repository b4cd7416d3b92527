use super::*;
use burnish_core::material::params::PARAMS;
use burnish_core::param;
use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

/// All factors of a material with their values, as an inspector shows them.
fn rows() -> Harness<'static, Vec<ParamValue>> {
    let values = PARAMS.iter().map(ParamSpec::default).collect();
    let show = |ui: &mut egui::Ui, values: &mut Vec<ParamValue>| {
        for (spec, value) in PARAMS.iter().zip(values) {
            match param_ui(ui, spec, *value, spec.default()).change {
                Some(Change::Set(new)) => *value = new,
                Some(Change::Reset) => *value = spec.default(),
                None => {}
            }
        }
    };
    Harness::builder().with_size(vec2(300.0, 800.0)).build_ui_state(show, values)
}

fn value(rows: &Harness<Vec<ParamValue>>, key: &str) -> ParamValue {
    PARAMS.iter().zip(rows.state()).find(|(spec, _)| spec.key == key).map(|(_, value)| *value).unwrap()
}

#[test]
fn a_number_is_set_by_its_name_and_reset_by_its_arrow() {
    let mut rows = rows();
    assert!(rows.query_by_label("Reset Roughness").is_none());
    rows.get_by_role_and_label(Role::Slider, "Roughness").set_value_accesskit(0.8);
    rows.run();
    assert_eq!(value(&rows, "roughness"), ParamValue::Number(0.8));
    rows.get_by_role_and_label(Role::SpinButton, "Roughness").set_value_accesskit(0.25);
    rows.run();
    assert_eq!(value(&rows, "roughness"), ParamValue::Number(0.25));
    rows.get_by_label("Reset Roughness").click();
    rows.run();
    assert_eq!(value(&rows, "roughness"), ParamValue::Number(1.0));
}

#[test]
fn colours_choices_and_toggles_are_set_by_their_names() {
    let mut rows = rows();
    rows.get_by_label("Base color hex").set_text_value_accesskit("#ff0000");
    rows.run();
    assert_eq!(value(&rows, "base-color"), ParamValue::Color([1.0, 0.0, 0.0]));
    rows.get_by_role_and_label(Role::SpinButton, "Base color green").set_value_accesskit(0.5);
    rows.run();
    assert_eq!(value(&rows, "base-color"), ParamValue::Color([1.0, 0.5, 0.0]));
    rows.get_by_role_and_label(Role::ColorWell, "Base color");
    rows.get_by_role_and_label(Role::CheckBox, "Double sided").click();
    rows.get_by_role_and_label(Role::ComboBox, "Alpha mode").click();
    rows.run();
    rows.get_by_label("blend").click();
    rows.run();
    assert_eq!(value(&rows, "double-sided"), ParamValue::Toggle(true));
    assert_eq!(value(&rows, "alpha-mode"), ParamValue::Choice(2));
}

#[test]
fn a_drag_ends_once() {
    let mut ended = 0;
    let spec = param::find(PARAMS, "roughness").unwrap();
    let mut number = ParamValue::Number(0.5);
    let mut row = Harness::builder().with_size(vec2(300.0, 40.0)).build_ui(|ui| {
        let edit = param_ui(ui, spec, number, ParamValue::Number(1.0));
        if let Some(Change::Set(new)) = edit.change {
            number = new;
        }
        ended += usize::from(edit.ended);
    });
    let middle = row.get_by_role_and_label(Role::Slider, "Roughness").rect().center();
    row.hover_at(middle);
    row.drag_at(middle);
    row.run();
    row.hover_at(middle + vec2(20.0, 0.0));
    row.run();
    row.drop_at(middle + vec2(20.0, 0.0));
    row.run();
    drop(row);
    assert_eq!(ended, 1);
    assert_ne!(number, ParamValue::Number(0.5));
}

#[test]
fn the_hover_text_tells_unit_range_and_what_a_reset_goes_back_to() {
    let spec = param::find(PARAMS, "anisotropy-rotation").unwrap();
    let text = hover_text(spec, ParamValue::Number(30.0));
    for part in [spec.help, "-180 to 180", "deg", "Unchanged: 30"] {
        assert!(text.contains(part), "{text}");
    }
}
