//! A clear or hazy sky by day: Preetham, Shirley, Smits 1999, A Practical Analytic Model for Daylight.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::{Sun, direction};
use crate::color::rgb;
use crate::scene::Environment;

/// Turbidities for which the model was fitted: 2 very clear, 10 hazy; below 1.7 it has negative light.
pub const TURBIDITY: RangeInclusive<f64> = 1.7..=10.0;
/// Illuminance of the sun outside of the atmosphere at its mean distance, lx (IES RP-21, 1984).
const SUN_LUX: f64 = 127_500.0;
/// Angular radius of the sun at its mean distance, radians: 0.2665 degrees.
const SUN_RADIUS: f32 = 0.004_651;
/// Least cosine of the polar angle: just above the horizon, where the distribution is as good as constant.
const LEAST_COS: f64 = 1e-3;

/// What the sky is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyModel {
    /// Haze, within [`TURBIDITY`].
    pub turbidity: f64,
    /// Of the sun above the horizon, radians, 0 to pi/2.
    pub elevation: f32,
    /// Of the sun from the front (+z) toward +x, radians.
    pub azimuth: f32,
    /// Reflectance of the ground below the horizon, linear Rec.709, 0 to 1.
    pub ground: Vec3,
}

/// Coefficients of one of the quantities Y, x, y.
struct Perez {
    distribution: [f64; 5],
    /// At the zenith.
    zenith: f64,
}

impl Perez {
    /// `F(theta, gamma) = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma)` (eq. 3).
    fn distribution(&self, cos_theta: f64, gamma: f64) -> f64 {
        let [a, b, c, d, e] = self.distribution;
        (1.0 + a * (b / cos_theta.max(LEAST_COS)).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
    }

    /// `zenith F(theta, gamma) / F(0, theta_sun)` (eq. 4).
    fn value(&self, cos_theta: f64, gamma: f64, theta_sun: f64) -> f64 {
        self.zenith * self.distribution(cos_theta, gamma) / self.distribution(1.0, theta_sun)
    }
}

impl SkyModel {
    fn clamped(&self) -> SkyModel {
        SkyModel {
            turbidity: self.turbidity.clamp(*TURBIDITY.start(), *TURBIDITY.end()),
            elevation: self.elevation.clamp(0.0, std::f32::consts::FRAC_PI_2),
            azimuth: self.azimuth,
            ground: self.ground.clamp(Vec3::ZERO, Vec3::ONE),
        }
    }

    /// Polar angle of the sun.
    fn theta_sun(&self) -> f64 {
        std::f64::consts::FRAC_PI_2 - f64::from(self.elevation)
    }

    /// Luminance in kcd/m2 and chromaticity x, y: appendix A.2.
    fn quantities(&self) -> [Perez; 3] {
        let (t, theta) = (self.turbidity, self.theta_sun());
        let chi = (4.0 / 9.0 - t / 120.0) * (std::f64::consts::PI - 2.0 * theta);
        let luminance = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        let line = |terms: [(f64, f64); 5]| terms.map(|(slope, offset)| slope * t + offset);
        let zenith = |rows: [[f64; 4]; 3]| {
            let cubic = |[a, b, c, d]: [f64; 4]| ((a * theta + b) * theta + c) * theta + d;
            let [square, once, alone] = rows.map(cubic);
            (square * t + once) * t + alone
        };
        [
            Perez {
                distribution: line([
                    (0.1787, -1.4630),
                    (-0.3554, 0.4275),
                    (-0.0227, 5.3251),
                    (0.1206, -2.5771),
                    (-0.0670, 0.3703),
                ]),
                zenith: luminance.max(0.0),
            },
            Perez {
                distribution: line([
                    (-0.0193, -0.2592),
                    (-0.0665, 0.0008),
                    (-0.0004, 0.2125),
                    (-0.0641, -0.8989),
                    (-0.0033, 0.0452),
                ]),
                zenith: zenith([
                    [0.00166, -0.00375, 0.00209, 0.0],
                    [-0.02903, 0.06377, -0.03202, 0.00394],
                    [0.11693, -0.21196, 0.06052, 0.25886],
                ]),
            },
            Perez {
                distribution: line([
                    (-0.0167, -0.2608),
                    (-0.0950, 0.0092),
                    (-0.0079, 0.2102),
                    (-0.0441, -1.6537),
                    (-0.0109, 0.0529),
                ]),
                zenith: zenith([
                    [0.00275, -0.00610, 0.00317, 0.0],
                    [-0.04214, 0.08970, -0.04153, 0.00516],
                    [0.15346, -0.26756, 0.06670, 0.26688],
                ]),
            },
        ]
    }

