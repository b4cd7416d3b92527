//! Punctual lights (KHR_lights_punctual) and cameras, from local to world space.

use std::f32::consts::FRAC_PI_2;

use ::gltf::json::Root;
use ::gltf::json::camera::Type as CameraType;
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light as Json, Type};
use ::gltf::json::validation::Checked;
use glam::{Affine3A, DAffine3, DVec3, Mat3, Vec3};

use crate::import::Cause;
use crate::import::numbers::pick;
use crate::import::report::Report;
use crate::scene::{Camera, Light, LightKind, Projection};

/// Least difference of the cone angles, so that the falloff between them never divides by zero.
const CONE_STEP: f32 = 1e-3;

/// A light on a node; its intensity is not changed by the node's scale.
pub(super) fn light(
    root: &Root,
    index: usize,
    name: String,
    world_from_local: DAffine3,
    at: &str,
    report: &mut Report,
) -> Result<Light, Cause> {
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map_or(&[][..], |l| &l.lights);
    let json = pick(lights, index, "light")?;
    let mut intensity = Vec3::from(json.color) * json.intensity;
    if !intensity.is_finite() {
        return Err(Cause::Invalid(format!("light {index}: colour or intensity is not finite")));
    }
    if intensity.min_element() < 0.0 {
        report.notice(at, "a negative light intensity was set to 0");
        intensity = intensity.max(Vec3::ZERO);
    }
    let range = json.range.filter(|r| *r > 0.0).unwrap_or(f32::INFINITY);
    if json.range.is_some_and(|r| r.is_nan() || r <= 0.0) {
        report.notice(at, "a light range that is not positive was left out");
    }
    let (rotation, position) = rigid(world_from_local)?;
    Ok(Light {
        name: json.name.clone().filter(|n| !n.is_empty()).unwrap_or(name),
        position,
        direction: -rotation.z_axis,
        intensity,
        range,
        kind: kind(json, index, at, report)?,
        ..Light::default()
    })
}

fn kind(json: &Json, index: usize, at: &str, report: &mut Report) -> Result<LightKind, Cause> {
    Ok(match json.type_ {
        Checked::Valid(Type::Point) => LightKind::Point,
        Checked::Valid(Type::Directional) => LightKind::PARALLEL,
        Checked::Valid(Type::Spot) => {
            let spot = json.spot.clone().unwrap_or_default();
            // An absent `spot` object means the defaults of its fields, which are not those of Rust.
            let outer = if json.spot.is_some() { spot.outer_cone_angle } else { std::f32::consts::FRAC_PI_4 };
            let inner = spot.inner_cone_angle;
            let outer_angle = if outer.is_nan() { FRAC_PI_2 } else { outer.clamp(CONE_STEP, FRAC_PI_2) };
            let inner_angle = if inner.is_nan() { 0.0 } else { inner.clamp(0.0, outer_angle - CONE_STEP) };
            if outer != outer_angle || inner != inner_angle {
                report.notice(at, "spot angles were brought to 0 <= inner < outer <= 90 degrees");
            }
            LightKind::Spot { inner_angle, outer_angle }
        }
        Checked::Invalid => return Err(Cause::Invalid(format!("light {index}: the type is unknown"))),
    })
}

/// A camera on a node; scale is removed from its transform, as glTF asks.
pub(super) fn camera(root: &Root, index: usize, name: String, world_from_local: DAffine3) -> Result<Camera, Cause> {
    let json = pick(&root.cameras, index, "camera")?;
    let invalid = |what: &str| Cause::Invalid(format!("camera {index}: {what}"));
    let positive = |v: f32| v.is_finite() && v > 0.0;
    let projection = match (&json.type_, &json.perspective, &json.orthographic) {
        (Checked::Valid(CameraType::Perspective), Some(p), _) => {
            if !(positive(p.yfov) && p.yfov < std::f32::consts::PI && positive(p.znear)) {
                return Err(invalid("the field of view is not between 0 and pi, or the near plane not positive"));
            }
            Projection::Perspective { yfov: p.yfov, near: p.znear }
        }
        (Checked::Valid(CameraType::Orthographic), _, Some(o)) => {
            let sound = o.ymag.is_finite() && o.ymag != 0.0 && o.znear >= 0.0 && o.zfar > o.znear && o.zfar.is_finite();
            if !sound {
                return Err(invalid("the magnification is 0, or the planes are not 0 <= near < far"));
            }
            Projection::Orthographic { ymag: o.ymag.abs(), near: o.znear, far: o.zfar }
        }
        _ => return Err(invalid("has no projection of its type")),
    };
    let (rotation, position) = rigid(world_from_local)?;
    let name = json.name.clone().filter(|n| !n.is_empty()).unwrap_or(name);
    Ok(Camera { name, world_from_view: Affine3A::from_mat3_translation(rotation, position), projection })
}

/// Rotation and translation of a transform: z keeps its direction, y stays as near as it can, x follows from them, so
/// that a mirroring does not turn the view inside out.
fn rigid(a: DAffine3) -> Result<(Mat3, Vec3), Cause> {
    let z = a.matrix3.z_axis.normalize_or_zero();
    let y = a.matrix3.y_axis.reject_from_normalized(z).normalize_or_zero();
    if z == DVec3::ZERO || y == DVec3::ZERO || !a.is_finite() {
        return Err(Cause::Invalid("the transform has no direction (a scale of 0)".into()));
    }
    let x = y.cross(z);
    let position = a.translation.as_vec3();
    if !position.is_finite() {
        return Err(Cause::Invalid("the position is not finite".into()));
    }
    Ok((Mat3::from_cols(x.as_vec3(), y.as_vec3(), z.as_vec3()), position))
}
