// Blended surfaces, sorted from far to near, over the lit picture.

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    let texel = resolve(in, front_facing);
    return vec4f(shade(texel, in.position, vec2u(in.clip.xy)), clamp(texel.opacity, 0.0, 1.0));
}