    /// The sky over an even ground, in nit, without the disc of the sun: an equirectangular map. Colours beyond Rec.709
    /// are clamped at 0.
    pub fn map(&self, width: u32, height: u32) -> Environment {
        let model = self.clamped();
        let (width, height) = (width.max(1), height.max(1));
        let [luminance, x, y] = model.quantities();
        let (theta_sun, to_sun) = (model.theta_sun(), direction(model.azimuth, model.elevation));
        let rgb_from_xyz = rgb::rgb_from_xyz();
        let grid = Environment::new("sky", width, height, Vec::new());
        let radiance = |d: Vec3| {
            let (cos_theta, gamma) = (f64::from(d.y), f64::from(d.angle_between(to_sun)));
            let of = |perez: &Perez| perez.value(cos_theta, gamma, theta_sun);
            let (luminance, x, y) = (1000.0 * of(&luminance).max(0.0), of(&x), of(&y));
            let xyz = luminance * DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
            (rgb_from_xyz * xyz).max(DVec3::ZERO).as_vec3()
        };
        let mut texels = vec![Vec3::ZERO; (width * height) as usize];
        texels.par_chunks_exact_mut(width as usize).enumerate().for_each(|(row, texels)| {
            for (column, texel) in texels.iter_mut().enumerate() {
                let d = grid.texel_direction(column as u32, row as u32, Vec2::splat(0.5));
                *texel = if d.y > 0.0 { radiance(d) } else { Vec3::ZERO };
            }
        });
        // The ground is white paper of its reflectance under sky and sun.
        let above = Environment::new("sky", width, height, texels);
        let lit = above.irradiance_up() + model.sun().irradiance * to_sun.y.max(0.0);
        let ground = model.ground * lit / std::f32::consts::PI;
        let below = |row: usize| grid.texel_direction(0, row as u32, Vec2::splat(0.5)).y <= 0.0;
        let mut texels = above.texels.to_vec();
        texels.chunks_exact_mut(width as usize).enumerate().filter(|(row, _)| below(*row)).for_each(|(_, texels)| {
            texels.fill(ground);
        });
        Environment::new("sky", width, height, texels)
    }

    /// The disc of the sun behind the same atmosphere: scattering of air and of haze (appendix A.1), without what ozone,
    /// water and mixed gases absorb. Its light above the atmosphere is taken for D65.
    pub fn sun(&self) -> Sun {
        let model = self.clamped();
        let theta = model.theta_sun();
        // Relative optical mass (Kasten 1965, as the paper has it): theta in degrees.
        let mass = 1.0 / (theta.cos().max(0.0) + 0.15 * (93.885 - theta.to_degrees()).powf(-1.253));
        let beta = 0.04608 * model.turbidity - 0.04586;
        let passed = |nm: f64| {
            let um = nm * 1e-3;
            (-mass * (0.008735 * um.powf(-4.08) + beta * um.powf(-1.3))).exp()
        };
        let irradiance = (SUN_LUX * rgb::integrate(passed)).max(DVec3::ZERO).as_vec3();
        Sun { direction: direction(model.azimuth, model.elevation), irradiance, angular_radius: SUN_RADIUS }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::rgb::luminance;

    fn sky(turbidity: f64, elevation_deg: f32) -> SkyModel {
        SkyModel { turbidity, elevation: elevation_deg.to_radians(), azimuth: 0.7, ground: Vec3::splat(0.2) }
    }

    #[test]
    fn the_zenith_has_the_luminance_and_colour_of_the_fit() {
        for turbidity in [2.0, 4.0, 8.0] {
            for elevation in [5.0, 30.0, 60.0] {
                let model = sky(turbidity, elevation);
                let map = model.map(64, 512);
                let top = map.radiance(Vec3::Y);
                let [wanted, ..] = model.quantities();
                let found = luminance(top);
                assert!((f64::from(found) / (1000.0 * wanted.zenith) - 1.0).abs() < 0.02, "{found} {}", wanted.zenith);
                assert!(top.z > top.x || turbidity > 3.0, "a clear zenith is blue: {top}");
            }
        }
    }

    #[test]
    fn everything_is_finite_and_not_negative_over_the_whole_range() {
        for turbidity in [1.0, 1.7, 3.0, 10.0, 99.0] {
            for elevation in [-10.0, 0.0, 1.0, 45.0, 90.0] {
                let model = sky(turbidity, elevation);
                let map = model.map(32, 16);
                assert!(map.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0), "{model:?}");
                let sun = model.sun();
                assert!(sun.irradiance.is_finite() && sun.irradiance.min_element() >= 0.0, "{sun:?}");
            }
        }
    }

    #[test]
    fn it_is_brightest_about_the_sun_and_the_same_on_both_sides_of_it() {
        let model = sky(3.0, 30.0);
        let map = model.map(1024, 512);
        let at = |azimuth: f32, elevation: f32| luminance(map.radiance(direction(azimuth, elevation.to_radians())));
        let brightest = map.texels.iter().map(|t| luminance(*t)).fold(0.0, f32::max);
        assert!(at(0.7, 30.0) > 0.98 * brightest);
        for (away, elevation) in [(0.3, 20.0), (1.5, 50.0), (3.0, 10.0)] {
            let ratio = at(0.7 + away, elevation) / at(0.7 - away, elevation);
            assert!((ratio - 1.0).abs() < 2e-3, "{away} {elevation}: {ratio}");
        }
    }

    #[test]
    fn a_low_sun_is_dim_and_red_and_the_ground_is_lit_by_all() {
        let (high, low) = (sky(3.0, 60.0).sun().irradiance, sky(3.0, 5.0).sun().irradiance);
        // Measured at noon under clear air: 80 to 110 klx square to the sun.
        assert!((7e4..1.15e5).contains(&luminance(high)), "{high}");
        assert!(luminance(low) < 0.4 * luminance(high) && low.x > 2.0 * low.z, "{low}");
        let model = sky(3.0, 60.0);
        let map = model.map(64, 32);
        let lit = map.irradiance_up() + high * 60f32.to_radians().sin();
        assert!((map.radiance(Vec3::NEG_Y) - 0.2 / std::f32::consts::PI * lit).length() < 1e-3 * lit.length());
        // A clear sky without its sun gives 8 to 25 klx; the model is known for a bright one.
        let sky_alone = luminance(map.irradiance_up());
        assert!((8e3..4e4).contains(&sky_alone), "{sky_alone}");
    }
}
