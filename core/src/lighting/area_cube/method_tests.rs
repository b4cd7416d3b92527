use std::sync::Arc;

use glam::UVec2;

use super::*;
use crate::lighting::Drawing;
use crate::reference::{Options, View};
use crate::scene::{self, gallery};

fn settings(values: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(PARAMS);
    for (key, value) in [("resolution", "32"), ("probe-paths", "16")].iter().chain(values) {
        settings.set(key, value).unwrap();
    }
    settings
}

/// A room with a body of a material beside the middle and the probe in the middle.
fn room(material: &str, roughness: &str) -> World {
    let text = format!("room?material={material}&roughness={roughness}&at=0.4,-0.3,0.2");
    let mut scene = gallery::open(&text).unwrap();
    scene.probes = vec![scene::Probe { position: Some(Vec3::ZERO), ..Default::default() }];
    World::new(&Arc::new(scene), Options::default())
}

/// Mean |a - b| over mean b of the pixels that show the subject.
fn difference(world: &World, method: &dyn Method, prepared: &Prepared, settings: &Settings) -> f64 {
    const PIXELS: u32 = 32;
    let drawing = Drawing::new(method, world, prepared, settings).unwrap();
    let view = View { camera: world.scene().cameras[0].clone(), size: UVec2::splat(PIXELS), seed: 0 };
    let (mut apart, mut whole, mut count) = (0.0, 0.0, 0);
    for i in 0..PIXELS * PIXELS {
        let pixel = UVec2::new(i % PIXELS, i / PIXELS);
        let mean = |sample: &dyn Fn(u32) -> Vec3, n: u32| (0..n).map(sample).sum::<Vec3>() / n as f32;
        let first = world.sample(&view, pixel, 0).first;
        if !first.is_some_and(|first| world.scene().subject.contains(&(first.instance as usize))) {
            continue;
        }
        let drawn = mean(&|index| drawing.sample(&view, pixel, index).radiance, 4);
        let traced = mean(&|index| world.sample(&view, pixel, index).radiance, 128);
        assert!(drawn.is_finite() && drawn.min_element() >= 0.0);
        apart += f64::from((drawn - traced).abs().element_sum());
        whole += f64::from(traced.element_sum());
        count += 1;
    }
    assert!(count > 40, "{count} pixels of the subject");
    apart / whole
}

#[test]
fn a_matt_body_off_the_middle_is_lit_by_what_is_near_it() {
    let world = room("white", "0.5");
    let prepared = AreaCube.prepare(&world, &settings(&[]), &Handle::default()).unwrap();
    let of = |values: &[(&str, &str)]| difference(&world, &AreaCube, &prepared, &settings(values));
    let (on, plain) = (of(&[]), of(&[("correction", "off"), ("normalization", "off")]));
    // The same probe as if it were infinitely far away.
    let far = impostor::Impostor;
    let mut classical = Settings::new(far.info().params);
    classical.set("solver", "classical").unwrap();
    classical.set("samples", "0").unwrap();
    let far = difference(&world, &far, &prepared, &classical);
    println!("matt: area cube {on:.3}, as the source has it {plain:.3}, as from the middle {far:.3}");
    assert!(on < 0.6 * far && on < plain, "{on} {plain} {far}");
}

#[test]
fn a_glossy_body_off_the_middle_is_lit_by_what_is_near_it() {
    let world = room("Ag", "0.6");
    let prepared = AreaCube.prepare(&world, &settings(&[]), &Handle::default()).unwrap();
    let of = |texels: &str, sum: &str| {
        difference(&world, &AreaCube, &prepared, &settings(&[("texels", texels), ("sum", sum)]))
    };
    let [coarse, usual, fine, few] = [of("2", "all"), of("4", "all"), of("8", "all"), of("8", "few")];
    println!("glossy: 2 {coarse:.3}, 4 {usual:.3}, 8 {fine:.3}, few of 8 {few:.3}");
    assert!(fine < usual && usual < coarse && fine < 0.15, "{coarse} {usual} {fine}");
}

#[test]
fn even_light_is_reflected_evenly_wherever_the_point_is() {
    let texels: Vec<f32> = EDGES
        .iter()
        .flat_map(|edge| downsample(*edge, 4, &|_| Vec3::ONE, &|d| d.abs().max_element().recip()))
        .flat_map(|texel| texel.to_array())
        .collect();
    let world = room("white", "0.5");
    let view = View { camera: world.scene().cameras[0].clone(), size: UVec2::splat(16), seed: 0 };
    let mut met = 0;
    for i in 0..256 {
        let eye = crate::reference::Eye::new(&world, &view, UVec2::new(i % 16, i / 16), 0);
        let Some(point) = eye.point() else { continue };
        let (surface, frame) = (point.surface(), point.base());
        for (edge, few) in [(2, false), (4, false), (16, true)] {
            let at = Looked { x: 0.9 * point.position().clamp(Vec3::NEG_ONE, Vec3::ONE), base: frame.n, coat: frame.n };
            let asked = Asked { few, corrected: true, normalized: true, middles: false };
            let texels = Texels::of(&texels, edge).unwrap();
            let light = reflected(&texels, &surface, frame, point.coat(), point.to_viewer(), 1.0, &at, asked);
            let albedo = point.albedo();
            // Fresnel is taken at the middles of caps: at grazing angles 2 x 2 texels are coarse for it.
            assert!(light.abs_diff_eq(albedo, 0.04), "{edge}: {light} {albedo}");
            met += 1;
        }
    }
    assert!(met > 300, "{met}");
}

#[test]
fn a_preparation_is_the_same_on_any_number_of_threads_and_ends_when_it_is_told() {
    let world = room("Ag", "0.3");
    let settings = settings(&[("probe-paths", "2")]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| AreaCube.prepare(&world, &settings, &Handle::default()).unwrap())
    };
    assert_eq!(on(1), on(3));
    let job = Handle::default();
    job.cancel();
    assert_eq!(AreaCube.prepare(&world, &settings, &job), Err(MethodError::Cancelled));
}
