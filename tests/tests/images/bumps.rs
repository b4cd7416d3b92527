//! Procedural bumps on pixels.

use burnish_core::lighting::classical::PARAMS;
use burnish_core::material::Material;
use burnish_core::param::Settings;
use burnish_core::surface::micro_normal::Kind;
use burnish_tests::{Need, scenes, trial};
use glam::{Vec3, Vec4Swizzles};
use libtest_mimic::Trial;

use super::render;

pub fn trials() -> Vec<Trial> {
    vec![
        trial("no bumps and bumps without depth change no bit", &[Need::Gpu], without),
        trial("bumps too fine for a pixel are roughness", &[Need::Gpu], too_fine),
        trial("fine bumps are as bright as the coarse ones that they stand for", &[Need::Gpu], as_bright),
    ]
}

fn metal() -> Material {
    Material { base_color: Vec3::new(1.0, 0.75, 0.34), metallic: 1.0, roughness: 0.3, ..Material::default() }
}

fn texels(material: Material) -> Vec<Vec3> {
    let picture = render(&scenes::plate(material), 1, Settings::new(PARAMS)).pop().expect("a camera");
    picture.texels.iter().map(|texel| texel.xyz()).collect()
}

fn without() {
    let plain = texels(metal());
    let none = Material { micro_normal: Kind::None, micro_depth: 1.0, micro_size_mm: 50.0, ..metal() };
    assert!(texels(none) == plain);
    let flat = Material { micro_normal: Kind::Hammered, micro_depth: 0.0, ..metal() };
    assert!(texels(flat) == plain);
    let hammered = Material { micro_normal: Kind::Hammered, micro_size_mm: 50.0, ..metal() };
    assert!(texels(hammered) != plain, "a test that cannot fail");
}

fn too_fine() {
    // A pixel is 5 mm wide.
    let fine = Material { micro_normal: Kind::Hammered, micro_depth: 0.3, micro_size_mm: 1.0, ..metal() };
    let rough = Material { roughness: (0.09f32.powi(2) + 0.3f32.powi(2)).powf(0.25), ..metal() };
    for (a, b) in texels(fine).iter().zip(&texels(rough)) {
        // Widths are packed in 16 bits.
        assert!(a.abs_diff_eq(*b, 1e-3 * b.max_element()), "{a} is not {b}");
    }
}

fn as_bright() {
    for kind in [Kind::Grain, Kind::Cast, Kind::Hammered] {
        let mean = |micro_size_mm: f32| {
            let bumpy = Material { micro_normal: kind, micro_depth: 0.25, micro_size_mm, ..metal() };
            let texels = texels(bumpy);
            texels.iter().sum::<Vec3>() / texels.len() as f32
        };
        // The last is wholly resolved, but for the finest octave of a cast skin; there are some 600 dents in the view.
        let [fine, between, coarse] = [1.0, 12.0, 40.0].map(mean);
        println!("{kind:?}: {fine} {between} {coarse}");
        // Slopes are not quite distributed as those of GGX, whose tails are longer.
        assert!(fine.abs_diff_eq(coarse, 0.05 * coarse.max_element()), "{kind:?}: {fine} is not {coarse}");
        assert!(between.abs_diff_eq(coarse, 0.05 * coarse.max_element()), "{kind:?}: {between} is not {coarse}");
    }
}
