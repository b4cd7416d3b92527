//! Sound files with bytes changed at random, from fixed seeds.

use std::time::{Duration, Instant};

use burnish_core::import::{Budget, ImportOptions, environment_from_bytes, scene_from_bytes};

use serde_json::json;

use crate::sources::{Nothing, triangle, triangle_glb};

/// Changes per file.
const ROUNDS: u64 = 2000;

/// A file of a kilobyte may not keep us longer, on a busy machine without optimisation.
const SLOWEST: Duration = Duration::from_secs(5);

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// One to four changes: a byte, a bit, a digit, a word of ones, a cut, a piece doubled.
fn mutate(source: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = source.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(8) {
            0 => bytes.truncate(at),
            1 => bytes.extend_from_within(at..),
            2 => bytes.iter_mut().skip(at).take(4).for_each(|b| *b = 0xFF),
            3 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b ^= 1 << (random.next() % 8)),
            // Numbers in text.
            4 | 5 => {
                let digit = bytes.iter().skip(at).position(u8::is_ascii_digit);
                if let Some(byte) = digit.and_then(|offset| bytes.get_mut(at + offset)) {
                    *byte = b"0123456789-.e"[random.below(13)];
                }
            }
            _ => bytes.iter_mut().skip(at).take(1).for_each(|b| *b = random.next() as u8),
        }
    }
    bytes
}

/// Runs `read` over every mutation; it must come back, in time, whatever it says.
fn survive(source: &[u8], seed: u64, read: impl Fn(&[u8])) {
    let mut random = Random(seed);
    for round in 0..ROUNDS {
        let bytes = mutate(source, &mut random);
        let start = Instant::now();
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| read(&bytes)));
        assert!(outcome.is_ok(), "seed {seed}, round {round}: panicked on {:?}", String::from_utf8_lossy(&bytes));
        assert!(start.elapsed() < SLOWEST, "seed {seed}, round {round}: {:?}", start.elapsed());
    }
}

/// Small enough that a mutated size is refused instead of cleared page by page.
fn budget() -> Budget {
    Budget { pixels: 1 << 20, vertices: 1 << 20, triangles: 1 << 20, ..Budget::default() }
}

fn model(bytes: &[u8], name: &str) {
    let options = ImportOptions { budget: budget(), ..ImportOptions::default() };
    match scene_from_bytes(bytes, name, &Nothing, &options) {
        Ok(imported) => imported.scene.validate().expect("a scene that passes its own checks"),
        Err(error) => assert!(error.to_string().starts_with(name), "{error}"),
    }
}

fn environment(bytes: &[u8], name: &str) {
    if let Ok((environment, _)) = environment_from_bytes(bytes, name, &budget()) {
        assert!(environment.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0));
    }
}

#[test]
fn mutated_gltf_and_glb_never_panic() {
    survive(&triangle_glb(), 1, |bytes| model(bytes, "m.glb"));
    let mut rich = triangle();
    rich["materials"] = json!([{
        "pbrMetallicRoughness": { "roughnessFactor": 0.5, "baseColorFactor": [1, 1, 1, 1] },
        "normalTexture": { "index": 0, "scale": 1.0 },
        "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 1 } },
    }]);
    rich["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    rich["nodes"] = json!([
        { "mesh": 0, "children": [1], "scale": [1, 2, 3] },
        { "camera": 0, "rotation": [0, 0, 0, 1] },
    ]);
    survive(rich.to_string().as_bytes(), 2, |bytes| model(bytes, "m.gltf"));
}

#[test]
fn mutated_obj_never_panics() {
    let text = "# box\nmtllib a.mtl\no box\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 -1e-3\nvt 0 0\nvt 1 0\n\
                vt 1 1\nvn 0 0 1\nusemtl x\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\ng top\nf -1//-1 -2//-1 -3//-1\n";
    survive(text.as_bytes(), 3, |bytes| model(bytes, "m.obj"));
}

#[test]
fn mutated_material_libraries_never_panic() {
    use burnish_core::import::{ResolveError, Resolver};
    struct Library<'a>(&'a [u8]);
    impl Resolver for Library<'_> {
        fn read(&self, uri: &str, _budget: u64) -> Result<Vec<u8>, ResolveError> {
            if uri == "a.mtl" { Ok(self.0.to_vec()) } else { Err(ResolveError::Missing { uri: uri.into() }) }
        }
    }
    let mtl = "newmtl x\nKa 0 0 0\nKd 1 0.5 0\nKs 1 1 1\nNs 96.0\nNi 1.45\nd 1.0\nTr 0\nillum 2\nPr 0.5\nPm 1\n\
               map_Kd -o 0 0 0 a.png\nmap_Pr b.png\nbump -bm 0.1 c.png\nnorm d.png\nnewmtl y\nKe 1 1 1\n";
    let obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n";
    survive(mtl.as_bytes(), 4, |bytes| {
        let imported = scene_from_bytes(obj, "m.obj", &Library(bytes), &ImportOptions::default());
        imported.expect("a broken library is a notice").scene.validate().expect("a sound scene");
    });
}

#[test]
fn mutated_hdr_never_panics() {
    let mut hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n-Y 4 +X 8\n".to_vec();
    for _ in 0..2 {
        hdr.extend([2, 2, 0, 8, 136, 128, 8, 1, 2, 3, 4, 5, 6, 7, 128, 136, 0, 136, 129]);
        hdr.extend([[9, 9, 9, 129], [1, 1, 1, 3], [8, 8, 8, 130], [1, 1, 1, 3]].concat());
    }
    assert!(environment_from_bytes(&hdr, "sky.hdr", &budget()).is_ok());
    survive(&hdr, 5, |bytes| environment(bytes, "sky.hdr"));
}
