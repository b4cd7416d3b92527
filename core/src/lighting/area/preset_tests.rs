//! Lights of the presets on the workbench, unshadowed: cosines against integrals at the points that the camera sees.

use std::f32::consts::TAU;
use std::sync::Arc;

use glam::{DVec3, UVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::{Shape, light, response};
use crate::document::{LightingPreset, shining};
use crate::math::frame::Frame;
use crate::math::sampling;
use crate::reference::{Eye, Options, SurfacePoint, View, World};
use crate::scene::{Environment, Scene, gallery};
use crate::surface::layered::Lobe;

/// Mean |a - b| over mean b of the subject, for all lights of a preset together.
const TOGETHER: f64 = 0.03;
/// The same of those that are over it, with the reasons in the page.
const OVER: [(&str, f64); 5] =
    [("rim", 0.053), ("strip-pair", 0.044), ("car-gallery", 0.036), ("top-softbox", 0.033), ("overcast", 0.032)];
/// Size of the picture whose points are compared: some 800 on the subject.
const SIZE: UVec2 = UVec2::new(80, 48);
/// Directions of each kind at a point.
const DIRECTIONS: u32 = 256;

fn workbench(preset: &LightingPreset, roughness: f32) -> Scene {
    let mut scene = gallery::open(&format!("workbench?room=none&roughness={roughness}")).unwrap();
    scene.environment = Some(Arc::new(Environment::new("black", 8, 4, vec![Vec3::ZERO; 32])));
    scene.lights = shining(&preset.lights_around(scene.subject_bounds()), &[]);
    scene
}

/// As the methods see it: a shading normal may look away from the viewer.
fn facing(wo: Vec3) -> Vec3 {
    Vec3::new(wo.x, wo.y, wo.z.max(1e-3)).normalize()
}

fn by_cosines(point: &SurfacePoint<'_>, shape: &Shape) -> Vec3 {
    let [wo, coat_wo] = [point.base(), point.coat()].map(|frame| facing(frame.to_local(point.to_viewer())));
    let [base, coat] = [point.base(), point.coat()].map(|frame| shape.local(frame));
    response(&point.surface(), wo, &base, coat_wo, &coat, true)
}

/// A direction to a shape.
fn toward(shape: &Shape, u: Vec2) -> Vec3 {
    match *shape {
        Shape::Rectangle { center, across, up } => {
            (center + across * (2.0 * u.x - 1.0) + up * (2.0 * u.y - 1.0)).normalize()
        }
        Shape::Cap { axis, sine } => {
            let cosine = 1.0 - u.x * (1.0 - (1.0 - sine * sine).sqrt());
            let around = Vec2::from_angle(TAU * u.y) * (1.0 - cosine * cosine).max(0.0).sqrt();
            Frame::new(axis).to_world(around.extend(cosine))
        }
        Shape::Everywhere => unreachable!("no light of a preset is around the subject"),
    }
}

/// Its density per steradian; 0 beside the shape.
fn density(shape: &Shape, wi: Vec3) -> f32 {
    match *shape {
        Shape::Rectangle { center, across, up } => {
            let normal = across.cross(up).normalize();
            let t = center.dot(normal) / wi.dot(normal);
            let at = wi * t - center;
            let inside = at.dot(across).abs() <= across.length_squared() && at.dot(up).abs() <= up.length_squared();
            let area = 4.0 * across.length() * up.length();
            if t > 0.0 && inside { t * t / (wi.dot(normal).abs() * area) } else { 0.0 }
        }
        // 1 - cos by the sine keeps the digits of small suns.
        Shape::Cap { axis, sine } => {
            let rise = sine * sine / (1.0 + (1.0 - sine * sine).sqrt());
            let inside = (wi - axis).length_squared() <= 2.0 * rise * (1.0 + 1e-5);
            if inside { 1.0 / (TAU * rise) } else { 0.0 }
        }
        Shape::Everywhere => 0.5 / TAU,
    }
}

/// Directions drawn from the light, from the lobe of the base and from that of the coat, by the balance heuristic
/// (Veach 1997, eq. 9.8).
fn by_integral(point: &SurfacePoint<'_>, shape: &Shape) -> Vec3 {
    let s = point.surface();
    let coat_alpha = Vec2::splat(s.coat_alpha);
    let lobes = [(s.lobe, point.base(), s.alpha, 1.0), (Lobe::Ggx, point.coat(), coat_alpha, s.coat.min(1.0).ceil())];
    let local = lobes.map(|(_, frame, ..)| facing(frame.to_local(point.to_viewer())));
    let term = |wi: Vec3| {
        let of_light = density(shape, wi);
        if of_light <= 0.0 {
            return DVec3::ZERO;
        }
        let of_lobe = |i: usize| {
            let (lobe, frame, alpha, used) = lobes[i];
            if used > 0.0 { lobe.pdf(local[i], frame.to_local(wi), alpha) } else { 0.0 }
        };
        (point.response(wi) / (of_light + of_lobe(0) + of_lobe(1))).as_dvec3()
    };
    let mut sum = DVec3::ZERO;
    for i in 0..DIRECTIONS {
        let u = sampling::hammersley(i, DIRECTIONS);
        sum += term(toward(shape, u));
        for (k, (lobe, frame, alpha, used)) in lobes.into_iter().enumerate() {
            if used > 0.0 {
                sum += lobe.sample_wi(local[k], alpha, u).map_or(DVec3::ZERO, |wi| term(frame.to_world(wi)));
            }
        }
    }
    (sum / f64::from(DIRECTIONS)).as_vec3()
}

/// Sums over points.
#[derive(Clone, Copy, Default)]
struct Sums {
    apart: f64,
    signed: f64,
    exact: f64,
}

impl Sums {
    fn add(&mut self, ours: Vec3, exact: Vec3) {
        let sum = |v: Vec3| f64::from(v.element_sum());
        self.apart += sum((ours - exact).abs());
        self.signed += sum(ours - exact);
        self.exact += sum(exact);
    }

    fn difference(&self) -> f64 {
        self.apart / self.exact
    }
}

/// For all lights together, for each of them, and for each instance of the scene.
fn measured(scene: Scene) -> (Sums, Vec<Sums>, Vec<Sums>) {
    let world = World::new(&Arc::new(scene), Options::default());
    let scene = world.scene();
    let view = View { camera: scene.cameras[0].clone(), size: SIZE, seed: 1 };
    let values = |pixel: UVec2| {
        let eye = Eye::new(&world, &view, pixel, 0);
        let point = eye.point().filter(|point| scene.subject.contains(&(point.instance() as usize)))?;
        let of = |light| match light::shape(light, point.position()) {
            Some((shape, radiance)) => (radiance * by_cosines(&point, &shape), radiance * by_integral(&point, &shape)),
            None => (Vec3::ZERO, Vec3::ZERO),
        };
        Some((point.instance() as usize, scene.lights.iter().map(of).collect::<Vec<_>>()))
    };
    let pixels: Vec<UVec2> = (0..SIZE.x * SIZE.y).map(|i| UVec2::new(i % SIZE.x, i / SIZE.x)).collect();
    let points: Vec<(usize, Vec<(Vec3, Vec3)>)> = pixels.into_par_iter().filter_map(values).collect();
    assert!(points.len() > 100, "{} points", points.len());
    let mut all = Sums::default();
    let mut lights = vec![Sums::default(); scene.lights.len()];
    let mut instances = vec![Sums::default(); scene.instances.len()];
    for (instance, values) in points {
        let (mut ours, mut exact) = (Vec3::ZERO, Vec3::ZERO);
        for (sums, (a, b)) in lights.iter_mut().zip(values) {
            sums.add(a, b);
            (ours, exact) = (ours + a, exact + b);
        }
        all.add(ours, exact);
        instances[instance].add(ours, exact);
    }
    (all, lights, instances)
}

/// A table in percent: rows of names, columns of roughness.
#[derive(Default)]
struct Table(Vec<(String, Vec<f64>)>);

impl Table {
    fn add(&mut self, name: String, sums: &Sums) {
        let value = 100.0 * sums.difference();
        match self.0.iter_mut().find(|(known, _)| *known == name) {
            Some((_, values)) => values.push(value),
            None => self.0.push((name, vec![value])),
        }
    }

    fn print(&self) {
        for (name, values) in &self.0 {
            let cells: Vec<String> = values.iter().map(|value| format!("{value:.1}")).collect();
            println!("| {name} | {} |", cells.join(" | "));
        }
    }
}

/// Prints the tables of the page: `cargo test -p burnish-core --lib -- presets_on_the_workbench --nocapture`.
#[test]
fn lights_of_the_presets_on_the_workbench_are_their_integrals() {
    let mut tables: [Table; 3] = Default::default();
    let mut faults = String::new();
    for roughness in [0.1, 0.2, 0.35, 0.5, 0.7, 1.0] {
        for preset in LightingPreset::library() {
            let scene = workbench(preset, roughness);
            let names: Vec<String> = scene.instances.iter().map(|instance| instance.name.clone()).collect();
            let (all, lights, instances) = measured(scene);
            let [of_presets, of_lights, of_instances] = &mut tables;
            of_presets.add(preset.id.clone(), &all);
            for (light, sums) in preset.lights.iter().zip(&lights) {
                of_lights.add(format!("{}, {}", preset.id, light.name), sums);
            }
            for (name, sums) in names.iter().zip(&instances).filter(|(_, sums)| sums.exact > 0.0) {
                of_instances.add(format!("{}, {name}", preset.id), sums);
            }
            let limit = OVER.iter().find(|(id, _)| *id == preset.id).map_or(TOGETHER, |(_, limit)| *limit);
            if all.difference() > limit {
                let (error, bias) = (100.0 * all.difference(), 100.0 * all.signed / all.exact);
                faults += &format!("{} at roughness {roughness}: {error:.2} %, bias {bias:+.2} %\n", preset.id);
            }
        }
    }
    tables.iter().for_each(Table::print);
    assert!(faults.is_empty(), "{faults}");
}
