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
    /// Marks of probes in the picture.
    pub probes: ProbeMarks,
    source: Source,
}

/// What the picture shows of probes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ProbeMarks {
    /// Where they stand, and the box of the chosen one.
    pub places: bool,
    /// The surfaces that the chosen one sees, as points at their distances.
    pub distances: bool,
    /// Name of the chosen one; the first when there is none of it.
    pub chosen: String,
}

/// Whose light is shown. Lights go by their names, and by which of those of the name: their places change as others are muted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// All light.
    #[default]
    All,
    /// The environment's.
    Environment,
    /// That of materials that glow.
    Emission,
    /// That of a light: its name, and how many of that name come before it.
    Light(String, usize),
}

impl Source {
    /// All that a scene has, all light first.
    pub fn of_scene(scene: &Scene) -> Vec<Source> {
        let before = |place: usize| scene.lights[..place].iter().filter(|l| l.name == scene.lights[place].name).count();
        let lights =
            (0..scene.lights.len()).map(|place| Source::Light(scene.lights[place].name.clone(), before(place)));
        [Source::All, Source::Environment, Source::Emission].into_iter().chain(lights).collect()
    }

    /// Name for people.
    pub fn title(&self) -> String {
        match self {
            Source::All => "All light".into(),
            Source::Environment => "Environment".into(),
            Source::Emission => "Glowing surfaces".into(),
            Source::Light(name, 0) => name.clone(),
            Source::Light(name, before) => format!("{name} ({})", before + 1),
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
        if matches!(self.source, Source::Light(..)) && self.contribution(scene) == Contribution::All {
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
            Source::Light(name, before) => {
                let mut places = (0..scene.lights.len()).filter(|place| scene.lights[*place].name == *name);
                places.nth(*before).map_or(Contribution::All, Contribution::Light)
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
        aids.show(Source::Light("b".into(), 0));
        assert_eq!(aids.contribution(&scene), Contribution::Light(1));
        scene.lights.remove(0);
        aids.follow(&scene);
        assert_eq!(aids.contribution(&scene), Contribution::Light(0));
        scene.lights.push(light("b"));
        let sources = Source::of_scene(&scene);
        assert_eq!((sources[3].title(), sources[4].title()), ("b".into(), "b (2)".into()));
        aids.show(sources[4].clone());
        assert_eq!(aids.contribution(&scene), Contribution::Light(1), "lights of one name are told apart");
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
