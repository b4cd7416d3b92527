//! A scene on the device with all that is made from it: tables, environment cubes, shadow maps.
//!
//! A [`Resident`] never changes. A changed scene becomes a new one that shares with the old whatever is still right, so
//! that a failure on the way leaves the old one whole.

use std::sync::{Arc, OnceLock};

use burnish_core::lighting::Prepared;
use burnish_core::lighting::probe::{self, Probes};
use burnish_core::scene::{Bounds, Environment, Scene};
use burnish_core::surface::ggx::Masking;
use burnish_core::trace::Accel;
use glam::Vec3;

use crate::error::RenderError;
use crate::pass::classical::light_group;
use crate::pass::environment::{BackgroundMap, EnvironmentMaps};
use crate::pass::shadow::Shadows;
use crate::passes::Passes;
use crate::probes::{GpuProbes, Lighting, places};
use crate::radiance_map::{GpuMap, met};
use crate::scene::{GpuScene, MaterialGroups};
use crate::tables::{TableCache, Tables};
use crate::trace::TraceTree;

/// Bytes of cubes that are kept beside those in use.
const SPARE_ENVIRONMENT_BYTES: u64 = 512 << 20;

/// Makes residents and keeps what the next may need again.
pub(crate) struct Loader {
    pub passes: Arc<Passes>,
    materials: MaterialGroups,
    tables: TableCache,
    environments: EnvironmentCache,
    quality: Quality,
}

/// How environments are prepared that were not seen before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Quality {
    /// In full, however long it takes.
    Full,
    /// Coarse at once; [`Loader::refined`] brings the rest.
    Coarse,
}

/// A scene ready to be drawn.
pub(crate) struct Resident {
    pub scene: Arc<Scene>,
    pub masking: Masking,
    pub on_gpu: GpuScene,
    pub maps: Arc<EnvironmentMaps>,
    /// The quality of the maps.
    pub quality: Quality,
    pub shadows: Shadows,
    /// What is seen where no surface is.
    pub background: BackgroundMap,
    /// Bind group 2 of what lights surfaces.
    pub lights: wgpu::BindGroup,
    /// What takes the place of the environment.
    pub lighting: Lighting,
    /// Bind group 2 of each probe.
    pub probe_groups: Vec<wgpu::BindGroup>,
    /// The baked map that lights it, and bind group 2 of that.
    pub map: Option<Mapped>,
    probes: Option<Arc<GpuProbes>>,
    /// Box around what each probe serves.
    pub served: Vec<Bounds>,
    /// Of the surroundings of each probe, made when first asked for.
    trees: OnceLock<Vec<TraceTree>>,
    bounds: Bounds,
    tables: Arc<TableBuffer>,
}

/// A baked map in a scene.
pub(crate) struct Mapped {
    pub map: Arc<GpuMap>,
    pub group: wgpu::BindGroup,
    /// The triangles that rays of smooth surfaces meet.
    tree: Arc<TraceTree>,
}

struct TableBuffer {
    floats: Vec<f32>,
    buffer: wgpu::Buffer,
}

impl Loader {
    pub fn new(passes: &Arc<Passes>, quality: Quality) -> Loader {
        Loader {
            passes: passes.clone(),
            materials: MaterialGroups::new(&passes.gpu, &passes.material_layout),
            tables: TableCache::default(),
            environments: EnvironmentCache::default(),
            quality,
        }
    }

