//! The one float buffer that leaves look things up in: GGX albedo, cosines of area lights, spectral Fresnel tables, split-sum tables.

use std::sync::Arc;

use burnish_core::lighting::{area, classical};
use burnish_core::material::Reflectance;
use burnish_core::scene::Scene;
use burnish_core::surface::fresnel::Fresnel;
use burnish_core::surface::ggx::Masking;
use burnish_core::surface::ggx::albedo::AlbedoTable;
use glam::Vec3;

/// Curves that no material uses at the moment and whose tables are kept: a preset is often tried and taken back.
const SPARE_CURVES: usize = 32;

/// Where a material's metal finds its curve, as [`crate::layout::types::MaterialData`] stores it.
#[derive(Clone, Copy, Debug)]
pub struct Metal {
    pub form: u32,
    /// F0 and the coefficients c0 to c3 of the form.
    pub numbers: [Vec3; 5],
    pub mean: Vec3,
    /// First float of the spectral table.
    pub table: u32,
    /// First float of the split-sum table, 0 for curves that need none.
    pub albedo_table: u32,
}

/// The floats, and the entries of the scene's materials.
pub struct Tables {
    pub floats: Vec<f32>,
    metals: Vec<Metal>,
}

/// Split-sum tables of the curves seen lately, the last used first.
#[derive(Default)]
pub struct TableCache {
    known: Vec<(Arc<Fresnel>, Masking, Arc<[f32]>)>,
}

impl Tables {
    /// Joins the tables of all materials; presets that share a curve share its tables.
    pub fn new(cache: &mut TableCache, scene: &Scene, masking: Masking) -> Tables {
        // The shader finds the cosines behind the albedo tables.
        let mut floats = [AlbedoTable::get().flat(), area::table()].concat();
        let mut seen: Vec<(&Arc<Fresnel>, Metal)> = Vec::new();
        let mut metals = Vec::with_capacity(scene.materials.len());
        for material in &scene.materials {
            let Reflectance::Preset { fresnel, .. } = &material.reflectance else {
                metals.push(Metal::of_base_color(material.base_color));
                continue;
            };
            let found = seen.iter().find(|(other, _)| same(other, fresnel));
            let metal = match found {
                Some((_, metal)) => *metal,
                None => Metal::new(fresnel, masking, &mut floats, cache),
            };
            seen.push((fresnel, metal));
            metals.push(metal);
        }
        cache.known.truncate(seen.len() + SPARE_CURVES);
        Tables { floats, metals }
    }

    /// The entry of a material by its index; white where there is none.
    pub fn fresnel(&self, index: usize) -> Metal {
        self.metals.get(index).copied().unwrap_or(Metal::of_base_color(Vec3::ONE))
    }
}

fn same(a: &Arc<Fresnel>, b: &Arc<Fresnel>) -> bool {
    Arc::ptr_eq(a, b) || a == b
}

impl TableCache {
    fn mean_table(&mut self, fresnel: &Arc<Fresnel>, masking: Masking) -> Arc<[f32]> {
        let place = self.known.iter().position(|(other, of, _)| *of == masking && same(other, fresnel));
        let entry = match place {
            Some(place) => self.known.remove(place),
            None => (fresnel.clone(), masking, classical::mean_fresnel_table(fresnel, masking).into()),
        };
        let table = entry.2.clone();
        self.known.insert(0, entry);
        table
    }
}

impl Metal {
    fn of_base_color(f0: Vec3) -> Metal {
        let fresnel = Fresnel::Rescaled { f0 };
        Metal::closed(&fresnel)
    }

    /// An entry without tables.
    fn closed(fresnel: &Fresnel) -> Metal {
        let (form, numbers, mean) = (fresnel.form(), fresnel.coefficients(), fresnel.mean());
        Metal { form, numbers, mean, table: 0, albedo_table: 0 }
    }

    fn new(fresnel: &Arc<Fresnel>, masking: Masking, floats: &mut Vec<f32>, cache: &mut TableCache) -> Metal {
        let mut metal = Metal::closed(fresnel);
        match &**fresnel {
            Fresnel::Rescaled { .. } | Fresnel::Schlick { .. } => return metal,
            Fresnel::Spectral { table } => {
                metal.table = floats.len() as u32;
                floats.extend(table.iter().flat_map(|c| c.to_array()));
            }
            _ => {}
        }
        metal.albedo_table = floats.len() as u32;
        floats.extend(cache.mean_table(fresnel, masking).iter());
        metal
    }
}
