//! A baked map as lookups see it: the light that arrives at a point is a mean over places near it.

use std::sync::Arc;

use glam::Vec3;
use half::f16;
use half::slice::HalfFloatSliceExt;

use super::bake::GROUPS;
use super::directions::Directions;
use super::near::{self, Grid, Near, SET};
use super::settings::{Look, baked_directions};
use crate::file::Array;
use crate::lighting::Prepared;
use crate::param::Settings;

/// The numbers of a group.
enum Light<'a> {
    Halves(&'a [f16]),
    Floats(&'a [f32]),
}

/// What was baked, ready for lookups.
pub(super) struct Map<'a> {
    pub near: Near<'a>,
    /// Light of each group with what it is multiplied by.
    groups: [Option<(Light<'a>, Vec3)>; 3],
    pub directions: Arc<Directions>,
    pub look: Look,
}

impl<'a> Map<'a> {
    /// `None` where a preparation has no map.
    pub fn of(prepared: &'a Prepared, settings: &Settings) -> Option<Map<'a>> {
        let directions = baked_directions(prepared)?;
        let (positions, normals) = (prepared.floats("positions"), prepared.floats("normals"));
        let (grid, starts) = Grid::of(prepared)?;
        let neighbours = prepared.whole("neighbours");
        let places = positions.len() / 3;
        if places == 0 || normals.len() != positions.len() || neighbours.len() != SET * places {
            return None;
        }
        let look = Look::new(settings);
        let mut groups = [const { None }; 3];
        for ((name, strength), group) in GROUPS.iter().zip(look.strengths).zip(&mut groups) {
            let (halves, floats) = (prepared.halves(name), prepared.floats(name));
            let scale = prepared.floats(&format!("{name} scale")).first().copied().unwrap_or(1.0);
            let whole = 3 * places * directions.len();
            if halves.len() == whole {
                *group = Some((Light::Halves(halves), scale * strength));
            } else if floats.len() == whole {
                *group = Some((Light::Floats(floats), scale * strength));
            } else if halves.len() + floats.len() > 0 {
                return None;
            }
        }
        let near = Near::new(positions, normals, grid, starts, neighbours);
        Some(Map { near, groups, directions, look })
    }

    /// Radiance that arrives at a point from each direction.
    pub fn arriving(&self, position: Vec3, normal: Vec3) -> Vec<Vec3> {
        let searched;
        let set = if self.look.filter.unguarded {
            searched = self.near.nearest_of_all(position, SET);
            &searched
        } else {
            self.near.set(position, normal).unwrap_or_default()
        };
        let weights = near::weights(&self.near, set, position, normal, self.look.filter);
        self.mean(set, weights)
    }

    /// Mean radiance of some places from each direction.
    pub fn mean(&self, set: &[u32], weights: [f32; SET]) -> Vec<Vec3> {
        let numbers = 3 * self.directions.len();
        let mut light = vec![Vec3::ZERO; self.directions.len()];
        let mut wide = vec![0.0f32; numbers];
        for (place, weight) in self.counted(set, weights) {
            let of_place = numbers * place..numbers * (place + 1);
            for (own, factor) in self.groups.iter().flatten().filter(|(_, factor)| *factor != Vec3::ZERO) {
                let own = match own {
                    Light::Floats(floats) => &floats[of_place.clone()],
                    Light::Halves(halves) => {
                        halves[of_place.clone()].convert_to_f32_slice(&mut wide);
                        &wide
                    }
                };
                let factor = weight * factor;
                for (sum, own) in light.iter_mut().zip(own.as_chunks::<3>().0) {
                    *sum += factor * Vec3::from_array(*own);
                }
            }
        }
        light
    }

    /// Places of a set that count, with their weights: a file may name some that are not there.
    fn counted(&self, set: &[u32], weights: [f32; SET]) -> impl Iterator<Item = (usize, f32)> {
        let places = self.near.len();
        let each = set.iter().map(|place| *place as usize).zip(weights);
        each.filter(move |(place, weight)| *weight > 0.0 && *place < places)
    }

    /// Radiance that arrives at a point in the cell of a direction, by [`GROUPS`].
    pub fn apart(&self, position: Vec3, normal: Vec3, direction: Vec3) -> [Vec3; 3] {
        let Some(set) = self.near.set(position, normal) else { return [Vec3::ZERO; 3] };
        let (count, k) = (self.directions.len(), self.directions.nearest(direction));
        let weights = near::weights(&self.near, set, position, normal, self.look.filter);
        self.groups.each_ref().map(|group| {
            let Some((light, factor)) = group else { return Vec3::ZERO };
            let of_place = |place: usize| {
                let first = 3 * (count * place + k);
                Vec3::from_array(match light {
                    Light::Halves(halves) => std::array::from_fn(|i| halves[first + i].to_f32()),
                    Light::Floats(floats) => std::array::from_fn(|i| floats[first + i]),
                })
            };
            *factor * self.counted(set, weights).map(|(place, weight)| weight * of_place(place)).sum::<Vec3>()
        })
    }

    /// Radiance from a direction between those of the map: a mean of the nearest, by a hat over the angle that is zero where the cells next to the
    /// own end.
    pub fn toward(&self, light: &[Vec3], direction: Vec3) -> Vec3 {
        if !self.look.smooth {
            return light[self.directions.nearest(direction)];
        }
        let reach = self.directions.reach();
        let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
        for (k, light) in light.iter().enumerate() {
            let weight = (self.directions.get(k).dot(direction) - reach).max(0.0);
            sum += weight * *light;
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { light[self.directions.nearest(direction)] }
    }
}

/// A map with its light in floats: it takes twice the memory, and what halves cost can be told.
pub fn in_floats(prepared: &Prepared) -> Option<Prepared> {
    let widened = |(name, array): (String, Array)| match array {
        Array::F16(halves) if GROUPS.contains(&name.as_str()) => (name, Array::F32(halves.to_f32_vec())),
        array => (name, array),
    };
    Prepared::of_flat(prepared.flat().into_iter().map(widened).collect())
}
