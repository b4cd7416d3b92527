use burnish_core::document::Document;
use eframe::egui::{self, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::window::stage::Stage;
use crate::window::user_presets::UserPresets;
use crate::window::{Options, Workbench};

fn window(folder: &str) -> Harness<'static, Workbench> {
    let folder = std::env::temp_dir().join(format!("burnish-browser-{folder}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    let scene = Some("gallery:workbench".into());
    let options = Options { scene, data_folder: Some(folder), ..Options::default() };
    let workbench = Workbench::new(&egui::Context::default(), options, Stage::Flat);
    let show = |ui: &mut egui::Ui, workbench: &mut Workbench| workbench.ui(ui);
    let mut harness = Harness::builder().with_size(vec2(1280.0, 800.0)).build_ui_state(show, workbench);
    harness.run_steps(3);
    harness
}

/// Goes on until something is shown; the folder is read by another thread.
fn wait_for(window: &mut Harness<Workbench>, label: &str) -> bool {
    for _ in 0..500 {
        window.run_steps(1);
        if window.query_by_label(label).is_some() {
            return true;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    false
}

/// Leaves what is found: more metals come with the program than the panel shows at once.
fn search(window: &mut Harness<Workbench>, text: &str) {
    window.get_by_label("Search presets").set_text_value_accesskit(text);
    window.run_steps(3);
}

fn metal(window: &Harness<Workbench>) -> Option<String> {
    window.state().session().material()?.preset.as_ref().map(|used| used.id.clone())
}

#[test]
fn a_click_on_a_ball_puts_the_metal_on_the_material_and_undo_takes_it_off() {
    let mut window = window("click");
    search(&mut window, "silver");
    window.get_by_role_and_label(Role::Button, "Silver").click();
    window.run_steps(3);
    assert_eq!(metal(&window).as_deref(), Some("Ag"));
    window.get_by_label("Remove metal").click();
    window.run_steps(3);
    assert_eq!(metal(&window), None);
    let session = window.state_mut().session_mut();
    assert_eq!((session.undo().as_deref(), session.undo().as_deref()), (Some("Remove metal"), Some("Assign Silver")));
}

#[test]
fn the_search_leaves_what_it_finds() {
    let mut window = window("search");
    search(&mut window, "gold");
    window.get_by_role_and_label(Role::Button, "Gold");
    assert!(window.query_by_role_and_label(Role::Button, "Silver").is_none());
}

#[test]
fn a_tag_leaves_those_that_have_it() {
    let mut window = window("tag");
    window.get_by_role_and_label(Role::ComboBox, "Show presets").click();
    window.run_steps(3);
    window.get_by_label("element").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Gold");
    assert!(window.query_by_role_and_label(Role::Button, "Red brass 85Cu-15Zn").is_none());
}

#[test]
fn balls_are_asked_for_where_they_are_seen_only() {
    let items = super::list(&UserPresets::default(), &Document::default());
    let asked = std::cell::RefCell::new(std::collections::BTreeSet::new());
    let count = items.len();
    let mut grid = Harness::builder().with_size(vec2(250.0, 260.0)).build_ui(|ui| {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for item in &items {
                    let look = super::tile::Look { in_use: false, selected: false, favourite: false };
                    let ball = || {
                        asked.borrow_mut().insert(item.key.clone());
                        None
                    };
                    super::tile::tile_ui(ui, item, ball, look);
                }
            });
        });
    });
    grid.run();
    let seen = asked.borrow().len();
    assert!((6..=12).contains(&seen) && seen < count, "{seen} of {count}");
}

#[test]
fn a_material_is_saved_as_preset_and_put_on_another() {
    let mut window = window("save");
    search(&mut window, "gold");
    window.get_by_role_and_label(Role::Button, "Gold").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Slider, "Roughness").set_value_accesskit(0.45);
    window.run_steps(3);
    window.get_by_label("Save as preset...").click();
    window.run_steps(3);
    window.get_by_label("Name of the preset").set_text_value_accesskit("Dull gold");
    window.run_steps(3);
    window.get_by_label("Save preset").click();
    assert!(wait_for(&mut window, "Dull gold"), "the preset is listed");
    window.state_mut().session_mut().selection.material = 1;
    search(&mut window, "dull");
    window.get_by_role_and_label(Role::Button, "Dull gold").click();
    window.run_steps(3);
    assert_eq!(metal(&window).as_deref(), Some("Au"));
    let session = window.state().session();
    let roughness = session.scene().materials.get(1).map(|material| material.roughness);
    assert_eq!(roughness, Some(0.45));
}
