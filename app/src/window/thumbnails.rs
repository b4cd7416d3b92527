//! Small rendered balls for presets: drawn in the background, one at a time, and kept on disk.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use burnish_core::color::rgb::srgb_from_linear;
use burnish_core::color::tone::{ToneMap, tone_display_linear};
use burnish_core::file::{read_picture, write_png};
use burnish_core::lighting::classical;
use burnish_core::material::params::{self, Values};
use burnish_core::material::preset::Preset;
use burnish_core::material::{Material, Reflectance};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::scene::{Camera, Environment, Instance, Light, Scene, gallery};
use burnish_core::surface::fresnel::Form;
use burnish_render::pass::environment::downsampled;
use burnish_render::{Passes, Renderer, View};
use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};
use glam::{Affine3A, UVec2, Vec2, Vec3, Vec4};

/// Pixels of an edge.
const SIZE: u32 = 96;
/// Jittered frames of a ball.
const FRAMES: u32 = 4;
/// Part of the new in every hash: raise it when balls shall look different.
const LOOK: u32 = 1;
/// What a ball is rendered with: it is looked at, not moved.
const BALL_FORM: Form = Form::Spectral;
/// Radius of the ball in metres: one for the hand, so that dents of a hammer show.
const BALL: f32 = 0.05;
/// Full vertical angle of the camera: a long lens.
const YFOV: f32 = 0.35;
/// Radius of the ball as a part of half the picture; the mask is a little smaller, so that its edge is all ball.
const RADIUS: f32 = 0.97;
const MASK: f32 = 0.94;
/// Seconds without input after which balls are drawn.
const QUIET_SECS: f64 = 0.3;
/// Balls that are with the worker at a time: enough that it does not wait for the next frame, few enough that what was
/// scrolled away soon makes room.
const UNDER_WAY: usize = 3;

/// What is on a ball.
#[derive(Clone, Debug)]
pub struct Subject {
    values: Values,
    metal: Option<Arc<Preset>>,
    lights: Vec<Light>,
    /// Factor on the studio.
    strength: f32,
    hash: String,
}

impl Subject {
    /// Factors over those of the default material, and the metal that replaces its reflectance.
    pub fn new(values: Values, metal: Option<Arc<Preset>>) -> Subject {
        let mut hasher = blake3::Hasher::new();
        hasher.update(format!("ball {LOOK} {SIZE} {BALL_FORM} {values:?}").as_bytes());
        if let Some(metal) = &metal {
            for list in [&metal.wavelength_nm, &metal.n, &metal.k] {
                hasher.update(&(list.len() as u64).to_le_bytes());
                list.iter().for_each(|number| _ = hasher.update(&number.to_le_bytes()));
            }
        }
        let hash = hasher.finalize().to_hex().to_string();
        Subject { values, metal, lights: Vec::new(), strength: 1.0, hash }
    }

    /// The same in the light of these lamps, and of so much of the studio.
    #[must_use]
    pub fn under(self, lights: Vec<Light>, strength: f32) -> Subject {
        let seen = format!("{} {strength} {lights:?}", self.hash);
        Subject { lights, strength, hash: blake3::hash(seen.as_bytes()).to_hex().to_string(), ..self }
    }

    fn material(&self) -> Material {
        let mut material = Material::default();
        params::apply(&mut material, &self.values);
        if let Some(metal) = &self.metal {
            let fresnel = Arc::new(metal.fresnel(BALL_FORM));
            material.reflectance = Reflectance::Preset { id: metal.id.clone(), fresnel };
        }
        material
    }
}

/// The balls.
#[derive(Default)]
pub struct Thumbnails {
    folder: Option<PathBuf>,
    worker: Option<Worker>,
    balls: HashMap<String, TextureHandle>,
    /// What the last frame asked for and did not get, in its order.
    asked: Vec<Arc<Subject>>,
    /// Hashes of what the worker was told to draw.
    under_way: Vec<String>,
    /// The worker ended early: what it was asked for does not come.
    failed: bool,
}

struct Worker {
    wanted: Sender<Arc<Subject>>,
    drawn: Receiver<Result<(String, ColorImage), String>>,
    busy: Arc<AtomicBool>,
    passes: Arc<Passes>,
}

impl Thumbnails {
    /// Keeps pictures in a folder, or none where there is none.
    pub fn new(folder: Option<PathBuf>) -> Thumbnails {
        Thumbnails { folder, ..Thumbnails::default() }
    }

