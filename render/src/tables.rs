//! The one float buffer that leaves look things up in: GGX albedo, spectral Fresnel tables, split-sum tables.

use std::sync::Arc;

use burnish_core::lighting::classical;
use burnish_core::material::Reflectance;
use burnish_core::scene::Scene;
use burnish_core::surface::fresnel::Fresnel;
use burnish_core::surface::ggx::Masking;
use burnish_core::surface::ggx::albedo::AlbedoTable;
use glam::Vec3;

/// Where a material's metal finds its curve, as [`crate::layout::types::MaterialData`] stores it.
#[derive(Clone, Copy, Debug)]
pub struct Metal {
    pub form: u32,
    pub f0: Vec3,
    pub n: Vec3,
    pub k: Vec3,
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

impl Tables {
    /// Builds the tables of all materials; presets that share a curve share its tables.
    pub fn new(scene: &Scene, masking: Masking) -> Tables {
        let mut floats = AlbedoTable::get().flat().to_vec();
        let mut known: Vec<(Arc<Fresnel>, Metal)> = Vec::new();
        let mut metals = Vec::with_capacity(scene.materials.len());
        for material in &scene.materials {
            let Reflectance::Preset { fresnel, .. } = &material.reflectance else {
                metals.push(Metal::of_base_color(material.base_color));
                continue;
            };
            let found = known.iter().find(|(seen, _)| Arc::ptr_eq(seen, fresnel) || seen == fresnel);
            let metal = found.map(|(_, metal)| *metal).unwrap_or_else(|| Metal::new(fresnel, masking, &mut floats));
            known.push((fresnel.clone(), metal));
            metals.push(metal);
        }
        Tables { floats, metals }
    }

    /// The entry of a material by its index; white where there is none.
    pub fn fresnel(&self, index: usize) -> Metal {
        self.metals.get(index).copied().unwrap_or(Metal::of_base_color(Vec3::ONE))
    }
}

impl Metal {
    fn of_base_color(f0: Vec3) -> Metal {
        let fresnel = Fresnel::Rescaled { f0 };
        Metal { form: fresnel.form(), f0, n: Vec3::ONE, k: Vec3::ZERO, mean: fresnel.mean(), table: 0, albedo_table: 0 }
    }

    fn new(fresnel: &Fresnel, masking: Masking, floats: &mut Vec<f32>) -> Metal {
        let mut metal = Metal { form: fresnel.form(), mean: fresnel.mean(), ..Metal::of_base_color(fresnel.f0()) };
        match fresnel {
            Fresnel::Rescaled { .. } | Fresnel::Schlick { .. } => return metal,
            Fresnel::Conductor { n, k } => {
                metal.n = *n;
                metal.k = *k;
            }
            Fresnel::Spectral { table } => {
                metal.table = floats.len() as u32;
                floats.extend(table.iter().flat_map(|c| c.to_array()));
            }
        }
        metal.albedo_table = floats.len() as u32;
        floats.extend(classical::mean_fresnel_table(fresnel, masking));
        metal
    }
}
