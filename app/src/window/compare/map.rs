//! Error maps: both pictures are brought to the CPU and measured by another thread.

use std::sync::Arc;

use burnish_core::document::Side;
use burnish_core::job::{Job, Outcome};
use burnish_core::measure::error_map::{ErrorMap, Metric, color};
use burnish_core::picture::Picture;
use eframe::egui::{self, Align2, Color32, ColorImage, FontId, Mesh, Pos2, Rect, Shape, TextureHandle, pos2, vec2};

use crate::number::short;
use crate::window::stage::Reading;

/// A traced picture is measured again when it has so many times the samples.
const AGAIN: f64 = 1.4;
/// Points of the legend's bar.
const BAR: egui::Vec2 = vec2(260.0, 12.0);

/// A picture to measure.
#[derive(Clone)]
pub struct Source {
    /// Scene-linear radiance.
    pub picture: Arc<Picture>,
    /// Samples of each pixel where it is path-traced.
    pub samples: Option<u32>,
}

/// The pictures that a map is made of.
#[derive(Clone)]
pub struct Pictures {
    /// What the other is measured by.
    pub reference: Source,
    /// What is measured.
    pub picture: Source,
    /// Exposure of the view in stops.
    pub exposure_ev: f32,
    /// What is measured.
    pub metric: Metric,
}

impl Pictures {
    /// A map of the others is right for these as well, or nearly so.
    fn is_near(&self, others: &Pictures) -> bool {
        let near = |a: &Source, b: &Source| match (a.samples, b.samples) {
            (None, None) => Arc::ptr_eq(&a.picture, &b.picture),
            (Some(old), Some(new)) => f64::from(new) < AGAIN * f64::from(old) && new >= old,
            _ => false,
        };
        self.metric == others.metric
            && self.exposure_ev == others.exposure_ev
            && near(&self.reference, &others.reference)
            && near(&self.picture, &others.picture)
    }
}

/// A map that can be shown.
struct Done {
    pictures: Pictures,
    map: Arc<ErrorMap>,
    texture: TextureHandle,
}

type Measured = Result<(ErrorMap, ColorImage), String>;

/// Pictures on their way, and the map of the last two.
#[derive(Default)]
pub struct MapDesk {
    readings: [Option<Reading>; 2],
    /// Live pictures at rest.
    live: [Option<Arc<Picture>>; 2],
    job: Option<(Pictures, Job<Measured>)>,
    done: Option<Done>,
    /// Why there is no map.
    fault: Option<String>,
}

impl MapDesk {
    /// The live picture of a side once it is on the CPU. `read` starts to read it; it is asked only while `settled`.
    /// Unsettled pictures are forgotten, and so is the map of them.
    pub fn live(&mut self, side: Side, settled: bool, read: impl FnOnce() -> Option<Reading>) -> Option<Arc<Picture>> {
        let place = side as usize;
        if !settled {
            self.drop_side(side);
            return None;
        }
        if self.live[place].is_none() && self.readings[place].is_none() {
            self.readings[place] = read();
        }
        match self.readings[place].as_mut().map(Reading::poll) {
            Some(Ok(Some(picture))) => (self.live[place], self.readings[place]) = (Some(Arc::new(picture)), None),
            Some(Err(fault)) => (self.fault, self.readings[place]) = (Some(fault), None),
            Some(Ok(None)) | None => {}
        }
        self.live[place].clone()
    }

    /// Forgets what is known of a side: its picture changed.
    pub fn drop_side(&mut self, side: Side) {
        let place = side as usize;
        if self.live[place].take().is_some() | self.readings[place].take().is_some() {
            self.forget();
        }
    }

    /// The map belongs to pictures that are no more.
    pub fn forget(&mut self) {
        (self.job, self.done, self.fault) = (None, None, None);
    }

    /// A picture is on its way.
    pub fn is_reading(&self) -> bool {
        self.readings.iter().any(Option::is_some)
    }

