//! Taking the sun out of a map: a small region beyond what a map can hold or a live renderer can sample becomes a light.

use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Turn;
use crate::color::rgb::luminance;
use crate::scene::{Environment, Light, LightKind};

/// A sun has at least this many times the mean luminance of the rest of its map.
const OVER_MEAN: f32 = 1000.0;
/// Half floats end at 65 504: a texel near that was cut off, and the sun was brighter.
const OVERFLOW: f32 = 60_000.0;
/// A texel at that end still is this many times brighter than the mean.
const OVER_MEAN_CUT: f32 = 50.0;
/// Texels of the sun have at least this share of the brightest one.
const SHARE_OF_PEAK: f32 = 0.05;
/// Below so many times the mean of the whole map a bright region is none worth the name.
const CONTRAST_MIN: f32 = 10.0;
/// Largest angular radius of a region that counts as a sun, radians: 5 degrees.
const RADIUS_MAX: f64 = 0.087_266;

/// A sun: parallel light from a small disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit, toward it.
    pub direction: Vec3,
    /// On a surface that faces it, lx per linear Rec.709 channel.
    pub irradiance: Vec3,
    /// Of a disc of the same solid angle, radians.
    pub angular_radius: f32,
}

/// A map in two parts.
#[derive(Clone, Debug)]
pub struct Split {
    /// The map with its surroundings in the place of the sun, turned and scaled as before.
    pub rest: Environment,
    /// The sun in the frame of the map and in its texels' measure: without rotation, strength and tint.
    pub sun: Sun,
}

/// Why a map has no sun to take out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoSun {
    /// No contrast.
    #[error("its brightest spot is {0:.0} times its mean; a sun has {OVER_MEAN} times")]
    Dim(f32),
    /// A large bright region.
    #[error("its brightest region is {0:.1} degrees across; a sun has at most 10")]
    Wide(f64),
}

impl Sun {
    /// The sun as it shines for a map that is turned and scaled.
    pub fn of(self, map: &Environment) -> Sun {
        let direction = Turn::by(map.rotation).to_world(self.direction);
        Sun { direction, irradiance: map.scale() * self.irradiance, ..self }
    }

    /// As a light of a scene, which the eye sees.
    pub fn light(&self, name: &str) -> Light {
        Light {
            name: name.into(),
            direction: -self.direction,
            intensity: self.irradiance,
            kind: LightKind::Directional { angular_radius: self.angular_radius },
            camera: true,
            ..Light::default()
        }
    }
}

/// Takes the brightest sun out of a map. What it and the rest light together is what the map lit: the integral of radiance
/// times direction stays. Of several suns the others stay in the map.
pub fn split_sun(map: &Environment) -> Result<Split, NoSun> {
    let grid = Grid { width: map.width.max(1) as usize, height: map.height.max(1) as usize, map };
    let peak = (0..grid.len()).map(|i| grid.luminance(i)).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    let (brightest, peak) = peak.unwrap_or((0, 0.0));
    let region = grid.region(brightest, SHARE_OF_PEAK * peak);
    let over = |mean: f32| if mean > 0.0 { peak / mean } else { 0.0 };
    let over_all = over(grid.mean_outside(&[]));
    let solid_angle: f64 = region.iter().map(|&i| grid.solid_angle(i)).sum();
    let angular_radius = (1.0 - solid_angle / TAU).clamp(-1.0, 1.0).acos();
    let reach = region.iter().map(|&i| grid.direction(i).dot(grid.direction(brightest))).fold(1.0, f64::min);
    // A long thin region has a small solid angle.
    if angular_radius > RADIUS_MAX || reach.clamp(-1.0, 1.0).acos() > 4.0 * RADIUS_MAX {
        let wide = NoSun::Wide(2.0 * angular_radius.to_degrees());
        return Err(if over_all < CONTRAST_MIN { NoSun::Dim(over_all) } else { wide });
    }
    // A lamp in the dark has all the contrast there is.
    let mean = grid.mean_outside(&region);
    let over_rest = if mean > 0.0 { over(mean) } else { over_all };
    let cut = map.texels.get(brightest).is_some_and(|t| t.max_element() >= OVERFLOW) && over_rest >= OVER_MEAN_CUT;
    if over_rest < OVER_MEAN && !cut {
        return Err(NoSun::Dim(over_rest));
    }
    let fill = grid.surroundings(&region);
    let mut texels = map.texels.to_vec();
    let mut vector = [DVec3::ZERO; 3];
    for &i in &region {
        let left = fill.min(texels[i]);
        let taken = (texels[i] - left).as_dvec3() * grid.solid_angle(i);
        (0..3).for_each(|c| vector[c] += taken[c] * grid.direction(i));
        texels[i] = left;
    }
    let [r, g, b] = vector;
    let toward = (0.2126 * r + 0.7152 * g + 0.0722 * b).try_normalize().unwrap_or(grid.direction(brightest));
    let sun = Sun {
        direction: toward.as_vec3().normalize(),
        irradiance: DVec3::new(r.dot(toward), g.dot(toward), b.dot(toward)).as_vec3().max(Vec3::ZERO),
        angular_radius: angular_radius as f32,
    };
    Ok(Split { rest: Environment { texels: texels.into(), ..map.clone() }, sun })
}

