use std::sync::Arc;

use glam::{UVec2, Vec3};

use super::*;
use crate::lighting::Drawing;
use crate::lighting::impostor::place;
use crate::reference::{Options, View};
use crate::scene::gallery;

fn settings(solver: Solver) -> Settings {
    let mut settings = Settings::new(PARAMS);
    for (key, value) in [("solver", solver.id()), ("resolution", "32"), ("probe-paths", "16"), ("samples", "0")] {
        settings.set(key, value).unwrap();
    }
    settings
}

fn room() -> World {
    World::new(&Arc::new(gallery::open("room").unwrap()), Options::default())
}

/// Mean |a - b| over mean b of the pixels that show the subject.
fn difference(world: &World, prepared: &Prepared, solver: Solver) -> f64 {
    const PIXELS: u32 = 40;
    let settings = settings(solver);
    let drawing = Drawing::new(&Impostor, world, prepared, &settings).unwrap();
    let camera = world.scene().cameras[0].clone();
    let view = View { camera, size: UVec2::splat(PIXELS), seed: 0 };
    let (mut apart, mut whole, mut count) = (0.0, 0.0, 0);
    for i in 0..PIXELS * PIXELS {
        let pixel = UVec2::new(i % PIXELS, i / PIXELS);
        let mean = |sample: &dyn Fn(u32) -> Vec3, n: u32| (0..n).map(sample).sum::<Vec3>() / n as f32;
        let first = world.sample(&view, pixel, 0).first;
        if !first.is_some_and(|first| world.scene().subject.contains(&(first.instance as usize))) {
            continue;
        }
        let drawn = mean(&|index| drawing.sample(&view, pixel, index).radiance, 8);
        let traced = mean(&|index| world.sample(&view, pixel, index).radiance, 64);
        apart += f64::from((drawn - traced).abs().element_sum());
        whole += f64::from(traced.element_sum());
        count += 1;
    }
    assert!(count > 50, "{count} pixels of the subject");
    apart / whole
}

#[test]
fn reflections_of_a_room_sit_where_they_belong() {
    let world = room();
    let prepared = Impostor.prepare(&world, &settings(Solver::Secant), &Handle::default()).unwrap();
    let of = |solver| difference(&world, &prepared, solver);
    let (classical, secant, march, cuboid) =
        (of(Solver::Classical), of(Solver::Secant), of(Solver::March), of(Solver::Box));
    println!("classical {classical:.3}, secant {secant:.3}, march {march:.3}, box {cuboid:.3}");
    assert!(classical > 0.35, "classical {classical}");
    // Noise of both sides and texels of 3 degrees.
    for (solver, error) in [("secant", secant), ("march", march), ("box", cuboid)] {
        assert!(error < 0.5 * classical, "{solver} {error}, classical {classical}");
    }
}

#[test]
fn a_probe_is_the_same_on_any_number_of_threads_and_ends_when_it_is_told() {
    let world = room();
    let settings = settings(Solver::Secant);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Impostor.prepare(&world, &settings, &Handle::default()).unwrap())
    };
    assert_eq!(on(1), on(3));
    let job = Handle::default();
    job.cancel();
    assert_eq!(Impostor.prepare(&world, &settings, &job), Err(MethodError::Cancelled));
}

#[test]
fn probes_are_placed_until_the_bound_is_kept() {
    // A ball needs one in a room; a long block across it, with a partition beside, more.
    let scene = gallery::open("room").unwrap();
    let effort = effort(&settings(Solver::Secant));
    let placed = place(&scene, &scene.subject, 1.0, &effort, &Handle::default()).unwrap();
    assert_eq!(placed.places.len(), 1, "{placed:?}");
    assert!(placed.p95 <= 1.0 && (placed.places[0] - scene.subject_bounds().center()).length() < 0.05, "{placed:?}");
    let crate_scene = gallery::open("crate").unwrap();
    let at = |bound: f32| place(&crate_scene, &crate_scene.subject, bound, &effort, &Handle::default()).unwrap();
    let (loose, tight) = (at(90.0), at(0.0));
    assert_eq!(loose.places.len(), 1);
    assert!(tight.p95 < loose.p95, "more probes are better: {tight:?} {loose:?}");
    let job = Handle::default();
    job.cancel();
    assert_eq!(place(&scene, &scene.subject, 1.0, &effort, &job), Err(MethodError::Cancelled));
    assert!(matches!(place(&scene, &[], 1.0, &effort, &Handle::default()), Err(MethodError::Unfit(_))));
}

#[test]
fn errors_of_hits_tell_searches_apart() {
    let world = room();
    let settings = settings(Solver::Secant);
    let prepared = Impostor.prepare(&world, &settings, &Handle::default()).unwrap();
    let view = View { camera: world.scene().cameras[0].clone(), size: UVec2::splat(60), seed: 0 };
    let rays = super::super::mirror_rays(&world, &prepared, &view);
    assert!(rays.len() > 200 && rays.iter().all(|ray| ray.met.is_some()), "a closed room");
    let of = |solver: Solver, refinements: u32| {
        let effort = Effort { solver, refinements, steps: 32, tolerance: 0.05 };
        super::super::hit_errors(&prepared, &rays, &effort)
    };
    let (classical, secant, march) = (of(Solver::Classical, 0), of(Solver::Secant, 1), of(Solver::March, 4));
    assert!(classical.p95 > 13.0 && classical.misses == 1.0, "{classical:?}");
    // The walls are planes, which the distances keep exactly.
    assert!(secant.p95 < 0.1 && secant.misses < 0.01, "{secant:?}");
    // 2.3 % end at edges of the walls, which lie between texels of 3 degrees.
    assert!(march.p95 < 0.1 && march.off < 0.03 && march.lookups > secant.lookups, "{march:?}");
}

#[test]
fn a_second_layer_finds_what_the_first_hides() {
    let world = World::new(&Arc::new(gallery::open("crate").unwrap()), Options::default());
    let view = View { camera: world.scene().cameras[0].clone(), size: UVec2::splat(90), seed: 0 };
    let of = |layers: &str| {
        let mut settings = settings(Solver::March);
        for (key, value) in [("layers", layers), ("resolution", "64"), ("probe-paths", "1")] {
            settings.set(key, value).unwrap();
        }
        let prepared = Impostor.prepare(&world, &settings, &Handle::default()).unwrap();
        let rays = super::super::mirror_rays(&world, &prepared, &view);
        let effort = Effort { solver: Solver::March, refinements: 10, steps: 64, tolerance: 0.05 };
        super::super::hit_errors(&prepared, &rays, &effort)
    };
    let (one, two) = (of("1"), of("2"));
    println!("{one:?}\n{two:?}");
    assert!(one.hidden > 0.01 && two.hidden < 0.5 * one.hidden, "{one:?} {two:?}");
    assert!(two.misses < 0.5 * one.misses && two.lookups > one.lookups, "{one:?} {two:?}");
    // Places that are not seen count now, and most of them are found.
    assert!(two.off < one.off + 0.01, "{one:?} {two:?}");
}
