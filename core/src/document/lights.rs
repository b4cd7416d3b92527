//! Edits of the lights of a document, and where their highlights and shadows fall.

use std::collections::BTreeSet;

use glam::{Quat, Vec3};

use super::edit::free;
use super::{Document, LightEntry, Shape, object_keys};
use crate::scene::photometry::Unit;
use crate::scene::{Bounds, Light, Scene};

/// Illuminance that a new light gives a subject, lx: a white wall of it has the radiance of 1 nit.
const NEW_LUX: f64 = std::f64::consts::PI;
/// Distance of a new light from the middle of a subject, in radii.
const NEW_DISTANCE: f32 = 3.0;
/// From there it comes: to the left of the front and above it, where a key light stands.
const NEW_FROM: Vec3 = Vec3::new(-0.55, 0.75, 0.65);

impl Document {
    /// The lights of the document: those of `model` until one was edited.
    pub fn light_entries(&self, model: &Scene) -> Vec<LightEntry> {
        self.lights.clone().unwrap_or_else(|| entries_of(model))
    }

    /// A light by its name.
    pub fn light(&self, model: &Scene, name: &str) -> Option<LightEntry> {
        self.light_entries(model).into_iter().find(|light| light.name == name)
    }

    /// Edits the list of lights, which from then on is the document's own.
    pub fn edit_lights(&mut self, model: &Scene, change: impl FnOnce(&mut Vec<LightEntry>)) {
        let before = self.light_entries(model);
        let mut lights = before.clone();
        change(&mut lights);
        if lights != before {
            self.lights = Some(lights);
        }
    }

    /// Edits a light; nothing happens where there is none of that name.
    pub fn edit_light(&mut self, model: &Scene, name: &str, change: impl FnOnce(&mut LightEntry)) {
        self.edit_lights(model, |lights| {
            if let Some(light) = lights.iter_mut().find(|light| light.name == name) {
                change(light);
            }
        });
    }

    /// Adds a light that shines on a subject from the upper left of its front; returns its name.
    pub fn add_light(&mut self, model: &Scene, shape: Shape, subject: Bounds) -> String {
        let radius = sound_radius(subject);
        let name = self.free_light_name(model, shape.title());
        let mut light = LightEntry::new(&name, shape, 0.0, Unit::Lumen);
        light.set_place(subject.center() + NEW_DISTANCE * radius * NEW_FROM.normalize());
        light.set_direction(-NEW_FROM);
        let unit = match shape {
            Shape::Sun { .. } => Unit::Lux,
            _ => Unit::Lumen,
        };
        light.unit = unit.symbol().into();
        light.power = 1.0;
        let per_unit = light.illuminance(f64::from(NEW_DISTANCE * radius));
        light.power = if per_unit > 0.0 { NEW_LUX / per_unit } else { 0.0 };
        self.edit_lights(model, |lights| lights.push(light));
        name
    }

    /// Removes lights by their names.
    pub fn remove_lights(&mut self, model: &Scene, names: &[String]) {
        self.edit_lights(model, |lights| lights.retain(|light| !names.contains(&light.name)));
    }

    /// Copies a light in its place under another name, which is returned; `None` where there is none of that name.
    pub fn duplicate_light(&mut self, model: &Scene, name: &str) -> Option<String> {
        let light = self.light(model, name)?;
        let copy = self.free_light_name(model, name);
        let named = LightEntry { name: copy.clone(), ..light };
        self.edit_lights(model, |lights| {
            let place = lights.iter().position(|light| light.name == name).map_or(lights.len(), |place| place + 1);
            lights.insert(place, named);
        });
        Some(copy)
    }

    /// Gives a light another name, or the next that is free; returns it.
    pub fn rename_light(&mut self, model: &Scene, name: &str, new: &str) -> String {
        if name == new || new.trim().is_empty() {
            return name.into();
        }
        let new = self.free_light_name(model, new.trim());
        self.edit_light(model, name, |light| light.name.clone_from(&new));
        new
    }

    /// `name`, or `name 2`, `name 3` ... where a light has it.
    pub fn free_light_name(&self, model: &Scene, name: &str) -> String {
        let taken: BTreeSet<String> = self.light_entries(model).into_iter().map(|light| light.name).collect();
        free(name, |candidate| taken.contains(candidate))
    }
}

/// What a document stores of the lights of a model, with names that are unique.
pub fn entries_of(model: &Scene) -> Vec<LightEntry> {
    let keys = object_keys(model);
    let mut taken = BTreeSet::new();
    let entry = |light: &Light| {
        let mut entry = LightEntry::of_light(light, &keys);
        let name = if entry.name.is_empty() { "Light" } else { &entry.name };
        entry.name = free(name, |candidate| taken.contains(candidate));
        taken.insert(entry.name.clone());
        entry
    };
    model.lights.iter().map(entry).collect()
}

