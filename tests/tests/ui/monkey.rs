//! A monkey at the window: whatever it does, nothing panics, the document stays loadable, and undo leads back to the start.

use std::path::{Path, PathBuf};

use burnish::window::{Command, Request, TABLE};
use burnish_core::document::Document;
use burnish_core::picture::Picture;
use burnish_tests::trial;
use eframe::egui::{self, Key, Modifiers, PointerButton, Pos2, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

const ACTIONS: u32 = 200;
const SIZE: [f32; 2] = [1100.0, 720.0];
/// Seeds in the suite; `BURNISH_SEEDS` asks for more.
const SEEDS: u64 = 3;
/// What would leave the test: other documents, files elsewhere, dialogs of the system, minutes of measuring.
const LEFT_ALONE: [&str; 18] = [
    "Default workbench",
    "Open",
    "Open...",
    "Save",
    "Save as...",
    "Save image...",
    "Save environment...",
    "Export...",
    "Browse...",
    "Quit",
    "Start page",
    "Recover",
    "Discard",
    "Reload",
    "Save preset",
    "Delete preset",
    "Measure",
    "Place automatically",
];
const COMMANDS_LEFT_ALONE: [Command; 7] = [
    Command::Start,
    Command::Open,
    Command::Save,
    Command::SaveAs,
    Command::SaveImage,
    Command::SaveEnvironment,
    Command::Quit,
];
const TEXTS: [&str; 9] =
    ["", "0.5", "gold", "-1e9", "nan", "#ff8800", "a long name with spaces", "\u{e9}\u{df}", "1e400"];

pub fn trials() -> Vec<Trial> {
    let seeds = std::env::var("BURNISH_SEEDS").ok().and_then(|seeds| seeds.parse().ok()).unwrap_or(SEEDS);
    let trial_of = |seed: u64| {
        let name: &'static str = Box::leak(format!("a_monkey_breaks_nothing_seed_{seed}").into_boxed_str());
        trial(name, &[], move || monkey(seed))
    };
    (0..seeds).map(trial_of).collect()
}

/// SplitMix64: the same actions for the same seed.
struct Dice(u64);

impl Dice {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count.max(1) as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn place(&mut self) -> Pos2 {
        pos2(SIZE[0] * self.unit() as f32, SIZE[1] * self.unit() as f32)
    }

    fn of<T: Clone>(&mut self, list: &[T]) -> Option<T> {
        list.get(self.below(list.len())).cloned()
    }

    fn modifiers(&mut self) -> Modifiers {
        let held = [Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND, Modifiers::ALT];
        self.of(&held).unwrap_or_default()
    }
}

/// Tells what was done when a test fails.
struct Log {
    seed: u64,
    actions: Vec<String>,
}

impl Drop for Log {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let last = self.actions.len().saturating_sub(12);
            eprintln!("seed {}, action {}: {:#?}", self.seed, self.actions.len(), &self.actions[last..]);
        }
    }
}

fn monkey(seed: u64) {
    let name = format!("monkey-{seed}");
    let mut bench = Bench::new(Setup { name: &name, scene: Some("gallery:workbench"), size: SIZE, drawn: false });
    let files = files(&bench.folder);
    // Should it measure all the same, it is soon done.
    let plan = &mut bench.workbench().chart_mut().plan;
    plan.size = glam::UVec2::new(16, 9);
    plan.methods.iter_mut().for_each(|chosen| chosen.on = false);
    bench.workbench().chart_mut().set_records(super::chart::records());
    let start = bench.text();
    let mut dice = Dice(seed);
    let mut log = Log { seed, actions: Vec::new() };
    for number in 0..ACTIONS {
        act(&mut bench, &mut dice, &mut log.actions, &files);
        bench.window.run_steps(2);
        if number % 20 == 19 {
            // Also looks whether everything has an accessible name.
            bench.window.run_ok();
            let text = bench.text();
            let json = serde_json::from_str(&text).expect("a document is JSON");
            let read = Document::from_json(json, Path::new("/monkey.burnish")).expect("it can be opened again");
            assert_eq!(read, **bench.session().document(), "it is read as it was written");
        }
    }
    bench.until("jobs are done", |workbench| !workbench.is_busy());
    let session = bench.workbench().session_mut();
    assert!(!session.history().past().is_empty() || session.history().future().next().is_some(), "it edited nothing");
    session.go_to(0);
    assert_eq!(bench.text(), start, "undo leads back to the start");
}

/// Files to drop: good ones, broken ones.
fn files(folder: &Path) -> Vec<PathBuf> {
    let sky = folder.join("sky.hdr");
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n".to_vec();
    bytes.extend([128, 128, 128, 129].repeat(16 * 8));
    std::fs::write(&sky, bytes).expect("the folder can be written");
    let picture = folder.join("steel.png");
    let flat = Picture::filled(2, 2, glam::Vec4::ONE);
    burnish_core::file::write_picture(&flat, &picture, Default::default(), 0.0).expect("the folder can be written");
    let broken = ["broken.hdr", "broken.png", "broken.json", "notes.txt"].map(|name| folder.join(name));
    for path in &broken {
        std::fs::write(path, b"no such thing").expect("the folder can be written");
    }
    [sky, picture].into_iter().chain(broken).collect()
}

