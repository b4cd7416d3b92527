//! Camera, film, sampler and integrator.

use glam::{Affine3A, Vec3};

use super::View;
use super::xml::Element;
use crate::scene::{Bounds, Projection};

/// Mitsuba refuses a near plane at 0, metres.
const LEAST_NEAR: f32 = 1e-6;
/// Mitsuba's far plane, unless the scene is larger, metres.
const FAR: f32 = 1e4;

/// The camera with its film and sampler. It looks along +z and has +x on its left.
pub fn sensor(view: &View<'_>, bounds: Bounds) -> Element {
    let size = view.size;
    let turned = view.camera.world_from_view * Affine3A::from_scale(Vec3::new(-1.0, 1.0, -1.0));
    let far = |near: f32| {
        let middle = if bounds.is_empty() { 0.0 } else { Vec3::from(turned.translation).distance(bounds.center()) };
        FAR.max(4.0 * (middle + bounds.radius() + near))
    };
    let sensor = match view.camera.projection {
        Projection::Perspective { yfov, near } => Element::plugin("sensor", "perspective")
            .with(Element::string("fov_axis", "y"))
            .with(Element::float("fov", yfov.to_degrees()))
            .with(Element::float("near_clip", near.max(LEAST_NEAR)))
            .with(Element::float("far_clip", far(near)))
            .with(Element::transform("to_world", &turned)),
        Projection::Orthographic { ymag, near, .. } => {
            // It sees from -1 to 1 across, and as much down as the film is high for its width.
            let scale = ymag * size.x as f32 / size.y.max(1) as f32;
            let scaled = turned * Affine3A::from_scale(Vec3::new(scale, scale, 1.0));
            Element::plugin("sensor", "orthographic")
                .with(Element::float("near_clip", near.max(LEAST_NEAR)))
                .with(Element::float("far_clip", far(near)))
                .with(Element::transform("to_world", &scaled))
        }
    };
    let film = Element::plugin("film", "hdrfilm")
        .with(Element::integer("width", size.x.into()))
        .with(Element::integer("height", size.y.into()))
        .with(Element::string("pixel_format", "rgb"))
        .with(Element::string("component_format", "float32"))
        .with(Element::plugin("rfilter", "box"));
    let sampler = Element::plugin("sampler", "independent").with(Element::integer("sample_count", view.samples.into()));
    sensor.with(film).with(sampler)
}

/// Paths of as many surfaces as ours. `transparent`: with surfaces that let light through, which only the volumetric path
/// tracer looks through on the way to a lamp.
pub fn integrator(view: &View<'_>, transparent: bool) -> Element {
    let kind = if transparent { "volpath" } else { "path" };
    // It counts the lamp as well.
    Element::plugin("integrator", kind)
        .with(Element::integer("max_depth", u64::from(view.bounces) + 1))
        .with(Element::integer("rr_depth", ROULETTE_DEPTH))
}

/// Where Russian roulette begins, as in [`crate::reference`].
const ROULETTE_DEPTH: u64 = 5;

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::scene::Camera;

    #[test]
    fn the_camera_is_turned_to_look_along_its_z() {
        let camera = Camera::look_at("c", Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, 1.0);
        let view = View { camera: &camera, size: UVec2::new(8, 4), samples: 16, bounces: 8 };
        let text = sensor(&view, Bounds::EMPTY).to_string();
        assert!(text.contains("value=\"-1 0 0 0 0 1 0 0 0 0 -1 5 0 0 0 1\"") && text.contains("fov_axis"), "{text}");
        assert!(integrator(&view, false).to_string().contains("name=\"max_depth\" value=\"9\""));
    }

    #[test]
    fn an_orthographic_camera_is_scaled_by_what_it_sees_across() {
        let projection = Projection::Orthographic { ymag: 1.5, near: 0.0, far: 9.0 };
        let camera = Camera { name: String::new(), world_from_view: Affine3A::IDENTITY, projection };
        let view = View { camera: &camera, size: UVec2::new(8, 4), samples: 16, bounces: 8 };
        let text = sensor(&view, Bounds::EMPTY).to_string();
        assert!(text.contains("value=\"-3 0 0 0 0 3 0 0 0 0 -1 0 0 0 0 1\""), "{text}");
    }
}
