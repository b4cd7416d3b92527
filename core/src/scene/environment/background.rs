//! What the eye sees where it meets nothing. Light is untouched by it: surfaces see the environment as it is.

use std::sync::Arc;

use glam::Vec3;

use super::Ground;
use crate::scene::Environment;

/// What is seen behind everything.
#[derive(Clone, Debug, Default)]
pub struct Background {
    /// Shown in the place of the environment: a blurred copy, or one colour. The environment itself when absent.
    pub map: Option<Arc<Environment>>,
    /// The ground that it is laid on; infinitely far away when absent.
    pub ground: Option<Ground>,
}

/// Where a ray from the eye meets the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backdrop {
    /// Unit direction, world, in which the map is looked up.
    pub direction: Vec3,
    /// Point of the ground, world, metres, where the ray meets it.
    pub ground: Option<Vec3>,
}

impl Background {
    /// A background of one colour, linear Rec.709 radiance in nit.
    pub fn of_color(color: Vec3) -> Background {
        let map = Environment::new("colour", 1, 1, vec![color.max(Vec3::ZERO)]);
        Background { map: Some(Arc::new(map)), ground: None }
    }

    /// True for the environment itself, infinitely far away.
    pub fn is_plain(&self) -> bool {
        self.map.is_none() && self.ground.is_none()
    }

    /// Where a ray meets it; `direction` unit.
    pub fn look(&self, origin: Vec3, direction: Vec3) -> Backdrop {
        let Some(ground) = &self.ground else { return Backdrop { direction, ground: None } };
        let found = ground.project(origin, direction);
        let on_ground = (found.w > 0.0).then(|| origin + found.w * direction);
        Backdrop { direction: found.truncate(), ground: on_ground }
    }

    /// Radiance of a direction; `environment` is that of the scene.
    pub fn radiance(&self, environment: Option<&Environment>, direction: Vec3) -> Vec3 {
        self.map.as_deref().or(environment).map_or(Vec3::ZERO, |map| map.radiance(direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_background_is_the_environment_and_a_colour_hides_it() {
        let environment = Environment::new("grey", 2, 1, vec![Vec3::splat(0.5); 2]);
        let plain = Background::default();
        assert!(plain.is_plain());
        assert_eq!(plain.radiance(Some(&environment), Vec3::X), Vec3::splat(0.5));
        assert_eq!(plain.look(Vec3::ONE, Vec3::X), Backdrop { direction: Vec3::X, ground: None });
        let black = Background::of_color(Vec3::ZERO);
        assert_eq!(black.radiance(Some(&environment), Vec3::Y), Vec3::ZERO);
        assert_eq!(plain.radiance(None, Vec3::Y), Vec3::ZERO);
    }
}
