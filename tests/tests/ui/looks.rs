//! How every panel, page and menu looks, to the pixel, with the viewport painted flat.

use burnish::window::{Command, CompareView, Legend, Menu, Pane, Request, TABLE};
use burnish_core::document::Side;
use burnish_core::measure::error_map::{ErrorMap, Metric};
use burnish_core::param::ParamValue;
use burnish_core::picture::Picture;
use burnish_tests::{Need, repository, trial};
use eframe::egui::{Color32, ColorImage, Id, Rect, TextureOptions, pos2, vec2};
use egui_kittest::SnapshotOptions;
use glam::{Vec3, Vec4};
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

const SCENE: &str = "gallery:workbench";

pub fn trials() -> Vec<Trial> {
    let gpu: &[Need] = &[Need::Gpu];
    vec![
        trial("every_panel_looks_as_accepted", gpu, every_panel),
        trial("the_method_panel_looks_as_accepted", gpu, method_panel),
        trial("the_window_looks_as_accepted_in_both_themes", gpu, whole_window),
        trial("start_page_palette_and_shortcut_page_look_as_accepted", gpu, pages),
        trial("the_import_preview_looks_as_accepted_in_both_themes", gpu, import_preview),
        trial("a_wipe_with_its_list_looks_as_accepted_in_both_themes", gpu, wipe_with_list),
        trial("a_chart_looks_as_accepted_in_both_themes", gpu, chart),
        trial("legends_of_error_maps_look_as_accepted", gpu, legends),
        trial("error_maps_under_their_legends_look_as_accepted", gpu, error_maps),
        trial("every_menu_shows_its_commands", &[], menus),
    ]
}

/// Fails where something looked otherwise.
fn judge(bench: &mut Bench) {
    let faults: Vec<String> =
        bench.window.take_snapshot_results().into_inner().iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}\nlook at the .diff.png files; UPDATE_SNAPSHOTS=1 accepts", faults.join("\n"));
}

fn look(bench: &mut Bench, name: &str) {
    bench.window.run_ok();
    let folder = repository().join("tests/tests/ui/snapshots");
    let options = SnapshotOptions::new().max_failed_pixels(0).output_path(folder);
    bench.window.snapshot_options(name, &options);
}

fn every_panel() {
    let setup = Setup { name: "panels", scene: Some(SCENE), size: [380.0, 620.0], drawn: true };
    let mut bench = Bench::new(setup);
    assert!(!Pane::ALL.is_empty());
    for shown in Pane::ALL {
        for pane in Pane::ALL {
            bench.workbench().show_panel(pane);
        }
        for pane in Pane::ALL.into_iter().filter(|pane| *pane != shown) {
            // One may have come to the front where another was put away.
            bench.workbench().show_panel(pane);
            bench.workbench().hide_panel(pane);
        }
        bench.workbench().show_panel(shown);
        // Levels are counted by another thread.
        bench.until("it rests", |workbench| !workbench.is_busy());
        look(&mut bench, &format!("panel_{}", shown.title().to_lowercase()));
    }
    judge(&mut bench);
}

fn method_panel() {
    let setup = Setup { name: "method", scene: Some(SCENE), size: [380.0, 1560.0], drawn: true };
    let mut bench = Bench::new(setup);
    for pane in Pane::ALL.into_iter().filter(|pane| *pane != Pane::Environment) {
        bench.workbench().show_panel(pane);
        bench.workbench().hide_panel(pane);
    }
    bench.workbench().show_panel(Pane::Environment);
    bench.until_shown("Coverage");
    bench.click("Coverage");
    bench.window.run_steps(20);
    look(&mut bench, "method");
    judge(&mut bench);
}

fn whole_window() {
    let setup = Setup { name: "window", scene: Some(SCENE), size: [1280.0, 800.0], drawn: true };
    let mut bench = Bench::new(setup);
    for (dark, name) in [(true, "window_dark"), (false, "window_light")] {
        bench.workbench().preferences_mut().dark = Some(dark);
        look(&mut bench, name);
    }
    judge(&mut bench);
}

