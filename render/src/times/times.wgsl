// Evaluates one reflectance curve many times, to be timed. `form` is known when the pipeline is made, as the curve of a
// scene of one metal would be; FORM_NONE leaves the curve out, for what loop and memory cost.

const FORM_NONE: u32 = 99u;

override form: u32 = FORM_NONE;
override loops: u32 = 64u;

@group(0) @binding(0) var<storage, read> numbers: array<f32>;
@group(0) @binding(1) var<storage, read_write> sums: array<vec4f>;

fn fresnel_table(table: u32, entry: u32) -> vec3f {
    let first = table + 3u * entry;
    return vec3f(numbers[first], numbers[first + 1u], numbers[first + 2u]);
}

fn number(i: u32) -> vec3f {
    return vec3f(numbers[3u * i], numbers[3u * i + 1u], numbers[3u * i + 2u]);
}

@compute @workgroup_size(64)
fn times(@builtin(global_invocation_id) id: vec3u) {
    // The table stands behind the five colours.
    let curve = Fresnel(form, 15u, number(0u), number(1u), number(2u), number(3u), number(4u));
    var cosine = fract(f32(id.x) * 0.618034);
    var sum = vec3f(0.0);
    for (var i = 0u; i < loops; i++) {
        // Another angle each time, in a way that cannot be foreseen.
        cosine = fract(cosine + 0.381966);
        if form == FORM_NONE {
            sum += vec3f(cosine);
        } else {
            sum += fresnel_eval(curve, cosine);
        }
    }
    sums[id.x] = vec4f(sum, 0.0);
}
