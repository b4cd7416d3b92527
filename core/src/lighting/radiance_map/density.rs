//! Places that lie closer together where light varies, as a coarse map tells.

use glam::Vec3;

use super::map::Map;
use super::near::SET;
use super::points::{Place, Surfaces};
use crate::math::sampling::{pcg, unit};

/// Least density, as a share of the greatest: where the coarse map saw nothing there may be something.
const LEAST: f32 = 0.05;
/// Places that are drawn until one is taken, at most.
const TRIES: u32 = 64;

/// How much the light around places varies.
pub(super) struct Density<'a> {
    map: Map<'a>,
    /// Of each place of the map, the greatest is 1.
    variations: Vec<f32>,
}

impl<'a> Density<'a> {
    /// By a coarse map; `None` where its light is the same everywhere.
    pub fn new(map: Map<'a>) -> Option<Density<'a>> {
        let set = |place: u32| map.near.neighbours_of(place);
        let places = 0..map.near.len() as u32;
        // A mean of neighbours has less noise.
        let irradiance = |place: u32| {
            let light = map.mean(set(place), [1.0 / SET as f32; SET]);
            map.directions.irradiance(&light, map.near.normal(place))
        };
        let all: Vec<f32> = places.clone().map(irradiance).collect();
        let of_set = |place: u32| set(place).iter().map(|other| all[*other as usize]);
        let contrast = |place: u32| {
            let (low, high) = of_set(place).fold((f32::MAX, 0.0f32), |(low, high), e| (low.min(e), high.max(e)));
            if high > 0.0 { (high - low) / (high + low) } else { 0.0 }
        };
        let mut variations: Vec<f32> = places.map(contrast).collect();
        let most = variations.iter().copied().fold(0.0, f32::max);
        if most <= 0.0 || !most.is_finite() {
            return None;
        }
        variations.iter_mut().for_each(|variation| *variation = (*variation / most).max(LEAST));
        Some(Density { map, variations })
    }

    /// Place number `index`, by chance; a pure function of surfaces, map and number.
    pub fn place(&self, surfaces: &Surfaces<'_>, index: u32) -> Option<Place> {
        let mut state = pcg(index ^ 0x68e3_1da4);
        let mut next = || {
            state = pcg(state);
            unit(state)
        };
        let mut last = None;
        for _ in 0..TRIES {
            let place = surfaces.drawn(Vec3::new(next(), next(), next()), index % 2 == 1)?;
            let known = self.map.near.set(place.position, place.normal).and_then(|set| set.first());
            let taken = known.is_none_or(|known| next() < self.variations[*known as usize]);
            last = Some(place);
            if taken {
                break;
            }
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::job::Handle;
    use crate::lighting::Method;
    use crate::lighting::radiance_map::{PARAMS, RadianceMap};
    use crate::param::Settings;
    use crate::reference::{Options, World};
    use crate::scene::gallery;

    #[test]
    fn more_places_lie_where_light_varies_and_all_on_surfaces() {
        let scene = Arc::new(gallery::open("cabin").unwrap());
        let world = World::new(&scene, Options::default());
        let mut settings = Settings::new(PARAMS);
        for (key, value) in [("points", "1500"), ("paths", "4"), ("gather", "0"), ("directions", "32")] {
            settings.set(key, value).unwrap();
        }
        let prepared = RadianceMap.prepare(&world, &settings, &Handle::default()).unwrap();
        let surfaces = Surfaces::new(&scene);
        let density = Density::new(Map::of(&prepared, &settings).unwrap()).unwrap();
        let variation = |place: &Place| {
            let set = density.map.near.set(place.position, place.normal).unwrap();
            density.variations[set[0] as usize]
        };
        let mean = |places: Vec<Place>| places.iter().map(variation).sum::<f32>() / places.len() as f32;
        let even = mean((0..2000).filter_map(|i| surfaces.place(i, 2000)).collect());
        let dense: Vec<Place> = (0..2000).filter_map(|i| density.place(&surfaces, i)).collect();
        assert_eq!(density.place(&surfaces, 7), Some(dense[7]));
        let beside = dense.iter().filter(|place| {
            let back = world.sighted(place.position + 1e-4 * place.geometric, -place.geometric);
            back.is_none_or(|back| (back.distance - 1e-4).abs() > 1e-5)
        });
        let (beside, dense) = (beside.count(), mean(dense.clone()));
        println!("{even} {dense}, {beside} beside");
        assert!(dense > 1.4 * even && beside < 20, "{even} {dense} {beside}");
        // Of even light nothing is known.
        for key in ["environment-strength", "lamps-strength", "glow-strength"] {
            settings.set(key, "0").unwrap();
        }
        assert!(Density::new(Map::of(&prepared, &settings).unwrap()).is_none());
    }
}
