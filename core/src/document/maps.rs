//! The environment of a resolved scene, from the entry of the document and the map that it names. What takes long is kept.

use std::sync::Arc;

use glam::Vec3;

use super::environment::{BackgroundEntry, EnvironmentEntry, GroundEntry, MadeEntry, vec3};
use crate::scene::environment::{NoSun, Split, blurred, split_sun};
use crate::scene::{Background, Environment, Ground, Scene};

/// Maps of each sort that are kept.
const KEPT: usize = 4;

/// Maps that were made, so that an edit of other things makes none again.
#[derive(Clone, Debug, Default)]
pub(super) struct Maps {
    /// The last used first, as in all lists.
    made: Vec<(MadeEntry, Arc<Environment>)>,
    /// With the blur.
    blurred: Vec<(Key<f64>, Environment)>,
    split: Vec<(Key<()>, Result<Split, NoSun>)>,
}

/// A map by its texels, which copies share, and what was asked of it.
#[derive(Clone, Debug)]
struct Key<A> {
    texels: Arc<[Vec3]>,
    width: u32,
    asked: A,
}

impl<A: PartialEq> Key<A> {
    fn new(map: &Environment, asked: A) -> Key<A> {
        Key { texels: map.texels.clone(), width: map.width, asked }
    }

    fn is(&self, other: &Key<A>) -> bool {
        Arc::ptr_eq(&self.texels, &other.texels) && self.width == other.width && self.asked == other.asked
    }
}

/// Finds an entry or makes it, and puts it first.
fn kept<K: Clone, V: Clone>(list: &mut Vec<(K, V)>, key: &K, same: impl Fn(&K) -> bool, make: impl FnOnce() -> V) -> V {
    let entry = match list.iter().position(|(known, _)| same(known)) {
        Some(place) => list.remove(place),
        None => (key.clone(), make()),
    };
    let value = entry.1.clone();
    list.insert(0, entry);
    list.truncate(KEPT);
    value
}

impl Maps {
    /// The map by numbers, if the document has one that counts.
    pub fn made(&mut self, entry: &EnvironmentEntry, notices: &mut Vec<String>) -> Option<Arc<Environment>> {
        let made = entry.made.as_ref().filter(|_| entry.source.is_none())?;
        if let MadeEntry::Unknown(value) = made {
            let kind = value.as_object().and_then(|o| o.keys().next()).map_or("made", String::as_str);
            notices.push(format!("environment: this version cannot make `{kind}`; the light of the scene is used"));
            return None;
        }
        // Unknown entries ended above; black stands in for nothing.
        let make = || Arc::new(made.map().unwrap_or_else(|| Environment::new("", 1, 1, vec![Vec3::ZERO])));
        Some(kept(&mut self.made, made, |known| known == made, make))
    }

    fn blurred(&mut self, map: &Environment, half_width_deg: f64) -> Environment {
        let key = Key::new(map, half_width_deg);
        kept(&mut self.blurred, &key, |known| known.is(&key), || blurred(map, half_width_deg))
    }

    fn split(&mut self, map: &Environment) -> Result<Split, NoSun> {
        let key = Key::new(map, ());
        kept(&mut self.split, &key, |known| known.is(&key), || split_sun(map))
    }

    /// Puts the map of a document into its scene, with all that the entry says about it.
    pub fn place(&mut self, scene: &mut Scene, map: &Environment, entry: &EnvironmentEntry, notices: &mut Vec<String>) {
        let placed = |of: &Environment| Environment {
            rotation: map.rotation + entry.rotation_deg.to_radians() as f32,
            strength: map.strength * entry.strength as f32,
            tint: map.tint * vec3(entry.tint),
            ..of.clone()
        };
        let mut lit = placed(map);
        scene.background = Background { map: self.background(&lit, entry, notices), ground: None };
        scene.background.ground = entry.ground.as_ref().and_then(|ground| on_ground(scene, ground, notices));
        // Blurred backgrounds have the sun in them already.
        let seen = scene.background.map.is_none();
        let mut suns = Vec::new();
        if entry.sun_split {
            match self.split(map) {
                Ok(split) => {
                    lit = placed(&split.rest);
                    suns.push(split.sun.of(&lit).light(&format!("Sun of {}", map.name)));
                }
                Err(reason) => notices.push(format!("environment `{}`: no sun was taken out: {reason}", map.name)),
            }
        }
        if let (Some(MadeEntry::Sky(sky)), None) = (&entry.made, &entry.source)
            && sky.sun
        {
            suns.push(sky.model().sun().of(&lit).light("Sun of the sky"));
        }
        for sun in &mut suns {
            sun.camera = seen;
            sun.intensity *= entry.sun_strength.max(0.0) as f32;
        }
        scene.lights.extend(suns);
        scene.environment = Some(Arc::new(lit));
    }

    /// What is seen in the place of the environment.
    fn background(
        &mut self,
        lit: &Environment,
        entry: &EnvironmentEntry,
        notices: &mut Vec<String>,
    ) -> Option<Arc<Environment>> {
        match &entry.background {
            BackgroundEntry::Color(color) => return Background::of_color(vec3(*color)).map,
            BackgroundEntry::Environment => {}
            BackgroundEntry::Unknown(value) => {
                notices.push(format!("background {value} is not in this version; the environment is shown"));
            }
        }
        (entry.background_blur_deg > 0.0).then(|| {
            let soft = self.blurred(lit, entry.background_blur_deg);
            Arc::new(Environment { rotation: lit.rotation, strength: lit.strength, tint: lit.tint, ..soft })
        })
    }
}

/// The ground where the entry leaves its place to the scene.
fn on_ground(scene: &Scene, entry: &GroundEntry, notices: &mut Vec<String>) -> Option<Ground> {
    let bounds = if entry.level.is_none() || entry.middle.is_none() { Some(scene.bounds()) } else { None };
    let bounds = bounds.filter(|bounds| !bounds.is_empty());
    let level = entry.level.map(|v| v as f32).or(bounds.map(|b| b.min.y)).unwrap_or(0.0);
    let center = bounds.map_or(Vec3::ZERO, |b| b.center());
    let [x, z] = entry.middle.map_or([center.x, center.z], |middle| middle.map(|v| v as f32));
    let ground = Ground {
        middle: Vec3::new(x, level, z),
        height: entry.height as f32,
        radius: entry.radius as f32,
        shadows: entry.shadows,
    };
    if !ground.is_sound() {
        notices.push("environment: the ground needs a height above 0 and a larger radius; it is left out".into());
    }
    Some(ground).filter(Ground::is_sound)
}
