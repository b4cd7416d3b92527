//! Units of light: what a lamp gives off in lumen, candela, lux, nit and watt.
//!
//! The base unit of a kind is that of [`Light::intensity`](super::Light::intensity): cd for points and spots, lx for suns,
//! nit for rectangles and spheres. All conversions are exact for the light as it is rendered, its cone and size included.

use std::f64::consts::PI;

use super::LightKind;

/// Lumen for each watt: the luminous efficacy of green light of 540 THz, which defines the candela. A watt is that of a
/// lamp without losses in the visible, the convention of glTF exporters; a real bulb of so many watts gives less.
pub const EFFICACY: f64 = 683.0;

/// A unit in which a light may be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Luminous flux, all the light that it gives off.
    Lumen,
    /// Luminous intensity: along its axis where it has one.
    Candela,
    /// Illuminance on a surface that faces it.
    Lux,
    /// Luminance of its surface, cd/m2.
    Nit,
    /// Radiant flux, see [`EFFICACY`].
    Watt,
}

impl Unit {
    /// All of them.
    pub const ALL: [Unit; 5] = [Unit::Lumen, Unit::Candela, Unit::Lux, Unit::Nit, Unit::Watt];

    /// Symbol, which is also what documents store.
    pub fn symbol(self) -> &'static str {
        match self {
            Unit::Lumen => "lm",
            Unit::Candela => "cd",
            Unit::Lux => "lx",
            Unit::Nit => "nit",
            Unit::Watt => "W",
        }
    }

    /// The unit of a symbol.
    pub fn of_symbol(symbol: &str) -> Option<Unit> {
        Unit::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// The unit of [`Light::intensity`](super::Light::intensity).
    pub fn base(kind: &LightKind) -> Unit {
        match kind {
            LightKind::Point | LightKind::Spot { .. } => Unit::Candela,
            LightKind::Directional { .. } => Unit::Lux,
            LightKind::Rectangle { .. } | LightKind::Sphere { .. } => Unit::Nit,
        }
    }

    /// How many of this unit one base unit of a light is. `None` where the light has no such quantity: a point has no
    /// luminance, a sun no flux, and a light without a size gives off nothing that could be divided among it.
    pub fn per_base(self, kind: &LightKind) -> Option<f64> {
        let factor = match (*kind, self) {
            (LightKind::Point, Unit::Candela) | (LightKind::Spot { .. }, Unit::Candela) => 1.0,
            (LightKind::Point, Unit::Lumen) => 4.0 * PI,
            (LightKind::Spot { inner_angle, outer_angle }, Unit::Lumen) => spot_angle(inner_angle, outer_angle),
            (LightKind::Directional { .. }, Unit::Lux) => 1.0,
            (LightKind::Directional { angular_radius }, Unit::Nit) => {
                1.0 / (PI * f64::from(angular_radius).sin().powi(2))
            }
            (LightKind::Rectangle { .. } | LightKind::Sphere { .. }, Unit::Nit) => 1.0,
            (LightKind::Rectangle { size, .. }, Unit::Candela) => f64::from(size.x) * f64::from(size.y),
            (LightKind::Rectangle { size, .. }, Unit::Lumen) => PI * f64::from(size.x) * f64::from(size.y),
            (LightKind::Sphere { radius }, Unit::Candela) => PI * f64::from(radius).powi(2),
            (LightKind::Sphere { radius }, Unit::Lumen) => 4.0 * PI * PI * f64::from(radius).powi(2),
            (_, Unit::Watt) => return Some(Unit::Lumen.per_base(kind)? / EFFICACY),
            _ => return None,
        };
        (factor.is_finite() && factor > 0.0).then_some(factor)
    }

    /// The units in which a light can be given.
    pub fn of_kind(kind: &LightKind) -> impl Iterator<Item = Unit> {
        Unit::ALL.into_iter().filter(move |unit| unit.per_base(kind).is_some())
    }

    /// A quantity in another unit; `None` where the light has one of them not.
    pub fn convert(self, value: f64, to: Unit, kind: &LightKind) -> Option<f64> {
        Some(value / self.per_base(kind)? * to.per_base(kind)?)
    }
}

/// Flux of a spot of 1 cd: the integral of its cone, a squared ramp in the cosine (KHR_lights_punctual).
fn spot_angle(inner_angle: f32, outer_angle: f32) -> f64 {
    let (inner, outer) = (f64::from(inner_angle).cos(), f64::from(outer_angle).cos());
    2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0)
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;

    const KINDS: [LightKind; 5] = [
        LightKind::Point,
        LightKind::Spot { inner_angle: 0.3, outer_angle: 0.7 },
        LightKind::Directional { angular_radius: 0.0047 },
        LightKind::Rectangle { across: Vec3::X, size: Vec2::new(0.6, 1.2) },
        LightKind::Sphere { radius: 0.05 },
    ];

    #[test]
    fn every_unit_of_a_kind_goes_to_every_other_and_back() {
        for kind in KINDS {
            let units: Vec<Unit> = Unit::of_kind(&kind).collect();
            assert!(units.contains(&Unit::base(&kind)) && Unit::base(&kind).per_base(&kind) == Some(1.0), "{kind:?}");
            for from in &units {
                for to in &units {
                    let there = from.convert(812.0, *to, &kind).unwrap();
                    let back = to.convert(there, *from, &kind).unwrap();
                    assert!((back / 812.0 - 1.0).abs() < 1e-12, "{kind:?}: {from:?} to {to:?}");
                }
            }
        }
    }

    #[test]
    fn flux_is_the_integral_of_intensity_over_all_directions() {
        let at = |kind: LightKind, unit: Unit| unit.per_base(&kind).unwrap();
        assert!((at(KINDS[0], Unit::Lumen) - 12.566_370_6).abs() < 1e-6);
        // By sums over the cosine.
        let n = 200_000;
        let (inner, outer) = (0.3_f64.cos(), 0.7_f64.cos());
        let ring = |i: i32| {
            let cos = (f64::from(i) + 0.5) / f64::from(n);
            ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
        };
        let spot = 2.0 * PI * (0..n).map(ring).sum::<f64>() / f64::from(n);
        assert!((at(KINDS[1], Unit::Lumen) / spot - 1.0).abs() < 1e-5, "{spot}");
        // Lambert's law: a flat lamp gives pi times its axis, a ball four pi times its disc.
        assert!((at(KINDS[3], Unit::Lumen) / at(KINDS[3], Unit::Candela) - PI).abs() < 1e-12);
        assert!((at(KINDS[4], Unit::Lumen) / at(KINDS[4], Unit::Candela) - 4.0 * PI).abs() < 1e-12);
        assert!((at(KINDS[4], Unit::Watt) * 683.0 / at(KINDS[4], Unit::Lumen) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_a_light_does_not_have_is_refused() {
        assert_eq!(Unit::Nit.per_base(&LightKind::Point), None);
        assert_eq!(Unit::Lumen.per_base(&LightKind::PARALLEL), None);
        assert_eq!(Unit::Nit.per_base(&LightKind::PARALLEL), None);
        let flat = LightKind::Rectangle { across: Vec3::X, size: Vec2::new(0.0, 1.0) };
        assert_eq!(Unit::of_kind(&flat).collect::<Vec<_>>(), [Unit::Nit]);
        assert!(Unit::ALL.into_iter().all(|unit| Unit::of_symbol(unit.symbol()) == Some(unit)));
        assert_eq!(Unit::of_symbol("candlepower"), None);
    }
}
