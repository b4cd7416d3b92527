// Depth seen from a light; masked materials leave holes. The view's clip_from_world is the light's.

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front_facing: bool) {
    let texel = resolve(in, front_facing);
    if cut_away(texel, in.instance) {
        discard;
    }
}
