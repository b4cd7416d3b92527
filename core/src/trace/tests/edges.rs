//! Edge cases of scenes, rays and what is accepted.

use std::cell::Cell;

use super::*;
use crate::scene::Bounds;
use crate::scene::gallery::shape;
use crate::trace::walk::{SLACK, Slabs, walk};
use crate::trace::wide::{Binary, LEAF, Wide};

fn wall(z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(0.0, 0.0, z))
}

/// Walls across the z axis.
fn walls(places: &[f32]) -> Scene {
    let mut scene = scene([shape::plane(2.0, 2.0)]);
    scene.instances = places.iter().map(|z| instance(0, wall(*z))).collect();
    scene
}

/// Beside the diagonal of a wall.
const ALONG_Z: Ray = Ray { origin: Vec3::new(0.25, 0.125, 0.0), direction: Vec3::Z, t_max: f32::INFINITY };

#[test]
fn nothing_is_hit_where_nothing_is() {
    let mut hidden = walls(&[1.0]);
    hidden.instances[0].visible = false;
    let mut flattened = walls(&[1.0]);
    flattened.instances[0].world_from_local = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    for scene in
        [Scene::default(), scene([Mesh::default()]), scene([Mesh::default(), Mesh::default()]), hidden, flattened]
    {
        let accel = Accel::new(&scene);
        assert_eq!(accel.closest(&ALONG_Z, any), None);
        assert!(!accel.occluded(&ALONG_Z, any));
    }
}

#[test]
fn the_nearest_accepted_hit_is_found() {
    let accel = Accel::new(&walls(&[3.0, 1.0, 2.0, -1.0]));
    let nearest = |accept: &dyn Fn(&Hit) -> bool| accel.closest(&ALONG_Z, accept).map(|hit| (hit.instance, hit.t));
    assert_eq!(nearest(&any), Some((1, 1.0)));
    assert_eq!(nearest(&|hit| hit.instance != 1), Some((2, 2.0)));
    assert_eq!(nearest(&|hit| hit.t > 2.5), Some((0, 3.0)));
    assert_eq!(nearest(&|_| false), None);
    assert!(accel.occluded(&ALONG_Z, |hit| hit.instance == 0));
    assert!(!accel.occluded(&ALONG_Z, |hit| hit.instance == 3));
}

#[test]
fn no_hit_is_offered_twice() {
    let accel = Accel::new(&walls(&[3.0, 1.0, 2.0]));
    let asked = Cell::new(0);
    accel.occluded(&ALONG_Z, |_| {
        asked.set(asked.get() + 1);
        false
    });
    assert_eq!(asked.get(), 3);
}

#[test]
fn a_ray_ends_before_its_end_and_begins_at_its_origin() {
    let accel = Accel::new(&walls(&[2.0]));
    for (t_max, there) in [(2.0, false), (2.0_f32.next_up(), true), (0.0, false), (-1.0, false), (f32::NAN, false)] {
        let ray = Ray { t_max, ..ALONG_Z };
        assert_eq!(accel.closest(&ray, any).is_some(), there, "{t_max}");
        assert_eq!(accel.occluded(&ray, any), there, "{t_max}");
    }
    let on_it = Ray { origin: ALONG_Z.origin + 2.0 * Vec3::Z, ..ALONG_Z };
    assert_eq!(accel.closest(&on_it, any).map(|hit| hit.t), Some(0.0));
}

#[test]
fn of_hits_at_one_distance_the_first_is_taken() {
    let mut scene = walls(&[1.0; 40]);
    scene.instances[0].visible = false;
    let accel = Accel::new(&scene);
    assert_eq!(accel.closest(&ALONG_Z, any).map(|hit| hit.instance), Some(1));
    // The diagonal belongs to both triangles.
    let diagonal = Ray { origin: Vec3::ZERO, ..ALONG_Z };
    assert_eq!(accel.closest(&diagonal, any).map(|hit| (hit.instance, hit.triangle)), Some((1, 0)));
    assert_eq!(accel.closest(&diagonal, |hit| hit.triangle != 0).map(|hit| (hit.instance, hit.triangle)), Some((1, 1)));
}

#[test]
fn triangles_without_area_are_never_hit() {
    let mut mesh = shape::plane(2.0, 2.0);
    let corners = [Vec3::ZERO, Vec3::X, 3.0 * Vec3::X, Vec3::new(f32::NAN, 0.0, 0.0)];
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(corners.map(|p| p + 0.5 * Vec3::NEG_Z));
    let solid = mesh.indices.len() as u32 / 3;
    for [a, b, c] in [[0, 1, 2], [0, 0, 1], [1, 1, 1], [0, 1, 3], [0, 1, 999]] {
        mesh.indices.extend([a, b, c].map(|i| first + i));
    }
    let accel = Accel::new(&scene([mesh]));
    for x in 0..40 {
        for direction in [Vec3::Z, Vec3::new(0.3, 0.1, 1.0), Vec3::X, Vec3::Y] {
            let at = Vec3::new(0.1 * x as f32 - 0.5, 0.0, -0.5);
            accel.occluded(&ray(at - 2.0 * direction, direction), |hit| {
                assert!(hit.triangle < solid && hit.barycentric.is_finite(), "{hit:?}");
                false
            });
        }
    }
}

