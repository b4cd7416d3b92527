use glam::Vec3;

use super::{Cause, ImportError, ImportOptions, NormalsWhenAbsent, ResolveError, Resolver, scene_from_bytes, sniff};
use crate::import::Budget;
use crate::import::budget::Meter;
use crate::import::picture::Encoded;
use crate::import::report::Report;

struct Nothing;

impl Resolver for Nothing {
    fn read(&self, uri: &str, _budget: u64) -> Result<Vec<u8>, ResolveError> {
        Err(ResolveError::Missing { uri: uri.into() })
    }
}

/// Runs `read` over changed copies of a file, from a fixed seed; it must come back, and within seconds.
pub(super) fn survive(source: &[u8], seed: u64, rounds: usize, read: impl Fn(&[u8])) {
    let mut state = seed;
    // SplitMix64 (Steele, Lea and Flood 2014).
    let mut random = |limit: usize| {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % limit.max(1) as u64) as usize
    };
    for round in 0..rounds {
        let mut bytes = source.to_vec();
        for _ in 0..=random(3) {
            let at = random(bytes.len());
            match random(8) {
                0 => bytes.truncate(at),
                1 => bytes.iter_mut().skip(at).take(4).for_each(|b| *b = 0xFF),
                2 => bytes.iter_mut().skip(at).take(8).for_each(|b| *b = 0x7F),
                _ => bytes.iter_mut().skip(at).take(1).for_each(|b| *b = random(256) as u8),
            }
        }
        let start = std::time::Instant::now();
        read(&bytes);
        assert!(start.elapsed().as_secs() < 5, "seed {seed}, round {round}: {:?}", start.elapsed());
    }
}

#[test]
fn mutated_pictures_never_panic() {
    let picture = image::RgbImage::from_fn(24, 16, |x, y| image::Rgb([x as u8 * 9, y as u8 * 15, 77]));
    for (seed, format) in [(1, image::ImageFormat::Png), (2, image::ImageFormat::Jpeg)] {
        let mut source = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut source, format).unwrap();
        survive(source.get_ref(), seed, 1000, |bytes| {
            let budget = Budget { pixels: 1 << 16, ..Budget::default() };
            let opened = Encoded::open(bytes.to_vec(), "image 0".into(), &mut Meter::new(budget));
            let _ = opened.and_then(|picture| picture.decode());
        });
    }
}

#[test]
fn an_error_prints_one_line_per_fault_with_file_element_cause_and_remedy() {
    let mut report = Report::new("a.glb");
    report.fault("extensionsRequired", Cause::Extension("EXT_meshopt_compression".into()));
    report.fault("buffer 0", Cause::Read(ResolveError::Missing { uri: "'x.bin'".into() }));
    let error = report.finish::<()>(None).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.glb: extensionsRequired: requires the extension EXT_meshopt_compression, which is not supported; \
         export the model without meshopt compression\na.glb: buffer 0: 'x.bin' does not exist"
    );
}

#[test]
fn faults_and_notices_beyond_a_page_are_counted() {
    let mut report = Report::new("a");
    (0..60).for_each(|i| report.fault(format!("mesh {i}"), Cause::Invalid("x".into())));
    let ImportError { faults, omitted } = report.finish(Some(())).unwrap_err();
    assert_eq!((faults.len(), omitted), (50, 10));

    let mut report = Report::new("a");
    (0..300).for_each(|i| report.notice("mesh", format!("kind {i}")));
    (0..5).for_each(|_| report.notice("mesh", "kind 7"));
    let notices = report.finish(Some(())).unwrap().1;
    assert_eq!((notices.len(), notices[7].count, notices[200].count), (201, 6, 100));
}

#[test]
fn the_content_decides_on_the_format() {
    assert_eq!(sniff::model(b"  {\"asset\":", "x.obj"), Ok(sniff::Model::Gltf));
    assert_eq!(sniff::model(b"# made by hand\nv 0 0 0\n", "x.txt"), Ok(sniff::Model::Obj));
    assert!(sniff::model(b"some words\n", "x.txt").is_err());
    assert!(sniff::model(b"ply\nformat ascii", "x.obj").is_err());
}

#[test]
fn missing_normals_of_a_gltf_become_smooth_when_asked_for() {
    // Two triangles folded by 45 degrees about the x axis, as bytes of one accessor.
    let points =
        [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, -1.0, 1.0]];
    let text: String =
        points.as_flattened().iter().flat_map(|p| p.to_le_bytes()).map(|b| format!("%{b:02x}")).collect();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":6}}],
        "bufferViews":[{{"buffer":0,"byteLength":72}}],"buffers":[{{"byteLength":72,"uri":"data:,{text}"}}]}}"#
    );
    let normal = |normals| {
        let options = ImportOptions { normals, ..ImportOptions::default() };
        scene_from_bytes(json.as_bytes(), "m.gltf", &Nothing, &options).unwrap().scene.meshes[0].normals[0]
    };
    assert_eq!(normal(NormalsWhenAbsent::FormatDefault), Vec3::Z);
    assert_eq!(normal(NormalsWhenAbsent::Smooth { crease_angle: 0.5 }), Vec3::Z);
    let between = (Vec3::Z + Vec3::new(0.0, 1.0, 1.0).normalize()).normalize();
    assert!(normal(NormalsWhenAbsent::Smooth { crease_angle: 1.0 }).abs_diff_eq(between, 1e-6));
}
