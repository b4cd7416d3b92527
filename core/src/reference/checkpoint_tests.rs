use std::sync::Arc;

use glam::Vec3;

use super::*;
use crate::file::testing::Folder;
use crate::material::{Reflectance, preset};
use crate::reference::{Control, FirstHit, Pass, PathSample, trace_with};
use crate::scene::{Camera, Scene, gallery};
use crate::surface::fresnel::Fresnel;
use crate::surface::ggx::Masking;

fn view() -> View {
    View { camera: Camera::look_at("a", Vec3::ONE, Vec3::ZERO, 0.5), size: UVec2::new(19, 18), seed: 7 }
}

fn key() -> Key {
    key_of(&gallery::open("workbench").unwrap(), &Options::default(), &view())
}

fn key_of(scene: &Scene, options: &Options, view: &View) -> Key {
    Key::new(&World::new(&Arc::new(scene.clone()), *options), view)
}

/// The workbench with a metal.
fn metallic() -> Scene {
    let mut scene = gallery::open("workbench").unwrap();
    let fresnel = Arc::new(Fresnel::Rescaled { f0: Vec3::ONE });
    scene.materials[0].reflectance = Reflectance::Preset { id: "any".into(), fresnel };
    scene
}

/// A path of any function, one of them not finite.
fn path(pixel: UVec2, index: u32) -> PathSample {
    let u = ((pixel.x * 31 + pixel.y * 17 + index * 101) % 97) as f32 / 97.0;
    let radiance = if (pixel, index) == (UVec2::new(3, 4), 5) { Vec3::NAN } else { Vec3::new(u, 0.1, 1.0 / (u + 0.1)) };
    let first = FirstHit { normal: Vec3::Y, albedo: Vec3::splat(u), instance: index % 3, material: pixel.x };
    PathSample { radiance, clamped: Vec3::splat(0.1 * u), first: (u > 0.5).then_some(first), rays: 1 }
}

fn add(film: &mut Film, samples: u32) {
    assert_eq!(trace_with(film, samples, &Control::default(), path), Pass::Whole);
}

#[test]
fn a_film_that_goes_on_from_disk_at_any_count_is_the_uninterrupted_one() {
    let folder = Folder::new();
    let file = folder.join("a.bin");
    let mut whole = Film::new(view().size);
    add(&mut whole, 9);
    for cut in 0..=9 {
        let mut film = Film::new(view().size);
        if cut > 0 {
            add(&mut film, cut);
        }
        write(&file, &film, &key()).unwrap();
        let mut film = read(&file, &key()).unwrap();
        if cut < 9 {
            add(&mut film, 9 - cut);
        }
        assert!(film == whole, "cut at {cut}");
    }
    assert_eq!(folder.names(), ["a.bin"]);
}

#[test]
fn a_checkpoint_of_another_picture_is_refused_with_what_differs() {
    let folder = Folder::new();
    let file = folder.join("a.bin");
    let scene = gallery::open("workbench").unwrap();
    write(&file, &Film::new(view().size), &key()).unwrap();
    let refused = |scene: &Scene, options: &Options, view: &View| {
        read(&file, &key_of(scene, options, view)).unwrap_err().to_string()
    };
    let options = Options::default();
    let mut other = scene.clone();
    other.materials[0].roughness = 0.123;
    let text = refused(&other, &options, &view());
    assert!(text.contains("a.bin: is the checkpoint of another picture; what differs: the materials; go on"), "{text}");
    let text = refused(&Scene { lights: vec![], instances: vec![], environment: None, ..other }, &options, &view());
    assert!(text.contains("the geometry, the materials"), "{text}");
    let text = refused(&scene, &options, &View { seed: 8, size: UVec2::new(18, 19), ..view() });
    assert!(text.contains("the size (19x18 there, 18x19 here), the seed (7 there, 8 here);"), "{text}");
    let text = refused(&scene, &options, &View { camera: Camera::look_at("a", Vec3::X, Vec3::ZERO, 0.5), ..view() });
    assert!(text.contains("the camera;"), "{text}");
    let changed = Options {
        bounces: 1,
        clamp: 10.0,
        masking: Masking::Separable,
        multiple_scattering: false,
        contribution: crate::reference::Contribution::Emission,
    };
    let text = refused(&scene, &changed, &view());
    for part in [
        "the bounces (64 there, 1 here)",
        "the clamp (inf there, 10 here)",
        "the masking (correlated there, separable here)",
        "the multiple scattering (on there, off here)",
    ] {
        assert!(text.contains(part), "{text}");
    }
    let by_wavelength = |id: &str| {
        let world = World::new(&Arc::new(metallic()), options).by_wavelength(|_| preset::find(id).ok()).0;
        Key::new(&world, &view())
    };
    assert_eq!(by_wavelength("Au"), by_wavelength("Au"));
    write(&file, &Film::new(view().size), &by_wavelength("Au")).unwrap();
    let text = read(&file, &by_wavelength("Ag")).unwrap_err().to_string();
    assert!(text.contains("what differs: the n and k of the metals;"), "{text}");
    let text = refused(&metallic(), &options, &view());
    assert!(text.contains("what differs: the wavelengths (on there, off here);"), "{text}");
    let older = Key { revision: 0, ..key() };
    write(&file, &Film::new(view().size), &older).unwrap();
    assert!(read(&file, &key()).unwrap_err().to_string().contains("revision of the path tracer (0 there, 2 here)"));
}

#[test]
fn numbers_that_do_not_fit_each_other_make_no_film() {
    let folder = Folder::new();
    let file = folder.join("a.bin");
    let mut film = Film::new(view().size);
    add(&mut film, 6);
    write(&file, &film, &key()).unwrap();
    let rewrite = |change: &dyn Fn(&mut Value)| {
        write(&file, &film, &key()).unwrap();
        let mut container = Container::read(&file, KIND, MAX_BYTES).unwrap();
        change(&mut container.header);
        container.write(&file).unwrap();
        read(&file, &key()).map(|_| ()).map_err(|e| e.reason)
    };
    assert_eq!(rewrite(&|_| ()), Ok(()));
    assert!(rewrite(&|h| h["samples"] = 7.into()).unwrap_err().contains("do not fit"));
    assert!(rewrite(&|h| h["first_rejected"] = Value::Null).unwrap_err().contains("do not fit"));
    assert!(rewrite(&|h| h["samples"] = (-1).into()).unwrap_err().contains("makes no sense"));
    assert!(rewrite(&|h| *h = Value::Null).unwrap_err().contains("makes no sense"));
    write(&file, &film, &key()).unwrap();
    let header = Container::read(&file, KIND, MAX_BYTES).unwrap().header;
    Container::new(KIND, header).with("count", vec![1_u32]).write(&file).unwrap();
    assert!(read(&file, &key()).unwrap_err().reason.contains("has 1 of u32 as `count`, not 342"));
}
