//! What probes see, drawn: six square views around a place, read back.

use std::fmt;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use burnish_core::job::Handle;
use burnish_core::lighting::MethodError;
use burnish_core::lighting::classical;
use burnish_core::lighting::probe::Raster;
use burnish_core::math::cube::{self, mirrored};
use burnish_core::param::Settings;
use burnish_core::reference::{Options, World};
use burnish_core::scene::environment::{Background, resized};
use burnish_core::scene::{Camera, Environment, Mesh, Projection, Scene};
use burnish_core::surface::ggx::Masking;
use glam::{Affine3A, Mat3, UVec2, Vec2, Vec3};

use crate::{Passes, RenderError, Renderer, View};

/// Near plane over the size of the scene. Depth is reversed floating point, which loses nothing by it.
const NEAR: f32 = 1e-5;
/// Near plane of an empty scene, metres.
const NEAR_LEAST: f32 = 1e-6;

/// Maps of the sky that are remembered: those of drafts and whole probes, before and after an edit.
const SKIES: usize = 4;

/// In place of an object that is hidden.
static NOTHING: LazyLock<Arc<Mesh>> = LazyLock::new(|| Arc::new(Mesh::default()));
/// In place of an environment that is not there.
static DARK: LazyLock<Environment> = LazyLock::new(|| Environment::new("dark", 8, 4, vec![Vec3::ZERO; 32]));

/// Draws what probes see by `classical`, on a device that others draw on at the same time. The scene stays on the device: while what a
/// probe serves is dragged, its surroundings are uploaded, and their shadow maps drawn, once.
pub struct DeviceRaster {
    passes: Arc<Passes>,
    /// With the scene that was drawn last.
    renderer: Mutex<Option<Renderer>>,
    skies: Mutex<Vec<Sky>>,
}

/// A map of the environment and one that is no finer than what is drawn. Turned and scaled copies share it.
#[derive(Clone)]
struct Sky {
    texels: Arc<[Vec3]>,
    /// Of the faces.
    edge: u32,
    size: UVec2,
    coarse: Arc<[Vec3]>,
}

impl fmt::Debug for DeviceRaster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("DeviceRaster").field(&self.passes.gpu.report().name).finish()
    }
}

impl DeviceRaster {
    /// Nothing is uploaded before there is something to draw.
    pub fn new(passes: &Arc<Passes>) -> DeviceRaster {
        DeviceRaster { passes: passes.clone(), renderer: Mutex::new(None), skies: Mutex::new(Vec::new()) }
    }

    /// The environment with texels no smaller than those of faces: a sun that fell between these would be missed, or count for too much.
    fn sky(&self, map: &Environment, edge: u32) -> Environment {
        let of = |Sky { coarse, size, .. }: &Sky| Environment {
            width: size.x,
            height: size.y,
            texels: coarse.clone(),
            ..map.clone()
        };
        let skies = || self.skies.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |sky: &&Sky| Arc::ptr_eq(&sky.texels, &map.texels) && sky.edge == edge;
        if let Some(sky) = skies().iter().find(is_it) {
            return of(sky);
        }
        let (width, height) = (map.width.min(2 * edge).max(1), map.height.min(edge).max(1));
        let coarse = if (width, height) == (map.width, map.height) { map.clone() } else { resized(map, width, height) };
        let coarse = widened(&coarse, 2.0 / edge as f32).into();
        let sky = Sky { texels: map.texels.clone(), edge, size: UVec2::new(width, height), coarse };
        let found = of(&sky);
        let mut skies = skies();
        skies.insert(0, sky);
        skies.truncate(SKIES);
        found
    }
}

/// The texels of a map, toward the poles means of so many in a row that they cover `angle`, radians.
fn widened(map: &Environment, angle: f32) -> Vec<Vec3> {
    let (width, step) = (map.width as usize, std::f32::consts::TAU / map.width as f32);
    let mut texels = map.texels.to_vec();
    for (y, row) in texels.chunks_exact_mut(width).enumerate() {
        let sine = (std::f32::consts::PI * (y as f32 + 0.5) / map.height as f32).sin();
        let count = ((angle / (step * sine)).ceil() as usize).min(width);
        // An odd number lies evenly about a texel.
        let side = count / 2;
        if side == 0 {
            continue;
        }
        let old = row.to_vec();
        let around = |x: usize| (0..=2 * side).map(move |i| (x + width + i - side) % width);
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = around(x).map(|x| old[x]).sum::<Vec3>() / (2 * side + 1) as f32;
        }
    }
    texels
}

