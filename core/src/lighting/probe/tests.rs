use std::sync::Arc;

use glam::{Affine3A, Vec3};

use super::behind::distances as distances_behind;
use super::*;
use crate::job::Handle;
use crate::lighting::{Method, impostor, prepared::key};
use crate::math::sampling::Random;
use crate::param::Settings;
use crate::reference::{Options, World};
use crate::scene::{self, ProbeSource, Scene, gallery};

const DEFAULTS: Defaults = Defaults { face: 16, paths: 2, layers: 1 };

fn place(x: f32, half: f32) -> Place {
    Place { middle: Vec3::new(x, 0.0, 0.0), half: Vec3::splat(half) }
}

#[test]
fn weights_sum_to_what_is_covered_and_change_without_a_seam() {
    let places = [place(0.0, 2.0), place(1.0, 1e9), place(1.5, 0.8), place(-4.0, 1.0)];
    let mut random = Random::new(5);
    for _ in 0..400 {
        let [a, b] = [0, 1].map(|_| {
            let (u, v) = (random.point2(), random.unit());
            Vec3::new(u.x, u.y, v) * 8.0 - 4.0
        });
        const STEPS: usize = 4000;
        let at = |step: usize| weights(&places, a.lerp(b, step as f32 / STEPS as f32));
        let mut before = at(0);
        for step in 1..=STEPS {
            let now = at(step);
            assert!((now.iter().sum::<f32>() - 1.0).abs() < 1e-5, "one of them serves everywhere");
            // A step of 2 mm, fades of at least 16 cm.
            let most = now.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(most < 0.25, "a jump of {most} between {a} and {b}");
            before = now;
        }
    }
    assert_eq!(weights(&places, Vec3::ZERO)[0], 1.0);
    assert_eq!(weights(&places[2..], Vec3::splat(100.0)), [0.0, 0.0], "outside of all boxes");
    let rim = weights(&places[3..], Vec3::new(-4.0 + 0.9, 0.0, 0.0))[0];
    assert!((rim - 0.5).abs() < 1e-5, "half way through the fade: {rim}");
}

#[test]
fn a_probe_serves_what_it_is_told_else_the_subject_else_the_largest_metal() {
    let room = gallery::open("room").unwrap();
    let of = |scene: &Scene| Sites::new(scene, DEFAULTS).list;
    let one = of(&room);
    assert_eq!(one[0].served, room.subject.iter().map(|i| *i as u32).collect::<Vec<_>>());
    assert!((one[0].middle - room.subject_bounds().center()).length() < 1e-6);
    let mut all = room.clone();
    all.subject.clear();
    assert_eq!(of(&all)[0].served, one[0].served, "the only metal");
    let mut told = room.clone();
    let probe = |position, serves: &[usize]| scene::Probe { position, serves: serves.into(), ..Default::default() };
    told.probes = vec![
        probe(Some(Vec3::ZERO), &[2, 1, 2, 99]),
        probe(None, &(0..room.instances.len()).collect::<Vec<_>>()),
        scene::Probe { resolution: Some(64), paths: Some(9), source: ProbeSource::Raster, ..probe(None, &[]) },
    ];
    let told = of(&told);
    assert_eq!(told.len(), 2, "one that serves everything sees nothing");
    assert_eq!((told[0].middle, &told[0].served[..]), (Vec3::ZERO, &[1, 2][..]));
    assert_eq!((told[1].face, told[1].paths, told[1].source), (64, 9, ProbeSource::Raster));
    let mut hidden = room.clone();
    hidden.instances[room.subject[0]].visible = false;
    assert!(of(&hidden).is_empty() || !of(&hidden)[0].served.contains(&(room.subject[0] as u32)));
}

