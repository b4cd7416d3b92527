//! One frame of a resident scene: the targets of a size, what the shaders are told, and the passes in their order.

use std::ops::Range;

use burnish_core::lighting::classical::FrameSettings;
use burnish_core::lighting::impostor::Show;
use burnish_core::lighting::radiance_map::MetSurface;
use burnish_core::math::sampling;
use burnish_core::reference::Contribution;
use burnish_core::scene::{Bounds, Camera, Projection};
use glam::camera::rh::proj::directx as proj;
use glam::{Mat4, UVec2, Vec2, Vec3, Vec4};

use crate::layout::types::{
    CONTRIBUTION_ALL, CONTRIBUTION_EMISSION, CONTRIBUTION_ENVIRONMENT, CONTRIBUTION_LIGHT, ViewData,
};
use crate::pass::classical::Variant;
use crate::pass::gbuffer::GBuffer;
use crate::pass::probe::Drawn;
use crate::pass::target;
use crate::passes::{Passes, frame_format};
use crate::probes::ProbeLook;
use crate::resident::Resident;

/// Textures of one picture size.
pub(crate) struct Targets {
    pub size: UVec2,
    gbuffer: GBuffer,
    gbuffer_group: wgpu::BindGroup,
    catcher_group: wgpu::BindGroup,
    /// Scene-linear radiance of one frame.
    pub frame: wgpu::TextureView,
}

impl Targets {
    pub fn new(passes: &Passes, size: UVec2) -> Targets {
        let gpu = &passes.gpu;
        let gbuffer = GBuffer::new(gpu, size);
        Targets {
            size,
            gbuffer_group: passes.classical.group(gpu, &gbuffer),
            catcher_group: passes.catcher.group(gpu, &gbuffer),
            gbuffer,
            frame: target(gpu, "frame", size, frame_format(gpu)).create_view(&Default::default()),
        }
    }
}

/// Lookups of a soft shadow in a frame: for what blocks, and for the share that is lit.
const SOFT_SEARCHED: u32 = 12;
const SOFT_FILTERED: u32 = 16;

/// One of the frames that are averaged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jitter {
    /// Which.
    pub frame: u32,
    /// Of how many; 1 samples the centres of pixels.
    pub frames: u32,
}

/// A frame with its view bound, ready to be encoded part by part.
pub(crate) struct Encoding {
    scene_group: wgpu::BindGroup,
    viewer: Vec4,
    clip_from_world: Mat4,
    samples: u32,
    /// Group 3 of each probe, where they add to the picture.
    looks: Vec<wgpu::BindGroup>,
    /// Group 3 of the baked map, where it adds to the picture, and whether smooth surfaces send rays.
    map: Option<(wgpu::BindGroup, bool)>,
    /// Errors of searches are shown.
    errors: bool,
    /// Lamps throw shadows on a ground that is seen.
    catches: bool,
}

impl Encoding {
    pub fn new(
        passes: &Passes,
        resident: &Resident,
        camera: &Camera,
        size: UVec2,
        (settings, look): (&FrameSettings, &ProbeLook),
        jitter: Jitter,
    ) -> Encoding {
        let data = view_data(resident, camera, size, settings, jitter);
        let gpu = &passes.gpu;
        let uniform = gpu.buffer("view", bytemuck::bytes_of(&data), wgpu::BufferUsages::UNIFORM);
        let scene_group = resident.on_gpu.group(&gpu.device, &passes.scene_layout, &uniform);
        let is_seen = matches!(settings.contribution, Contribution::All | Contribution::Environment);
        let catches = is_seen && resident.background.catches && resident.shadows.light_count > 0;
        // Their light comes from all sources, and is shown with those.
        let probed = !resident.probe_groups.is_empty() && settings.contribution == Contribution::All;
        let errors = look.show == Show::Error && !resident.lighting.is_area_cube();
        let trees = if probed && errors { resident.trees(passes) } else { &[] };
        let group = |probe: usize| passes.probe.effort(gpu, look, trees.get(probe));
        let looks = if probed { (0..resident.probe_groups.len()).map(group).collect() } else { Vec::new() };
        // Where a tree does not fit the device nothing is shown of errors.
        let errors = errors && trees.len() == resident.probe_groups.len();
        let map = resident.map.as_ref().filter(|_| settings.contribution == Contribution::All).map(|mapped| {
            let scene = &resident.scene;
            let mut used = scene.instances.iter().filter(|instance| instance.visible);
            let traced = used.any(|instance| MetSurface::may_be_smooth(scene, instance.material, look.map.below));
            (mapped.map.look(gpu, &passes.radiance_map, &look.map), traced)
        });
        Encoding {
            map,
            scene_group,
            viewer: data.viewer,
            clip_from_world: data.clip_from_world,
            samples: data.samples,
            looks,
            errors,
            catches,
        }
    }