    /// The valid scene with metals tabulated for `masking`; takes over from `before` what did not change.
    pub fn load(
        &mut self,
        scene: &Arc<Scene>,
        masking: Masking,
        lighting: &Lighting,
        before: Option<&Resident>,
    ) -> Result<Resident, RenderError> {
        let environment = scene.environment.as_ref().ok_or(RenderError::NoEnvironment)?;
        let passes = self.passes.clone();
        let gpu = &passes.gpu;
        let tables = Tables::new(&mut self.tables, scene, masking);
        let on_gpu = GpuScene::new(gpu, &mut self.materials, scene, &tables, lighting, before.map(|b| &b.on_gpu))?;
        let (maps, quality) = self.environments.get(&passes, environment, self.quality)?;
        let bounds = match before {
            Some(before) if same_places(&before.scene, scene) => before.bounds,
            _ => scene.bounds(),
        };
        let shadows = passes.shadow.build(
            gpu,
            scene,
            bounds,
            &on_gpu,
            &passes.scene_layout,
            before.map(|before| &before.shadows),
        );
        let tables = match before {
            Some(before) if before.tables.floats == tables.floats => before.tables.clone(),
            _ => Arc::new(TableBuffer {
                buffer: gpu.buffer("tables", bytemuck::cast_slice(&tables.floats), wgpu::BufferUsages::STORAGE),
                floats: tables.floats,
            }),
        };
        let probes = match (lighting.probes(), before.and_then(|before| before.probes.as_ref())) {
            (Some(prepared), Some(before)) if Arc::ptr_eq(prepared, &before.prepared) => Some(before.clone()),
            (Some(prepared), _) => Some(Arc::new(GpuProbes::new(gpu, prepared)?)),
            (None, _) => None,
        };
        let places = match &probes {
            Some(probes) => probes.places.clone(),
            None => places(gpu, Probes::of(&Prepared::nothing())),
        };
        let lights = light_group(gpu, &passes.light_layout, &maps, &shadows, (&tables.buffer, &places));
        let served = match before {
            Some(before) if before.lighting.is_like(lighting) && same_places(&before.scene, scene) => {
                before.served.clone()
            }
            _ => lighting.probes().map_or_else(Vec::new, |prepared| served(scene, prepared)),
        };
        let each = probes.iter().flat_map(|probes| &probes.each);
        let group = |probe| passes.probe.group(gpu, probe, &places, &tables.buffer);
        let probe_groups = each.map(group).collect();
        let map = match lighting.map() {
            None => None,
            Some(prepared) => {
                let old = before.and_then(|before| Some((before.map.as_ref()?, &*before.scene)));
                Some(mapped(&passes, scene, prepared, old, (&maps, &shadows, &tables.buffer))?)
            }
        };
        let seen = before.map(|before| &before.background);
        let background = BackgroundMap::new(gpu, &passes.background_layout, scene, seen)?;
        gpu.check()?;
        Ok(Resident {
            scene: scene.clone(),
            masking,
            on_gpu,
            maps,
            quality,
            shadows,
            background,
            lights,
            lighting: lighting.clone(),
            probe_groups,
            map,
            probes,
            served,
            trees: OnceLock::new(),
            bounds,
            tables,
        })
    }

    /// Takes over cubes that were prepared in full for an environment; scenes loaded from now on have them.
    pub fn refined(&mut self, environment: &Environment, maps: EnvironmentMaps) {
        self.environments.insert(environment, Arc::new(maps), Quality::Full);
    }
}

impl Resident {
    /// The triangles around each probe, without what it serves; none where they do not fit the device.
    pub fn trees(&self, passes: &Passes) -> &[TraceTree] {
        self.trees.get_or_init(|| {
            let Some(prepared) = self.lighting.probes() else { return Vec::new() };
            let tree = |maps: &Prepared| {
                let around = probe::surroundings(&self.scene, maps.whole("served"));
                TraceTree::new(&passes.gpu, &Accel::new(&around))
            };
            prepared.parts().iter().map(tree).collect::<Result<_, _>>().unwrap_or_default()
        })
    }

    /// It is of this very scene, lit like this.
    pub fn is_of(&self, scene: &Arc<Scene>, masking: Masking, lighting: &Lighting) -> bool {
        Arc::ptr_eq(&self.scene, scene) && self.masking == masking && self.lighting.is_like(lighting)
    }
}