/// The lights that shine: not muted, and solo if any is. `keys` are those of the instances.
pub fn shining(lights: &[LightEntry], keys: &[String]) -> Vec<Light> {
    let solo = lights.iter().any(|light| light.solo && !light.muted);
    let shines = |light: &&LightEntry| !light.muted && (light.solo || !solo);
    let made = lights.iter().filter(shines).map(|light| {
        let unlit = light.unlit.iter().filter_map(|key| keys.iter().position(|known| known == key));
        light.light(unlit.collect())
    });
    made.collect()
}

/// Half the diagonal of a box in metres; 1 for an empty one.
fn sound_radius(bounds: Bounds) -> f32 {
    Some(bounds.radius()).filter(|radius| *radius > 0.0 && radius.is_finite()).unwrap_or(1.0)
}

impl LightEntry {
    /// Stands and shines as in a mirror across the plane through `point` at right angles to axis 0 (x), 1 (y) or 2 (z).
    pub fn mirror(&mut self, axis: usize, point: Vec3) {
        let Some(normal) = Vec3::AXES.get(axis).copied() else { return };
        let place = self.place();
        self.set_place(place - 2.0 * (place - point).dot(normal) * normal);
        let direction = self.direction();
        self.set_direction(direction - 2.0 * direction.dot(normal) * normal);
        self.roll_deg = -self.roll_deg;
    }

    /// Shines at a point; a light that stands there stays as it is.
    pub fn aim(&mut self, point: Vec3) {
        self.set_direction(point - self.place());
    }

    /// Goes about a point by angles in degrees, to the left as seen from above and up, and turns along.
    pub fn orbit(&mut self, center: Vec3, yaw_deg: f64, pitch_deg: f64) {
        let offset = if self.shape.has_place() { self.place() - center } else { -self.direction() };
        let distance = offset.length();
        if distance <= 0.0 || !distance.is_finite() {
            return;
        }
        let yaw = offset.x.atan2(offset.z) + yaw_deg.to_radians() as f32;
        let most = 89.9_f32.to_radians();
        let pitch = ((offset.y / distance).clamp(-1.0, 1.0).asin() + pitch_deg.to_radians() as f32).clamp(-most, most);
        let from = Vec3::new(yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos());
        self.set_place(center + distance * from);
        self.set_direction(-from);
    }

    /// Puts its highlight on a point of a surface: there a mirror would show the light's middle to the viewer. Its distance
    /// stays. `normal` and `to_viewer` are unit vectors. Says whether it could: not from behind the surface.
    pub fn put_highlight(&mut self, point: Vec3, normal: Vec3, to_viewer: Vec3) -> bool {
        let cos = normal.dot(to_viewer);
        if cos <= 0.0 || !cos.is_finite() {
            return false;
        }
        self.put_along(point, 2.0 * cos * normal - to_viewer)
    }

    /// Puts the shadow of a point, such as the middle of a subject, on another. The distance from what throws it stays.
    pub fn put_shadow(&mut self, on: Vec3, of: Vec3) -> bool {
        self.put_along(of, of - on)
    }

    /// In this direction from a point, as far as before, shining at it.
    fn put_along(&mut self, point: Vec3, direction: Vec3) -> bool {
        let Some(direction) = direction.try_normalize() else { return false };
        if self.shape.has_place() {
            let distance = Some((self.place() - point).length()).filter(|d| *d > 1e-4).unwrap_or(1.0);
            self.set_place(point + distance * direction);
        }
        self.set_direction(-direction);
        true
    }

    /// Turned by a rotation about its own place.
    pub fn turn(&mut self, by: Quat) {
        self.set_rotation(by * self.rotation());
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::document::{Curves, DEFAULT_SCENE, open, resolve};
    use crate::math::sampling::Random;
    use crate::scene::gallery;

    #[test]
    fn lights_of_the_model_become_the_documents_own_with_the_first_edit() {
        let opened = open(DEFAULT_SCENE).unwrap();
        let model = opened.sources.models[DEFAULT_SCENE].clone();
        let mut document = opened.document;
        let scene = |document: &Document| resolve(document, &opened.sources, &mut Curves::default()).scene;
        let before = scene(&document);
        assert!(!model.lights.is_empty() && document.lights.is_none());
        document.edit_lights(&model, |_| {});
        assert!(document.lights.is_none(), "no edit");
        let name = document.add_light(&model, Shape::Sphere { radius: 0.1 }, model.bounds());
        let after = scene(&document);
        assert_eq!(after.lights.len(), before.lights.len() + 1);
        for (a, b) in before.lights.iter().zip(&after.lights) {
            assert!((a.intensity - b.intensity).length() <= 1e-6 * a.intensity.length(), "{a:?} {b:?}");
            assert!((a.position - b.position).length() < 1e-6 && (a.direction - b.direction).length() < 1e-6);
        }
        let copy = document.duplicate_light(&model, &name).unwrap();
        assert_eq!(document.rename_light(&model, &copy, &name), format!("{name} 3"), "a name stands for one light");
        document.edit_light(&model, &name, |light| light.solo = true);
        assert_eq!(scene(&document).lights.len(), 1);
        document.edit_light(&model, &name, |light| light.muted = true);
        assert_eq!(scene(&document).lights.len(), before.lights.len() + 1, "a muted solo counts as none");
        document.remove_lights(&model, std::slice::from_ref(&name));
        assert!(document.light(&model, &name).is_none());
    }

    #[test]
    fn a_new_light_lights_its_subject() {
        let model = gallery::open("ball").unwrap();
        for shape in Shape::all(0.5) {
            let mut document = Document::new("gallery:ball".into());
            let bounds = Bounds { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) };
            let name = document.add_light(&model, shape, bounds);
            let light = document.light(&model, &name).unwrap();
            let distance = f64::from(light.place().length());
            assert!((light.illuminance(distance) / NEW_LUX - 1.0).abs() < 1e-6, "{shape:?}");
            assert!(light.direction().dot(-light.place().normalize()) > 0.999);
        }
    }

