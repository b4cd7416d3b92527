// Fresnel reflectance of metals. The pass supplies fresnel_table(table, entry).

const FRESNEL_RESCALED: u32 = 0u;
const FRESNEL_SCHLICK: u32 = 1u;
const FRESNEL_CONDUCTOR: u32 = 2u;
const FRESNEL_SPECTRAL: u32 = 3u;
const FRESNEL_COMPENSATED: u32 = 4u;
const FRESNEL_F82: u32 = 5u;
const FRESNEL_SERIES2: u32 = 6u;
const FRESNEL_SERIES3: u32 = 7u;
const FRESNEL_SERIES4: u32 = 8u;
const FRESNEL_TABLE_SIZE: u32 = 256u;
// Range of n and k in which f32 neither over- nor underflows.
const FRESNEL_INDEX_MIN: f32 = 1e-4;
const FRESNEL_INDEX_MAX: f32 = 1e3;

// A reflectance curve; each form reads the fields that it needs. Never stored in a buffer.
// c0 to c3: n and k, a and alpha, b, or the coefficients of a series.
struct Fresnel {
    form: u32,
    table: u32,
    f0: vec3f,
    c0: vec3f,
    c1: vec3f,
    c2: vec3f,
    c3: vec3f,
}

// f0 + (f90 - f0)(1 - cos)^5.
fn fresnel_schlick(f0: vec3f, f90: f32, cos_theta: f32) -> vec3f {
    let y = 1.0 - clamp(cos_theta, 0.0, 1.0);
    let y2 = y * y;
    return f0 + (vec3f(f90) - f0) * (y2 * y2 * y);
}

// F* - a x (1 - x)^alpha, F* Schlick's curve to 1; alpha above 0.
fn fresnel_compensated(f0: vec3f, a: vec3f, alpha: vec3f, cos_theta: f32) -> vec3f {
    let x = clamp(cos_theta, 0.0, 1.0);
    let y = 1.0 - x;
    // One logarithm for the three channels; 1e-8 is below the least y that is not 0.
    let power = select(vec3f(0.0), exp2(alpha * log2(max(y, 1e-8))), y > 0.0);
    return fresnel_schlick(f0, 1.0, x) - x * a * power;
}

