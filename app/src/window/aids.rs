//! How the picture is looked at: false colours, marks of clipping, the light of one source. It belongs to the window and is in
//! no document.

use burnish_core::measure::view::DisplayMode;
use burnish_core::reference::Contribution;
use burnish_core::scene::Scene;

/// The aids that are on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aids {
    /// The picture, or what judges its exposure.
    pub mode: DisplayMode,
    source: Source,
}

/// Whose light is shown. Lights go by their names: their places change as others are muted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// All light.
    #[default]
    All,
    /// The environment's.
    Environment,
    /// That of materials that glow.
    Emission,
    /// That of a light.
    Light(String),
}

impl Source {
    /// All that a scene has, all light first.
    pub fn of_scene(scene: &Scene) -> Vec<Source> {
        let lights = scene.lights.iter().map(|light| Source::Light(light.name.clone()));
        [Source::All, Source::Environment, Source::Emission].into_iter().chain(lights).collect()
    }

    /// Name for people.
    pub fn title(&self) -> &str {
        match self {
            Source::All => "All light",
            Source::Environment => "Environment",
            Source::Emission => "Glowing surfaces",
            Source::Light(name) => name,
        }
    }
}

impl Aids {
    /// Whose light is shown.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Shows the light of a source.
    pub fn show(&mut self, source: Source) {
        self.source = source;
    }

    /// Goes back to all light where the light that is shown is no longer there, or muted.
    pub fn follow(&mut self, scene: &Scene) {
        if let Source::Light(name) = &self.source
            && !scene.lights.iter().any(|light| light.name == *name)
        {
            self.source = Source::All;
        }
    }

    /// Shows a mode, or the picture again where it is shown already.
    pub fn toggle(&mut self, mode: DisplayMode) {
        self.mode = if self.mode == mode { DisplayMode::Picture } else { mode };
    }

    /// What renderers call the source.
    pub fn contribution(&self, scene: &Scene) -> Contribution {
        match &self.source {
            Source::All => Contribution::All,
            Source::Environment => Contribution::Environment,
            Source::Emission => Contribution::Emission,
            Source::Light(name) => {
                let place = scene.lights.iter().position(|light| light.name == *name);
                place.map_or(Contribution::All, Contribution::Light)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use burnish_core::scene::Light;

    use super::*;

    #[test]
    fn a_light_is_followed_by_its_name_until_it_is_gone() {
        let light = |name: &str| Light { name: name.into(), ..Light::default() };
        let mut scene = Scene { lights: vec![light("a"), light("b")], ..Scene::default() };
        let mut aids = Aids::default();
        assert_eq!(Source::of_scene(&scene).len(), 5);
        aids.show(Source::Light("b".into()));
        assert_eq!(aids.contribution(&scene), Contribution::Light(1));
        scene.lights.remove(0);
        aids.follow(&scene);
        assert_eq!(aids.contribution(&scene), Contribution::Light(0));
        scene.lights.clear();
        aids.follow(&scene);
        assert_eq!((aids.source(), aids.contribution(&scene)), (&Source::All, Contribution::All));
    }

    #[test]
    fn a_mode_is_left_the_way_it_was_entered() {
        let mut aids = Aids::default();
        aids.toggle(DisplayMode::FalseColor);
        assert_eq!(aids.mode, DisplayMode::FalseColor);
        aids.toggle(DisplayMode::Clipping);
        aids.toggle(DisplayMode::Clipping);
        assert_eq!(aids.mode, DisplayMode::Picture);
    }
}