    /// Takes over what was drawn; once a frame. Without `passes` there are no balls, and while the viewport has not come
    /// to rest they wait. Returns what went wrong, once.
    pub fn frame(&mut self, ctx: &egui::Context, passes: Option<&Arc<Passes>>, rests: bool) -> Option<String> {
        let Some(passes) = passes else {
            self.worker = None;
            self.balls.clear();
            self.asked.clear();
            self.under_way.clear();
            return None;
        };
        if !self.worker.as_ref().is_some_and(|worker| Arc::ptr_eq(&worker.passes, passes)) {
            // What an earlier device did not get done is asked for again.
            self.under_way.clear();
            self.failed = false;
            self.worker = Some(Worker::start(passes, self.folder.clone(), ctx));
        }
        let fault = self.take_drawn(ctx);
        let worker = self.worker.as_ref()?;
        let active = ctx.input(|input| {
            input.pointer.any_down() || f64::from(input.pointer.time_since_last_movement()) < QUIET_SECS
        });
        worker.busy.store(active || !rests, Ordering::Relaxed);
        for subject in std::mem::take(&mut self.asked) {
            self.ask(&subject);
        }
        // The list of this frame is made by this frame.
        self.asked.clear();
        if active && self.is_drawing() {
            // Without another frame nobody would notice that the hand came to rest.
            ctx.request_repaint_after_secs(QUIET_SECS as f32);
        }
        fault
    }

    /// Makes textures of what the worker finished. Returns why it ended.
    fn take_drawn(&mut self, ctx: &egui::Context) -> Option<String> {
        let worker = self.worker.as_ref()?;
        let mut fault = None;
        while let Ok(drawn) = worker.drawn.try_recv() {
            match drawn {
                Ok((hash, image)) => {
                    let texture = ctx.load_texture(format!("ball {hash}"), image, TextureOptions::LINEAR);
                    self.under_way.retain(|known| *known != hash);
                    self.balls.insert(hash, texture);
                }
                Err(words) => {
                    self.failed = true;
                    fault = Some(words);
                }
            }
        }
        fault
    }

    /// Balls were asked for and are on their way.
    pub fn is_drawing(&self) -> bool {
        self.worker.is_some() && !self.failed && !(self.under_way.is_empty() && self.asked.is_empty())
    }

    /// The ball of a subject that is seen in this frame; `None` until it is drawn. What is no longer asked for is not
    /// drawn, so that a long list costs what is seen of it.
    pub fn get(&mut self, subject: &Arc<Subject>) -> Option<&TextureHandle> {
        self.worker.as_ref()?;
        if !self.balls.contains_key(&subject.hash) {
            self.ask(subject);
        }
        self.balls.get(&subject.hash)
    }

    /// Hands a subject to the worker if it has room, else notes it for the next frame.
    fn ask(&mut self, subject: &Arc<Subject>) {
        let known = self.under_way.contains(&subject.hash) || self.balls.contains_key(&subject.hash);
        let Some(worker) = self.worker.as_ref().filter(|_| !known && !self.failed) else { return };
        if self.under_way.len() >= UNDER_WAY {
            return self.asked.push(subject.clone());
        }
        self.under_way.push(subject.hash.clone());
        // A worker that ended has told why.
        let _ = worker.wanted.send(subject.clone());
    }
}

impl Worker {
    fn start(passes: &Arc<Passes>, folder: Option<PathBuf>, ctx: &egui::Context) -> Worker {
        let (wanted, subjects) = channel::<Arc<Subject>>();
        let (results, drawn) = channel();
        let busy = Arc::new(AtomicBool::new(false));
        let (own_passes, own_busy, ctx) = (passes.clone(), busy.clone(), ctx.clone());
        std::thread::spawn(move || {
            let mut painter = Painter { passes: own_passes, folder, renderer: None };
            for subject in subjects {
                let drawn = painter.ball(&subject, &own_busy).map(|image| (subject.hash.clone(), image));
                let failed = drawn.is_err();
                let heard = results.send(drawn).is_ok();
                ctx.request_repaint();
                if failed || !heard {
                    return;
                }
            }
        });
        Worker { wanted, drawn, busy, passes: passes.clone() }
    }
}

/// Draws balls on its own thread.
struct Painter {
    passes: Arc<Passes>,
    folder: Option<PathBuf>,
    renderer: Option<(Renderer, Arc<Scene>)>,
}

