//! One reflectance curve of each form, and the buffer of tables that both languages look things up in.

use std::sync::LazyLock;

use burnish_core::lighting::area;
use burnish_core::lighting::area_cube::tables;
use burnish_core::lighting::classical::mean_fresnel_table;
use burnish_core::surface::fresnel::{Fresnel, TABLE_SIZE};
use burnish_core::surface::ggx::Masking;
use burnish_core::surface::ggx::albedo::{ALBEDO_STRIDE, AlbedoTable};
use glam::Vec3;

/// WGSL that reads the curves: `parity_curve`, `parity_curve_mean` and `parity_curve_albedo`.
pub const WGSL: &str = include_str!("curves.wgsl");

/// Curves in [`Curves::all`].
pub const COUNT: usize = 9;
/// Floats of the fields of a curve.
const FIELDS: usize = 22;

/// A curve with what comes with it.
pub struct Curve {
    pub fresnel: Fresnel,
    pub mean: Vec3,
    /// Split-sum table of either masking; none where the curve has a closed form.
    pub albedo: Option<[Vec<f32>; 2]>,
}

/// Everything in the buffer, and the curves in Rust.
pub struct Curves {
    pub all: [Curve; COUNT],
    pub floats: Vec<f32>,
}

/// Place of the cosines of area lights in the buffer.
pub const AREA: u32 = 2 * ALBEDO_STRIDE;

/// Place of the tables of area cubes in the buffer.
pub const AREA_CUBE: u32 = AREA + 2 * area::STRIDE;

/// Place of the first curve's fields in the buffer.
pub fn first() -> u32 {
    AREA_CUBE + tables::NORMALS + 2 * tables::STRIDE
}

static CURVES: LazyLock<Curves> = LazyLock::new(|| {
    // Gold at 650, 550 and 450 nm, nearly.
    let (n, k) = (Vec3::new(0.16, 0.42, 1.38), Vec3::new(3.6, 2.35, 1.91));
    // Not a metal's curve but one whose entries differ from each other in every channel.
    let table = Box::new(std::array::from_fn(|i| {
        let x = i as f32 / (TABLE_SIZE - 1) as f32;
        Vec3::new(1.0 - 0.4 * x, 1.0 - 0.9 * x + 0.3 * x * x, (1.0 - x) * (1.0 - x))
    }));
    // Red above 1 as gold has it; the coefficients are of the size that metals have, of both signs.
    let f0 = Vec3::new(1.037, 0.73, 0.36);
    let [a, b, c] = [(0.05, -0.9, 3.1), (0.3, 0.6, 1.2), (-0.2, 2.4, 0.4)].map(Vec3::from);
    let forms = [
        Fresnel::rescaled(n, k),
        Fresnel::schlick(n),
        Fresnel::Conductor { n, k },
        Fresnel::Spectral { table },
        Fresnel::Compensated { f0, a, alpha: Vec3::new(0.3, 5.2, 9.0) },
        Fresnel::F82 { f0, b: a },
        Fresnel::Series2 { f0, c: [a, b] },
        Fresnel::Series3 { f0, c: [a, b, c] },
        Fresnel::Series4 { f0, c: [a, b, c, -b] },
    ];
    let all = forms.map(|fresnel| {
        let closed = matches!(fresnel, Fresnel::Rescaled { .. } | Fresnel::Schlick { .. });
        let albedo = (!closed).then(|| Masking::ALL.map(|masking| mean_fresnel_table(&fresnel, masking)));
        Curve { mean: fresnel.mean(), fresnel, albedo }
    });
    let floats = floats(&all);
    Curves { all, floats }
});

impl Curves {
    /// Made at first use.
    pub fn get() -> &'static Curves {
        &CURVES
    }
}

/// The albedo tables, the cosines of area lights, the tables of area cubes, the fields of all curves, then their tables.
fn floats(curves: &[Curve]) -> Vec<f32> {
    let mut floats = [AlbedoTable::get().flat(), area::table(), tables::flat()].concat();
    assert_eq!(floats.len(), first() as usize);
    floats.resize(floats.len() + FIELDS * curves.len(), 0.0);
    for (i, curve) in curves.iter().enumerate() {
        let mut table = 0;
        if let Fresnel::Spectral { table: entries } = &curve.fresnel {
            table = floats.len();
            floats.extend(entries.iter().flat_map(Vec3::to_array));
        }
        let mut albedo = [0; 2];
        for (place, table) in albedo.iter_mut().zip(curve.albedo.iter().flatten()) {
            *place = floats.len();
            floats.extend(table);
        }
        // Whole numbers below 2^24 keep every digit.
        let numbers = [curve.fresnel.form() as usize, table, albedo[0], albedo[1]].map(|v| v as f32);
        let [f0, c0, c1, c2, c3] = curve.fresnel.coefficients();
        let fields = [f0, c0, c1, c2, c3, curve.mean].map(|v| v.to_array());
        let at = first() as usize + FIELDS * i;
        floats[at..at + FIELDS].copy_from_slice(&[&numbers, fields.as_flattened()].concat());
    }
    floats
}
