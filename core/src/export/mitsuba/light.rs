//! Light: lamps, and the environment on a grid that Mitsuba interpolates as we do.

use std::f32::consts::PI;

use glam::{Affine3A, Mat3, Vec3};

use super::element_name;
use super::xml::Element;
use crate::export::{Folder, Loss, Report, image, slug};
use crate::file::FileError;
use crate::scene::{Environment, Light, LightKind};

/// Texels of the profile of a spot light, across and down.
const PROFILE: u32 = 512;
/// Widest cone whose profile is written, in radians: its texels lie in a plane, where a right angle is at infinity.
const WIDEST_PROFILE: f32 = 75.0 * PI / 180.0;

/// A lamp; units are the same, radiance of one nit being one.
pub fn lamp(index: usize, light: &Light, folder: &mut Folder<'_>) -> Result<Element, FileError> {
    let place = element_name("light", index, &light.name);
    if light.range.is_finite() && matches!(light.kind, LightKind::Point | LightKind::Spot { .. }) {
        folder.report.note(&place, Loss::Dropped, "its range: it shines on by the square of distance");
    }
    tell_of_switches(light, &place, &mut folder.report);
    let rgb = |name: &str| Element::rgb(name, light.intensity);
    Ok(match light.kind {
        LightKind::Point => Element::plugin("emitter", "point")
            .with(Element::triple("point", "position", light.position))
            .with(rgb("intensity")),
        LightKind::Directional { angular_radius } => {
            if angular_radius > 0.0 {
                folder.report.note(&place, Loss::Approximated, "its angle: parallel light of the same illuminance");
            }
            Element::plugin("emitter", "directional")
                .with(Element::triple("vector", "direction", light.direction))
                .with(rgb("irradiance"))
        }
        LightKind::Rectangle { across, size } => {
            // The square of Mitsuba reaches from -1 to 1 and shines along its z.
            let up = across.cross(light.direction);
            let axes = Mat3::from_cols(-across * (0.5 * size.x), up * (0.5 * size.y), light.direction);
            Element::plugin("shape", "rectangle")
                .with(Element::transform("to_world", &Affine3A::from_mat3_translation(axes, light.position)))
                .with(Element::plugin("emitter", "area").with(rgb("radiance")))
        }
        LightKind::Sphere { radius } => Element::plugin("shape", "sphere")
            .with(Element::triple("point", "center", light.position))
            .with(Element::float("radius", radius))
            .with(Element::plugin("emitter", "area").with(rgb("radiance"))),
        LightKind::Spot { inner_angle, outer_angle } => {
            let matrix = Affine3A::from_mat3_translation(facing(light.direction), light.position);
            let spot = Element::plugin("emitter", "spot")
                .with(Element::transform("to_world", &matrix))
                .with(Element::float("cutoff_angle", outer_angle.to_degrees()))
                .with(rgb("intensity"));
            if outer_angle > WIDEST_PROFILE {
                folder.report.note(&place, Loss::Approximated, "the edge of its cone by a ramp in the angle");
                return Ok(spot.with(Element::float("beam_width", inner_angle.to_degrees())));
            }
            let file = format!("textures/spot-{}.exr", slug(index, &light.name));
            let values = profile(inner_angle, outer_angle);
            folder.write(&file, &image::exr(&file, PROFILE, PROFILE, vec![("Y", values)])?)?;
            let texture = Element::plugin("texture", "bitmap")
                .named("texture")
                .with(Element::string("filename", &file))
                .with(Element::boolean("raw", true))
                .with(Element::string("wrap_mode", "clamp"));
            // No ramp of its own: the profile has it.
            spot.with(Element::float("beam_width", outer_angle.to_degrees())).with(texture)
        }
    })
}

/// Mitsuba has no switches of lights, and its lights with an area are surfaces.
fn tell_of_switches(light: &Light, place: &str, report: &mut Report) {
    let mut note = |loss, what: &str| report.note(place, loss, what);
    if !light.kind.is_punctual() {
        note(Loss::Approximated, "a surface that hides what is behind it");
        if !light.camera {
            note(Loss::Dropped, "its absence from the view");
        }
    }
    if matches!(light.kind, LightKind::Sphere { .. }) {
        note(Loss::Dropped, "its light on what is inside of it");
    }
    if !light.reflections {
        note(Loss::Dropped, "its absence from reflections");
    }
    if !light.shadows {
        note(Loss::Dropped, "its lack of shadows");
    }
    if !light.unlit.is_empty() {
        note(Loss::Dropped, "the list of objects that it does not light");
    }
}

