//! Textures at a point: what the GPU's samplers do at the largest mip level. Detail finer than a pixel is averaged by the
//! paths of the pixel.

use std::sync::LazyLock;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::color::rgb::linear_from_srgb;
use crate::material::{Filter, TextureRef, Wrap};
use crate::scene::{Image, Mesh, Scene, Texels};

/// Linear values of the 256 codes of sRGB.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| linear_from_srgb(Vec3::splat(code as f32 / 255.0)).x));

/// Texture coordinates of a point, both sets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinates(pub [Vec2; 2]);

impl Coordinates {
    /// Between the corners of a triangle.
    pub(super) fn new(mesh: &Mesh, corners: [usize; 3], weights: Vec3) -> Coordinates {
        Coordinates([0, 1].map(|set| between(&mesh.uvs[set], corners, weights).unwrap_or(Vec2::ZERO)))
    }
}

/// A list of a mesh between the corners of a triangle; `None` where the mesh has none.
pub(super) fn between<T>(list: &[T], corners: [usize; 3], weights: Vec3) -> Option<T>
where
    T: Copy + std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    let [a, b, c] = corners.map(|corner| list.get(corner).copied());
    Some(a? * weights.x + b? * weights.y + c? * weights.z)
}

/// RGBA of a texture; colours are decoded from sRGB. `None` where there is no texture.
pub(super) fn lookup(scene: &Scene, texture: Option<TextureRef>, at: &Coordinates, color: bool) -> Option<Vec4> {
    let texture = texture?;
    let image = scene.images.get(texture.image)?;
    let uv = texture.transform.transform_point2(at.0[usize::from(texture.uv_set == 1)]);
    if !uv.is_finite() {
        return None;
    }
    let size = Vec2::new(image.width as f32, image.height as f32);
    let texel = |x: i64, y: i64| {
        let x = wrapped(x, image.width, texture.sampler.wrap_u);
        let y = wrapped(y, image.height, texture.sampler.wrap_v);
        texel(image, x, y, color)
    };
    let p = uv * size;
    if texture.sampler.magnify == Filter::Nearest {
        return Some(texel(p.x.floor() as i64, p.y.floor() as i64));
    }
    let low = (p - 0.5).floor();
    let f = p - 0.5 - low;
    let (x, y) = (low.x as i64, low.y as i64);
    let top = texel(x, y).lerp(texel(x + 1, y), f.x);
    let bottom = texel(x, y + 1).lerp(texel(x + 1, y + 1), f.x);
    Some(top.lerp(bottom, f.y))
}

fn wrapped(i: i64, size: u32, wrap: Wrap) -> usize {
    let n = i64::from(size.max(1));
    let i = match wrap {
        Wrap::Repeat => i.rem_euclid(n),
        Wrap::Mirror => {
            let twice = i.rem_euclid(2 * n);
            if twice < n { twice } else { 2 * n - 1 - twice }
        }
        Wrap::Clamp => i.clamp(0, n - 1),
    };
    i as usize
}

/// A texel in linear numbers; white where the image has fewer than it says.
fn texel(image: &Image, x: usize, y: usize, color: bool) -> Vec4 {
    let first = 4 * (y * image.width as usize + x);
    match &image.texels {
        Texels::Unorm8(codes) => {
            let Some([r, g, b, a]) = codes.get(first..first + 4).and_then(|c| c.as_array()) else { return Vec4::ONE };
            let alpha = f32::from(*a) / 255.0;
            if color {
                return Vec3::from_array([r, g, b].map(|c| LINEAR[usize::from(*c)])).extend(alpha);
            }
            Vec3::from_array([r, g, b].map(|c| f32::from(*c) / 255.0)).extend(alpha)
        }
        Texels::Unorm16(codes) => {
            let Some(codes) = codes.get(first..first + 4).and_then(|c| c.as_array::<4>()) else { return Vec4::ONE };
            let value = Vec4::from_array(codes.map(|c| f32::from(c) / 65535.0));
            if color { linear_from_srgb(value.xyz()).extend(value.w) } else { value }
        }
    }
}

/// Mean of a colour texture, for choosing among lights.
pub(super) fn mean(scene: &Scene, texture: Option<TextureRef>) -> Vec3 {
    mean_texel(scene, texture, true).map_or(Vec3::ONE, Vec4::xyz)
}

/// Mean RGBA of a texture; colours are decoded from sRGB. `None` where there is no texture.
pub fn mean_texel(scene: &Scene, texture: Option<TextureRef>, color: bool) -> Option<Vec4> {
    let image = scene.images.get(texture?.image)?;
    let (w, h) = (image.width as usize, image.height as usize);
    // Every texel of small images, 64 x 64 of large ones.
    let (nx, ny) = (w.min(64), h.min(64));
    let sum: Vec4 = (0..nx * ny).map(|i| texel(image, (i % nx) * w / nx, (i / nx) * h / ny, color)).sum();
    Some(sum / (nx * ny).max(1) as f32)
}
