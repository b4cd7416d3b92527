//! Where the probes of a scene stand, and what is recorded from there.

use glam::Vec3;

use crate::scene::{Probe, ProbeSource, Scene};

/// Most probes of a scene that count: a device has a bit for each.
pub const MOST: usize = 32;
/// Half the edges of the box of a probe that serves everywhere, metres.
const EVERYWHERE: f32 = 1e9;

/// A probe with all that the scene and the method leave open filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// Name for people.
    pub name: String,
    /// Where it stands, metres.
    pub middle: Vec3,
    /// Half the edges of the box in which it serves.
    pub half: Vec3,
    /// Texels along the edge of a face.
    pub face: u32,
    /// Where its light comes from.
    pub source: ProbeSource,
    /// Paths for a texel.
    pub paths: u32,
    /// Layers of surfaces: 2 with what lies behind what is seen.
    pub layers: u32,
    /// Indices of the instances that it serves, in order; never empty.
    pub served: Vec<u32>,
}

/// What is recorded where a probe does not say otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defaults {
    /// Texels along the edge of a face.
    pub face: u32,
    /// Paths for a texel.
    pub paths: u32,
    /// Layers of surfaces, 1 or 2.
    pub layers: u32,
}

/// Of all probes of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sites {
    /// In the order of the scene's.
    pub list: Vec<Site>,
}

impl Sites {
    /// Those of the scene, at most [`MOST`]; one in the middle of [`Scene::served`] where it has none. A probe that serves nothing, or
    /// everything there is, is left out.
    pub fn new(scene: &Scene, defaults: Defaults) -> Sites {
        let one = [Probe { name: "probe".into(), ..Probe::default() }];
        let probes = if scene.probes.is_empty() { &one[..] } else { &scene.probes[..] };
        Sites { list: probes.iter().filter_map(|probe| Site::new(scene, probe, defaults)).take(MOST).collect() }
    }
}

/// Most texels along an edge, paths for a texel, and layers, of a probe that is made in a part of a second.
const COARSE: Defaults = Defaults { face: 32, paths: 4, layers: 1 };

impl Sites {
    /// The same places, recorded in a part of a second.
    #[must_use]
    pub fn coarse(mut self) -> Sites {
        for site in &mut self.list {
            site.face = site.face.min(COARSE.face);
            site.paths = site.paths.min(COARSE.paths);
            site.layers = site.layers.min(COARSE.layers);
            site.source = ProbeSource::Raster;
        }
        self
    }
}

impl Site {
    fn new(scene: &Scene, probe: &Probe, defaults: Defaults) -> Option<Site> {
        let mut served = if probe.serves.is_empty() { scene.served() } else { probe.serves.clone() };
        served.retain(|i| scene.instances.get(*i).is_some_and(|instance| instance.visible));
        served.sort_unstable();
        served.dedup();
        let all = scene.instances.iter().filter(|instance| instance.visible).count();
        if served.is_empty() || served.len() == all {
            return None;
        }
        Some(Site {
            name: probe.name.clone(),
            middle: probe.position.unwrap_or_else(|| scene.bounds_of(&served).center()),
            half: probe.extent.unwrap_or(Vec3::splat(EVERYWHERE)),
            face: probe.resolution.unwrap_or(defaults.face).max(2),
            source: probe.source,
            paths: probe.paths.unwrap_or(defaults.paths).max(1),
            layers: defaults.layers,
            served: served.into_iter().map(|i| i as u32).collect(),
        })
    }
}
