//! Probes: what is seen from a place beside or inside the objects that it serves, which are left out of it: their
//! surroundings' light, and how far away they are.
//!
//! [`Sites`] says where the probes of a scene stand, [`prepare`] records what is seen from them, [`Probes`] finds those that
//! know the surroundings of a point, with weights that change without a seam.

mod behind;
mod bounds;
mod distances;
mod raster;
pub(super) mod seen;
mod sites;
#[cfg(test)]
mod tests;
mod trace;
mod warnings;
mod weight;

use glam::Vec3;

use crate::leaf::Leaf;
use crate::lighting::{Prepared, impostor::Extent};
use crate::math;
use crate::reference::SurfacePoint;

pub use behind::{Behind, behind};
pub use bounds::{Cells, bounds};
pub use distances::{DistanceCube, JUMP};
pub use raster::Raster;
pub use seen::surroundings;
pub use sites::{Defaults, MOST, Site, Sites};
pub use trace::{Surroundings, prepare};
pub use warnings::warnings;
pub use weight::{BLEND, FADE, Place, weights};

/// The WGSL twin of weights and distances. The pass supplies `probe_place`, where a probe stands and half its box, and
/// `probe_inverse_depth`, a texel of a [`DistanceCube`].
pub static WGSL: Leaf = Leaf {
    name: "probe",
    source: include_str!("probe.wgsl"),
    needs: &[&math::WGSL],
    externs: "fn probe_place(index: u32) -> ProbePlace { return ProbePlace(vec3f(0.0), vec3f(1.0)); }
fn probe_inverse_depth(side: u32, x: u32, y: u32) -> f32 { return 1.0; }",
};

/// A share of the light that is more than what sums of weights are rounded by.
const UNKNOWN: f32 = 1e-4;

/// The probes that were prepared.
#[derive(Clone, Copy, Debug)]
pub struct Probes<'a> {
    prepared: &'a Prepared,
}

/// One that was prepared.
#[derive(Clone, Copy, Debug)]
pub struct Probe<'a> {
    /// Its maps, as [`PreparedMaps::unturned`](crate::lighting::classical::PreparedMaps::unturned) takes them.
    pub maps: &'a Prepared,
    /// Where it stands, metres.
    pub middle: Vec3,
    /// What its distances say as a whole.
    pub extent: Extent,
    /// How far the surroundings are.
    pub distances: DistanceCube<'a>,
}

impl<'a> Probe<'a> {
    fn of(maps: &'a Prepared) -> Option<Probe<'a>> {
        let [near, far, radius] = maps.vector("probe", 1).to_array();
        let [low, high] = [2, 3].map(|i| maps.vector("probe", i));
        Some(Probe {
            maps,
            middle: maps.vector("probe", 0),
            extent: Extent { near, far, radius, low, high },
            distances: DistanceCube::new(*maps.whole("face").first()?, maps.floats("distances"), maps.floats("bounds")),
        })
    }

    /// Its second layer, where it was recorded: what lies behind the surfaces that it sees, and their light where nothing does.
    pub fn behind(&self) -> Option<Probe<'a>> {
        Probe::of(self.maps.parts().first()?)
    }
}

impl<'a> Probes<'a> {
    /// Those of a preparation, none where it has none.
    pub fn of(prepared: &'a Prepared) -> Probes<'a> {
        Probes { prepared }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.prepared.parts().len()
    }

    /// There are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One by its number.
    pub fn get(&self, index: usize) -> Option<Probe<'a>> {
        Probe::of(self.prepared.parts().get(index)?)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Probe<'a>> + use<'a> {
        let all = *self;
        (0..all.len()).filter_map(move |index| all.get(index))
    }

    /// True when a probe serves an instance.
    pub fn serves(&self, index: usize, instance: u32) -> bool {
        self.prepared.parts().get(index).is_some_and(|maps| maps.whole("served").binary_search(&instance).is_ok())
    }

    /// Where they stand and how far they serve, in order.
    pub fn places(&self) -> impl Iterator<Item = Place> + use<'a> {
        let box_of = |maps: &Prepared| Place { middle: maps.vector("probe", 0), half: maps.vector("probe", 4) };
        self.prepared.parts().iter().map(box_of)
    }

    /// Sums over the probes that know the surroundings of a point what `of` makes of each, from the point relative to its middle;
    /// what none knows is the environment. Probes for which it has nothing count as unknown.
    pub fn shaded(
        &self,
        point: &SurfacePoint<'_>,
        random: [f32; 4],
        of: impl Fn(&Probe<'a>, Vec3) -> Option<Vec3>,
    ) -> Vec3 {
        let (mut sum, mut left) = (Vec3::ZERO, 1.0);
        for (probe, weight) in self.about(point.instance(), point.position()) {
            let Some(light) = of(&probe, point.position() - probe.middle) else { continue };
            sum += weight * light;
            left -= weight;
        }
        if left > UNKNOWN { sum + left * point.environment([random, random]) } else { sum }
    }

    /// The probes that know the surroundings of a point of an instance, with their weights, which sum to 1 or, at the rim
    /// of the boxes in which probes serve, less.
    pub fn about(&self, instance: u32, position: Vec3) -> Vec<(Probe<'a>, f32)> {
        let serving: Vec<(usize, Place)> =
            self.places().enumerate().filter(|(index, _)| self.serves(*index, instance)).collect();
        let places: Vec<Place> = serving.iter().map(|(_, place)| *place).collect();
        let weighed = serving.iter().zip(weights(&places, position)).filter(|(_, weight)| *weight > 0.0);
        weighed.filter_map(|((index, _), weight)| Some((self.get(*index)?, weight))).collect()
    }
}
