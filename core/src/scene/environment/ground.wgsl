// A background on a ground: where a ray from the eye meets dome and disc. Twin of ground.rs.

// Direction from the centre of the dome to where the ray leaves it or meets the disc; w is the distance to the disc along
// the ray, 0 where it is not met. `direction` is a unit vector.
fn ground_project(origin: vec3f, direction: vec3f, center: vec3f, height: f32, radius: f32) -> vec4f {
    let o = origin - center;
    let b = dot(o, direction);
    // Past the rim of the dome the nearest point of the ray, so that nothing jumps there.
    let exit = -b + sqrt(max(b * b - dot(o, o) + radius * radius, 0.0));
    if exit <= 0.0 {
        return vec4f(direction, 0.0);
    }
    let above = o.y + height;
    if above > 0.0 && direction.y < 0.0 {
        let reach = -above / direction.y;
        if reach > 0.0 && reach < exit {
            let p = o + reach * direction;
            if dot(p, p) < radius * radius {
                return vec4f(normalize(p), reach);
            }
        }
    }
    return vec4f(normalize(o + exit * direction), 0.0);
}
