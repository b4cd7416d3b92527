//! The cubes of an environment: however they are made, they are the same.

use std::time::Duration;

use burnish_core::lighting::classical;
use burnish_core::scene::Environment;
use burnish_render::Gpu;
use burnish_render::pass::environment::{EnvironmentMaps, EnvironmentPass, Progress, Refinement};
use burnish_render::readback::{read_buffer, read_texture};
use burnish_tests::{Need, trial};
use glam::Vec3;
use half::f16;
use libtest_mimic::Trial;

pub fn trials() -> Vec<Trial> {
    vec![
        trial("cubes refined in slices are those built at once, bit for bit", &[Need::Gpu], refined),
        trial("dimmed cubes are those of the dimmed map, bit for bit", &[Need::Gpu], dimmed),
        trial("coarse cubes hold the light of the map", &[Need::Gpu], coarse),
        trial("a map too large to be uploaded is refused with its name", &[Need::Gpu], too_large),
    ]
}

/// A map without symmetry, with lamps where tiles and faces meet: at the poles, across the seam, on edges of the cube.
fn map(width: u32) -> Environment {
    let height = width / 2;
    let mut texels: Vec<Vec3> = (0..width * height)
        .map(|i| {
            let hash = i.wrapping_mul(2_654_435_761) >> 20;
            Vec3::new((i % width) as f32 / width as f32, 0.5, (i / width) as f32 / height as f32) + hash as f32 / 4096.0
        })
        .collect();
    let lamps =
        [(0.1, 0.0), (0.7, 0.999), (0.0, 0.4), (0.999, 0.4), (0.125, 0.5), (0.375, 0.3), (0.5, 0.25), (0.8, 0.7)];
    for (i, (u, v)) in lamps.into_iter().enumerate() {
        let (x, y) = ((u * width as f32) as usize, (v * height as f32) as usize);
        texels[y * width as usize + x] = Vec3::new(500.0, 400.0, 100.0) * (1.0 + i as f32);
    }
    Environment::new("test", width, height, texels)
}

fn open() -> (Gpu, EnvironmentPass) {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let pass = EnvironmentPass::new(&gpu);
    (gpu, pass)
}

fn build(gpu: &Gpu, pass: &EnvironmentPass, map: &Environment) -> EnvironmentMaps {
    pass.build(gpu, map).unwrap_or_else(|e| panic!("{e}"))
}

/// All levels and faces of a cube.
fn bytes(gpu: &Gpu, cube: &wgpu::Texture) -> Vec<Vec<u8>> {
    (0..cube.mip_level_count())
        .flat_map(|level| (0..6).map(move |face| read_texture(gpu, cube, level, face).expect("a device that works")))
        .collect()
}

fn refined() {
    let (gpu, pass) = open();
    let map = map(256);
    let built = build(&gpu, &pass, &map);
    for budget in [Duration::from_millis(20), Duration::from_secs(100)] {
        let mut refinement = Refinement::new(&map);
        let mut last = 0.0;
        let refined = loop {
            match refinement.advance(&gpu, &pass, budget).unwrap_or_else(|e| panic!("{e}")) {
                Progress::Working(done) => {
                    assert!((last..=1.0).contains(&done), "{done} after {last}");
                    last = done;
                    std::thread::sleep(Duration::from_micros(200));
                }
                Progress::Finished(maps) => break maps,
            }
        };
        let pairs = [
            (&refined.radiance, &built.radiance),
            (&refined.dimmed, &built.dimmed),
            (&refined.prefiltered, &built.prefiltered),
            (&refined.irradiance, &built.irradiance),
        ];
        for (i, (a, b)) in pairs.into_iter().enumerate() {
            assert!(bytes(&gpu, a) == bytes(&gpu, b), "cube {i} differs, with a budget of {budget:?}");
        }
        assert_eq!(
            (refined.source_count, refined.wide_alpha, refined.scale),
            (built.source_count, built.wide_alpha, built.scale)
        );
        assert_eq!(refined.sources.size(), built.sources.size());
        let after = refinement.advance(&gpu, &pass, budget).unwrap_or_else(|e| panic!("{e}"));
        assert!(matches!(after, Progress::Working(1.0)), "cubes are handed out once");
    }
}

fn dimmed() {
    let (gpu, pass) = open();
    for width in [128, 256] {
        let map = map(width);
        let split = classical::split(&map, classical::shading_block(width), classical::SHADING_SOURCES);
        assert!(!split.sources.is_empty());
        let built = build(&gpu, &pass, &map);
        let alone = build(&gpu, &pass, &split.dimmed);
        for (i, (a, b)) in bytes(&gpu, &built.dimmed).iter().zip(bytes(&gpu, &alone.radiance)).enumerate() {
            assert!(*a == b, "level {} face {} differs, at {width} columns", i / 6, i % 6);
        }
        assert!(bytes(&gpu, &built.dimmed) != bytes(&gpu, &built.radiance));
    }
}

fn coarse() {
    let (gpu, pass) = open();
    let map = map(256);
    let built = build(&gpu, &pass, &map);
    let coarse = pass.coarse(&gpu, &map).unwrap_or_else(|e| panic!("{e}"));
    let colours = |cube: &wgpu::Texture| -> Vec<f32> {
        let bytes = read_texture(&gpu, cube, 0, 2).expect("a device that works");
        let halves: &[f16] = bytemuck::cast_slice(&bytes);
        halves.iter().map(|x| x.to_f32()).collect()
    };
    let (fine, rough) = (colours(&built.irradiance), colours(&coarse.irradiance));
    assert_eq!(fine.len(), rough.len());
    for (a, b) in rough.iter().zip(&fine) {
        assert!((a * coarse.scale - b * built.scale).abs() <= 0.03 * b * built.scale, "irradiance {a} is not {b}");
    }
    let power = |maps: &EnvironmentMaps| -> f32 {
        let bytes = read_buffer(&gpu, &maps.sources).expect("a device that works");
        // Direction, padding, power, padding.
        let floats: &[f32] = bytemuck::cast_slice(&bytes);
        floats.chunks(8).map(|source| source[4] + source[5] + source[6]).sum::<f32>() * maps.scale
    };
    assert!(coarse.source_count > 0);
    assert!(power(&coarse) > 0.5 * power(&built), "the lamps are lost");
    assert!(coarse.prefiltered.width() <= 64 && coarse.radiance.width() <= 128);
}

fn too_large() {
    let (gpu, pass) = open();
    let width = gpu.device.limits().max_texture_dimension_2d + 1;
    let map = Environment::new("strip", width, 1, vec![Vec3::ONE; width as usize]);
    let error = pass.build(&gpu, &map).err().expect("no cubes").to_string();
    assert!(error.contains("strip") && error.contains("smaller"), "{error}");
    assert!(pass.coarse(&gpu, &map).is_ok());
    let mut refinement = Refinement::new(&map);
    let refused = loop {
        match refinement.advance(&gpu, &pass, Duration::from_millis(1)) {
            Ok(Progress::Working(_)) => std::thread::yield_now(),
            Ok(Progress::Finished(_)) => panic!("cubes of a map that does not fit"),
            Err(error) => break error.to_string(),
        }
    };
    assert_eq!(refused, error);
}