fn pages() {
    let setup = Setup { name: "pages", scene: None, size: [1000.0, 700.0], drawn: true };
    let mut bench = Bench::new(setup);
    look(&mut bench, "start_page");
    bench.workbench().preferences_mut().dark = Some(false);
    look(&mut bench, "start_page_light");
    bench.workbench().preferences_mut().dark = None;
    bench.workbench().ask(Request::Command(Command::Palette));
    look(&mut bench, "palette");
    bench.workbench().ask(Request::Command(Command::Palette));
    bench.window.run_steps(3);
    bench.workbench().ask(Request::Command(Command::Shortcuts));
    look(&mut bench, "shortcuts");
    judge(&mut bench);
}

fn import_preview() {
    let setup = Setup { name: "preview", scene: Some(SCENE), size: [900.0, 760.0], drawn: true };
    let mut bench = Bench::new(setup);
    let gold = burnish_core::material::preset::find("Au").expect("it is there");
    let rows = gold.wavelength_nm.iter().zip(gold.n.iter().zip(&gold.k));
    let rows: Vec<String> = rows.map(|(nm, (n, k))| format!("{},{n},{k}", nm / 1000.0)).collect();
    let good = format!("wl,n,k\n{}", rows.join("\n"));
    for (name, text, sign) in [
        ("import_preview", &good, "Plot of n and k over wavelength"),
        ("import_fault", &good.replace("0.5,0.97112", "0.5,-0.97112"), "Nothing can be imported:"),
    ] {
        bench.workbench().ask(Request::ImportText(text.clone()));
        bench.until_shown(sign);
        for (dark, theme) in [(true, "dark"), (false, "light")] {
            bench.workbench().preferences_mut().dark = Some(dark);
            look(&mut bench, &format!("{name}_{theme}"));
        }
        bench.click("Cancel");
    }
    judge(&mut bench);
}

/// A differs from B in lines of many kinds.
fn wipe_with_list() {
    let setup = Setup { name: "wipe", scene: Some(SCENE), size: [1280.0, 800.0], drawn: true };
    let mut bench = Bench::new(setup);
    let session = bench.workbench().session_mut();
    session.edit("Store as A", "", |document| document.store_side(Side::A));
    session.edit("Edits", "", |document| {
        let metal = burnish_core::material::preset::find("Au").expect("it is there");
        document.assign_preset(0, &metal, Default::default());
        document.set_value(0, "roughness", ParamValue::Number(0.8)).expect("it is a factor");
        document.set_value(1, "base-color", ParamValue::Color([0.5, 0.25, 0.125])).expect("it is a factor");
        document.set_lighting("samples", ParamValue::Integer(64)).expect("it is a setting");
        document.environment.rotation_deg = 30.0;
        document.view.exposure_ev = 0.5;
    });
    bench.workbench().ask(Request::Command(Command::Compare(CompareView::Wipe)));
    bench.workbench().show_panel(Pane::Compare);
    for (dark, name) in [(true, "wipe_dark"), (false, "wipe_light")] {
        bench.workbench().preferences_mut().dark = Some(dark);
        look(&mut bench, name);
    }
    bench.workbench().ask(Request::Command(Command::Compare(CompareView::SideBySide)));
    look(&mut bench, "side_by_side");
    judge(&mut bench);
}

/// With sides, a picked mark and marks within the noise.
fn chart() {
    let setup = Setup { name: "chart", scene: Some(SCENE), size: [1280.0, 800.0], drawn: true };
    let mut bench = Bench::new(setup);
    bench.workbench().chart_mut().set_records(super::chart::records());
    bench.workbench().show_panel(Pane::Chart);
    bench.window.run_steps(3);
    bench.click("classical samples=0: 3.1 ms, relMSE 0.0121");
    bench.click("As A");
    bench.click("classical samples=16: 30.5 ms, relMSE 0.0021");
    bench.click("As B");
    // The message leaves.
    bench.window.run_steps(700);
    for (dark, name) in [(true, "chart_dark"), (false, "chart_light")] {
        bench.workbench().preferences_mut().dark = Some(dark);
        look(&mut bench, name);
    }
    judge(&mut bench);
}