    /// What the surfaces are.
    pub fn surfaces(
        &self,
        passes: &Passes,
        encoder: &mut wgpu::CommandEncoder,
        resident: &Resident,
        targets: &Targets,
    ) {
        passes.gbuffer.encode(encoder, &targets.gbuffer, &resident.on_gpu, &self.scene_group);
    }

    /// Lights the surfaces in some rows of the picture.
    pub fn light(
        &self,
        passes: &Passes,
        encoder: &mut wgpu::CommandEncoder,
        resident: &Resident,
        targets: &Targets,
        rows: Range<u32>,
    ) {
        let areas = resident.shadows.has_areas;
        let with = |group| [&self.scene_group, group, &resident.lights, &resident.background.group];
        if self.catches {
            let groups = with(&targets.catcher_group);
            passes.catcher.encode(encoder, &targets.gbuffer, groups, areas, rows.clone());
        }
        let variant =
            Variant { sampled: self.samples > 0, areas, probed: !self.looks.is_empty(), mapped: self.map.is_some() };
        passes.classical.encode(encoder, &targets.frame, with(&targets.gbuffer_group), variant, rows.clone());
        if let (Some((look, traced)), Some(mapped)) = (&self.map, &resident.map) {
            let groups = [&self.scene_group, &targets.gbuffer_group, &mapped.group, look];
            passes.radiance_map.encode(encoder, &targets.frame, groups, *traced, rows.clone());
        }
        let drawn = match (resident.lighting.is_area_cube(), self.errors) {
            (true, _) => Drawn::AreaCube,
            (false, true) => Drawn::Errors,
            (false, false) => Drawn::Light { sampled: variant.sampled },
        };
        for ((probe, look), served) in resident.probe_groups.iter().zip(&self.looks).zip(&resident.served) {
            let Some(part) = covered(&self.clip_from_world, targets.size, served, &rows) else { continue };
            let groups = [&self.scene_group, &targets.gbuffer_group, probe, look];
            passes.probe.encode(encoder, &targets.frame, groups, drawn, part);
        }
    }

    /// Blended surfaces over them.
    pub fn blend(&self, passes: &Passes, encoder: &mut wgpu::CommandEncoder, resident: &Resident, targets: &Targets) {
        let groups = [&self.scene_group, &resident.lights];
        let depth = &targets.gbuffer.depth;
        passes.forward.encode(
            encoder,
            &targets.frame,
            depth,
            &resident.on_gpu,
            groups,
            (self.viewer, resident.shadows.has_areas),
        );
    }

    /// All of it.
    pub fn whole(&self, passes: &Passes, encoder: &mut wgpu::CommandEncoder, resident: &Resident, targets: &Targets) {
        self.surfaces(passes, encoder, resident, targets);
        self.light(passes, encoder, resident, targets, 0..targets.size.y);
        self.blend(passes, encoder, resident, targets);
    }
}

/// The part of some rows of a picture that shows a box of the world: left top corner and size in pixels; `None` where it shows none. A box
/// that reaches behind the viewer may be anywhere.
fn covered(clip_from_world: &Mat4, size: UVec2, bounds: &Bounds, rows: &Range<u32>) -> Option<[u32; 4]> {
    let corner = |i: u32| {
        let pick = |axis: u32| if i >> axis & 1 == 1 { bounds.max } else { bounds.min };
        *clip_from_world * Vec3::new(pick(0).x, pick(1).y, pick(2).z).extend(1.0)
    };
    let (mut low, mut high) = (Vec2::splat(f32::MAX), Vec2::splat(f32::MIN));
    for clip in (0..8).map(corner) {
        if clip.w.is_nan() || clip.w <= 1e-6 {
            (low, high) = (Vec2::NEG_ONE, Vec2::ONE);
            break;
        }
        let ndc = Vec2::new(clip.x, -clip.y) / clip.w;
        (low, high) = (low.min(ndc), high.max(ndc));
    }
    let pixel = 2.0 / size.as_vec2();
    if (low - pixel).cmpgt(Vec2::ONE).any() || (high + pixel).cmplt(Vec2::NEG_ONE).any() {
        return None;
    }
    let pixels = |ndc: Vec2| (0.5 * ndc + 0.5).clamp(Vec2::ZERO, Vec2::ONE) * size.as_vec2();
    // A pixel more at every side: the frame is moved by a part of one.
    let (low, high) = ((pixels(low) - 1.0).as_uvec2(), (pixels(high) + 2.0).as_uvec2().min(size));
    let (top, bottom) = (low.y.max(rows.start), high.y.min(rows.end));
    (low.x < high.x && top < bottom).then(|| [low.x, top, high.x - low.x, bottom - top])
}

