use std::sync::Arc;

use super::*;
use crate::lighting::impostor::{Extent, Solver, solve};
use crate::lighting::probe::{Surroundings, bounds, surroundings};
use crate::math::sampling::Random;
use crate::reference::{Options, World};
use crate::scene::gallery;

const FACE: u32 = 64;
const TOLERANCE: f32 = 1e-3;

fn unit(random: &mut Random) -> Vec3 {
    let (a, b) = (random.point2(), random.unit());
    (Vec3::new(a.x, a.y, b) * 2.0 - 1.0).try_normalize().unwrap_or(Vec3::X)
}

/// Rays that a march of 2048 steps finds something for, those of them for which the pyramid finds nothing, or what is farther away,
/// and rays that need more lookups than 24 steps allow.
fn compare(seen: &Surroundings, reach: f32, rays: u32) -> [u32; 3] {
    let cube = seen.distances();
    let mut random = Random::new(3);
    let [mut found, mut lost, mut long] = [0; 3];
    for _ in 0..rays {
        let (x, r) = (reach * random.unit() * unit(&mut random), unit(&mut random));
        let effort = |solver| Effort { solver, refinements: 24, steps: 2048, tolerance: TOLERANCE };
        let dense = solve(&cube, &seen.extent, x, r, &effort(Solver::March));
        let quick = solve(&cube, &seen.extent, x, r, &effort(Solver::Pyramid));
        long += u32::from(quick.lookups > 24 * LOOKUPS_PER_STEP);
        if dense.is_hit {
            found += 1;
            if !quick.is_hit || quick.t > dense.t + 2e-3 * (1.0 + dense.t) {
                lost += 1;
                println!("{x} {r} {dense:?} {quick:?}");
            }
        }
    }
    [found, lost, long]
}

#[test]
fn nothing_that_a_dense_march_finds_is_lost() {
    for name in ["room", "crate", "box-sphere"] {
        let scene = gallery::open(name).unwrap();
        let served: Vec<u32> = scene.subject.iter().map(|i| *i as u32).collect();
        let bounds = scene.subject_bounds();
        let around = World::new(&Arc::new(surroundings(&scene, &served)), Options::default());
        let seen = Surroundings::seen(&around, bounds.center(), FACE);
        let [found, lost, long] = compare(&seen, (bounds.max - bounds.min).length() * 0.5, 4000);
        println!("{name}: {found} {lost} {long}");
        assert!(long <= 4, "{name}: {long} of 4000 rays end before they are through");
        assert!(found > 2000 && lost == 0, "{name}: {lost} of {found}");
    }
}

#[test]
fn whatever_is_kept_a_place_is_finite_and_not_behind_the_point() {
    let kinds: [fn(u32) -> f32; 4] = [
        |i| [0.0, f32::NAN, 1.0, f32::INFINITY, -1.0, 1e30, 1e-30, 0.5][i as usize % 8],
        |i| if i % 3 == 0 { 0.0 } else { 0.6 + 0.3 * (i as f32).sin() },
        |_| 0.0,
        |_| f32::INFINITY,
    ];
    for (kind, kept) in kinds.into_iter().enumerate() {
        for face in [0, 1, 2, 5, 16] {
            let inverse: Vec<f32> = (0..6 * face * face).map(kept).collect();
            let all = bounds(face, &inverse);
            // Without its bounds a cube is searched quad by quad.
            for bounds in [all.as_slice(), &[]] {
                let cube = DistanceCube::new(face, &inverse, bounds);
                let mut random = Random::new(face.into());
                for i in 0..25_000u32 {
                    let x = match i % 50 {
                        0 => Vec3::ZERO,
                        1 => 1e-20 * unit(&mut random),
                        2 => 1e6 * unit(&mut random),
                        3 => Vec3::ONE,
                        _ => 2.0 * random.unit() * unit(&mut random),
                    };
                    let r = match i % 7 {
                        0 => Vec3::NEG_Y,
                        1 => Vec3::ONE.normalize(),
                        _ => unit(&mut random),
                    };
                    let tolerance = [0.01, f32::INFINITY][i as usize % 2];
                    let steps = [0, 1, 30, 256][i as usize % 4];
                    let effort = Effort { solver: Solver::Pyramid, refinements: 2, steps, tolerance };
                    let extent = Extent { near: 0.1, far: 2.0, radius: 1.0, low: Vec3::NEG_ONE, high: Vec3::ONE };
                    let found = solve(&cube, &extent, x, r, &effort);
                    assert!(found.t.is_finite() && found.t >= 0.0, "{kind} {face} {x} {r} {effort:?}: {found:?}");
                    assert!(found.lookups <= LOOKUPS_PER_STEP * steps.max(1), "{kind} {face} {x} {r}: {found:?}");
                    assert!((found.direction(x, r).length() - 1.0).abs() < 1e-4, "{kind} {face} {x} {r}");
                }
            }
        }
    }
}

#[test]
fn a_wall_between_the_middles_of_texels_is_not_passed() {
    let scene = gallery::open("room").unwrap();
    let served: Vec<u32> = scene.subject.iter().map(|i| *i as u32).collect();
    let around = World::new(&Arc::new(surroundings(&scene, &served)), Options::default());
    let seen = Surroundings::seen(&around, Vec3::ZERO, 16);
    let rays = [Vec3::X, Vec3::NEG_X, Vec3::NEG_Z, Vec3::ONE.normalize(), Vec3::new(-1.0, -1.0, -1.0).normalize()];
    for (solver, r) in [Solver::March, Solver::Pyramid].into_iter().flat_map(|solver| rays.map(|r| (solver, r))) {
        let effort = Effort { solver, refinements: 10, steps: 64, tolerance: 0.05 };
        let found = solve(&seen.distances(), &seen.extent, Vec3::splat(0.001), r, &effort);
        let wanted = around.distance(Vec3::splat(0.001), r).unwrap();
        assert!(found.is_hit && (found.t - wanted).abs() < 0.02 * wanted, "{solver:?} {r}: {found:?} {wanted}");
    }
}
