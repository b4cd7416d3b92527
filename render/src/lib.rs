//! The wgpu renderer (stub).
mod device;
use burnish_core::{
    param::Settings,
    picture::Picture,
    scene::{Camera, Scene},
};
pub use device::*;
/// View
pub struct View {
    /// s
    pub size: glam::UVec2,
    /// c
    pub camera: Camera,
    /// s
    pub settings: Settings,
    /// j
    pub jitter_frames: u32,
}
/// R
pub struct Renderer;
impl Renderer {
    /// n
    pub fn new(_: &Gpu, _: &Scene) -> Result<Renderer, GpuError> {
        Ok(Renderer)
    }
    /// r
    pub fn render(&mut self, v: &View) -> Result<Picture, GpuError> {
        Ok(Picture::from_fn(v.size.x, v.size.y, |x, y| glam::Vec4::new(x as f32 / 100.0, y as f32 / 100.0, 0.2, 1.0)))
    }
}
