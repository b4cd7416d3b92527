//! `--lighting`: presets of lights by id or file, and scenes that they light.

use std::sync::Arc;

use burnish_core::document::{self, LightingPreset};
use burnish_core::scene::Scene;

use crate::failure::Failure;

/// Stands for every preset of the program.
const ALL: &str = "all";

/// The preset that an option names.
pub fn find(wanted: &str) -> Result<LightingPreset, Failure> {
    LightingPreset::find(wanted).map_err(|e| Failure::usage(format!("--lighting {wanted}: {e}")))
}

/// The presets that a repeatable option names, each once; `all` stands for those of the program.
pub fn find_all(wanted: &[String]) -> Result<Vec<LightingPreset>, Failure> {
    let mut presets: Vec<LightingPreset> = Vec::new();
    for name in wanted {
        let more = if name == ALL { LightingPreset::library().to_vec() } else { vec![find(name)?] };
        for preset in more {
            match presets.iter().find(|known| known.id == preset.id) {
                None => presets.push(preset),
                Some(known) if *known == preset => {}
                Some(_) => {
                    let id = &preset.id;
                    return Err(Failure::usage(format!(
                        "--lighting {name}: another preset has the id `{id}`; give it one of its own"
                    )));
                }
            }
        }
    }
    Ok(presets)
}

/// Lights a scene by a preset around its subject in the place of all lights; the strength and turn of the preset's environment act on
/// the map that is there.
pub fn light(scene: &mut Scene, preset: &LightingPreset) {
    scene.lights = document::shining(&preset.lights_around(scene.subject_bounds()), &[]);
    if let (Some(map), Some(entry)) = (&mut scene.environment, &preset.environment) {
        let map = Arc::make_mut(map);
        map.strength *= entry.strength.max(0.0) as f32;
        map.rotation += entry.rotation_deg.to_radians() as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_every_preset_once() {
        let ids = |wanted: &[&str]| {
            let wanted: Vec<String> = wanted.iter().map(ToString::to_string).collect();
            find_all(&wanted)
                .unwrap_or_else(|e| panic!("{e:?}"))
                .into_iter()
                .map(|preset| preset.id)
                .collect::<Vec<_>>()
        };
        let library: Vec<String> = LightingPreset::library().iter().map(|preset| preset.id.clone()).collect();
        assert!(library.len() > 1);
        assert_eq!(ids(&["all", "rim"]), library);
        assert_eq!(ids(&["window", "rim", "Window"]), ["window", "rim"]);
        assert!(ids(&[]).is_empty());
    }
}