impl Raster for DeviceRaster {
    fn faces(&self, around: &World, middle: Vec3, edge: u32, job: &Handle) -> Result<Vec<Vec3>, MethodError> {
        let unfit = |error: RenderError| MethodError::Unfit(error.to_string());
        let mut scene = without_hidden(around.scene());
        let sky = Arc::new(match &scene.environment {
            Some(map) => self.sky(map, edge),
            None => Environment::clone(&DARK),
        });
        // Seen as the map itself, in full floats.
        scene.background = Background { map: Some(sky.clone()), ground: None };
        scene.environment = Some(sky);
        let scene = Arc::new(scene);
        let bounds = scene.bounds();
        let near =
            if bounds.is_empty() { NEAR_LEAST } else { (NEAR * bounds.min.distance(bounds.max)).max(NEAR_LEAST) };
        let settings = settings(around.options());
        let mut held = self.renderer.lock().unwrap_or_else(PoisonError::into_inner);
        // Taken out meanwhile: what an error leaves is not used again.
        let mut renderer = match held.take() {
            Some(mut renderer) => renderer.set_scene(&scene).map(|()| renderer),
            None => Renderer::with_passes(&self.passes, &scene),
        }
        .map_err(unfit)?;
        let mut texels = Vec::with_capacity(6 * edge as usize * edge as usize);
        for side in 0..6 {
            let view = View {
                size: UVec2::splat(edge),
                camera: camera(side, middle, near),
                settings: settings.clone(),
                jitter_frames: 1,
            };
            let picture = renderer.render_while(&view, |_| !job.is_cancelled()).map_err(unfit)?;
            let Some(picture) = picture else {
                *held = Some(renderer);
                return Err(MethodError::Cancelled);
            };
            // What is no number is left out, as a film does.
            let light = picture.texels.iter().map(|texel| texel.truncate());
            texels.extend(light.map(|light| if light.is_finite() { light } else { Vec3::ZERO }));
        }
        *held = Some(renderer);
        Ok(texels)
    }
}

/// The scene with hidden objects empty and in one place. Boxes of scenes hold hidden objects too, and shadow maps of suns follow boxes:
/// so two scenes are equal to [`Renderer::set_scene`] that differ in hidden objects alone.
fn without_hidden(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.meshes.push(NOTHING.clone());
    let empty = scene.meshes.len() - 1;
    for instance in scene.instances.iter_mut().filter(|instance| !instance.visible) {
        (instance.mesh, instance.world_from_local) = (empty, Affine3A::IDENTITY);
    }
    scene
}

/// Looked up without samples: those are noise.
fn settings(options: &Options) -> Settings {
    let mut settings = Settings::new(classical::PARAMS);
    let masking = if options.masking == Masking::Separable { "separable" } else { "correlated" };
    let scattering = if options.multiple_scattering { "on" } else { "off" };
    for (key, value) in [("samples", "0"), ("masking", masking), ("multiple-scattering", scattering)] {
        let set = settings.set(key, value);
        debug_assert!(set.is_ok(), "{key} is a setting of classical: {set:?}");
    }
    settings
}

/// Sees a face of a cube as [`cube::direction`] lays it out.
fn camera(side: u32, middle: Vec3, near: f32) -> Camera {
    let at = |x: f32, y: f32| mirrored(cube::direction(side, Vec2::new(x, y)));
    let right = (at(1.0, 0.0) - at(-1.0, 0.0)).normalize();
    let up = (at(0.0, -1.0) - at(0.0, 1.0)).normalize();
    Camera {
        name: "probe".into(),
        world_from_view: Affine3A::from_mat3_translation(Mat3::from_cols(right, up, -at(0.0, 0.0)), middle),
        projection: Projection::Perspective { yfov: std::f32::consts::FRAC_PI_2, near },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_see_the_texels_of_their_face_in_its_order() {
        for side in 0..6 {
            let camera = camera(side, Vec3::new(1.0, 2.0, 3.0), 0.1);
            assert!((camera.world_from_view.matrix3.determinant() - 1.0).abs() < 1e-5, "face {side} is not mirrored");
            for p in [Vec2::new(0.1, 0.2), Vec2::new(0.9, 0.3), Vec2::new(0.5, 0.95)] {
                let ray = camera.ray(p, 1.0);
                let wanted = mirrored(cube::direction(side, 2.0 * p - 1.0));
                assert!(ray.direction.abs_diff_eq(wanted, 1e-5), "face {side} {p}: {} {wanted}", ray.direction);
            }
        }
    }

    #[test]
    fn texels_toward_the_poles_become_wider_and_keep_their_sum() {
        let mut texels = vec![Vec3::ZERO; 128 * 64];
        for row in [0, 3, 31, 62] {
            texels[128 * row + 77] = Vec3::splat(64.0);
        }
        let map = Environment::new("bright", 128, 64, texels.clone());
        let wide = widened(&map, 2.0 / 64.0);
        for (row, (new, old)) in wide.chunks(128).zip(texels.chunks(128)).enumerate() {
            let [new_sum, old_sum] = [new, old].map(|row| row.iter().sum::<Vec3>());
            assert!(new_sum.abs_diff_eq(old_sum, 1e-2), "row {row}: {new_sum} {old_sum}");
            let sine = (std::f32::consts::PI * (row as f32 + 0.5) / 64.0).sin();
            let lit = new.iter().filter(|texel| texel.x > 0.0).count();
            let angle = lit as f32 * std::f32::consts::TAU / 128.0 * sine;
            assert!(lit == 0 || lit == 128 || angle >= 2.0 / 64.0, "row {row}: {lit} texels");
        }
        assert_eq!(wide[31 * 128..32 * 128], texels[31 * 128..32 * 128], "at the horizon they are wide enough");
    }

    #[test]
    fn settings_are_those_of_the_world() {
        let read = |options: Options| classical::FrameSettings::new(&settings(&options));
        let plain = read(Options::default());
        assert_eq!((plain.samples, plain.masking, plain.multiple_scattering), (0, Masking::Correlated, true));
        let other = read(Options { masking: Masking::Separable, multiple_scattering: false, ..Options::default() });
        assert_eq!((other.masking, other.multiple_scattering), (Masking::Separable, false));
    }
}