    /// A thread measures.
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Takes what a thread has done, and lets one measure these pictures where the map is not of them.
    pub fn update(&mut self, ctx: &egui::Context, pictures: Option<Pictures>) {
        if let Some((of, job)) = &mut self.job {
            match job.poll() {
                Outcome::Running => return,
                Outcome::Done(Ok((map, image))) => {
                    let texture = ctx.load_texture("error map", image, egui::TextureOptions::NEAREST);
                    self.done = Some(Done { pictures: of.clone(), map: Arc::new(map), texture });
                    self.fault = None;
                }
                Outcome::Done(Err(fault)) => (self.fault, self.done) = (Some(fault), None),
                Outcome::Failed => (self.fault, self.done) = (Some("measuring failed".into()), None),
            }
            self.job = None;
        }
        let Some(pictures) = pictures else { return };
        let known = self.done.as_ref().is_some_and(|done| done.pictures.is_near(&pictures));
        if known || self.fault.is_some() {
            return;
        }
        // A map of another metric is not shown under the new one's name.
        self.done.take_if(|done| done.pictures.metric != pictures.metric);
        let (of, ctx) = (pictures.clone(), ctx.clone());
        let job = Job::spawn("Measuring", move || ctx.request_repaint(), move |_| measure(&pictures));
        self.job = Some((of, job));
    }

    /// The map with its picture.
    pub fn shown(&self) -> Option<(&ErrorMap, &TextureHandle)> {
        self.done.as_ref().map(|done| (&*done.map, &done.texture))
    }

    /// What there is to say about the map.
    pub fn legend(&self, metric: Metric) -> Legend {
        let Some(done) = &self.done else {
            let text = match (&self.fault, &self.job) {
                (Some(fault), _) => fault.clone(),
                (None, Some(_)) => "measuring".into(),
                (None, None) => "waits for both pictures to be sharp".into(),
            };
            return Legend { metric, span: None, text };
        };
        let samples = |source: &Source| source.samples.map(|samples| format!("{samples} samples"));
        let (a, b) = (samples(&done.pictures.reference), samples(&done.pictures.picture));
        let against = match (a, b) {
            (Some(a), None) => format!(", against {a}"),
            (None, Some(b)) => format!(", of {b}"),
            (Some(a), Some(b)) => format!(", {b} against {a}"),
            (None, None) => String::new(),
        };
        let text = format!("mean {}{against}", short(done.map.mean));
        Legend { metric, span: Some(done.map.span), text }
    }
}

fn measure(pictures: &Pictures) -> Measured {
    let Pictures { reference, picture, exposure_ev, metric } = pictures;
    let map = ErrorMap::new(*metric, &reference.picture, &picture.picture, *exposure_ev).map_err(|e| e.to_string())?;
    let size = [map.width as usize, map.height as usize];
    let colors = map.colors().into_iter().map(|[r, g, b]| Color32::from_rgb(r, g, b)).collect();
    Ok((map, ColorImage::new(size, colors)))
}

/// Colours with numbers, and what is to be known about a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// What is measured.
    pub metric: Metric,
    /// The value of the last colour; `None` before there is a map.
    pub span: Option<f32>,
    /// Mean, samples, or why there is no map.
    pub text: String,
}

impl Legend {
    /// Points that it takes.
    pub const SIZE: egui::Vec2 = vec2(BAR.x + 20.0, 60.0);

    /// Paints it into a place.
    pub fn ui(&self, ui: &mut egui::Ui, place: Rect) {
        let ink = Color32::from_gray(235);
        let painter = ui.painter_at(place);
        painter.rect_filled(place, 4.0, Color32::from_black_alpha(190));
        let inner = place.shrink2(vec2(10.0, 5.0));
        let font = FontId::proportional(12.5);
        let title = format!("{}: {}", self.metric.title(), self.text);
        let line = Rect::from_min_size(inner.min, vec2(inner.width(), 16.0));
        let label = egui::Label::new(egui::RichText::new(&title).size(12.5).color(ink)).truncate().selectable(false);
        ui.put(line, label).on_hover_text(format!("{title}\n{}", self.metric.help()));
        let bar = Rect::from_min_size(pos2(inner.left(), inner.top() + 20.0), vec2(inner.width(), BAR.y));
        painter.add(self.bar(bar));
        let first = if self.metric.is_signed() { -1.0 } else { 0.0 };
        for share in [0.0, 0.5, 1.0f32] {
            let value = self.span.map(|span| (first + (1.0 - first) * share) * span);
            let words = match (value, share) {
                (Some(v), 1.0) if self.metric != Metric::Flip => format!("{}+", short(f64::from(v))),
                (Some(v), _) => short(f64::from(v)),
                (None, _) => continue,
            };
            let at = pos2(bar.left() + share * bar.width(), bar.bottom() + 2.0);
            let align = [Align2::LEFT_TOP, Align2::CENTER_TOP, Align2::RIGHT_TOP][(2.0 * share) as usize];
            painter.text(at, align, words, font.clone(), ink);
        }
    }

