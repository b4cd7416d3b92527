// Fills the G-buffer. Mirrored instances are drawn with the winding turned round, so front_facing needs no correction.

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front_facing: bool) -> Packed {
    let texel = resolve(in, front_facing);
    if cut_away(texel, in.instance) {
        discard;
    }
    return texel_pack(texel);
}
