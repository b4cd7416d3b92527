//! Textures and buffers back to the CPU.

use std::sync::mpsc::{Receiver, TryRecvError};

use glam::{UVec2, Vec4};

use crate::device::{Gpu, GpuError};

/// The bytes of one level of one layer, rows without padding.
pub fn read_texture(gpu: &Gpu, texture: &wgpu::Texture, level: u32, layer: u32) -> Result<Vec<u8>, GpuError> {
    let (buffer, rows) = copy_texture(gpu, texture, level, layer);
    let bytes = map(gpu, &buffer)?;
    Ok(rows.of(&bytes))
}

/// How rows lie in a buffer.
struct Rows {
    row: u32,
    padded: u32,
}

impl Rows {
    /// The bytes without padding.
    fn of(&self, bytes: &[u8]) -> Vec<u8> {
        bytes.chunks(self.padded as usize).flat_map(|line| &line[..self.row as usize]).copied().collect()
    }
}

/// Starts to copy one level of one layer.
fn copy_texture(gpu: &Gpu, texture: &wgpu::Texture, level: u32, layer: u32) -> (wgpu::Buffer, Rows) {
    let width = (texture.width() >> level).max(1);
    let height = (texture.height() >> level).max(1);
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    let row = width * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = read_buffer_of(gpu, u64::from(padded) * u64::from(height));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level,
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
            aspect: wgpu::TextureAspect::All,
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: Some(height),
            },
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    (buffer, Rows { row, padded })
}

/// A texture on its way to the CPU: nobody waits for it.
pub struct Reading {
    gpu: Gpu,
    buffer: wgpu::Buffer,
    rows: Rows,
    done: Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Reading {
    /// Starts to read the first level of the first layer.
    pub fn start(gpu: &Gpu, texture: &wgpu::Texture) -> Reading {
        let (buffer, rows) = copy_texture(gpu, texture, 0, 0);
        let done = request(&buffer);
        Reading { gpu: gpu.clone(), buffer, rows, done }
    }

    /// The bytes, rows without padding; `None` while they are on their way. They are given out once.
    pub fn poll(&mut self) -> Result<Option<Vec<u8>>, GpuError> {
        // An error comes up again by the device's own check.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        match self.done.try_recv() {
            Err(TryRecvError::Empty) => Ok(None),
            Err(error) => Err(failed(&error)),
            Ok(result) => {
                result.map_err(|e| failed(&e))?;
                let view = self.buffer.get_mapped_range(..).map_err(|e| failed(&e))?;
                Ok(Some(self.rows.of(&view)))
            }
        }
    }
}

/// One texel of a texture of four 32-bit or 16-bit floats.
pub fn read_texel(gpu: &Gpu, texture: &wgpu::Texture, at: UVec2) -> Result<Vec4, GpuError> {
    let buffer = read_buffer_of(gpu, 16);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: at.x, y: at.y, z: 0 }, ..texture.as_image_copy() },
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout: Default::default() },
        wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    let bytes = map(gpu, &buffer)?;
    Ok(match texture.format() {
        wgpu::TextureFormat::Rgba16Float => {
            let half = |i: usize| half::f16::from_bits(u16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]])).to_f32();
            Vec4::new(half(0), half(1), half(2), half(3))
        }
        _ => bytemuck::pod_read_unaligned(&bytes),
    })
}

/// The bytes of a buffer that allows `COPY_SRC`.
pub fn read_buffer(gpu: &Gpu, source: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let buffer = read_buffer_of(gpu, source.size());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, source.size());
    gpu.queue.submit([encoder.finish()]);
    map(gpu, &buffer)
}

fn read_buffer_of(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

fn map(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let receive = request(buffer);
    gpu.wait()?;
    receive.recv().map_err(|e| failed(&e))?.map_err(|e| failed(&e))?;
    let view = buffer.get_mapped_range(..).map_err(|e| failed(&e))?;
    Ok(view.to_vec())
}

/// Asks for the bytes of a buffer.
fn request(buffer: &wgpu::Buffer) -> Receiver<Result<(), wgpu::BufferAsyncError>> {
    let (send, receive) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver is gone only when nobody wants the bytes any more.
        let _ = send.send(result);
    });
    receive
}

fn failed(reason: &dyn std::fmt::Display) -> GpuError {
    GpuError::Failed(format!("reading back: {reason}"))
}
