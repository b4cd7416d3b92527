//! The picture that all are judged by, and how far it can be trusted.

use super::cache::film_hash;
use super::run::changed;
use super::{BenchError, Cache, Region, Shot};
use crate::material::preset::FormChoice;
use crate::measure::{Errors, errors, interior};
use crate::param::Settings;
use crate::picture::Picture;
use crate::reference::checkpoint::Key;
use crate::reference::{self, Control, Film, Pass, View, World};
use crate::surface::fresnel::Form;

/// A traced picture with its regions and its noise.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Linear radiance.
    pub picture: Picture,
    /// The pixels of each of [`Region::ALL`].
    pub masks: [Vec<bool>; Region::ALL.len()],
    /// What its noise adds to the errors in each region: a smaller one tells nothing.
    pub floors: [Option<Errors>; Region::ALL.len()],
    /// Paths through a pixel.
    pub samples: u32,
    /// Settings of the reference that are not default, as text.
    pub settings: Vec<(String, String)>,
    /// Hash of what it was made from.
    pub(super) key: String,
}

impl Truth {
    /// Traces two halves of `samples / 2` paths a pixel, at least one, with independent seeds, on the current rayon
    /// pool; halves that the cache holds are read instead. `settings` are those of the reference.
    pub fn trace(
        shot: &Shot,
        settings: &Settings,
        samples: u32,
        cache: &Cache,
        control: &Control,
    ) -> Result<Truth, BenchError> {
        let world = world_of(shot, settings);
        let half = (samples / 2).max(1);
        let view = |seed| View { camera: shot.camera.clone(), size: shot.size, seed };
        let key = Key::new(&world, &view(0));
        let films = [0, 1].map(|seed| {
            cache.film(&key.with_seed(seed), half, shot.size, |film| {
                match reference::trace(&world, &view(seed), film, half, control) {
                    Pass::Whole => Ok(()),
                    Pass::Cancelled => Err(BenchError::Cancelled),
                }
            })
        });
        let key = film_hash(&key, half);
        let [a, b] = films;
        Ok(Truth { settings: changed(settings), ..Truth::of_halves(shot, key, &a?, &b?)? })
    }

    fn of_halves(shot: &Shot, key: String, a: &Film, b: &Film) -> Result<Truth, BenchError> {
        let [left, right] = [a, b].map(Film::picture);
        let texels = left.texels.iter().zip(&right.texels).map(|(a, b)| 0.5 * (*a + *b)).collect();
        let picture = Picture { width: left.width, height: left.height, texels };
        let subject = subject(shot, a);
        let inner = interior(&subject, shot.size.x);
        let masks = [vec![true; subject.len()], subject, inner];
        let between = errors(&left, &right, shot.exposure_ev, &masks.each_ref().map(Vec::as_slice))?;
        let mut floors = [None; Region::ALL.len()];
        for (floor, between) in floors.iter_mut().zip(between) {
            *floor = between.map(Errors::floor_of_halves);
        }
        Ok(Truth { picture, masks, floors, samples: a.samples() + b.samples(), settings: Vec::new(), key })
    }
}

/// Pixels that show an instance of the subject.
fn subject(shot: &Shot, film: &Film) -> Vec<bool> {
    let chosen = &shot.scene.subject;
    let is_subject = |instance: u32| chosen.is_empty() || chosen.contains(&(instance as usize));
    film.pixels().iter().map(|pixel| pixel.instance != reference::NOTHING && is_subject(pixel.instance)).collect()
}

/// The form that settings of the reference choose.
pub(super) fn form_of(settings: &Settings) -> FormChoice {
    let text = settings.text("fresnel").unwrap_or_default();
    FormChoice::read(&text, Default::default()).unwrap_or(FormChoice::Of(Form::Spectral))
}

/// A world for settings of the reference.
pub(super) fn world_of(shot: &Shot, settings: &Settings) -> World {
    World::of_settings(&shot.in_form(form_of(settings)), settings, None, |id| shot.metal(id)).0
}
