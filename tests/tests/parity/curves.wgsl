// Curves of the buffer, see curves.rs: form, table, two split-sum tables, f0, four coefficients, mean.

fn parity_curve(index: u32) -> Fresnel {
    let at = PARITY_CURVES + 22u * index;
    let form = u32(parity_table[at]);
    let table = u32(parity_table[at + 1u]);
    return Fresnel(
        form, table, parity_vec3(at + 4u), parity_vec3(at + 7u), parity_vec3(at + 10u), parity_vec3(at + 13u),
        parity_vec3(at + 16u),
    );
}

// Split-sum table, 0 where the curve needs none.
fn parity_curve_albedo(index: u32, masking: u32) -> u32 {
    return u32(parity_table[PARITY_CURVES + 22u * index + 2u + masking]);
}

fn parity_curve_mean(index: u32) -> vec3f {
    return parity_vec3(PARITY_CURVES + 22u * index + 19u);
}
