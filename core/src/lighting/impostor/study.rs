//! How far a search is off what a ray meets.

use std::sync::Arc;

use glam::{UVec2, Vec3};
use rayon::prelude::*;

use super::{Effort, follow};
use crate::lighting::Prepared;
use crate::lighting::probe::{Probes, behind, surroundings};
use crate::reference::{Eye, View, World};

/// A place is another one from this share of its distance on.
const OFF: f32 = 0.01;

/// A mirrored line of sight, and what it meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorRay {
    /// Index of the instance that mirrors.
    pub instance: u32,
    /// Where, metres.
    pub position: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// Metres to what it meets past the instances that the probe serves; `None` for the sky.
    pub met: Option<f32>,
    /// The probe sees that place too, or has it in its second layer, within 1 % of its distance; true for the sky.
    pub is_seen: bool,
}

/// The errors of many rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HitErrors {
    /// How many rays there were.
    pub rays: usize,
    /// Degrees between where the search looked and what the ray meets, as seen from the probe: of half of the rays at most.
    pub median: f32,
    /// Of 95 % of them at most.
    pub p95: f32,
    /// Share of the rays without a hit, within the tolerance.
    pub misses: f32,
    /// Share that meet what the probe does not have: no search can find that.
    pub hidden: f32,
    /// Share, of the others, that ended before or behind what they meet, by more than 1 % of its distance from the probe.
    pub off: f32,
    /// Distances that were looked up for a ray, mean.
    pub lookups: f32,
}

/// The mirrored lines of sight of all pixels that show an instance which a probe of the preparation serves.
pub fn mirror_rays(world: &World, prepared: &Prepared, view: &View) -> Vec<MirrorRay> {
    let size = view.size;
    let probes = Probes::of(prepared);
    // What was recorded without what is served: only a second layer asks.
    let layered: Vec<(&Prepared, World)> = (probes.iter())
        .filter(|probe| probe.behind().is_some())
        .map(|probe| {
            let around = surroundings(world.scene(), probe.maps.whole("served"));
            (probe.maps, world.updated(&Arc::new(around), *world.options()))
        })
        .collect();
    let rows = (0..size.y).into_par_iter().flat_map_iter(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    rows.filter_map(|pixel| {
        let eye = Eye::new(world, view, pixel, 0);
        let point = eye.point()?;
        let (probe, _) = probes.about(point.instance(), point.position()).into_iter().next()?;
        let direction = point.mirrored();
        let met = world.distance_past(point.position(), direction, probe.maps.whole("served"));
        let is_seen = met.is_none_or(|t| {
            let from_probe = point.position() + t * direction - probe.middle;
            let (length, toward) = (from_probe.length(), from_probe.normalize_or(direction));
            let first = world.distance_past(probe.middle, toward, probe.maps.whole("served"));
            let second = || {
                let (_, around) = layered.iter().find(|(maps, _)| std::ptr::eq(*maps, probe.maps))?;
                Some(behind(around, probe.middle, toward)?.to)
            };
            let is_there = |distance: f32| (distance - length).abs() <= OFF * length;
            first.is_some_and(is_there) || second().is_some_and(is_there)
        });
        Some(MirrorRay { instance: point.instance(), position: point.position(), direction, met, is_seen })
    })
    .collect()
}

/// Follows rays by one solver, each through the surroundings of the probe that counts most.
pub fn hit_errors(prepared: &Prepared, rays: &[MirrorRay], effort: &Effort) -> HitErrors {
    let probes = Probes::of(prepared);
    let of = |ray: &MirrorRay| {
        let about = probes.about(ray.instance, ray.position);
        let (probe, _) = about.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let x = ray.position - probe.middle;
        let (found, _) = follow(&probe, x, ray.direction, effort);
        let wanted = ray.met.map_or(ray.direction, |t| x + t * ray.direction);
        let degrees = apart(found.direction(x, ray.direction), wanted);
        let off = ray.is_seen && ray.met.is_some_and(|t| (found.t - t).abs() > OFF * wanted.length());
        Some((degrees, !found.is_hit, off, found.lookups))
    };
    let mut all: Vec<(f32, bool, bool, u32)> = rays.par_iter().filter_map(of).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = all.len();
    if count == 0 {
        return HitErrors::default();
    }
    let share =
        |flag: fn(&(f32, bool, bool, u32)) -> bool| all.iter().filter(|one| flag(one)).count() as f32 / count as f32;
    HitErrors {
        rays: count,
        median: all[count / 2].0,
        p95: all[count * 95 / 100].0,
        misses: share(|one| one.1),
        hidden: rays.iter().filter(|ray| !ray.is_seen).count() as f32 / rays.len() as f32,
        off: share(|one| one.2) * count as f32 / rays.iter().filter(|ray| ray.is_seen).count().max(1) as f32,
        lookups: all.iter().map(|one| one.3 as f32).sum::<f32>() / count as f32,
    }
}

/// Degrees between directions of any length; small ones keep their digits.
pub(super) fn apart(a: Vec3, b: Vec3) -> f32 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}