#[test]
fn rays_without_sense_hit_nothing_or_something_but_end() {
    let accel = Accel::new(&walls(&[1.0, 2.0]));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, f32::MAX, 1e-45] {
        for (origin, direction) in [(Vec3::splat(bad), Vec3::Z), (Vec3::ZERO, Vec3::splat(bad))] {
            let hit = accel.closest(&ray(origin, direction), any);
            assert!(hit.is_none_or(|hit| hit.t.is_finite()), "{hit:?}");
        }
    }
}

#[test]
fn rays_in_the_planes_of_boxes_miss_nothing() {
    // Flat boxes all around; the ray runs along their sides and edges and starts on them.
    let accel = Accel::new(&scene([shape::block(Vec3::splat(2.0), 0.0, 1), shape::plane(8.0, 8.0)]));
    for (a, b) in [(0.0, 0.0), (-0.0, 0.5), (1.0, 0.0), (1.0, 1.0), (-1.0, 0.25), (0.5, -0.0)] {
        for axis in 0..3 {
            let mut origin = Vec3::ZERO;
            (origin[axis], origin[(axis + 1) % 3], origin[(axis + 2) % 3]) = (-3.0, a, b);
            let mut direction = Vec3::splat(-0.0);
            direction[axis] = 1.0;
            let hit = accel.closest(&ray(origin, direction), |hit| hit.instance == 0).map(|hit| hit.t);
            assert_eq!(hit, Some(2.0), "{origin}");
            origin[axis] = -1.0;
            let hit = accel.closest(&ray(origin, direction), |hit| hit.instance == 0).map(|hit| hit.t);
            assert_eq!(hit, Some(0.0), "{origin}");
        }
    }
}

#[test]
fn magnitudes_do_not_matter_to_the_trees() {
    for size in [1e-18, 1e-12, 1e-3, 1e6, 1e15] {
        let mut mesh = shape::sphere(1.0, 32);
        mesh.positions.iter_mut().for_each(|p| *p *= size);
        let scene = scene([mesh]);
        let rays: Vec<Ray> =
            super::agree::rays(500, 1.0).into_iter().map(|r| ray(size * r.origin, r.direction)).collect();
        let accel = Accel::new(&scene);
        let found: Vec<Option<Hit>> = rays.iter().map(|ray| accel.closest(ray, any)).collect();
        assert!(found.iter().flatten().count() > 250, "{size}");
        let expected = brute_force(&scene, &rays);
        assert!(found == expected, "{size}");
        let farthest = found.iter().flatten().map(|hit| hit.t / size).fold(0.0, f32::max);
        assert!(farthest > 1.0 && farthest < 2.5, "{size}: {farthest}");
    }
}

#[test]
fn trees_of_untouched_meshes_are_shared() {
    let mut scene = scene([shape::sphere(1.0, 32), shape::torus(1.0, 0.2, 8, 8), shape::plane(1.0, 1.0)]);
    scene.instances[2].visible = false;
    let first = Accel::new(&scene);
    scene.instances[0].world_from_local = wall(5.0);
    scene.instances[1].visible = false;
    scene.meshes[1] = Arc::new(shape::torus(1.0, 0.3, 8, 8));
    let moved = first.updated(&scene);
    assert!(Arc::ptr_eq(&first.shared.trees[0].1, &moved.shared.trees[0].1), "of the sphere that moved");
    assert_eq!(moved.shared.trees.len(), 1, "the torus is another and hidden");
    let hit = |accel: &Accel| accel.closest(&ray(Vec3::ZERO, Vec3::Z), any).map(|hit| hit.t);
    assert_eq!((hit(&first).map(f32::round), hit(&moved).map(f32::round)), (Some(1.0), Some(4.0)));
    // A hidden mesh keeps its tree.
    scene.instances[0].visible = false;
    let hidden = moved.updated(&scene);
    assert!(Arc::ptr_eq(&first.shared.trees[0].1, &hidden.shared.trees[0].1));
    assert_eq!(hit(&hidden), None);
    assert!(first.bytes() > 10_000 && hidden.bytes() < first.bytes());
}

#[test]
fn the_number_of_threads_does_not_change_the_trees() {
    let mesh = shape::sphere(1.0, 200);
    let built = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| Accel::new(&scene([mesh.clone(), shape::plane(1.0, 1.0)])).flatten())
    };
    let one = built(1);
    for threads in [2, 7] {
        assert!(built(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_tree_of_any_depth_is_walked() {
    // Each box holds one leaf and all the rest: as deep as the list is long.
    let count = 30_000;
    let around = |i: usize| (Vec3::splat(-(i as f32) - 1.0), Vec3::splat(i as f32 + 1.0));
    let mut list = Vec::new();
    for i in (0..count).rev() {
        let (min, max) = around(i);
        let leaf = Binary { min, max, link: i as u32, is_leaf: true };
        if i > 0 {
            list.push(Binary { min, max, link: 2, is_leaf: false });
        }
        list.push(leaf);
    }
    let Wide { nodes, leaves } = Wide::new(&list, 1);
    let (min, max) = around(count);
    let slabs = Slabs::new(&ALONG_Z, &Bounds { min, max }, SLACK);
    let mut seen = vec![false; count];
    let mut limit = f32::INFINITY;
    walk(&nodes, &slabs, &mut limit, |leaf, _| {
        seen[leaves[(leaf & !LEAF) as usize][0] as usize] = true;
        false
    });
    assert!(seen.iter().all(|seen| *seen));
}
