//! What a picture is made from: the scene with the options that change it, and who looks at it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::{Curves, Document, LightingPreset};
use burnish_core::material::preset::{self, FormChoice, Preset, PresetError};
use burnish_core::material::{Material, Reflectance, finish};
use burnish_core::scene::{Camera, Scene};
use glam::UVec2;

use super::lighting;
use crate::failure::Failure;
use crate::source::{self, Opened, SceneArg};
use crate::value::{self, CameraChoice, MetalChoice};

/// Pixels of a picture where nothing is said of them.
const SIZE: UVec2 = UVec2::new(1280, 720);

/// The options of every command that looks at a scene.
#[derive(clap::Args)]
pub struct StageArgs {
    #[command(flatten)]
    scene: SceneArg,
    /// Environment map, .hdr or .exr [default: that of the document or scene, else a studio]
    #[arg(long, value_name = "FILE")]
    env: Option<PathBuf>,
    /// Metal for the material SLOT, a name or #index; for all without one; repeatable
    #[arg(long, value_name = "PRESET[:SLOT]", value_parser = value::metal)]
    metal: Vec<MetalChoice>,
    /// Finish for the material SLOT, see below; for those with a --metal without one, without --metal for all; repeatable
    #[arg(long, value_name = "ID[:SLOT]", value_parser = value::metal)]
    finish: Vec<MetalChoice>,
    /// Coat for the material SLOT, see below; without one as --finish; repeatable
    #[arg(long, value_name = "ID[:SLOT]", value_parser = value::metal)]
    coat: Vec<MetalChoice>,
    /// Roughness factor, 0 to 1, of the materials that got a --metal; without --metal of all
    #[arg(long, value_name = "R", value_parser = value::number(0.0, 1.0))]
    roughness: Option<f32>,
    /// Anisotropy strength, 0 to 1, of the same materials
    #[arg(long, value_name = "A", value_parser = value::number(0.0, 1.0))]
    anisotropy: Option<f32>,
    /// Lighting preset around the subject in the place of all lights: an id, see below, or a .json file
    #[arg(long, value_name = "ID|FILE")]
    lighting: Option<String>,
    /// Pixels of the picture [default: 1280x720]
    #[arg(long, value_name = "WxH", value_parser = value::size)]
    size: Option<UVec2>,
    /// Eye and target in metres and the vertical angle in degrees [default: the document's view; of a model all; a gallery scene's first]
    #[arg(long, value_name = "NAME|#INDEX|EX,EY,EZ,TX,TY,TZ,FOV", value_parser = value::camera, allow_hyphen_values = true)]
    camera: Option<CameraChoice>,
}

/// Which metals a form is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Forms {
    /// Those of `--metal`; the materials of a document keep their own.
    OfMaterials,
    /// All.
    OfAll,
}

/// A scene as it is looked at.
pub struct Staged {
    pub scene: Scene,
    pub camera: Camera,
    pub size: UVec2,
    /// What the user should know, one line each.
    pub notices: Vec<String>,
    /// The document that the scene came from.
    pub document: Option<Document>,
    /// The presets of `--metal`, by id.
    pub metals: BTreeMap<String, Preset>,
}

impl StageArgs {
    /// A scene as it is, as a picture of a size.
    pub fn plain(scene: &str, size: UVec2) -> StageArgs {
        let scene = SceneArg::named(scene);
        StageArgs {
            scene,
            env: None,
            metal: Vec::new(),
            finish: Vec::new(),
            coat: Vec::new(),
            roughness: None,
            anisotropy: None,
            lighting: None,
            size: Some(size),
            camera: None,
        }
    }

    /// Whether `--size` is there.
    pub fn is_sized(&self) -> bool {
        self.size.is_some()
    }

    /// SCENE and the environment map, where they are files.
    pub fn files(&self) -> Vec<PathBuf> {
        self.scene.file().map(PathBuf::from).into_iter().chain(self.env.clone()).collect()
    }

    /// Opens SCENE; a document must have all of its files.
    pub fn open(&self) -> Result<Opened, Failure> {
        self.scene.open()?.complete()
    }

    /// Makes the changes that the options ask for, metals in the form `choice`.
    pub fn set(&self, mut opened: Opened, choice: FormChoice, forms: Forms) -> Result<Staged, Failure> {
        let size = self.size.unwrap_or(SIZE);
        let environment = self.env.as_deref().map(source::environment).transpose()?;
        opened.light(environment.as_ref());
        // Of the scene as it came: materials do not move it.
        let usual = opened.camera(size);
        let Opened { mut scene, mut notices, document, .. } = opened;
        if let (Some(document), Forms::OfAll) = (&document, forms) {
            scene = Arc::unwrap_or_clone(document.in_form(&scene, choice, &mut Curves::default()));
        }
        if document.is_none() {
            set_form(&mut scene, choice);
        }
        let mut metals = BTreeMap::new();
        notices.extend(self.set_materials(&mut scene, choice, &mut metals)?);
        if let Some(wanted) = &self.lighting {
            lighting::light(&mut scene, &lighting::find(wanted)?);
        }
        let camera = self.camera(&scene, document.as_ref())?.unwrap_or(usual);
        Ok(Staged { scene, camera, size, notices, document, metals })
    }

