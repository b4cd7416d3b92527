//! Environments: equirectangular pictures of radiance, as Radiance HDR or OpenEXR.

mod exr;
mod hdr;
mod primaries;
#[cfg(test)]
mod tests;

use std::path::Path;

use glam::Vec3;

use super::report::Report;
use super::{Budget, Cause, ImportError, Notice, sniff};
use crate::scene::Environment;

/// A decoded picture before its values are judged: linear, in the primaries that the file names.
struct Raw {
    width: usize,
    height: usize,
    /// Row 0 at the top.
    texels: Vec<Vec3>,
    primaries: Option<primaries::Primaries>,
}

/// Reads an equirectangular environment from its bytes; `file_name` serves messages and the name.
///
/// The content decides on the format. Texels come out as finite, non-negative linear Rec.709: what was not is repaired
/// and counted in a notice.
pub fn environment_from_bytes(
    bytes: &[u8],
    file_name: &str,
    budget: &Budget,
) -> Result<(Environment, Vec<Notice>), ImportError> {
    let mut report = Report::new(file_name);
    let raw = read(bytes, budget, &mut report);
    let raw = report.keep("file", raw);
    let environment = raw.map(|raw| finish(raw, file_name, &mut report));
    report.finish(environment)
}

fn read(bytes: &[u8], budget: &Budget, report: &mut Report) -> Result<Raw, Cause> {
    let (asked, limit) = (bytes.len() as u64, budget.file_bytes);
    if asked > limit {
        return Err(Cause::Limit { what: "bytes", asked, limit });
    }
    match sniff::describe(bytes) {
        "a Radiance HDR picture" => hdr::read(bytes, budget),
        "an OpenEXR picture" => exr::read(bytes, budget, report),
        found => Err(Cause::Content { found: found.into(), expected: "a Radiance HDR or OpenEXR picture" }),
    }
}

/// Refuses sizes that are zero or over the budget, before memory is taken.
fn check_size(width: u64, height: u64, budget: &Budget) -> Result<(), Cause> {
    if width == 0 || height == 0 {
        return Err(Cause::Invalid(format!("the size is {width}x{height}")));
    }
    // Sides are kept within u32 by the formats, so the product is exact.
    let (asked, limit) = (width.saturating_mul(height), budget.pixels);
    if asked > limit {
        return Err(Cause::Limit { what: "pixels", asked, limit });
    }
    Ok(())
}

/// Converts to Rec.709 and repairs values.
fn finish(raw: Raw, file_name: &str, report: &mut Report) -> Environment {
    let Raw { width, height, mut texels, primaries } = raw;
    if let Some(matrix) = primaries.as_ref().and_then(|p| p.to_rec709(report)) {
        texels.iter_mut().for_each(|t| *t = (matrix * t.as_dvec3()).as_vec3());
        report.notice("primaries", "the colours were converted to Rec.709 primaries");
    }
    repair(&mut texels, report);
    if width != 2 * height {
        report.notice("size", format!("{width}x{height} is not 2:1; the picture is stretched over the sphere"));
    }
    Environment {
        name: Path::new(file_name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default(),
        width: width as u32,
        height: height as u32,
        texels: texels.into(),
        rotation: 0.0,
        strength: 1.0,
        tint: Vec3::ONE,
    }
}

/// NaN and negative values become 0, infinite ones the largest finite value.
fn repair(texels: &mut [Vec3], report: &mut Report) {
    let finite = texels.iter().flat_map(|t| t.to_array()).filter(|v| v.is_finite());
    let greatest = finite.fold(0.0_f32, f32::max);
    let (mut nan, mut negative, mut infinite) = (0, 0, 0);
    for texel in texels.iter_mut() {
        let values = texel.to_array().map(|v| match v {
            _ if v.is_nan() => {
                nan += 1;
                0.0
            }
            _ if v < 0.0 => {
                negative += 1;
                0.0
            }
            _ if v.is_infinite() => {
                infinite += 1;
                greatest
            }
            _ => v,
        });
        *texel = Vec3::from(values);
    }
    report.notice_many("pixels", "values that were not numbers were set to 0", nan);
    report.notice_many("pixels", "negative values were set to 0", negative);
    report.notice_many("pixels", format!("infinite values were set to the largest finite one, {greatest}"), infinite);
    if greatest == 0.0 {
        report.notice("pixels", "the picture is black everywhere");
    }
}
