//! Seconds of work on the device by its own time stamps.

use crate::device::Gpu;
use crate::error::RenderError;
use crate::readback::read_buffer;

/// Two time stamps around commands.
pub struct DeviceClock {
    stamps: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

/// Bytes of two stamps.
const BYTES: u64 = 16;

impl DeviceClock {
    /// `None` where the device has no time stamps between its commands.
    pub fn new(gpu: &Gpu) -> Option<DeviceClock> {
        if !gpu.has(wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS) {
            return None;
        }
        let resolved = wgpu::BufferDescriptor {
            label: Some("stamps"),
            size: BYTES,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        };
        let stamps = wgpu::QuerySetDescriptor { label: Some("stamps"), ty: wgpu::QueryType::Timestamp, count: 2 };
        Some(DeviceClock {
            stamps: gpu.device.create_query_set(&stamps),
            resolved: gpu.device.create_buffer(&resolved),
        })
    }

    /// The commands that follow are timed.
    pub fn start(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.write_timestamp(&self.stamps, 0);
    }

    /// Those that follow are not.
    pub fn stop(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.write_timestamp(&self.stamps, 1);
        encoder.resolve_query_set(&self.stamps, 0..2, &self.resolved, 0);
    }

    /// Seconds between the two, after the commands were submitted; waits for them.
    pub fn secs(&self, gpu: &Gpu) -> Result<f64, RenderError> {
        let bytes = read_buffer(gpu, &self.resolved)?;
        let [start, end] = bytemuck::pod_read_unaligned::<[u64; 2]>(&bytes);
        Ok(end.saturating_sub(start) as f64 * f64::from(gpu.queue.get_timestamp_period()) * 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    #[test]
    fn work_takes_time_on_the_devices_clock_and_no_more_than_on_the_wall() {
        // Without an adapter, or without stamps, there is nothing to hold.
        let Some((gpu, clock)) = Gpu::new().ok().and_then(|gpu| Some((gpu.clone(), DeviceClock::new(&gpu)?))) else {
            return;
        };
        let size = 1 << 26;
        let descriptor = wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        };
        let [a, b] = [0, 1].map(|_| gpu.device.create_buffer(&descriptor));
        let start = Instant::now();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        clock.start(&mut encoder);
        encoder.copy_buffer_to_buffer(&a, 0, &b, 0, size);
        clock.stop(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        let secs = clock.secs(&gpu).unwrap();
        assert!(secs > 0.0 && secs <= start.elapsed().as_secs_f64(), "{secs} s");
    }
}
