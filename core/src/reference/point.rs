//! A point of a surface with its textures looked up: the CPU side of what the G-buffer holds, at full detail.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::texture::{Coordinates, between, lookup};
use super::waves::Waves;
use super::world::World;
use crate::material::{Looked, Material, Reflectance};
use crate::math::frame::Frame;
use crate::surface::fresnel::{Fresnel, schlick_mean};
use crate::surface::layered::{Lobe, Surface};
use crate::surface::micro_normal;
use crate::trace::{Hit, rounding};

/// A point that a ray met.
#[derive(Clone, Debug)]
pub(super) struct Point<'a> {
    /// World, metres.
    pub position: Vec3,
    /// How far rounding may have moved it, see [`rounding`].
    pub rounding: Vec3,
    /// Normal of the triangle on the side that is looked at, unit.
    pub geometric: Vec3,
    /// Seen from the side on which corners run counter-clockwise.
    pub front: bool,
    /// Frame of the base, x along the axis of anisotropy.
    pub base: Frame,
    /// Frame of the coat.
    pub coat: Frame,
    /// Radiance that it gives off toward the eye.
    pub emission: Vec3,
    /// Index into `Scene::materials`.
    pub material: u32,
    /// Without the reflectance curve of a metal that has none of its own.
    parts: Parts<'a>,
}

/// What [`Point::surface`] is made of.
#[derive(Clone, Debug)]
struct Parts<'a> {
    base_color: Vec3,
    metallic: f32,
    alpha: Vec2,
    lobe: Lobe,
    /// Curve of the material's metal and its mean, unless `own` takes its place.
    preset: Option<(&'a Fresnel, Vec3)>,
    /// Curve by the base colour, or of the metal at the wavelengths of the path.
    own: (Fresnel, Vec3),
    dielectric_f0: Vec3,
    dielectric_f90: f32,
    coat: f32,
    coat_alpha: f32,
}

/// The triangle of a hit.
pub(super) struct Triangle<'a> {
    world: &'a World,
    hit: &'a Hit,
    corners: [usize; 3],
    weights: Vec3,
}

impl<'a> Triangle<'a> {
    pub(super) fn new(world: &'a World, hit: &'a Hit) -> Triangle<'a> {
        let mesh = world.mesh(hit.instance);
        let first = 3 * hit.triangle as usize;
        let corners = [0, 1, 2].map(|i| mesh.indices[first + i] as usize);
        let weights = Vec3::new(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x, hit.barycentric.y);
        Triangle { world, hit, corners, weights }
    }

    /// Of its textures.
    pub(super) fn coordinates(&self) -> Coordinates {
        Coordinates::new(self.world.mesh(self.hit.instance), self.corners, self.weights)
    }

    fn color(&self) -> Vec4 {
        let mesh = self.world.mesh(self.hit.instance);
        between(&mesh.colors, self.corners, self.weights).unwrap_or(Vec4::ONE)
    }

    /// Normal on the counter-clockwise side, world, unit; zero for a triangle without area.
    pub(super) fn normal(&self) -> Vec3 {
        let mesh = self.world.mesh(self.hit.instance);
        let [a, b, c] = self.corners.map(|corner| mesh.positions[corner]);
        let local = (b - a).cross(c - a);
        (self.world.normal_from_local(self.hit.instance) * local.normalize_or_zero()).normalize_or_zero()
    }

    /// Share of the light that the surface holds back, 0 to 1, before the alpha mode.
    pub(super) fn opacity(&self) -> f32 {
        let world = self.world;
        let material = world.material(self.hit.instance);
        let texel = lookup(world.scene(), material.base_color_texture, &self.coordinates(), true);
        (material.opacity * texel.map_or(1.0, |t| t.w) * self.color().w).clamp(0.0, 1.0)
    }
}

impl<'a> Point<'a> {
    /// The point of a hit, seen from `to_viewer` (unit), in the colours of a path.
    pub(super) fn new(world: &'a World, hit: &'a Hit, to_viewer: Vec3, waves: Waves) -> Point<'a> {
        let triangle = Triangle::new(world, hit);
        let scene = world.scene();
        let mesh = world.mesh(hit.instance);
        let instance = &scene.instances[hit.instance as usize];
        let m = world.material(hit.instance);
        let (corners, weights) = (triangle.corners, triangle.weights);

        let [a, b, c] = corners.map(|corner| instance.world_from_local.transform_point3(mesh.positions[corner]));
        let position = a * weights.x + b * weights.y + c * weights.z;
        let rounding = rounding(&instance.world_from_local, corners.map(|corner| mesh.positions[corner]));
        let outward = triangle.normal();
        let front = outward.dot(to_viewer) >= 0.0;
        let side = if front { 1.0 } else { -1.0 };
        let geometric = side * outward;

        let normals = world.normal_from_local(hit.instance);
        let smooth = between(&mesh.normals, corners, weights).unwrap_or(Vec3::ZERO);
        let n = (normals * smooth).try_normalize().unwrap_or(outward);
        let tangent = between(&mesh.tangents, corners, weights).unwrap_or(Vec4::X);
        let along = instance.world_from_local.transform_vector3(tangent.xyz());
        let frame = Frame::with_tangent(n, along);
        let handed = Frame {
            b: frame.b * mesh.tangents.get(corners[0]).map_or(1.0, |t| t.w) * world.mirroring(hit.instance),
            ..frame
        };