/// Its number in shaders.
fn contribution(contribution: Contribution) -> u32 {
    match contribution {
        Contribution::All => CONTRIBUTION_ALL,
        Contribution::Environment => CONTRIBUTION_ENVIRONMENT,
        Contribution::Emission => CONTRIBUTION_EMISSION,
        // A light that is not there has the largest number, which is none.
        Contribution::Light(index) => u32::try_from(index).unwrap_or(u32::MAX).saturating_add(CONTRIBUTION_LIGHT),
    }
}

fn view_data(
    resident: &Resident,
    camera: &Camera,
    size: UVec2,
    settings: &FrameSettings,
    Jitter { frame, frames }: Jitter,
) -> ViewData {
    let size = size.as_vec2();
    let jitter = if frames == 1 {
        Vec2::ZERO
    } else {
        sampling::hammersley(frame, frames) + Vec2::splat(0.5 / frames as f32) - 0.5
    };
    let clip_from_world = clip_from_world(camera, size, jitter);
    let Resident { scene, maps, shadows, .. } = resident;
    let (rotation, scale) = scene.environment.as_ref().map_or((0.0, Vec3::ONE), |e| (e.rotation, e.scale()));
    ViewData {
        clip_from_world,
        world_from_clip: clip_from_world.inverse(),
        viewer: viewer(camera),
        environment_scale: maps.scale * scale,
        environment_mips: maps.radiance.mip_level_count() as f32,
        environment_cos: rotation.cos(),
        environment_sin: rotation.sin(),
        size,
        light_count: shadows.light_count,
        samples: settings.samples,
        masking: settings.masking as u32,
        multiple_scattering: u32::from(settings.multiple_scattering),
        frame,
        prefiltered_mips: maps.prefiltered.mip_level_count() as f32,
        source_count: maps.source_count,
        wide_alpha: maps.wide_alpha,
        contribution: contribution(settings.contribution),
        unlit_words: shadows.unlit_words,
        soft_searched: SOFT_SEARCHED,
        soft_filtered: SOFT_FILTERED,
    }
}

/// Reversed depth: 1 at the near plane; 0 infinitely far away, or at the far plane of an orthographic camera.
/// `jitter` moves the picture by a part of a pixel.
pub fn clip_from_world(camera: &Camera, size: Vec2, jitter: Vec2) -> Mat4 {
    let aspect = size.x / size.y;
    let clip_from_view = match camera.projection {
        Projection::Perspective { yfov, near } => proj::perspective_infinite_reverse(yfov, aspect, near),
        // Far and near are exchanged: depth is reversed.
        Projection::Orthographic { ymag, near, far } => {
            proj::orthographic(-ymag * aspect, ymag * aspect, -ymag, ymag, far, near)
        }
    };
    let moved = Mat4::from_translation(Vec3::new(2.0 * jitter.x / size.x, -2.0 * jitter.y / size.y, 0.0));
    moved * clip_from_view * Mat4::from(camera.world_from_view.inverse())
}

/// The viewer as a homogeneous point: a direction when orthographic.
fn viewer(camera: &Camera) -> Vec4 {
    match camera.projection {
        Projection::Perspective { .. } => Vec3::from(camera.world_from_view.translation).extend(1.0),
        Projection::Orthographic { .. } => camera.world_from_view.transform_vector3(Vec3::Z).extend(0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_covers_the_pixels_that_its_points_are_seen_in() {
        let size = UVec2::new(160, 90);
        let camera = Camera::look_at("c", Vec3::new(1.0, 2.0, 5.0), Vec3::ZERO, 0.8);
        let clip = clip_from_world(&camera, size.as_vec2(), Vec2::ZERO);
        let bounds = Bounds { min: Vec3::new(-0.3, -0.2, -0.4), max: Vec3::new(0.5, 0.6, 0.1) };
        let all = 0..size.y;
        let [left, top, width, height] = covered(&clip, size, &bounds, &all).expect("it is in the picture");
        assert!(width < size.x / 2 && height < size.y / 2, "{width} {height}");
        for i in 0..1000_u32 {
            let share = Vec3::new((i % 10) as f32, (i / 10 % 10) as f32, (i / 100) as f32) / 9.0;
            let point = clip * (bounds.min + share * (bounds.max - bounds.min)).extend(1.0);
            let at = (Vec2::new(point.x, -point.y) / point.w * 0.5 + 0.5) * size.as_vec2();
            assert!((left as f32..(left + width) as f32).contains(&at.x), "{at}");
            assert!((top as f32..(top + height) as f32).contains(&at.y), "{at}");
        }
        assert_eq!(covered(&clip, size, &bounds, &(0..top)), None, "rows above it");
        let behind = Bounds { min: Vec3::splat(-9.0), max: Vec3::splat(9.0) };
        assert_eq!(covered(&clip, size, &behind, &all), Some([0, 0, 160, 90]), "the viewer is inside");
        let beside = Bounds { min: Vec3::new(40.0, 0.0, -21.0), max: Vec3::new(41.0, 1.0, -20.0) };
        assert_eq!(covered(&clip, size, &beside, &all), None);
    }
}