fn act(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>, files: &[PathBuf]) {
    match dice.below(100) {
        0..40 => click_something(bench, dice, log),
        40..52 => press_keys(bench, dice, log),
        52..66 => set_something(bench, dice, log),
        66..76 => drag(bench, dice, log),
        76..84 => type_something(bench, dice, log),
        84..92 => command(bench, dice, log),
        92..97 => {
            let (notches, modifiers) = (dice.unit() as f32 * 8.0 - 4.0, dice.modifiers());
            let at = dice.place();
            log.push(format!("wheel {notches} at {at} with {modifiers:?}"));
            bench.window.hover_at(at);
            bench.window.event_modifiers(
                egui::Event::MouseWheel {
                    unit: egui::MouseWheelUnit::Line,
                    delta: vec2(0.0, notches),
                    phase: egui::TouchPhase::Move,
                    source: egui::MouseWheelSource::Unknown,
                    modifiers,
                },
                modifiers,
            );
        }
        _ => {
            let Some(file) = dice.of(files) else { return };
            log.push(format!("drop {}", file.display()));
            bench.drop_file(&file);
        }
    }
}

/// Labels and places of what can be seen and is not left alone.
fn targets(bench: &Bench, wanted: impl Fn(Role) -> bool) -> Vec<(String, Role, egui::Rect)> {
    let area = egui::Rect::from_min_size(Pos2::ZERO, SIZE.into());
    let nodes =
        bench.window.get_all_by(|node| !node.is_disabled() && (node.label().is_some() || node.value().is_some()));
    let named = nodes.filter_map(|node| {
        let accesskit = node.accesskit_node();
        let label = accesskit.label().or_else(|| accesskit.value())?;
        let role = accesskit.role();
        let alone = LEFT_ALONE.iter().any(|left| label == *left || label.starts_with(&format!("{left} ")));
        (wanted(role) && !alone).then_some(())?;
        let rect = accesskit.raw_bounds().map(|_| node.rect())?;
        area.contains(rect.center()).then_some((label, role, rect))
    });
    named.collect()
}

fn click_something(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>) {
    let found = targets(bench, |role| !matches!(role, Role::Window | Role::GenericContainer | Role::Pane));
    let Some((label, role, rect)) = dice.of(&found) else { return };
    let button = if dice.below(8) == 0 { PointerButton::Secondary } else { PointerButton::Primary };
    let modifiers = dice.modifiers();
    let clicks = if dice.below(8) == 0 { 2 } else { 1 };
    log.push(format!("{clicks} click on {role:?} `{label}` with {button:?} {modifiers:?}"));
    let pos = rect.center();
    bench.window.hover_at(pos);
    for _ in 0..clicks {
        for pressed in [true, false] {
            bench.window.event_modifiers(egui::Event::PointerButton { pos, button, pressed, modifiers }, modifiers);
        }
    }
}

fn press_keys(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>) {
    let plain = [Key::Enter, Key::Escape, Key::Tab, Key::ArrowDown, Key::ArrowUp, Key::Delete];
    let of_table = TABLE.iter().filter(|entry| !COMMANDS_LEFT_ALONE.contains(&entry.command));
    let keys: Vec<(Modifiers, Key)> = (of_table.filter_map(|entry| entry.shortcut))
        .map(|shortcut| (shortcut.modifiers, shortcut.logical_key))
        .chain(plain.map(|key| (Modifiers::NONE, key)))
        .collect();
    let Some((modifiers, key)) = dice.of(&keys) else { return };
    log.push(format!("press {modifiers:?} {key:?}"));
    bench.window.key_press_modifiers(modifiers, key);
}

fn set_something(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>) {
    let found = targets(bench, |role| matches!(role, Role::Slider | Role::SpinButton));
    let Some((label, role, _)) = dice.of(&found) else { return };
    let value = match dice.below(6) {
        0 => -1e30,
        1 => 1e30,
        2 => 0.0,
        _ => dice.unit(),
    };
    log.push(format!("set {role:?} `{label}` to {value}"));
    let node = bench.window.get_all_by_role_and_label(role, &label).next();
    if let Some(node) = node {
        node.set_value_accesskit(value);
    }
}

fn drag(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>) {
    let (from, to, modifiers) = (dice.place(), dice.place(), dice.modifiers());
    let buttons = [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary];
    let Some(button) = dice.of(&buttons) else { return };
    log.push(format!("drag {button:?} from {from} to {to} with {modifiers:?}"));
    let press = |pos, pressed| egui::Event::PointerButton { pos, button, pressed, modifiers };
    bench.window.hover_at(from);
    bench.window.event_modifiers(press(from, true), modifiers);
    bench.window.run_steps(1);
    bench.window.hover_at(from.lerp(to, 0.5));
    bench.window.run_steps(1);
    bench.window.hover_at(to);
    bench.window.run_steps(1);
    bench.window.event_modifiers(press(to, false), modifiers);
}

fn type_something(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>) {
    let found = targets(bench, |role| matches!(role, Role::TextInput | Role::SearchInput));
    let (Some((label, role, _)), Some(text)) = (dice.of(&found), dice.of(&TEXTS)) else { return };
    let enter = dice.below(2) == 0;
    log.push(format!("type `{text}` into `{label}`, enter {enter}"));
    let Some(node) = bench.window.get_all_by_role_and_label(role, &label).next() else { return };
    node.focus();
    bench.window.run_steps(1);
    bench.window.event(egui::Event::Text(text.into()));
    bench.window.run_steps(1);
    if enter {
        bench.window.key_press(Key::Enter);
    }
}

fn command(bench: &mut Bench, dice: &mut Dice, log: &mut Vec<String>) {
    let Some(entry) = dice.of(TABLE).filter(|entry| !COMMANDS_LEFT_ALONE.contains(&entry.command)) else { return };
    log.push(format!("command {}", entry.title));
    bench.workbench().ask(Request::Command(entry.command));
}