/// A map in a scene; takes over from before what is still right.
fn mapped(
    passes: &Passes,
    scene: &Scene,
    prepared: &Arc<Prepared>,
    before: Option<(&Mapped, &Scene)>,
    around: (&EnvironmentMaps, &Shadows, &wgpu::Buffer),
) -> Result<Mapped, RenderError> {
    let gpu = &passes.gpu;
    let map = match before {
        Some((old, _)) if Arc::ptr_eq(&old.map.prepared, prepared) => old.map.clone(),
        _ => Arc::new(GpuMap::new(gpu, prepared)?),
    };
    let visible = |scene: &Scene| scene.instances.iter().map(|instance| instance.visible).collect::<Vec<_>>();
    let tree = match before {
        Some((old, of)) if same_places(of, scene) && visible(of) == visible(scene) => old.tree.clone(),
        _ => Arc::new(TraceTree::new(gpu, &Accel::new(&probe::surroundings(scene, &[])))?),
    };
    let group = passes.radiance_map.group(gpu, &map, &met(gpu, scene), tree.buffer(), around);
    Ok(Mapped { map, group, tree })
}

/// Boxes around what probes serve.
fn served(scene: &Scene, prepared: &Prepared) -> Vec<Bounds> {
    let of = |maps: &Prepared| {
        let served: Vec<usize> = maps.whole("served").iter().map(|i| *i as usize).collect();
        scene.bounds_of(&served)
    };
    prepared.parts().iter().map(of).collect()
}

/// True when every instance is where it was: the bounds stay.
fn same_places(a: &Scene, b: &Scene) -> bool {
    let same_meshes =
        a.meshes.len() == b.meshes.len() && a.meshes.iter().zip(&b.meshes).all(|(a, b)| Arc::ptr_eq(a, b));
    same_meshes
        && a.instances.len() == b.instances.len()
        && a.instances
            .iter()
            .zip(&b.instances)
            .all(|(a, b)| (a.mesh, a.world_from_local) == (b.mesh, b.world_from_local))
}

/// Prepared environments, the last used first. Turned and scaled copies of one map share its cubes.
#[derive(Default)]
struct EnvironmentCache {
    known: Vec<Cubes>,
}

struct Cubes {
    texels: Arc<[Vec3]>,
    width: u32,
    maps: Arc<EnvironmentMaps>,
    quality: Quality,
}

impl EnvironmentCache {
    fn get(
        &mut self,
        passes: &Passes,
        environment: &Environment,
        quality: Quality,
    ) -> Result<(Arc<EnvironmentMaps>, Quality), RenderError> {
        let known = self.known.iter().find(|prepared| prepared.is_of(environment));
        let (maps, quality) = match (known, quality) {
            (Some(prepared), _) => (prepared.maps.clone(), prepared.quality),
            (None, Quality::Full) => (Arc::new(passes.environment.build(&passes.gpu, environment)?), quality),
            (None, Quality::Coarse) => (Arc::new(passes.environment.coarse(&passes.gpu, environment)?), quality),
        };
        self.insert(environment, maps.clone(), quality);
        Ok((maps, quality))
    }

    /// Puts it first, in the place of what there was of this map, and forgets what is too much.
    fn insert(&mut self, environment: &Environment, maps: Arc<EnvironmentMaps>, quality: Quality) {
        self.known.retain(|prepared| !prepared.is_of(environment));
        let Environment { texels, width, .. } = environment;
        self.known.insert(0, Cubes { texels: texels.clone(), width: *width, maps, quality });
        let mut spare = 0;
        let kept = self.known.iter().skip(1).take_while(|prepared| {
            spare += bytes(&prepared.maps);
            spare <= SPARE_ENVIRONMENT_BYTES
        });
        let kept = 1 + kept.count();
        self.known.truncate(kept);
    }
}

impl Cubes {
    fn is_of(&self, environment: &Environment) -> bool {
        Arc::ptr_eq(&self.texels, &environment.texels) && self.width == environment.width
    }
}

/// Bytes of the cubes on the device.
fn bytes(maps: &EnvironmentMaps) -> u64 {
    let cube = |texture: &wgpu::Texture| {
        let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(8));
        let face = u64::from(texture.width()).pow(2);
        // All mips together are a third of the largest.
        let levels = if texture.mip_level_count() > 1 { face + face / 3 } else { face };
        6 * texel * levels
    };
    [&maps.radiance, &maps.prefiltered, &maps.dimmed, &maps.irradiance].into_iter().map(cube).sum()
}