#[test]
fn what_is_recorded_depends_on_the_surroundings_and_not_on_what_is_served() {
    let room = gallery::open("room").unwrap();
    let served = room.subject[0];
    let settings = Settings::new(impostor::PARAMS);
    let key = |scene: &Scene| key(&impostor::Impostor, &settings, scene);
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = room.clone();
        change(&mut scene);
        key(&scene)
    };
    let before = key(&room);
    let material = room.instances[served].material;
    assert_eq!(with(&|s| s.materials[material].roughness = 0.9), before, "its material");
    assert_eq!(with(&|s| s.cameras.clear()), before);
    let other = (0..room.instances.len()).find(|i| *i != served).unwrap();
    for (what, changed) in [
        ("another material", with(&|s| s.materials[s.instances[other].material].base_color = Vec3::X)),
        ("its place", with(&|s| s.instances[served].world_from_local.translation.x += 0.1)),
        ("a probe's place", with(&|s| s.probes = vec![scene::Probe { position: Some(Vec3::X), ..Default::default() }])),
        ("another object", with(&|s| s.instances[other].visible = false)),
    ] {
        assert_ne!(changed, before, "{what}");
    }
    // With a place of its own the probe does not follow.
    let fixed = |s: &mut Scene| s.probes = vec![scene::Probe { position: Some(Vec3::ZERO), ..Default::default() }];
    let moved = with(&|s| {
        fixed(s);
        s.instances[served].world_from_local = Affine3A::from_translation(Vec3::splat(0.1));
    });
    assert_eq!(moved, with(&fixed));
}

#[test]
fn probes_are_kept_in_parts_and_found_by_whom_they_serve() {
    let mut room = gallery::open("room").unwrap();
    let other = (0..room.instances.len()).find(|i| !room.subject.contains(i)).unwrap();
    let at = |x: f32, serves: Vec<usize>| scene::Probe {
        position: Some(Vec3::new(x, 0.0, 0.0)),
        extent: Some(Vec3::ONE),
        serves,
        ..Default::default()
    };
    room.probes = vec![at(-0.3, Vec::new()), at(0.3, Vec::new()), at(0.0, vec![other])];
    let subject = room.subject[0] as u32;
    let world = World::new(&Arc::new(room), Options::default());
    let prepared = prepare(&world, &Sites::new(world.scene(), DEFAULTS), &Handle::default()).unwrap();
    let probes = Probes::of(&prepared);
    assert_eq!(probes.len(), 3);
    let about = |instance: u32, x: f32| {
        let found = probes.about(instance, Vec3::new(x, 0.0, 0.0));
        found.iter().map(|(probe, weight)| (probe.middle.x, *weight)).collect::<Vec<_>>()
    };
    assert_eq!(about(subject, -0.3), [(-0.3, 1.0)]);
    assert_eq!(about(subject, 0.0), [(-0.3, 0.5), (0.3, 0.5)]);
    assert_eq!(about(other as u32, 0.25).len(), 1);
    assert!(about(99, 0.0).is_empty() && about(subject, 5.0).is_empty());
    for probe in probes.iter() {
        assert!(probe.extent.near > 0.05 && probe.extent.far < 2.6, "{:?}", probe.extent);
    }
    let folder = std::env::temp_dir().join(format!("burnish-probes-{}", std::process::id()));
    let store = crate::lighting::Store::within(&folder);
    store.keep("k", &prepared).unwrap();
    assert_eq!(store.read("k"), Some(prepared.clone()));
    assert!(prepared.bytes() > 3 * 6 * 16 * 16 * 4);
    std::fs::remove_dir_all(folder).unwrap();
    assert!(impostor::Impostor.points().is_some());
}