impl Painter {
    /// From the folder, else drawn and kept there.
    fn ball(&mut self, subject: &Subject, busy: &AtomicBool) -> Result<ColorImage, String> {
        let path = self.folder.as_ref().map(|folder| folder.join(format!("{}.png", subject.hash)));
        if let Some(picture) = path.as_deref().and_then(kept) {
            return Ok(image(&picture));
        }
        while busy.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(30));
        }
        let picture = self.draw(subject).map_err(|e| format!("Pictures of presets: {e}"))?;
        if let (Some(folder), Some(path)) = (&self.folder, path) {
            // A ball that cannot be kept is drawn again next time.
            let _ = std::fs::create_dir_all(folder);
            let _ = write_png(&picture, &path, ToneMap::None, 0.0);
        }
        Ok(image(&picture))
    }

    fn draw(&mut self, subject: &Subject) -> Result<Picture, burnish_render::RenderError> {
        let (renderer, scene) = match &mut self.renderer {
            Some(made) => made,
            None => {
                let scene = Arc::new(stage());
                let renderer = Renderer::with_passes(&self.passes, &scene)?;
                self.renderer.insert((renderer, scene))
            }
        };
        let mut changed = Scene::clone(scene);
        changed.materials = vec![subject.material()];
        changed.lights.clone_from(&subject.lights);
        // Lamps of a preset are seen in the ball, not beside it.
        changed.lights.iter_mut().for_each(|light| light.camera = false);
        if let Some(studio) = &mut changed.environment
            && studio.strength != subject.strength
        {
            *studio = Arc::new(Environment { strength: subject.strength, ..Environment::clone(studio) });
        }
        *scene = Arc::new(changed);
        renderer.set_scene(scene)?;
        let view = View {
            size: UVec2::splat(SIZE),
            camera: camera(),
            settings: Settings::new(classical::PARAMS),
            jitter_frames: FRAMES,
        };
        Ok(masked(renderer.render(&view)?))
    }
}

/// A ball under the studio, at the resolution that a small picture needs.
fn stage() -> Scene {
    let instance =
        Instance { name: "ball".into(), mesh: 0, material: 0, world_from_local: Affine3A::IDENTITY, visible: true };
    Scene {
        name: "ball".into(),
        meshes: vec![Arc::new(gallery::shape::sphere(BALL, 96))],
        materials: vec![Material::default()],
        instances: vec![instance],
        environment: Some(Arc::new(downsampled(&gallery::studio()))),
        ..Scene::default()
    }
}

/// From slightly above, so far away that the ball has [`RADIUS`] in the picture.
fn camera() -> Camera {
    let half_angle = (RADIUS * (0.5 * YFOV).tan()).atan();
    let eye = Vec3::new(0.0, 0.2, 1.0).normalize() * (BALL / half_angle.sin());
    Camera::look_at("ball", eye, Vec3::ZERO, YFOV)
}

/// Through the display transform, cut out as a disc; linear, premultiplied.
fn masked(picture: Picture) -> Picture {
    let Picture { width, height, texels } = picture;
    let center = 0.5 * Vec2::new(width as f32, height as f32);
    let radius = MASK * center.y;
    let cut = |(place, texel): (usize, Vec4)| {
        let (x, y) = (place as u32 % width, place as u32 / width);
        let distance = (Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - center).length();
        let alpha = (radius - distance + 0.5).clamp(0.0, 1.0);
        (tone_display_linear(ToneMap::Neutral, texel.truncate()) * alpha).extend(alpha)
    };
    Picture { width, height, texels: texels.into_iter().enumerate().map(cut).collect() }
}

/// A picture of the folder; one that is damaged or of another size counts as none.
fn kept(path: &Path) -> Option<Picture> {
    let (picture, _) = read_picture(path).ok()?;
    (picture.width == SIZE && picture.height == SIZE).then_some(picture)
}

fn image(picture: &Picture) -> ColorImage {
    let texel = |texel: &Vec4| {
        let straight = if texel.w > 0.0 { texel.truncate() / texel.w } else { Vec3::ZERO };
        let [r, g, b] = srgb_from_linear(straight).to_array().map(byte);
        egui::Color32::from_rgba_unmultiplied(r, g, b, byte(texel.w))
    };
    ColorImage::new([picture.width as usize, picture.height as usize], picture.texels.iter().map(texel).collect())
}

fn byte(v: f32) -> u8 {
    (v.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset::library;
    use burnish_core::param::ParamValue;

    #[test]
    fn every_metal_and_every_factor_has_a_hash_of_its_own() {
        let of = |metal: &Preset| Subject::new(Values::new(), Some(Arc::new(metal.clone()))).hash;
        let mut hashes: Vec<String> = library().iter().map(of).collect();
        hashes.push(Subject::new(Values::new(), None).hash);
        for roughness in [0.1, 0.2] {
            hashes.push(Subject::new(Values::from([("roughness", ParamValue::Number(roughness))]), None).hash);
        }
        let count = hashes.len();
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), count);
        let again = library().iter().map(of).next();
        assert!(again.is_some_and(|hash| hashes.contains(&hash)), "the same in every run");
    }

    #[test]
    fn a_ball_is_opaque_in_the_middle_and_clear_in_the_corners() {
        let texels = vec![Vec4::ONE; (SIZE * SIZE) as usize];
        let ball = image(&masked(Picture { width: SIZE, height: SIZE, texels }));
        assert_eq!(ball.pixels.first().map(|p| p.a()), Some(0));
        let middle = (SIZE * SIZE / 2 + SIZE / 2) as usize;
        assert_eq!(ball.pixels.get(middle).map(|p| p.a()), Some(255));
    }
}