fn legends() {
    let show = |ui: &mut eframe::egui::Ui| {
        let legends = Metric::ALL.map(|metric| {
            let span = if metric == Metric::Flip { 1.0 } else { 0.02 };
            Legend { metric, span: Some(span), text: "mean 0.0123, against 512 samples".into() }
        });
        let waiting = Legend { metric: Metric::Flip, span: None, text: "measuring".into() };
        for (row, legend) in legends.into_iter().chain([waiting]).enumerate() {
            let corner = pos2(16.0, 14.0 + 66.0 * row as f32);
            legend.ui(ui, Rect::from_min_size(corner, Legend::SIZE));
        }
    };
    let mut harness = egui_kittest::Harness::builder().with_size([316.0, 360.0]).wgpu().build_ui(show);
    harness.run_steps(3);
    let folder = repository().join("tests/tests/ui/snapshots");
    let options = SnapshotOptions::new().max_failed_pixels(0).output_path(folder);
    harness.snapshot_options("error_map_legends", &options);
    let faults: Vec<String> = harness.take_snapshot_results().into_inner().iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A ball with a highlight of radiance `peak` that lies `shift` pixels further to the right.
fn ball(peak: f32, shift: f32) -> Picture {
    const SIZE: (u32, u32) = (280, 150);
    let mut picture = Picture::filled(SIZE.0, SIZE.1, Vec4::new(0.02, 0.03, 0.05, 1.0));
    for (i, texel) in picture.texels.iter_mut().enumerate() {
        let (x, y) = ((i as u32 % SIZE.0) as f32 - 140.0, (i as u32 / SIZE.0) as f32 - 75.0);
        let distance2 = (x * x + y * y) / (64.0 * 64.0);
        if distance2 < 1.0 {
            let height = (1.0 - distance2).sqrt();
            let (u, v) = ((x + 24.0 - shift) / 20.0, (y + 22.0) / 20.0);
            let gloss = peak / (1.0 + u * u + v * v);
            *texel = (Vec3::new(0.5, 0.33, 0.12) * height + Vec3::new(1.0, 0.8, 0.45) * gloss).extend(1.0);
        }
    }
    picture
}

fn error_maps() {
    let (reference, picture) = (ball(0.6, 0.0), ball(0.5, 4.0));
    let show = move |ui: &mut eframe::egui::Ui| {
        for (row, metric) in Metric::ALL.into_iter().enumerate() {
            let map = ErrorMap::new(metric, &reference, &picture, 0.0).expect("of one size");
            let size = [map.width as usize, map.height as usize];
            let image = ColorImage::from_rgb(size, map.colors().as_flattened());
            let texture = ui.ctx().load_texture(metric.title(), image, TextureOptions::NEAREST);
            let place = Rect::from_min_size(pos2(8.0, 8.0 + 226.0 * row as f32), vec2(size[0] as f32, size[1] as f32));
            ui.painter().image(texture.id(), place, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
            // A texture lives as long as its handle.
            ui.data_mut(|data| data.insert_temp(Id::unique(metric.title()), texture));
            let text = format!("mean {:.4}", map.mean);
            let legend = Legend { metric, span: Some(map.span), text };
            legend.ui(ui, Rect::from_min_size(place.left_bottom() + vec2(0.0, 6.0), Legend::SIZE));
        }
    };
    let height = 226.0 * Metric::ALL.len() as f32 + 8.0;
    let mut harness = egui_kittest::Harness::builder().with_size([300.0, height]).wgpu().build_ui(show);
    harness.run_steps(3);
    let folder = repository().join("tests/tests/ui/snapshots");
    let options = SnapshotOptions::new().max_failed_pixels(0).output_path(folder);
    harness.snapshot_options("error_maps", &options);
    let faults: Vec<String> = harness.take_snapshot_results().into_inner().iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Also that every entry has a menu: what is in no menu is found by nobody.
fn menus() {
    use egui_kittest::kittest::Queryable;
    let setup = Setup { name: "menus", scene: Some(SCENE), size: [1000.0, 800.0], drawn: false };
    let mut bench = Bench::new(setup);
    for menu in Menu::ALL {
        bench.open_menu(menu.title());
        for entry in TABLE.iter().filter(|entry| entry.menu == menu) {
            let named = |label: &str| label == entry.title || label.starts_with(&format!("{} ", entry.title));
            let found = bench.window.get_all_by_role(eframe::egui::Role::Button);
            let found = found.into_iter().any(|node| {
                egui_kittest::kittest::NodeT::accesskit_node(&node).label().is_some_and(|label| named(&label))
            });
            assert!(found, "{}", entry.title);
        }
        bench.keys(eframe::egui::Modifiers::NONE, eframe::egui::Key::Escape);
    }
}