    /// Applies `--metal`, `--finish`, `--coat`, `--roughness` and `--anisotropy`; returns what the user should know.
    fn set_materials(
        &self,
        scene: &mut Scene,
        choice: FormChoice,
        metals: &mut BTreeMap<String, Preset>,
    ) -> Result<Vec<String>, Failure> {
        let mut notices = Vec::new();
        let mut changed = vec![false; scene.materials.len()];
        for MetalChoice { preset, slot } in &self.metal {
            let preset = preset::find(preset).map_err(|e| metal_failure(preset, e))?;
            let fresnel = Arc::new(preset.fresnel(choice.form(&preset)));
            let slots = match slot {
                Some(slot) => slot
                    .among("material", scene.materials.iter().map(|m| m.name.as_str()))
                    .map_err(|e| Failure::usage(format!("--metal {}: {e}", preset.id)))?,
                None => (0..scene.materials.len()).collect(),
            };
            for slot in slots {
                let material = &mut scene.materials[slot];
                material.reflectance = Reflectance::Preset { id: preset.id.clone(), fresnel: fresnel.clone() };
                if std::mem::take(&mut material.unlit) {
                    notices.push(format!("material `{}` was unlit and is lit now to show its metal", material.name));
                }
                changed[slot] = true;
            }
            metals.insert(preset.id.clone(), preset);
        }
        let all = self.metal.is_empty();
        let targets: Vec<usize> = (0..changed.len()).filter(|slot| all || changed[*slot]).collect();
        set_finishes(scene, finish::Kind::Finish, &self.finish, &targets)?;
        set_finishes(scene, finish::Kind::Coat, &self.coat, &targets)?;
        for slot in targets {
            let Material { roughness, anisotropy, .. } = &mut scene.materials[slot];
            *roughness = self.roughness.unwrap_or(*roughness);
            *anisotropy = self.anisotropy.unwrap_or(*anisotropy);
        }
        Ok(notices)
    }

    /// That of `--camera`.
    fn camera(&self, scene: &Scene, document: Option<&Document>) -> Result<Option<Camera>, Failure> {
        let pick = match &self.camera {
            None => return Ok(None),
            Some(CameraChoice::LookAt { eye, target, yfov }) => {
                return Ok(Some(Camera::look_at("look at", *eye, *target, *yfov)));
            }
            Some(CameraChoice::Of(pick)) => pick,
        };
        // Those that were saved in the document come first.
        let saved = document.iter().flat_map(|document| &document.cameras).map(|entry| entry.camera());
        let cameras: Vec<Camera> = saved.chain(scene.cameras.iter().cloned()).collect();
        let found = pick
            .among("camera", cameras.iter().map(|c| c.name.as_str()))
            .map_err(|e| Failure::usage(format!("--camera: {e}; or give ex,ey,ez,tx,ty,tz,fov")))?;
        Ok(Some(cameras[found[0]].clone()))
    }
}

/// Gives the metals that a gallery scene brings the form that is asked for.
fn set_form(scene: &mut Scene, choice: FormChoice) {
    for material in &mut scene.materials {
        if let Reflectance::Preset { id, fresnel } = &mut material.reflectance
            && let Ok(preset) = preset::find(id)
        {
            *fresnel = Arc::new(preset.fresnel(choice.form(&preset)));
        }
    }
}

/// What `--finish` and `--coat` take, for help texts.
pub fn help() -> String {
    let ids = |kind| finish::list(kind).map(|finish| finish.id.as_str()).collect::<Vec<_>>().join(", ");
    let lightings = LightingPreset::library().iter().map(|preset| preset.id.as_str()).collect::<Vec<_>>().join(", ");
    format!("Finishes: {}\nCoats: {}\nLightings: {lightings}\n", ids(finish::Kind::Finish), ids(finish::Kind::Coat))
}

/// Applies `--finish` or `--coat`; without a slot to `targets`.
fn set_finishes(
    scene: &mut Scene,
    kind: finish::Kind,
    choices: &[MetalChoice],
    targets: &[usize],
) -> Result<(), Failure> {
    for MetalChoice { preset, slot } in choices {
        let failure = |e: &dyn std::fmt::Display| Failure::usage(format!("--{} {preset}: {e}", kind.word()));
        let finish = finish::find(kind, preset).map_err(|e| failure(&e))?;
        let slots = match slot {
            Some(slot) => {
                slot.among("material", scene.materials.iter().map(|m| m.name.as_str())).map_err(|e| failure(&e))?
            }
            None => targets.to_vec(),
        };
        for slot in slots {
            finish.apply(&mut scene.materials[slot]);
        }
    }
    Ok(())
}

/// A preset's file may be at fault, or the name that was given.
pub fn metal_failure(preset: &str, error: PresetError) -> Failure {
    match error {
        PresetError::File(_) | PresetError::Json { .. } | PresetError::Field { .. } | PresetError::TooLarge { .. } => {
            Failure::input(Path::new(preset), error)
        }
        PresetError::Unknown { .. } => Failure::usage(format!("--metal {preset}: {error}")),
    }
}
