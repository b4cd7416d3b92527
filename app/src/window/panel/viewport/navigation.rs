//! What drags and turns of the wheel do to the camera and the light: rules without a window.

use burnish_core::document::CameraEntry;
use eframe::egui::{Event, Modifiers, MouseWheelUnit, PointerButton, Vec2};

use crate::window::preferences::{Navigation, Preferences};

/// Degrees of a turn per point of a drag.
const DEGREES_PER_POINT: f64 = 0.4;
/// Zoom per point of a drag, as a natural logarithm.
const ZOOM_PER_POINT: f64 = 0.006;
/// Zoom of one notch of the wheel, as a natural logarithm.
const ZOOM_PER_NOTCH: f64 = 0.12;
/// Stops of exposure of one notch of the wheel.
pub const EV_PER_NOTCH: f64 = 0.25;
/// Points that a smooth wheel or a trackpad moves for one notch.
const POINTS_PER_NOTCH: f32 = 40.0;

/// What a drag does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// Turns the camera about its target.
    Orbit,
    /// Shifts the picture.
    Pan,
    /// Moves nearer or farther.
    Zoom,
    /// Turns the environment.
    TurnLight,
    /// Puts the selected light by its highlight, its shadow, or around the subject.
    PlaceLight,
}

/// Buttons that gestures begin with.
pub const BUTTONS: [PointerButton; 3] = [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary];

/// What a drag with a button does. Alt only ever adds a way: window managers take it.
pub fn gesture(navigation: Navigation, button: PointerButton, held: Modifiers) -> Option<Gesture> {
    use PointerButton::{Middle, Primary, Secondary};
    if button == Secondary && held.shift && !held.command {
        return Some(Gesture::TurnLight);
    }
    match (navigation, button) {
        (Navigation::Burnish, Primary) => Some(Gesture::Orbit),
        (Navigation::Burnish, Middle) => Some(Gesture::Pan),
        (Navigation::Burnish, Secondary) if held.command => Some(Gesture::Pan),
        (Navigation::Burnish, Secondary) => Some(Gesture::Zoom),
        (Navigation::Blender, Middle) if held.shift => Some(Gesture::Pan),
        (Navigation::Blender, Middle) if held.command => Some(Gesture::Zoom),
        (Navigation::Blender, Middle) => Some(Gesture::Orbit),
        (Navigation::Maya, Primary) if held.alt || held.command => Some(Gesture::Orbit),
        (Navigation::Maya, Middle) => Some(Gesture::Pan),
        (Navigation::Maya, Secondary) => Some(Gesture::Zoom),
        _ => None,
    }
}

/// What the gestures of a preset are, for people.
pub fn summary(navigation: Navigation) -> &'static str {
    match navigation {
        Navigation::Burnish => "Left drag turns, middle or Ctrl+right drag shifts, wheel or right drag zooms.",
        Navigation::Blender => "Middle drag turns, Shift+middle drag shifts, wheel or Ctrl+middle drag zooms.",
        Navigation::Maya => {
            "Ctrl+left or Alt+left drag turns, middle drag shifts, wheel or right drag zooms, each also with Alt."
        }
    }
}

/// How the user likes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feel {
    /// Factor on every movement.
    pub speed: f64,
    /// Zooms the other way.
    pub invert_zoom: bool,
}

impl Feel {
    /// As the user chose.
    pub fn new(preferences: &Preferences) -> Feel {
        let speed = f64::from(preferences.navigation_speed);
        let speed = if speed.is_finite() { speed.clamp(0.1, 10.0) } else { 1.0 };
        Feel { speed, invert_zoom: preferences.invert_zoom }
    }

    fn zoom(self, logarithm: f64) -> f64 {
        (if self.invert_zoom { logarithm } else { -logarithm } * self.speed).clamp(-5.0, 5.0).exp()
    }
}

/// Moves the camera by a drag of so many points in a picture of a height in points.
pub fn drag_camera(camera: &mut CameraEntry, gesture: Gesture, by: Vec2, height: f32, feel: Feel) {
    let (x, y) = (f64::from(by.x), f64::from(by.y));
    match gesture {
        Gesture::Orbit => {
            let degrees = DEGREES_PER_POINT * feel.speed;
            camera.orbit(-degrees * x, degrees * y);
        }
        // A shift keeps what is under the pointer there, whatever the speed.
        Gesture::Pan => camera.pan(x / f64::from(height.max(1.0)), -y / f64::from(height.max(1.0))),
        Gesture::Zoom => camera.zoom(feel.zoom(ZOOM_PER_POINT * (x - y))),
        Gesture::TurnLight | Gesture::PlaceLight => {}
    }
}

/// The environment's rotation after a drag to the right by so many points: reflections follow the pointer.
pub fn turned(rotation_deg: f64, by: f32, feel: Feel) -> f64 {
    (rotation_deg + DEGREES_PER_POINT * feel.speed * f64::from(by) + 180.0).rem_euclid(360.0) - 180.0
}

/// Turns of the wheel and pinches of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wheel {
    /// Notches towards the picture, without Shift.
    pub zoom: f64,
    /// Notches up, with Shift.
    pub exposure: f64,
    /// Factor of pinches, above 1 when fingers part.
    pub pinch: f64,
}