/// A map as texels with neighbours, in its own frame.
struct Grid<'a> {
    map: &'a Environment,
    width: usize,
    height: usize,
}

impl Grid<'_> {
    fn len(&self) -> usize {
        self.map.texels.len().min(self.width * self.height)
    }

    fn luminance(&self, i: usize) -> f32 {
        self.map.texels.get(i).map_or(0.0, |t| luminance(*t))
    }

    fn solid_angle(&self, i: usize) -> f64 {
        self.map.texel_solid_angle((i / self.width) as u32)
    }

    /// Of the middle of a texel, unit.
    fn direction(&self, i: usize) -> DVec3 {
        let (x, y) = ((i % self.width) as f64 + 0.5, (i / self.width) as f64 + 0.5);
        let (sin_phi, cos_phi) = ((x / self.width as f64 - 0.5) * TAU).sin_cos();
        let (sin_theta, cos_theta) = (y / self.height as f64 * PI).sin_cos();
        DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
    }

    /// The up to eight texels around one; across the poles the one opposite.
    fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let (w, h) = (self.width as i64, self.height as i64);
        let (x, y) = (i as i64 % w, i as i64 / w);
        let steps = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
        steps.filter(|step| *step != (0, 0)).map(move |(dx, dy)| {
            let row = y + dy;
            let beyond = row < 0 || row >= h;
            let column = x + dx + if beyond { w / 2 } else { 0 };
            (row.clamp(0, h - 1) * w + column.rem_euclid(w)) as usize
        })
    }

    /// Texels connected with one whose luminance is not less than a bound.
    fn region(&self, start: usize, least: f32) -> Vec<usize> {
        let mut seen = vec![false; self.len()];
        let (mut region, mut open) = (Vec::new(), VecDeque::from([start]));
        while let Some(i) = open.pop_front() {
            if i >= seen.len() || seen[i] || self.luminance(i) < least {
                continue;
            }
            seen[i] = true;
            region.push(i);
            open.extend(self.neighbours(i).filter(|n| !seen[*n]));
        }
        region
    }

    fn mean_outside(&self, region: &[usize]) -> f32 {
        let total = |i: usize| f64::from(self.luminance(i)) * self.solid_angle(i);
        // Row by row: texels of a row are alike in size, and maps may have tens of millions.
        let width = self.map.width.max(1) as usize;
        let of_row = |row: usize| -> f64 {
            let texels = row * width..self.len().min((row + 1) * width);
            let light: f64 = texels.map(|i| f64::from(self.luminance(i))).sum();
            light * self.solid_angle(row * width)
        };
        let all: f64 = (0..self.len().div_ceil(width)).into_par_iter().map(of_row).collect::<Vec<_>>().iter().sum();
        let inside: f64 = region.iter().map(|&i| total(i)).sum();
        let left = 4.0 * PI - region.iter().map(|&i| self.solid_angle(i)).sum::<f64>();
        ((all - inside) / left.max(1e-9)).max(0.0) as f32
    }

    /// Mean of the texels that touch a region from outside, by solid angle.
    fn surroundings(&self, region: &[usize]) -> Vec3 {
        let mut inside = vec![false; self.len()];
        region.iter().for_each(|&i| inside[i] = true);
        let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
        for i in region.iter().flat_map(|&i| self.neighbours(i)) {
            if !std::mem::replace(&mut inside[i], true) {
                sum += self.map.texels[i].as_dvec3() * self.solid_angle(i);
                whole += self.solid_angle(i);
            }
        }
        if whole > 0.0 { (sum / whole).as_vec3() } else { Vec3::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    /// A sky with discs (direction, angular radius, radiance) in it.
    fn sky(discs: &[(Vec3, f32, Vec3)]) -> Environment {
        let grid = Environment::new("sky", 512, 256, Vec::new());
        let texel = |i: u32| {
            let d = grid.texel_direction(i % 512, i / 512, Vec2::splat(0.5));
            let ground = Vec3::new(0.3, 0.5, 0.9) * (1.2 + d.y);
            let lit = discs.iter().find(|(at, radius, _)| d.angle_between(*at) < *radius);
            lit.map_or(ground, |(_, _, radiance)| *radiance)
        };
        Environment::new("sky", 512, 256, (0..512 * 256).map(texel).collect())
    }

    /// The integral of radiance times direction: irradiance of a plane is its product with the normal where all light is
    /// before the plane.
    fn vector(map: &Environment) -> [DVec3; 3] {
        let grid = Grid { map, width: map.width as usize, height: map.height as usize };
        let mut sum = [DVec3::ZERO; 3];
        for i in 0..grid.len() {
            let light = grid.solid_angle(i) * map.texels[i].as_dvec3();
            (0..3).for_each(|c| sum[c] += light[c] * grid.direction(i));
        }
        sum
    }

    #[test]
    fn map_and_sun_light_what_the_map_lit_wherever_the_sun_is() {
        for toward in [Vec3::new(0.3, 0.8, -0.5), Vec3::new(0.0, 1.0, 1e-3), Vec3::new(0.0, 0.2, 1.0), Vec3::NEG_Y] {
            let toward = toward.normalize();
            let map = sky(&[(toward, 0.03, Vec3::new(6.0e4, 5.5e4, 4.0e4))]);
            let Split { rest, sun } = split_sun(&map).unwrap();
            assert!(sun.direction.angle_between(toward) < 0.02, "{} for {toward}", sun.direction);
            assert!((sun.angular_radius / 0.03 - 1.0).abs() < 0.2, "{}", sun.angular_radius);
            let brightest = rest.texels.iter().map(|t| t.max_element()).fold(0.0, f32::max);
            assert!(brightest < 3.0, "something of the sun stayed: {brightest}");
            let (before, after) = (vector(&map), vector(&rest));
            for c in 0..3 {
                let together = after[c] + f64::from(sun.irradiance[c]) * sun.direction.as_dvec3();
                let apart = (together - before[c]).length() / before[c].length();
                assert!(apart < 1e-3, "channel {c} at {toward}: {apart}");
            }
        }
    }

    #[test]
    fn values_cut_off_at_the_end_of_halves_are_a_sun() {
        let toward = Vec3::new(0.5, 0.5, 0.7).normalize();
        let mut map = sky(&[(toward, 0.02, Vec3::splat(65_504.0))]);
        map.texels = map.texels.iter().map(|t| t.min(Vec3::splat(65_504.0)) + 300.0).collect();
        assert!(split_sun(&map).is_ok());
    }

    #[test]
    fn of_two_suns_the_brighter_goes() {
        let (a, b) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.6, 0.8, 0.0));
        let map = sky(&[(a, 0.03, Vec3::splat(2e4)), (b, 0.03, Vec3::splat(5e4))]);
        let Split { rest, sun } = split_sun(&map).unwrap();
        assert!(sun.direction.angle_between(b) < 0.02);
        assert!(rest.radiance(a).x > 1e4 && rest.radiance(b).x < 10.0);
    }

    #[test]
    fn maps_without_a_sun_say_why() {
        assert!(matches!(split_sun(&sky(&[])), Err(NoSun::Dim(_))));
        assert!(matches!(split_sun(&sky(&[(Vec3::Y, 0.4, Vec3::splat(6.5e4))])), Err(NoSun::Wide(_))));
        let black = Environment::new("black", 4, 2, vec![Vec3::ZERO; 8]);
        assert_eq!(split_sun(&black).unwrap_err(), NoSun::Dim(0.0));
        let one = Environment::new("one", 1, 1, vec![Vec3::ONE]);
        assert!(split_sun(&one).is_err());
    }

    #[test]
    fn the_sun_turns_and_is_scaled_with_its_map() {
        let map = sky(&[(Vec3::NEG_Z, 0.03, Vec3::splat(5e4))]);
        let tint = Vec3::new(1.0, 0.5, 0.0);
        let turned = Environment { rotation: std::f32::consts::FRAC_PI_2, strength: 2.0, tint, ..map.clone() };
        let sun = split_sun(&turned).unwrap().sun;
        let seen = sun.of(&turned);
        // What was ahead is left.
        assert!((seen.direction - Vec3::NEG_X).length() < 1e-2, "{}", seen.direction);
        assert!((seen.irradiance - sun.irradiance * 2.0 * tint).length() < 1e-3 * sun.irradiance.length());
        assert!((seen.light("sun").direction - Vec3::X).length() < 1e-2);
    }
}
