//! A plain traversal of the exported arrays, in double precision and one box at a time.

use glam::{DMat3, DVec3};

use super::agree::{crowd, rays};
use super::*;
use crate::scene::Bounds;
use crate::trace::{Flat, FlatInstance, FlatNode, FlatTriangle};

/// Distance, instance and triangle.
type Found = Option<(f64, u32, u32)>;

fn traversed(flat: &Flat, ray: &Ray) -> Found {
    let mut best = None;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    if flat.instances.is_empty() {
        return best;
    }
    let t_max = f64::from(ray.t_max);
    visit(flat, 0, [origin, direction], grown(flat.slack, flat.bounds, origin), t_max, &mut best, &mut |i, best| {
        let instance = &flat.instances[i];
        let columns = |c: [[f32; 4]; 3]| DMat3::from_cols_array_2d(&c.map(|[x, y, z, _]| [x, y, z].map(f64::from)));
        let linear = columns(instance.local_from_world) + columns(instance.local_from_world_left);
        let origin = linear * (origin - DVec3::from(instance.translation.map(f64::from)));
        let direction = linear * direction;
        let slack = grown(instance.slack, instance.bounds(), origin);
        visit(flat, instance.root, [origin, direction], slack, t_max, best, &mut |t, best| {
            meet(&flat.triangles[t], instance, [origin, direction], t_max, best);
        });
    });
    best
}

fn grown(slack: f32, bounds: Bounds, origin: DVec3) -> f64 {
    let reach = (bounds.min.as_dvec3() - origin).abs().max((bounds.max.as_dvec3() - origin).abs());
    f64::from(slack) * reach.max_element()
}

fn visit(
    flat: &Flat,
    node: u32,
    ray: [DVec3; 2],
    grown: f64,
    t_max: f64,
    best: &mut Found,
    leaf: &mut dyn FnMut(usize, &mut Found),
) {
    let FlatNode { planes, children } = &flat.nodes[node as usize];
    for (i, child) in children.iter().enumerate().filter(|(_, child)| **child != FlatNode::NONE) {
        let plane = |side: usize| DVec3::from_array([0, 1, 2].map(|axis| f64::from(planes[axis][side][i])));
        let [a, b] = [plane(0) - grown, plane(1) + grown].map(|p| (p - ray[0]) / ray[1]);
        let enter = a.min(b).max_element().max(0.0);
        let leave = a.max(b).min_element().min(best.map_or(t_max, |(t, ..)| t));
        if enter > leave {
            continue;
        }
        if child & FlatNode::LEAF == 0 {
            visit(flat, *child, ray, grown, t_max, best, leaf);
            continue;
        }
        for primitive in FlatNode::primitives(*child) {
            leaf(primitive, best);
        }
    }
}

/// Moeller and Trumbore 1997.
fn meet(
    triangle: &FlatTriangle,
    instance: &FlatInstance,
    [origin, direction]: [DVec3; 2],
    t_max: f64,
    best: &mut Found,
) {
    let corner = |p: &[f32]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
    let (a, ab, ac) = {
        let a = corner(&triangle.a);
        (a, corner(&triangle.b) - a, corner(&triangle.c) - a)
    };
    let p = direction.cross(ac);
    let (determinant, from_a) = (ab.dot(p), origin - a);
    let q = from_a.cross(ab);
    let [u, v, t] = [from_a.dot(p), direction.dot(q), ac.dot(q)].map(|x| x / determinant);
    let met = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && t < best.map_or(t_max, |(t, ..)| t);
    if met {
        *best = Some((t, instance.instance, triangle.triangle));
    }
}

#[test]
fn a_plain_traversal_of_the_arrays_finds_the_same() {
    let scene = crowd();
    let accel = Accel::new(&scene);
    let flat = accel.flatten();
    let solid: usize = scene.meshes.iter().map(|mesh| crate::trace::mesh_tree::triangles(mesh).count()).sum();
    assert_eq!(flat.triangles.len(), solid, "meshes are there once, however many instances they have");
    assert_eq!(flat.instances.len(), scene.instances.iter().filter(|i| i.visible).count());
    let mut differ = 0;
    for ray in rays(20_000, 6.0) {
        let expected = accel.closest(&ray, any);
        match (traversed(&flat, &ray), expected) {
            (None, None) => {}
            (Some((t, instance, triangle)), Some(hit)) => {
                let near = (t - f64::from(hit.t)).abs() <= 1e-5 * (1.0 + t);
                let same = (instance, triangle) == (hit.instance, hit.triangle);
                // Of several at one distance either is right.
                assert!(near, "{t} {instance} {triangle}, {hit:?}, the same: {same}");
            }
            // At the outline of an instance rounding decides.
            _ => differ += 1,
        }
    }
    assert!(differ <= 3, "{differ} rays meet something in one traversal only");
}

#[test]
fn arrays_are_words_without_holes() {
    assert_eq!((size_of::<FlatNode>(), size_of::<FlatInstance>(), size_of::<FlatTriangle>()), (224, 144, 48));
    let empty = Accel::new(&Scene::default()).flatten();
    assert!(empty.nodes.is_empty() && empty.instances.is_empty() && empty.triangles.is_empty());
    assert_eq!(traversed(&empty, &ray(Vec3::ZERO, Vec3::X)), None);
}