#[test]
fn a_probe_where_it_fails_is_told() {
    let room = gallery::open("room").unwrap();
    let warned = |change: &dyn Fn(&mut Scene)| {
        let mut scene = room.clone();
        change(&mut scene);
        let world = World::new(&Arc::new(scene.clone()), Options::default());
        let sites = Sites::new(&scene, DEFAULTS);
        let prepared = prepare(&world, &sites, &Handle::default()).unwrap();
        warnings(&scene, &sites, &prepared).join("; ")
    };
    let at = |position: Vec3| {
        move |s: &mut Scene| {
            s.probes = vec![scene::Probe { name: "p".into(), position: Some(position), ..Default::default() }];
        }
    };
    assert_eq!(warned(&|_| ()), "");
    // The walls are 0.12 m thick slabs.
    let inside = warned(&at(Vec3::new(1.06, 0.0, 0.0)));
    assert!(inside.contains("probe `p`") && inside.contains("inside of an object"), "{inside}");
    let outside = warned(&at(Vec3::new(3.0, 0.0, 0.0)));
    assert!(outside.contains("beyond the surroundings"), "{outside}");
    let alone = warned(&|s| {
        let served = s.subject[0];
        s.instances.iter_mut().enumerate().for_each(|(i, instance)| instance.visible = i == served);
    });
    assert!(alone.contains("no probe serves"), "{alone}");
    let sky = warned(&|s| {
        // All but a wall behind, far away.
        s.instances.iter_mut().skip(2).for_each(|instance| instance.visible = false);
        s.instances[1].world_from_local.translation += glam::Vec3A::new(0.0, 0.0, 500.0);
    });
    assert!(sky.contains("nothing but the sky"), "{sky}");
}

#[test]
fn behind_a_body_is_the_wall_and_behind_the_wall_nothing() {
    let room = gallery::open("room").unwrap();
    let ball = room.subject_bounds();
    let world = World::new(&Arc::new(room), Options::default());
    let origin = Vec3::new(-0.9, ball.center().y, ball.center().z);
    let found = behind(&world, origin, Vec3::X).unwrap();
    // The back of the ball is none of it.
    assert!((found.to - 1.9).abs() < 1e-3, "{found:?}");
    assert!(found.from >= ball.max.x - origin.x - 1e-3 && found.from < found.to, "{found:?}");
    assert_eq!(behind(&world, origin, -Vec3::X), None);
    let face = 8;
    let kept = distances_behind(&world, origin, face, &Handle::default());
    let cube = DistanceCube::new(face, &kept, &[]);
    assert!((cube.distance(Vec3::X) - 1.9).abs() < 1e-3, "{}", cube.distance(Vec3::X));
    assert_eq!(cube.distance(Vec3::NEG_X), 0.0);
}

#[test]
fn a_second_layer_is_kept_with_the_first() {
    let room = gallery::open("crate").unwrap();
    let world = World::new(&Arc::new(room), Options::default());
    let of = |layers: u32| {
        prepare(&world, &Sites::new(world.scene(), Defaults { layers, ..DEFAULTS }), &Handle::default()).unwrap()
    };
    let (one, two) = (of(1), of(2));
    let [front, both] = [&one, &two].map(|prepared| Probes::of(prepared).get(0).unwrap());
    assert!(front.behind().is_none());
    let second = both.behind().unwrap();
    assert_eq!(front.distances.distance(Vec3::X), both.distances.distance(Vec3::X));
    assert_eq!(front.maps.floats("distances"), both.maps.floats("distances"));
    // What is behind is farther away, and there is some of it.
    let mut count = 0;
    for i in 0..6 * 16 * 16 {
        let direction = DistanceCube::direction(16, i / 256, i % 16, i / 16 % 16);
        let (before, behind) = (both.distances.distance(direction), second.distances.distance(direction));
        assert!(behind == 0.0 || behind > before, "{direction} {before} {behind}");
        count += usize::from(behind > 0.0);
    }
    assert!(count > 50 && count < 6 * 16 * 16 / 2, "{count}");
    assert_eq!(Sites::new(world.scene(), Defaults { layers: 2, ..DEFAULTS }).coarse().list[0].layers, 1);
    let folder = std::env::temp_dir().join(format!("burnish-probe-layers-{}", std::process::id()));
    let store = crate::lighting::Store::within(&folder);
    store.keep("k", &two).unwrap();
    assert_eq!(store.read("k"), Some(two.clone()));
    std::fs::remove_dir_all(folder).unwrap();
}