impl Wheel {
    /// Sums up events.
    pub fn read(events: &[Event]) -> Wheel {
        let mut wheel = Wheel { pinch: 1.0, ..Wheel::default() };
        for event in events {
            match event {
                Event::MouseWheel { unit, delta, modifiers, .. } => {
                    // Some systems turn the wheel into a sideways one while Shift is held.
                    let sideways = modifiers.shift && delta.y == 0.0;
                    let delta = if sideways { delta.x } else { delta.y };
                    let notches = f64::from(match unit {
                        MouseWheelUnit::Point => delta / POINTS_PER_NOTCH,
                        MouseWheelUnit::Line => delta,
                        MouseWheelUnit::Page => 10.0 * delta,
                    });
                    match modifiers.shift {
                        true => wheel.exposure += notches,
                        false => wheel.zoom += notches,
                    }
                }
                Event::Zoom(factor) if *factor > 0.0 => wheel.pinch *= f64::from(*factor),
                _ => {}
            }
        }
        wheel
    }

    /// The factor on the camera's distance.
    pub fn distance_factor(self, feel: Feel) -> f64 {
        feel.zoom(ZOOM_PER_NOTCH * self.zoom) / self.pinch.clamp(0.01, 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{MouseWheelSource, TouchPhase, vec2};

    const FEEL: Feel = Feel { speed: 1.0, invert_zoom: false };
    const ALL: [Navigation; 3] = [Navigation::Burnish, Navigation::Blender, Navigation::Maya];

    fn camera() -> CameraEntry {
        CameraEntry { target: [0.0; 3], distance: 4.0, yaw_deg: 0.0, pitch_deg: 0.0, ..CameraEntry::default() }
    }

    fn wheel(unit: MouseWheelUnit, delta: Vec2, modifiers: Modifiers) -> Wheel {
        let (phase, source) = (TouchPhase::Move, MouseWheelSource::Unknown);
        Wheel::read(&[Event::MouseWheel { unit, delta, phase, source, modifiers }])
    }

    #[test]
    fn every_preset_reaches_everything_without_alt() {
        let held = [Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND];
        for navigation in ALL {
            for wanted in [Gesture::Orbit, Gesture::Pan, Gesture::Zoom, Gesture::TurnLight] {
                let reached = BUTTONS
                    .iter()
                    .any(|button| held.iter().any(|held| gesture(navigation, *button, *held) == Some(wanted)));
                assert!(reached, "{navigation:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn the_light_turns_with_shift_and_right_in_every_preset() {
        for navigation in ALL {
            let with = gesture(navigation, PointerButton::Secondary, Modifiers::SHIFT);
            assert_eq!(with, Some(Gesture::TurnLight));
        }
    }

    #[test]
    fn alt_changes_no_gesture_of_maya_but_the_left_one() {
        let maya = |button, held| gesture(Navigation::Maya, button, held);
        assert_eq!(maya(PointerButton::Primary, Modifiers::ALT), Some(Gesture::Orbit));
        assert_eq!(maya(PointerButton::Primary, Modifiers::NONE), None);
        for button in [PointerButton::Middle, PointerButton::Secondary] {
            assert_eq!(maya(button, Modifiers::ALT), maya(button, Modifiers::NONE));
        }
    }

    #[test]
    fn a_drag_to_the_right_turns_the_front_to_the_right_and_one_down_shows_the_top() {
        let mut turned = camera();
        drag_camera(&mut turned, Gesture::Orbit, vec2(100.0, 50.0), 500.0, FEEL);
        assert!((turned.yaw_deg + 40.0).abs() < 1e-9 && (turned.pitch_deg - 20.0).abs() < 1e-9);
    }

    #[test]
    fn a_pan_keeps_the_target_under_the_pointer() {
        let mut panned = camera();
        drag_camera(&mut panned, Gesture::Pan, vec2(0.0, 250.0), 500.0, FEEL);
        // The picture went down by half its height: the middle of the old one is at the lower edge.
        let height = 2.0 * panned.distance * (0.5 * panned.yfov_deg).to_radians().tan();
        assert!((panned.target[1] - 0.5 * height).abs() < 1e-6);
    }

    #[test]
    fn the_wheel_goes_nearer_and_the_other_way_when_inverted() {
        let up = wheel(MouseWheelUnit::Line, vec2(0.0, 1.0), Modifiers::NONE);
        assert!(up.distance_factor(FEEL) < 1.0);
        assert!(up.distance_factor(Feel { invert_zoom: true, ..FEEL }) > 1.0);
        let back = wheel(MouseWheelUnit::Line, vec2(0.0, -1.0), Modifiers::NONE);
        assert!((up.distance_factor(FEEL) * back.distance_factor(FEEL) - 1.0).abs() < 1e-12);
        assert!(Wheel::read(&[Event::Zoom(1.5)]).distance_factor(FEEL) < 1.0);
    }

    #[test]
    fn shift_and_wheel_is_exposure_whichever_way_the_system_reports_it() {
        for delta in [vec2(0.0, 2.0), vec2(2.0, 0.0)] {
            let read = wheel(MouseWheelUnit::Line, delta, Modifiers::SHIFT);
            assert_eq!((read.zoom, read.exposure), (0.0, 2.0));
        }
        assert_eq!(wheel(MouseWheelUnit::Point, vec2(0.0, 40.0), Modifiers::SHIFT).exposure, 1.0);
    }

    #[test]
    fn a_full_turn_of_the_light_is_none() {
        let points = 360.0 / DEGREES_PER_POINT as f32;
        assert!((turned(30.0, points, FEEL) - 30.0).abs() < 1e-3);
        assert!(turned(170.0, 50.0, FEEL) < 0.0);
    }

    #[test]
    fn nonsense_in_the_preferences_still_moves_the_camera_by_finite_amounts() {
        let preferences = Preferences { navigation_speed: f32::NAN, ..Preferences::default() };
        let mut moved = camera();
        drag_camera(&mut moved, Gesture::Zoom, vec2(1e9, 0.0), 0.0, Feel::new(&preferences));
        assert!(moved.distance > 0.0 && moved.distance.is_finite());
    }
}
