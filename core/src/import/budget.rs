//! Limits on what a file may ask for, and a meter that counts against them.

use super::Cause;

/// Limits on what one import may ask for. Sums over all files and elements of that import, except where noted.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Bytes of the model, its buffers and its encoded pictures together.
    pub file_bytes: u64,
    /// Bytes of a JSON text.
    pub json_bytes: u64,
    /// Objects in a JSON text; `{}` takes two bytes there and some hundreds once parsed.
    pub json_objects: u64,
    /// Pixels of all decoded pictures together, or of one environment.
    pub pixels: u64,
    /// Nodes of the node hierarchy.
    pub nodes: u64,
    /// Nodes from a root to its deepest leaf.
    pub depth: u64,
    /// Placed primitives after the hierarchy was expanded.
    pub instances: u64,
    /// Triangles of all placed primitives together, those of a mesh counted as often as it is placed.
    pub placed_triangles: u64,
    /// Vertices of all meshes, each mesh counted once.
    pub vertices: u64,
    /// Triangles of all meshes, each mesh counted once.
    pub triangles: u64,
}

impl Default for Budget {
    /// Ample for models that a desktop machine renders: 1 GiB of files, 2^28 pixels (a 16k square), 2e7 triangles.
    fn default() -> Budget {
        Budget {
            file_bytes: 1 << 30,
            json_bytes: 1 << 28,
            json_objects: 3_000_000,
            pixels: 1 << 28,
            nodes: 1_000_000,
            depth: 1024,
            instances: 1_000_000,
            placed_triangles: 200_000_000,
            vertices: 60_000_000,
            triangles: 20_000_000,
        }
    }
}

/// Counts what an import has used.
#[derive(Debug)]
pub(super) struct Meter {
    /// The limits.
    pub budget: Budget,
    bytes: u64,
    pixels: u64,
    instances: u64,
    placed_triangles: u64,
    vertices: u64,
    triangles: u64,
}

impl Meter {
    pub fn new(budget: Budget) -> Meter {
        Meter { budget, bytes: 0, pixels: 0, instances: 0, placed_triangles: 0, vertices: 0, triangles: 0 }
    }

    /// Bytes that may still be read.
    pub fn bytes_left(&self) -> u64 {
        self.budget.file_bytes.saturating_sub(self.bytes)
    }

    pub fn take_bytes(&mut self, count: u64) -> Result<(), Cause> {
        take(&mut self.bytes, count, self.budget.file_bytes, "bytes")
    }

    pub fn take_pixels(&mut self, width: u64, height: u64) -> Result<(), Cause> {
        take(&mut self.pixels, width.saturating_mul(height), self.budget.pixels, "pixels")
    }

    /// One placed primitive of so many triangles.
    pub fn take_instance(&mut self, triangles: u64) -> Result<(), Cause> {
        take(&mut self.instances, 1, self.budget.instances, "instances")?;
        take(&mut self.placed_triangles, triangles, self.budget.placed_triangles, "placed triangles")
    }

    pub fn take_vertices(&mut self, count: u64) -> Result<(), Cause> {
        take(&mut self.vertices, count, self.budget.vertices, "vertices")
    }

    pub fn take_triangles(&mut self, count: u64) -> Result<(), Cause> {
        take(&mut self.triangles, count, self.budget.triangles, "triangles")
    }
}

/// Adds to a sum unless it would pass its limit; the sum is then left as it was.
fn take(sum: &mut u64, count: u64, limit: u64, what: &'static str) -> Result<(), Cause> {
    let asked = sum.saturating_add(count);
    if asked > limit {
        return Err(Cause::Limit { what, asked, limit });
    }
    *sum = asked;
    Ok(())
}