    /// The colours from the least to the largest.
    fn bar(&self, place: Rect) -> Shape {
        const STEPS: usize = 64;
        let mut mesh = Mesh::default();
        let first = if self.metric.is_signed() { -1.0 } else { 0.0 };
        for step in 0..STEPS {
            let [from, to] = [step, step + 1].map(|i| place.left() + place.width() * i as f32 / STEPS as f32);
            let share = first + (1.0 - first) * (step as f32 + 0.5) / STEPS as f32;
            let [r, g, b] = color(self.metric, share);
            let part = Rect::from_min_max(pos2(from, place.top()), pos2(to, place.bottom()));
            mesh.add_colored_rect(part, Color32::from_rgb(r, g, b));
        }
        Shape::mesh(mesh)
    }
}

/// The value of a map under a point, with the sides of the picture that it covers.
pub fn value_at(map: &ErrorMap, rect: Rect, pointer: Pos2) -> Option<f32> {
    let at = (pointer - rect.min) / rect.size();
    if !rect.contains(pointer) {
        return None;
    }
    map.value((at.x * map.width as f32) as u32, (at.y * map.height as f32) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{UVec2, Vec4};

    fn source(value: f32, samples: Option<u32>) -> Source {
        Source { picture: Arc::new(Picture::filled(32, 16, Vec4::new(value, value, value, 1.0))), samples }
    }

    fn until_done(desk: &mut MapDesk, ctx: &egui::Context, pictures: &Pictures) {
        desk.update(ctx, Some(pictures.clone()));
        let start = std::time::Instant::now();
        while desk.is_busy() {
            assert!(start.elapsed().as_secs() < 60);
            std::thread::sleep(std::time::Duration::from_millis(2));
            desk.update(ctx, None);
        }
    }

    #[test]
    fn a_map_is_measured_once_for_the_same_pictures_and_again_for_more_samples() {
        let (mut desk, ctx) = (MapDesk::default(), egui::Context::default());
        let pictures = Pictures {
            reference: source(0.5, Some(10)),
            picture: source(0.25, None),
            exposure_ev: 0.0,
            metric: Metric::Luminance,
        };
        assert!(desk.legend(Metric::Luminance).text.starts_with("waits"));
        until_done(&mut desk, &ctx, &pictures);
        let map = desk.shown().unwrap().0.clone();
        assert!((map.mean + 0.25).abs() < 1e-4 && map.span == 0.5);
        assert_eq!(desk.legend(Metric::Luminance).text, "mean -0.25, against 10 samples");
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(64.0, 32.0));
        assert_eq!(value_at(&map, rect, pos2(120.0, 60.0)).map(|v| (v * 100.0).round()), Some(-25.0));
        assert_eq!(value_at(&map, rect, pos2(10.0, 60.0)), None);

        let more = |samples| Pictures { reference: source(0.5, Some(samples)), ..pictures.clone() };
        desk.update(&ctx, Some(more(13)));
        assert!(!desk.is_busy(), "hardly more samples");
        desk.update(&ctx, Some(more(14)));
        assert!(desk.is_busy() && desk.shown().is_some(), "the old one is shown with its own count");
    }

    #[test]
    fn a_picture_that_changes_takes_its_map_away() {
        let (mut desk, ctx) = (MapDesk::default(), egui::Context::default());
        let size = UVec2::new(32, 16);
        let picture = desk.live(Side::B, true, || Some(Reading::Flat(size))).unwrap();
        let picture = Source { picture, samples: None };
        let again = desk.live(Side::B, true, || None).unwrap();
        assert!(Arc::ptr_eq(&again, &picture.picture), "it is read once");
        let pictures =
            Pictures { reference: source(0.5, Some(1)), picture, exposure_ev: 0.0, metric: Metric::Relative };
        until_done(&mut desk, &ctx, &pictures);
        assert!(desk.shown().is_some());
        assert!(desk.live(Side::B, false, || None).is_none());
        assert!(desk.shown().is_none());
    }

    #[test]
    fn pictures_of_two_sizes_are_refused_in_words() {
        let (mut desk, ctx) = (MapDesk::default(), egui::Context::default());
        let small = Source { picture: Arc::new(Picture::filled(2, 2, Vec4::ONE)), samples: None };
        let pictures =
            Pictures { reference: source(0.5, Some(1)), picture: small, exposure_ev: 0.0, metric: Metric::Flip };
        until_done(&mut desk, &ctx, &pictures);
        assert!(desk.shown().is_none() && desk.legend(Metric::Flip).text.contains("one size"));
    }
}
