//! A scene made ready for paths.

use std::sync::Arc;

use glam::{Mat3A, UVec2, Vec2, Vec3};

use super::lights::Lights;
use super::point::Triangle;
use super::sampler::PathSampler;
use super::waves::{MetalWaves, Waves};
use super::{Contribution, Options, PathSample, View, is_spectral, path};
use crate::lighting::probe::Raster;
use crate::material::preset::Preset;
use crate::material::{AlphaMode, Material, Reflectance};
use crate::math::frame::Frame;
use crate::math::sampling::{pcg, unit};
use crate::param::Settings;
use crate::scene::{Mesh, Scene};
use crate::surface::micro_normal;
use crate::trace::{Accel, Hit, Ray};

/// A scene made ready for paths.
#[derive(Clone, Debug)]
pub struct World {
    scene: Arc<Scene>,
    accel: Accel,
    lights: Lights,
    options: Options,
    /// Draws what probes see; it is not of the scene, but whoever records a probe has a world.
    raster: Option<Arc<dyn Raster>>,
    instances: Vec<Placed>,
    /// Cosine-weighted mean reflectance of the metal of each material; zero where it has none.
    fresnel_means: Vec<Vec3>,
    /// The metals at all wavelengths, by material; `None` when colours are traced.
    metals: Option<Vec<Option<Arc<MetalWaves>>>>,
    /// Some surface lets light through.
    some_cut: bool,
    /// Some surface is not there from behind.
    some_one_sided: bool,
}

/// What rays need to know of an instance.
#[derive(Clone, Copy, Debug)]
struct Placed {
    normal_from_local: Mat3A,
    /// -1 where the transform mirrors, else 1.
    mirroring: f32,
    two_sided: bool,
    cut: bool,
}

/// A surface on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighted {
    /// Metres to it.
    pub distance: f32,
    /// Its instance.
    pub instance: u32,
    /// The ray meets its back.
    pub from_behind: bool,
    /// Its back is as good as its front.
    pub two_sided: bool,
}

/// Which surfaces a ray sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sight {
    /// What is drawn: backs of one-sided surfaces are not.
    Eye,
    /// What light meets: both sides.
    Light,
}

impl World {
    /// Makes a scene ready. Its metals are traced in the forms that its materials hold.
    pub fn new(scene: &Arc<Scene>, options: Options) -> World {
        World::of_parts(scene, options, Accel::new(scene), Lights::new(scene))
    }

    /// The same for an edited scene; what is unchanged is shared.
    pub fn updated(&self, scene: &Arc<Scene>, options: Options) -> World {
        let new = World::of_parts(scene, options, self.accel.updated(scene), self.lights.updated(scene));
        new.with_raster(self.raster.clone())
    }

    /// The same with someone who draws what probes see, or nobody: then paths are traced for these too.
    #[must_use]
    pub fn with_raster(self, raster: Option<Arc<dyn Raster>>) -> World {
        World { raster, ..self }
    }

    /// Who draws what probes see.
    pub fn raster(&self) -> Option<&Arc<dyn Raster>> {
        self.raster.as_ref()
    }

    /// The world as settings made of [`super::PARAMS`] ask for it, by wavelength or not, from `old` where there is one; with
    /// the ids of metals that `metal` does not know, see [`World::by_wavelength`].
    pub fn of_settings(
        scene: &Arc<Scene>,
        settings: &Settings,
        old: Option<World>,
        metal: impl Fn(&str) -> Option<Preset>,
    ) -> (World, Vec<String>) {
        let options = Options::new(settings);
        let world = match old {
            Some(old) => old.updated(scene, options),
            None => World::new(scene, options),
        };
        if is_spectral(settings) { world.by_wavelength(metal) } else { (world, Vec::new()) }
    }

    /// The same that shows the light of these sources only.
    #[must_use]
    pub fn showing(self, contribution: Contribution) -> World {
        World { options: Options { contribution, ..self.options }, ..self }
    }

    fn of_parts(scene: &Arc<Scene>, options: Options, accel: Accel, lights: Lights) -> World {
        let placed = |instance: &crate::scene::Instance| {
            let matrix = instance.world_from_local.matrix3;
            let material = &scene.materials[instance.material];
            Placed {
                normal_from_local: matrix.inverse().transpose(),
                mirroring: if matrix.determinant() < 0.0 { -1.0 } else { 1.0 },
                two_sided: material.double_sided,
                cut: material.alpha_mode != AlphaMode::Opaque,
            }
        };
        let mean = |material: &Material| match &material.reflectance {
            Reflectance::Preset { fresnel, .. } => fresnel.mean(),
            Reflectance::BaseColor => Vec3::ZERO,
        };
        let instances: Vec<Placed> = scene.instances.iter().map(placed).collect();
        World {
            some_cut: instances.iter().any(|i| i.cut),
            some_one_sided: instances.iter().any(|i| !i.two_sided),
            fresnel_means: scene.materials.iter().map(mean).collect(),
            metals: None,
            scene: scene.clone(),
            accel,
            lights,
            options,
            raster: None,
            instances,
        }
    }

