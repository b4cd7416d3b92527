use std::f32::consts::PI;
use std::sync::Arc;

use super::*;
use crate::lighting::probe::{Defaults, DistanceCube, Sites, prepare};
use crate::lighting::{Prepared, Store};
use crate::math::sampling::Random;
use crate::scene::{ProbeSource, Scene, gallery};

/// Draws a formula.
struct Formula(fn(Vec3) -> Vec3);

/// Cannot draw.
#[derive(Debug)]
struct Unfit(MethodError);

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Formula")
    }
}

impl Raster for Formula {
    fn faces(&self, _: &World, _: Vec3, edge: u32, _: &Handle) -> Result<Vec<Vec3>, MethodError> {
        Ok(faces_of(edge, self.0))
    }
}

impl Raster for Unfit {
    fn faces(&self, _: &World, _: Vec3, _: u32, _: &Handle) -> Result<Vec<Vec3>, MethodError> {
        Err(self.0.clone())
    }
}

fn faces_of(edge: u32, light: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    let texel = |i: u32| light(DistanceCube::direction(edge, i / (edge * edge), i % edge, i / edge % edge));
    (0..6 * edge * edge).map(texel).collect()
}

/// Integral of a map over all directions.
fn power(map: &Environment) -> Vec3 {
    let row = |y: u32| {
        let edge = |row: u32| (PI * row as f32 / map.height as f32).cos();
        let of_texel = (edge(y) - edge(y + 1)) * 2.0 * PI / map.width as f32;
        let first = (y * map.width) as usize;
        of_texel * map.texels[first..first + map.width as usize].iter().sum::<Vec3>()
    };
    (0..map.height).map(row).sum()
}

#[test]
fn what_is_drawn_is_found_in_its_direction() {
    let light = |d: Vec3| Vec3::new(1.0 + d.x, 1.0 + d.y * d.z, 1.0 - 0.5 * d.z);
    let map = unfolded(32, drawn_edge(32), &faces_of(128, light), &Handle::default()).unwrap();
    let mut random = Random::new(3);
    for _ in 0..2000 {
        let u = random.point2();
        let (sin, cos) = (2.0 * PI * u.x).sin_cos();
        let y = 1.0 - 2.0 * u.y;
        let level = (1.0 - y * y).sqrt();
        let d = Vec3::new(level * cos, y, level * sin);
        // Half a texel of the map, to which its outermost rows are even.
        assert!(map.radiance(d).abs_diff_eq(light(d), 0.025), "{d}: {} {}", map.radiance(d), light(d));
    }
}

#[test]
fn a_single_bright_texel_keeps_its_power_wherever_it_lies() {
    for face in [16, 48, 300] {
        let edge = drawn_edge(face);
        let middle = edge / 2;
        // The middle of a face, two places off it, an edge, a corner, where texels are a third as wide.
        for (x, y) in [(middle, middle), (middle + 3, middle / 2), (edge / 5, 1), (0, middle), (0, 0)] {
            for side in 0..6 {
                let mut faces = vec![Vec3::ZERO; (6 * edge * edge) as usize];
                faces[((side * edge + y) * edge + x) as usize] = Vec3::new(1000.0, 0.0, 0.0);
                let map = unfolded(face, edge, &faces, &Handle::default()).unwrap();
                let p = (Vec2::new(x as f32, y as f32) + 0.5) / edge as f32 * 2.0 - 1.0;
                let angle = cube::weight(p) * (2.0 / edge as f32).powi(2);
                let kept = power(&map).x / (1000.0 * angle);
                let most = if (x, y) == (0, 0) { 0.15 } else { 0.05 };
                assert!((kept - 1.0).abs() < most, "{face}: {kept} of the texel {x} {y} of face {side}");
            }
        }
    }
}

fn sites(scene: &Scene, source: ProbeSource) -> Sites {
    let mut sites = Sites::new(scene, Defaults { face: 16, paths: 2, layers: 1 });
    sites.list.iter_mut().for_each(|site| site.source = source);
    sites
}

fn prepared(raster: Option<Arc<dyn Raster>>, source: ProbeSource) -> Result<Prepared, MethodError> {
    let world = World::new(&Arc::new(gallery::open("room").unwrap()), Options::default()).with_raster(raster);
    prepare(&world, &sites(world.scene(), source), &Handle::default())
}

#[test]
fn a_probe_is_drawn_where_someone_draws_and_traced_where_nobody_can() {
    let raster = ProbeSource::Raster;
    let drawn = prepared(Some(Arc::new(Formula(|_| Vec3::splat(3.0)))), raster).unwrap();
    let irradiance = |prepared: &Prepared| prepared.parts()[0].halves("irradiance")[0].to_f32();
    assert!((irradiance(&drawn) / (3.0 * PI) - 1.0).abs() < 2e-3, "{}", irradiance(&drawn));
    let traced = prepared(None, raster).unwrap();
    assert!((irradiance(&traced) / irradiance(&drawn) - 1.0).abs() > 0.1, "rooms are not even");
    let unfit = Unfit(MethodError::Unfit("no device".into()));
    assert_eq!(prepared(Some(Arc::new(unfit)), raster).unwrap(), traced);
    assert_eq!(prepared(Some(Arc::new(Unfit(MethodError::Cancelled))), raster), Err(MethodError::Cancelled));
    let distances = |prepared: &Prepared| prepared.parts()[0].floats("distances").to_vec();
    assert_eq!(distances(&drawn), distances(&traced), "they stay those of rays");
}

#[test]
fn what_lies_behind_a_drawn_probe_has_direct_light_too() {
    let room = Arc::new(gallery::open("crate").unwrap());
    let second = |bounces, source| {
        let world = World::new(&room, Options { bounces, ..Options::default() });
        let mut sites = sites(&room, source);
        sites.list.iter_mut().for_each(|site| site.layers = 2);
        prepare(&world, &sites, &Handle::default()).unwrap().parts()[0].parts()[0].clone()
    };
    let drawn = second(64, ProbeSource::Raster);
    assert!(drawn == second(1, ProbeSource::Traced));
    assert!(drawn != second(64, ProbeSource::Traced), "light that bounces is there to be left out");
}

#[test]
fn a_traced_probe_is_never_drawn_and_alone_is_kept() {
    let traced = prepared(None, ProbeSource::Traced).unwrap();
    let anyway = prepared(Some(Arc::new(Formula(|_| Vec3::ONE))), ProbeSource::Traced).unwrap();
    assert_eq!(traced, anyway);
    let folder = std::env::temp_dir().join(format!("burnish-raster-{}", std::process::id()));
    let store = Store::within(&folder);
    let drawn = prepared(Some(Arc::new(Formula(|_| Vec3::ONE))), ProbeSource::Raster).unwrap();
    assert!(drawn.is_fleeting() && !traced.is_fleeting());
    store.keep("drawn", &drawn).unwrap();
    store.keep("traced", &traced).unwrap();
    let kept = (store.read("drawn"), store.read("traced"));
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(kept, (None, Some(traced)));
}