/// What a spot light gives off through a plane before it, whose edges the outer cone touches: the square of a ramp in the
/// cosine (KHR_lights_punctual, "Inner and Outer Cone Angles").
fn profile(inner_angle: f32, outer_angle: f32) -> Vec<f32> {
    let (edge, inner, outer) = (outer_angle.tan(), inner_angle.cos(), outer_angle.cos());
    let at = |i: u32| (2.0 * (i as f32 + 0.5) / PROFILE as f32 - 1.0) * edge;
    let value = |(x, y): (f32, f32)| {
        let cos = (1.0 + x * x + y * y).sqrt().recip();
        ((cos - outer) / (inner - outer).max(1e-6)).clamp(0.0, 1.0).powi(2)
    };
    (0..PROFILE * PROFILE).map(|i| value((at(i % PROFILE), at(i / PROFILE)))).collect()
}

/// A rotation that takes +z to a direction.
fn facing(direction: Vec3) -> Mat3 {
    let z = direction.normalize_or(Vec3::Z);
    let (x, y) = z.any_orthonormal_pair();
    // Right-handed, whichever way the pair turns.
    if x.cross(y).dot(z) > 0.0 { Mat3::from_cols(x, y, z) } else { Mat3::from_cols(y, x, z) }
}

/// The environment.
///
/// Across, Mitsuba has its nodes at the centres of texels, as we do. Down it has one on each pole and as many steps between
/// as rows less one: with two steps for each of our texels there is a node at every centre and at every edge, and what is
/// linear between centres is met everywhere.
pub fn environment(map: &Environment, folder: &mut Folder<'_>) -> Result<Element, FileError> {
    let (width, texels) = refined(map);
    // Mitsuba has one factor for all channels.
    let channel = |i: usize| texels.iter().map(|texel| map.tint[i] * texel[i]).collect();
    let channels = vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))];
    let height = texels.len() as u32 / width.max(1);
    let file = "textures/environment.exr";
    folder.write(file, &image::exr(file, width, height, channels)?)?;
    // The left edge of a map is -z there and +z here.
    let half_turn = Mat3::from_diagonal(Vec3::new(-1.0, 1.0, -1.0));
    let turned = Affine3A::from_mat3(Mat3::from_rotation_y(map.rotation) * half_turn);
    Ok(Element::plugin("emitter", "envmap")
        .with(Element::string("filename", file))
        .with(Element::float("scale", map.strength))
        .with(Element::transform("to_world", &turned)))
}

/// The map with `2 height + 1` rows, and at least two columns; returns its width.
fn refined(map: &Environment) -> (u32, Vec<Vec3>) {
    let (width, height) = (map.width.max(1) as usize, map.height.max(1) as usize);
    let columns = width.max(2);
    let texel = |x: usize, y: usize| map.texels.get(y * width + x % width).copied().unwrap_or(Vec3::ZERO);
    let mut texels = Vec::with_capacity(columns * (2 * height + 1));
    for node in 0..=2 * height {
        // The rows whose centres lie above and below the node, or one on a centre.
        let (above, below) = (node.saturating_sub(1) / 2, (node / 2).min(height - 1));
        texels.extend((0..columns).map(|x| 0.5 * (texel(x, above) + texel(x, below))));
    }
    (columns as u32, texels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_the_refined_map_are_centres_and_edges_of_the_texels() {
        let texels = (0..6).map(|i| Vec3::splat((i * i) as f32)).collect();
        let map = Environment::new("e", 2, 3, texels);
        let (width, refined) = refined(&map);
        assert_eq!((width, refined.len()), (2, 14));
        let left: Vec<f32> = refined.iter().step_by(2).map(|t| t.x).collect();
        assert_eq!(left, [0.0, 0.0, 2.0, 4.0, 10.0, 16.0, 16.0]);
    }

    #[test]
    fn one_texel_becomes_two_columns() {
        let (width, refined) = refined(&Environment::new("e", 1, 1, vec![Vec3::ONE]));
        assert_eq!((width, refined), (2, vec![Vec3::ONE; 6]));
    }

    #[test]
    fn a_spot_looks_along_its_direction() {
        for direction in [Vec3::Z, Vec3::NEG_Z, Vec3::Y, Vec3::new(0.3, -0.8, 0.1)] {
            let m = facing(direction);
            assert!((m * Vec3::Z - direction.normalize()).length() < 1e-6 && (m.determinant() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn the_profile_is_full_within_the_inner_cone_and_ends_at_the_outer() {
        let values = profile(0.2, 0.5);
        let at = |angle: f32| {
            let x = 0.5 * (angle.tan() / 0.5_f32.tan() + 1.0) * PROFILE as f32;
            values[(PROFILE / 2 * PROFILE) as usize + (x as usize).min(PROFILE as usize - 1)]
        };
        assert_eq!((at(0.0), at(0.19)), (1.0, 1.0));
        assert!(at(0.499) < 1e-3, "{}", at(0.499));
        let middle = (0.35_f32.cos() - 0.5_f32.cos()) / (0.2_f32.cos() - 0.5_f32.cos());
        assert!((at(0.35) - middle * middle).abs() < 0.01);
    }
}