        let at = triangle.coordinates();
        let look = |texture, color| lookup(scene, texture, &at, color);
        let mut normal = side * perturbed(look(m.normal_texture, false), m.normal_scale, &handed);
        let coat_normal = side * perturbed(look(m.coat_normal_texture, false), m.coat_normal_scale, &handed);
        if m.micro_normal != micro_normal::Kind::None {
            let gradient = world.bumps(hit.instance, position);
            normal = micro_normal::bent(normal, geometric, side * m.micro_depth * gradient);
        }

        let axis = anisotropy_axis(m, look(m.anisotropy_texture, false));
        let base = Frame::with_tangent(normal, handed.t * axis.x + handed.b * axis.y);
        let parts = Parts::new(world, &triangle, m, &at, waves);
        let texel = look(m.emission_texture, true).map_or(Vec3::ONE, Vec4::xyz);
        let mut point = Point {
            position,
            rounding,
            geometric,
            front,
            base,
            coat: Frame::new(coat_normal),
            emission: waves.of_rgb(m.emission * texel),
            material: instance.material as u32,
            parts,
        };
        if m.unlit {
            point.emission = point.parts.base_color;
            point.parts.make_black();
        }
        point
    }

    /// What is evaluated there.
    pub(super) fn surface(&self, world: &World) -> Surface<'_> {
        let Parts { base_color, metallic, alpha, lobe, preset, own, dielectric_f0, dielectric_f90, coat, coat_alpha } =
            &self.parts;
        let options = world.options();
        let (fresnel, fresnel_mean) = preset.unwrap_or((&own.0, own.1));
        Surface {
            base_color: *base_color,
            metallic: *metallic,
            alpha: *alpha,
            lobe: *lobe,
            fresnel,
            fresnel_mean,
            dielectric_f0: *dielectric_f0,
            dielectric_f90: *dielectric_f90,
            coat: *coat,
            coat_alpha: *coat_alpha,
            masking: options.masking,
            multiple_scattering: options.multiple_scattering,
        }
    }
}

impl<'a> Parts<'a> {
    fn new(world: &'a World, triangle: &Triangle, m: &'a Material, at: &Coordinates, waves: Waves) -> Parts<'a> {
        let look = |texture, color| lookup(world.scene(), texture, at, color).unwrap_or(Vec4::ONE);
        let Looked { color, metallic, alpha, dielectric_f0, dielectric_f90, coat, coat_alpha } =
            Looked::new(m, triangle.color().xyz(), look);
        // An unlit surface shows its colour as it is.
        let base_color = waves.of_rgb(if m.unlit { color } else { color.clamp(Vec3::ZERO, Vec3::ONE) });
        let rescaled = |f0| (Fresnel::Rescaled { f0 }, schlick_mean(f0, 1.0));
        let mut own = rescaled(base_color);
        let metal = world.metal(triangle.hit.instance);
        let preset = match (&m.reflectance, metal, waves) {
            (Reflectance::BaseColor, ..) => None,
            (Reflectance::Preset { .. }, Some(metal), Waves::Three(places)) => {
                own = metal.at(places);
                None
            }
            (Reflectance::Preset { fresnel, .. }, None, Waves::Three(_)) => {
                own = rescaled(waves.of_rgb(fresnel.f0()));
                None
            }
            (Reflectance::Preset { fresnel, .. }, ..) => Some((&**fresnel, world.fresnel_mean(triangle.hit.instance))),
        };
        Parts {
            base_color,
            metallic,
            alpha,
            lobe: m.lobe(),
            preset,
            own,
            dielectric_f0: waves.of_rgb(dielectric_f0),
            dielectric_f90,
            coat,
            coat_alpha,
        }
    }

    /// Reflects nothing.
    fn make_black(&mut self) {
        self.base_color = Vec3::ZERO;
        self.metallic = 0.0;
        self.preset = None;
        self.dielectric_f0 = Vec3::ZERO;
        self.dielectric_f90 = 0.0;
        self.coat = 0.0;
    }
}

/// The direction of the brushing in tangent space: that of the texture, turned by the material's angle.
fn anisotropy_axis(m: &Material, texel: Option<Vec4>) -> Vec2 {
    let direction = texel.map_or(Vec2::X, |t| 2.0 * t.xy() - 1.0);
    Vec2::from_angle(m.anisotropy_rotation).rotate(direction)
}

/// A normal of a texture in the world.
fn perturbed(texel: Option<Vec4>, scale: f32, frame: &Frame) -> Vec3 {
    let Some(texel) = texel else { return frame.n };
    let local = 2.0 * texel.xyz() - 1.0;
    let bent = frame.t * (local.x * scale) + frame.b * (local.y * scale) + frame.n * local.z;
    bent.try_normalize().unwrap_or(frame.n)
}
