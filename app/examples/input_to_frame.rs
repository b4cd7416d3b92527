//! How long the window takes from an input to the end of the next frame, live and with the reference running.
//!
//! `cargo run --release -p burnish --example input_to_frame [SCENE]` drags a slider and turns the camera in a window of
//! 1280 x 800 that is drawn offscreen, in bursts of movements at 30 Hz with pauses in which the reference is traced. An
//! input that comes while a frame is drawn waits for the one after it, as in a window.

use std::error::Error;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use burnish::window::offscreen::Offscreen;
use burnish::window::{Command, Options, Request, Workbench};
use eframe::egui::{Event, Modifiers, PointerButton, Pos2, pos2};
use glam::UVec2;

const SIZE: UVec2 = UVec2::new(1280, 800);
/// Seconds between movements of a hand.
const STEP: f64 = 1.0 / 30.0;
/// Movements in a burst.
const MOVES: u32 = 20;
const BURSTS: u32 = 12;
/// Seconds between bursts: 0.3 of rest, then tracing, of a length that no frame keeps time with.
const PAUSE: f64 = 1.37;
/// Middle of the rail of `Roughness` and of the viewport in the initial layout.
const SLIDER: Pos2 = pos2(1134.0, 381.0);
const VIEWPORT: Pos2 = pos2(615.0, 420.0);

/// A window with a clock and a hand.
struct Bench {
    screen: Offscreen,
    workbench: Workbench,
    start: Instant,
    /// When the window is drawn next without input, in seconds; other threads ask for it too.
    due: Arc<Mutex<f64>>,
}

impl Bench {
    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Draws frames until `end`, with inputs at their times. Returns the milliseconds from each to the end of its frame.
    fn run(&mut self, end: f64, inputs: &[(f64, Event)]) -> Result<Vec<f64>, Box<dyn Error>> {
        let (mut next, mut taken) = (0, Vec::new());
        while self.now() < end || next < inputs.len() {
            let now = self.now();
            let arrived = inputs[next..].iter().take_while(|(time, _)| *time <= now).count();
            let due = *self.due.lock().expect("nobody panics with it");
            if arrived == 0 && due > now {
                std::thread::sleep(Duration::from_micros(500));
                continue;
            }
            *self.due.lock().expect("nobody panics with it") = f64::INFINITY;
            let events = inputs[next..next + arrived].iter().map(|(_, event)| event.clone()).collect();
            let wait = self.screen.frame(&mut self.workbench, events, now)?;
            let shown = self.now();
            taken.extend(inputs[next..next + arrived].iter().map(|(time, _)| 1e3 * (shown - time)));
            next += arrived;
            let mut due = self.due.lock().expect("nobody panics with it");
            *due = f64::min(*due, shown + wait.as_secs_f64());
        }
        Ok(taken)
    }

    /// Bursts of a drag around a place. The first input of each, which may meet a running trace, and all others.
    fn drag(&mut self, at: Pos2, reach: f32) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
        let mut taken = [Vec::new(), Vec::new()];
        for burst in 0..BURSTS {
            let pressed = |pressed, pos| Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            };
            let begin = self.now() + PAUSE + 0.011 * f64::from(burst);
            let place = |step: u32| {
                let share = f64::from(step) / f64::from(MOVES) + f64::from(burst) / 3.0;
                at + reach * eframe::egui::vec2((share * std::f64::consts::TAU).sin() as f32, 0.0)
            };
            let mut inputs = vec![(begin, Event::PointerMoved(place(0))), (begin, pressed(true, place(0)))];
            inputs.extend((1..=MOVES).map(|i| (begin + STEP * f64::from(i), Event::PointerMoved(place(i)))));
            inputs.push((begin + STEP * f64::from(MOVES + 1), pressed(false, place(MOVES))));
            let mut times = self.run(0.0, &inputs)?;
            taken[0].push(times.remove(1));
            taken[1].extend(times.split_off(1));
        }
        Ok(taken)
    }
}

fn report(what: &str, taken: &mut [f64]) {
    taken.sort_by(f64::total_cmp);
    let at = |share: f64| taken[((taken.len() - 1) as f64 * share).round() as usize];
    let late = taken.iter().filter(|ms| **ms > 100.0).count();
    println!(
        "{what:34} {:4} inputs: median {:5.1} ms, 95 % {:5.1} ms, most {:5.1} ms, {late} over 100 ms",
        taken.len(),
        at(0.5),
        at(0.95),
        at(1.0)
    );
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = std::env::args().nth(1).unwrap_or_else(|| "gallery:workbench".into());
    let folder = std::env::temp_dir().join(format!("burnish-input-{}", std::process::id()));
    let mut screen = Offscreen::like_native(SIZE)?;
    let options = Options { scene: Some(scene), data_folder: Some(folder.clone()), ..Options::default() };
    let mut workbench = Workbench::new(screen.context(), options, screen.stage());
    screen.picture(&mut workbench)?;
    let (start, due) = (Instant::now(), Arc::new(Mutex::new(0.0)));
    let asked = due.clone();
    screen.context().set_request_repaint_callback(move |info| {
        let time = start.elapsed().as_secs_f64() + info.delay.as_secs_f64();
        let mut due = asked.lock().expect("nobody panics with it");
        *due = f64::min(*due, time);
    });
    let mut bench = Bench { screen, workbench, start, due };
    for reference in [false, true] {
        if reference {
            bench.workbench.ask(Request::Command(Command::Reference));
            let end = bench.now() + 5.0;
            bench.run(end, &[])?;
            println!("{}", bench.workbench.reference().text(true));
        }
        let mode = if reference { "reference" } else { "live" };
        for (what, at, reach) in [("roughness", SLIDER, 30.0), ("camera", VIEWPORT, 120.0)] {
            let before = bench.workbench.session().revision;
            let [mut first, mut rest] = bench.drag(at, reach)?;
            assert!(bench.workbench.session().revision > before, "{what} did not move");
            report(&format!("{mode}, {what}, first of a drag"), &mut first);
            report(&format!("{mode}, {what}, moves of a drag"), &mut rest);
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    Ok(())
}