    /// The same scene traced by wavelength: metals by their n and k, colours as smooth spectra, light as that of D65 times
    /// its colour. `metal` finds presets by id; returned are the ids that it does not know, which reflect as the rescaled
    /// form of the colour of their F0.
    pub fn by_wavelength(mut self, metal: impl Fn(&str) -> Option<Preset>) -> (World, Vec<String>) {
        let mut unknown = Vec::new();
        let mut find = |material: &Material| {
            let Reflectance::Preset { id, .. } = &material.reflectance else { return None };
            let found = metal(id).map(|metal| Arc::new(MetalWaves::new(&metal)));
            if found.is_none() && !unknown.contains(id) {
                unknown.push(id.clone());
            }
            found
        };
        self.metals = Some(self.scene.materials.iter().map(&mut find).collect());
        (self, unknown)
    }

    /// The metals at all wavelengths, by material; `None` when colours are traced.
    pub(super) fn wavelengths(&self) -> Option<&[Option<Arc<MetalWaves>>]> {
        self.metals.as_deref()
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Memory of what was made of the scene, which itself is not counted: trees, densities of light, places of instances.
    pub fn bytes(&self) -> u64 {
        let instances = size_of_val(&self.instances[..]) + size_of_val(&self.fresnel_means[..]);
        (self.accel.bytes() + self.lights.bytes() + instances) as u64
    }

    /// The settings.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Follows path number `index` through a pixel, which is counted from the top left.
    pub fn sample(&self, view: &View, pixel: UVec2, index: u32) -> PathSample {
        let mut sampler = PathSampler::new(view.seed, pixel, index);
        let [x, y, z, _] = sampler.next4();
        let size = view.size.as_vec2();
        let start = view.camera.ray((pixel.as_vec2() + Vec2::new(x, y)) / size, size.x / size.y);
        self.follow(start.origin, start.direction, sampler, z)
    }

    /// Follows path number `index` from a place in a direction (world, unit), as an eye there sees it; `pixel` sets its random
    /// numbers apart from those of other directions.
    pub fn along(&self, origin: Vec3, direction: Vec3, pixel: UVec2, index: u32) -> PathSample {
        let mut sampler = PathSampler::new(0, pixel, index);
        let [_, _, z, _] = sampler.next4();
        self.follow(origin, direction, sampler, z)
    }

    /// The same with the light apart by where it comes from.
    pub fn along_apart(&self, origin: Vec3, direction: Vec3, pixel: UVec2, index: u32) -> path::Apart {
        let mut sampler = PathSampler::new(0, pixel, index);
        let [_, _, z, _] = sampler.next4();
        let waves = if self.metals.is_some() { Waves::draw(z) } else { Waves::Rgb };
        path::trace_apart(self, Ray { origin, direction, t_max: f32::INFINITY }, sampler, waves)
    }

    /// The environment is drawn from where it is bright: [`World::sky_drawn`] finds directions.
    pub fn draws_sky(&self) -> bool {
        self.lights.draws_sky()
    }

    /// A direction of the environment (world, unit), drawn with [`World::sky_density`], and its radiance; `u` in `[0, 1)^2`. `None` where there is none
    /// to be drawn, or a number falls between two.
    pub fn sky_drawn(&self, u: Vec2) -> Option<(Vec3, Vec3)> {
        self.lights.sky_drawn(u)
    }

    /// Per steradian; 0 where the environment is not drawn.
    pub fn sky_density(&self, direction: Vec3) -> f32 {
        self.lights.look(direction).1
    }

    /// Follows a path; `u` draws its wavelengths, where there are some.
    fn follow(&self, origin: Vec3, direction: Vec3, sampler: PathSampler, u: f32) -> PathSample {
        let waves = if self.metals.is_some() { Waves::draw(u) } else { Waves::Rgb };
        path::trace(self, Ray { origin, direction, t_max: f32::INFINITY }, sampler, waves)
    }

    /// Metres from a place to the nearest surface in a direction (world, unit); `None` for the sky.
    pub fn distance(&self, origin: Vec3, direction: Vec3) -> Option<f32> {
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        self.closest(&ray, Sight::Light, 0).map(|hit| hit.t)
    }

    /// The nearest surface in a direction.
    pub fn sighted(&self, origin: Vec3, direction: Vec3) -> Option<Sighted> {
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        self.closest(&ray, Sight::Light, 0).map(|hit| Sighted {
            distance: hit.t,
            instance: hit.instance,
            from_behind: Triangle::new(self, &hit).normal().dot(direction) > 0.0,
            two_sided: self.instances[hit.instance as usize].two_sided,
        })
    }

    /// The same past some instances, whose indices are in order.
    pub fn distance_past(&self, origin: Vec3, direction: Vec3, instances: &[u32]) -> Option<f32> {
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        let seen = |hit: &Hit| instances.binary_search(&hit.instance).is_err();
        let hit = self.accel.closest(&ray, |hit| seen(hit) && self.is_there(&ray, hit, Sight::Light, 0));
        hit.map(|hit| hit.t)
    }

    /// The light of the scene.
    pub(super) fn lights(&self) -> &Lights {
        &self.lights
    }

    /// The nearest surface that is seen; `salt` decides where a surface is half there.
    pub(super) fn closest(&self, ray: &Ray, sight: Sight, salt: u32) -> Option<Hit> {
        if self.some_cut || (sight == Sight::Eye && self.some_one_sided) {
            return self.accel.closest(ray, |hit| self.is_there(ray, hit, sight, salt));
        }
        self.accel.closest(ray, |_| true)
    }

    /// True when something lies on the ray.
    pub(super) fn occluded(&self, ray: &Ray, salt: u32) -> bool {
        if self.some_cut {
            return self.accel.occluded(ray, |hit| self.is_there(ray, hit, Sight::Light, salt));
        }
        self.accel.occluded(ray, |_| true)
    }

    fn is_there(&self, ray: &Ray, hit: &Hit, sight: Sight, salt: u32) -> bool {
        let placed = &self.instances[hit.instance as usize];
        let triangle = Triangle::new(self, hit);
        if sight == Sight::Eye && !placed.two_sided && triangle.normal().dot(ray.direction) > 0.0 {
            return false;
        }
        match self.material(hit.instance).alpha_mode {
            AlphaMode::Opaque => true,
            AlphaMode::Mask { cutoff } => triangle.opacity() >= cutoff,
            AlphaMode::Blend => {
                // The salt is hashed by itself: those of the rays of a path are neighbours, as are triangles.
                let chance = unit(pcg(pcg(pcg(salt) ^ hit.triangle).wrapping_add(hit.instance)));
                chance < triangle.opacity()
            }
        }
    }

    pub(super) fn mesh(&self, instance: u32) -> &Mesh {
        &self.scene.meshes[self.scene.instances[instance as usize].mesh]
    }

    pub(super) fn material(&self, instance: u32) -> &Material {
        &self.scene.materials[self.scene.instances[instance as usize].material]
    }

    pub(super) fn metal(&self, instance: u32) -> Option<&MetalWaves> {
        self.metals.as_ref()?.get(self.scene.instances[instance as usize].material)?.as_deref()
    }

    pub(super) fn fresnel_mean(&self, instance: u32) -> Vec3 {
        self.fresnel_means[self.scene.instances[instance as usize].material]
    }

    pub(super) fn normal_from_local(&self, instance: u32) -> Mat3A {
        self.instances[instance as usize].normal_from_local
    }

    pub(super) fn mirroring(&self, instance: u32) -> f32 {
        self.instances[instance as usize].mirroring
    }

    pub(super) fn is_two_sided(&self, instance: u32) -> bool {
        self.instances[instance as usize].two_sided
    }

    /// Gradient of the bumps at a point of an instance, in the world, at full detail. They lie in the frame of the object
    /// without its scale and shear.
    pub(super) fn bumps(&self, instance: u32, position: Vec3) -> Vec3 {
        let m = self.material(instance);
        let placed = &self.scene.instances[instance as usize].world_from_local;
        let axis = Vec3::from(placed.matrix3.x_axis).try_normalize().unwrap_or(Vec3::X);
        let own = Frame::with_tangent(axis, placed.matrix3.y_axis.into());
        let p = own.to_local(position - Vec3::from(placed.translation));
        own.to_world(micro_normal::eval(m.micro_normal, p, m.micro_size_mm * 1e-3, 0.0).gradient)
    }
}