// The same with the exponent 6.
fn fresnel_f82(f0: vec3f, b: vec3f, cos_theta: f32) -> vec3f {
    let x = clamp(cos_theta, 0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    return fresnel_schlick(f0, 1.0, x) - x * (y2 * y2 * y2) * b;
}

// F* - x (c0 y^3 + c1 y^8), y = 1 - x.
fn fresnel_series2(f0: vec3f, c0: vec3f, c1: vec3f, cos_theta: f32) -> vec3f {
    let x = clamp(cos_theta, 0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    let y4 = y2 * y2;
    return fresnel_schlick(f0, 1.0, x) - (x * y2 * y) * (c0 + (y4 * y) * c1);
}

// F* - x (c0 y^2 + c1 y^6 + c2 y^12).
fn fresnel_series3(f0: vec3f, c0: vec3f, c1: vec3f, c2: vec3f, cos_theta: f32) -> vec3f {
    let x = clamp(cos_theta, 0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    let y4 = y2 * y2;
    let y6 = y4 * y2;
    return fresnel_schlick(f0, 1.0, x) - (x * y2) * (c0 + y4 * (c1 + y6 * c2));
}

// F* - x (c0 y^2 + c1 y^4 + c2 y^8 + c3 y^16).
fn fresnel_series4(f0: vec3f, c0: vec3f, c1: vec3f, c2: vec3f, c3: vec3f, cos_theta: f32) -> vec3f {
    let x = clamp(cos_theta, 0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    let y4 = y2 * y2;
    return fresnel_schlick(f0, 1.0, x) - (x * y2) * (c0 + y2 * (c1 + y4 * (c2 + (y4 * y4) * c3)));
}

// Exact unpolarised reflectance of one complex index n + ik from vacuum, in the form that keeps its digits in f32.
fn fresnel_conductor(n: f32, k: f32, cos_theta: f32) -> f32 {
    let eta = clamp(n, FRESNEL_INDEX_MIN, FRESNEL_INDEX_MAX);
    let kappa = clamp(k, 0.0, FRESNEL_INDEX_MAX);
    let c = clamp(cos_theta, 0.0, 1.0);
    let c2 = c * c;
    let s2 = (1.0 - c) * (1.0 + c);
    let t0 = (eta - kappa) * (eta + kappa) - s2;
    let nk = eta * kappa;
    let ab = sqrt(t0 * t0 + 4.0 * nk * nk);
    // Real part of sqrt(t0 + 2ink); the larger part first, so that nothing cancels.
    let larger = sqrt(0.5 * (ab + abs(t0)));
    let smaller = nk / max(larger, 1e-20);
    let a = select(larger, smaller, t0 < 0.0);
    let t1 = ab + c2;
    let t2 = 2.0 * a * c;
    // At 90 degrees an index of one gives 0 / 0; like every other it reflects all there.
    let rs = select(1.0, (t1 - t2) / (t1 + t2), t1 + t2 > 0.0);
    let t3 = c2 * ab + s2 * s2;
    let t4 = t2 * s2;
    let sum = t3 + t4;
    // Zero only where the surface is the vacuum itself.
    let rp = select(rs, rs * (t3 - t4) / sum, sum > 0.0);
    return clamp(0.5 * (rs + rp), 0.0, 1.0);
}

// Exact unpolarised reflectance of a dielectric; eta = index transmitted / incident, 1 under total reflection.
fn fresnel_dielectric(eta: f32, cos_theta: f32) -> f32 {
    let c = clamp(cos_theta, 0.0, 1.0);
    let g2 = (eta - 1.0) * (eta + 1.0) + c * c;
    if g2 <= 0.0 {
        return 1.0;
    }
    let g = sqrt(g2);
    let rs = (c - g) / (c + g);
    let rp = (eta * eta * c - g) / (eta * eta * c + g);
    return 0.5 * (rs * rs + rp * rp);
}

// Table of 256 entries over the cosine, linear between them.
fn fresnel_spectral(table: u32, cos_theta: f32) -> vec3f {
    let x = clamp(cos_theta, 0.0, 1.0) * f32(FRESNEL_TABLE_SIZE - 1u);
    let entry = min(u32(x), FRESNEL_TABLE_SIZE - 2u);
    return mix(fresnel_table(table, entry), fresnel_table(table, entry + 1u), x - f32(entry));
}

// The curve at the cosine between light and half vector, within [0, 1].
fn fresnel_eval(f: Fresnel, cos_theta: f32) -> vec3f {
    var value: vec3f;
    switch f.form {
        case FRESNEL_CONDUCTOR: {
            value = vec3f(
                fresnel_conductor(f.c0.x, f.c1.x, cos_theta),
                fresnel_conductor(f.c0.y, f.c1.y, cos_theta),
                fresnel_conductor(f.c0.z, f.c1.z, cos_theta),
            );
        }
        case FRESNEL_COMPENSATED: {
            value = fresnel_compensated(f.f0, f.c0, f.c1, cos_theta);
        }
        case FRESNEL_F82: {
            value = fresnel_f82(f.f0, f.c0, cos_theta);
        }
        case FRESNEL_SERIES2: {
            value = fresnel_series2(f.f0, f.c0, f.c1, cos_theta);
        }
        case FRESNEL_SERIES3: {
            value = fresnel_series3(f.f0, f.c0, f.c1, f.c2, cos_theta);
        }
        case FRESNEL_SERIES4: {
            value = fresnel_series4(f.f0, f.c0, f.c1, f.c2, f.c3, cos_theta);
        }
        case FRESNEL_SPECTRAL: {
            value = fresnel_spectral(f.table, cos_theta);
        }
        // Rescaled and Schlick differ in where f0 comes from only.
        default: {
            value = fresnel_schlick(f.f0, 1.0, cos_theta);
        }
    }
    return clamp(value, vec3f(0.0), vec3f(1.0));
}