    #[test]
    fn a_mirrored_light_shines_as_its_image_and_twice_is_none() {
        let mut light = LightEntry::new("a", Shape::Rectangle { width: 1.0, height: 2.0 }, 1.0, Unit::Nit);
        light.position = [1.0, 2.0, 3.0];
        light.set_rotation(Quat::from_euler(glam::EulerRot::YXZ, 0.7, -0.6, 0.3));
        for axis in 0..3 {
            let mut image = light.clone();
            let point = Vec3::new(0.5, 0.0, 0.0);
            image.mirror(axis, point);
            let flip = |v: Vec3| v - 2.0 * v[axis] * Vec3::AXES[axis];
            assert!((image.direction() - flip(light.direction())).length() < 1e-5, "{axis}");
            assert!((image.place() - point - flip(light.place() - point)).length() < 1e-5, "{axis}");
            // The edge of a rectangle has no sign.
            let across = |entry: &LightEntry| entry.rotation() * Vec3::X;
            assert!(across(&image).dot(flip(across(&light))).abs() > 1.0 - 1e-5, "{axis}");
            image.mirror(axis, point);
            assert!((image.place() - light.place()).length() < 1e-5);
        }
    }

    #[test]
    fn an_orbit_keeps_the_distance_and_never_turns_over() {
        let mut light = LightEntry::new("a", Shape::Point, 1.0, Unit::Lumen);
        let center = Vec3::new(0.1, 0.2, 0.3);
        light.set_place(center + Vec3::new(0.0, 1.0, 2.0));
        light.aim(center);
        let before = light.clone();
        light.orbit(center, 30.0, 10.0);
        light.orbit(center, -30.0, -10.0);
        assert!((light.place() - before.place()).length() < 1e-4);
        light.orbit(center, 0.0, 500.0);
        assert!(((light.place() - center).length() - 5.0_f32.sqrt()).abs() < 1e-4 && light.place().y > center.y);
        assert!((light.direction() + (light.place() - center).normalize()).length() < 1e-4);
    }

    /// Largest angle in degrees between the direction in which the highlight was put and where the light then is, over random
    /// points of a scene.
    fn highlight_error(scene: &Scene, picks: usize) -> f32 {
        let camera = scene.cameras[0].clone();
        let mut random = Random::new(7);
        let (mut found, mut worst) = (0, 0.0_f32);
        while found < picks {
            let at = Vec2::new(random.unit(), random.unit());
            let ray = camera.ray(at, 1.5);
            let Some(picked) = scene.pick(ray).filter(|picked| scene.subject.contains(&picked.instance)) else {
                continue;
            };
            for shape in Shape::all(0.3) {
                let mut light = LightEntry::new("a", shape, 1.0, Unit::Nit);
                light.set_place(picked.position + Vec3::new(0.4, 1.2, 0.7));
                let distance = (light.place() - picked.position).length();
                if !light.put_highlight(picked.position, picked.normal, -ray.direction) {
                    continue;
                }
                // By the law of reflection, written otherwise.
                let expected = ray.direction - 2.0 * ray.direction.dot(picked.normal) * picked.normal;
                let toward = match shape.has_place() {
                    true => light.place() - picked.position,
                    false => -light.direction(),
                };
                worst = worst.max(toward.angle_between(expected).to_degrees());
                if shape.has_place() {
                    assert!((toward.length() / distance - 1.0).abs() < 1e-4);
                    assert!(light.direction().angle_between(-expected).to_degrees() < 2.0);
                }
                found += 1;
            }
        }
        worst
    }

    #[test]
    fn a_highlight_falls_where_it_is_put() {
        for name in ["ball", "workbench"] {
            let scene = gallery::open(name).unwrap();
            let worst = highlight_error(&scene, 200);
            assert!(worst < 2.0, "{name}: {worst} degrees");
        }
    }

    #[test]
    fn a_shadow_falls_where_it_is_put() {
        let mut light = LightEntry::new("a", Shape::Point, 1.0, Unit::Lumen);
        light.set_place(Vec3::new(1.0, 3.0, 0.0));
        let (of, on) = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.5, 0.0, 0.5));
        assert!(light.put_shadow(on, of));
        let (to_shadow, to_body) = ((on - light.place()).normalize(), (of - light.place()).normalize());
        assert!((to_shadow - to_body).length() < 1e-5, "they lie on one ray");
        assert!(!light.put_shadow(of, of), "nothing throws a shadow on itself");
    }
}
