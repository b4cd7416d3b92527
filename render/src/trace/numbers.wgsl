// Arithmetic that rounds as written: for decisions that must come out alike for neighbours, and as on the processor.
// Compilers may join a product and a sum to one operation that rounds once, and may reorder; shaders cannot forbid it.

/// Zero, but no compiler knows: `trace_walk` reads it from the buffer.
var<private> trace_zero: u32;

/// The number itself, rounded to single precision before anything else is done with it.
fn trace_rounded(x: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(x) ^ vec3u(trace_zero));
}

/// A number rounded to half of its digits. The other half is exact, and so are products of two halves.
fn trace_high(x: vec3f) -> vec3f {
    return bitcast<vec3f>((bitcast<vec3u>(x) + vec3u(0x800u)) & vec3u(0xfffff000u));
}

/// `a b - product` without rounding, where `product` is the rounded `a b`.
///
/// Dekker 1971, A Floating-Point Technique for Extending the Available Precision, section 5.
fn trace_left_of_product(a: vec3f, b: vec3f, product: vec3f) -> vec3f {
    let high_a = trace_high(a);
    let high_b = trace_high(b);
    let low_a = a - high_a;
    let low_b = b - high_b;
    return ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b;
}

/// `a + b - sum` without rounding, where `sum` is the rounded `a + b`.
///
/// Knuth 1969, The Art of Computer Programming, volume 2, section 4.2.2.
fn trace_left_of_sum(a: vec3f, b: vec3f, sum: vec3f) -> vec3f {
    let from_b = trace_rounded(sum - a);
    return trace_rounded(a - trace_rounded(sum - from_b)) + trace_rounded(b - from_b);
}

/// A quotient within a unit in the last place: division alone may be five halves of one away.
fn trace_divided(x: vec3f, y: f32) -> vec3f {
    let quotient = trace_rounded(x / y);
    let product = trace_rounded(quotient * y);
    let left = (x - product) - trace_left_of_product(quotient, vec3f(y), product);
    return quotient + left / y;
}

/// `columns * v` as in double precision, rounded once; both come as a number and what single precision leaves of it.
fn trace_transformed(columns: mat3x3f, columns_left: mat3x3f, v: vec3f, v_left: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    var left = vec3f(0.0);
    for (var i = 0u; i < 3u; i++) {
        let factor = vec3f(v[i]);
        let product = trace_rounded(columns[i] * factor);
        let next = trace_rounded(sum + product);
        left += trace_left_of_product(columns[i], factor, product) + trace_left_of_sum(sum, product, next)
            + (columns[i] * v_left[i] + columns_left[i] * factor);
        sum = next;
    }
    return sum + left;
}

/// `a b - c d` without rounding of the products, for products that are equal when rounded.
///
/// A product of 24 bits by 24 has 48. Equal ones differ by less than 2^27 of the last of these, whatever stands before:
/// the lower words are enough. Products too small for single precision count as zero: such a point is on the edge for
/// both triangles that share it.
fn trace_difference(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let bits = vec4u(bitcast<u32>(a), bitcast<u32>(b), bitcast<u32>(c), bitcast<u32>(d));
    let exponents = (bits >> vec4u(23u)) & vec4u(0xffu);
    if any(exponents == vec4u(0u)) {
        return 0.0;
    }
    let digits = (bits & vec4u(0x7fffffu)) | vec4u(0x800000u);
    let first = i32(exponents.x + exponents.y);
    let second = i32(exponents.z + exponents.w);
    if abs(first - second) > 2 {
        return 0.0;
    }
    let least = min(first, second);
    let difference = ((digits.x * digits.y) << u32(first - least)) - ((digits.z * digits.w) << u32(second - least));
    let negative = ((bits.x ^ bits.y) & 0x80000000u) != 0u;
    // Two exponents have a bias of 127, two numbers 23 digits after the point.
    let magnitude = ldexp(f32(bitcast<i32>(difference)), least - 300);
    return select(magnitude, -magnitude, negative);
}
