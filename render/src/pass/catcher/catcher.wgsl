// Shadows on the ground of the background: the share of its light that surfaces block, per channel. Twin of
// core/src/reference/backdrop.rs, but that nothing blocks the sky here.

@group(1) @binding(0) var words0: texture_2d<u32>;

// How far above the ground points of it lie, as a share of the height of the map above it.
const CATCHER_LIFT: f32 = 1e-4;

// As floats into the second words of the G-buffer.
@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4u {
    let pixel = vec2u(position.xy);
    if textureLoad(words0, pixel, 0).x != 0u {
        discard;
    }
    let origin = eye(position.xy);
    let direction = background_direction(position.xy);
    let found = background_found(origin, direction);
    if found.w <= 0.0 {
        discard;
    }
    let at = origin + found.w * direction;
    let level = background.center.y - background.height * (1.0 - CATCHER_LIFT);
    let blocked = catcher_blocked(vec3f(at.x, level, at.z), sample_rotation(pixel));
    return vec4u(bitcast<vec3u>(blocked), 0u);
}

fn catcher_blocked(position: vec3f, rotation: vec2f) -> vec3f {
    let up = vec3f(0.0, 1.0, 0.0);
    var all = classical_irradiance(up);
    var blocked = vec3f(0.0);
    for (var i = 0u; i < view.light_count; i++) {
        let light = lights[i];
        var irradiance = vec3f(0.0);
        var visible = 1.0;
        if areas && light.kind >= LIGHT_RECTANGLE {
            let frame = Frame(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), up);
            var polygon = area_polygon(area_local(lamp_shape(light, position), frame));
            irradiance = lamp_radiance(light) * max(area_flux(&polygon).z, 0.0);
            visible = soft_visibility(light, position, up, rotation);
        } else {
            let lamp = lamp_at(light, position);
            irradiance = lamp.irradiance * max(lamp.direction.y, 0.0);
            visible = shadow_visibility(light, position, up, lamp.direction, lamp.distance);
        }
        all += irradiance;
        blocked += irradiance * (1.0 - visible);
    }
    return select(vec3f(0.0), blocked / max(all, vec3f(1e-30)), all > vec3f(0.0));
}
