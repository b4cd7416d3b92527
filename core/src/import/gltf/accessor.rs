//! Typed reading of accessors with checked arithmetic: a file may state any count, offset and stride.

use std::borrow::Cow;

use ::gltf::json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use ::gltf::json::{Root, validation::Checked};

use crate::import::Cause;
use crate::import::numbers::pick;

/// The JSON with the bytes of its buffers; a buffer that could not be had is `None` and was reported.
pub(super) struct Data<'a> {
    pub root: &'a Root,
    pub buffers: Vec<Option<Cow<'a, [u8]>>>,
}

/// Where the elements of an accessor or a sparse part lie.
struct Layout<'a> {
    /// Ends with the last element.
    bytes: &'a [u8],
    stride: usize,
}

/// What an accessor says of itself, checked.
pub(super) struct Shape {
    /// Elements.
    pub count: usize,
    /// Numbers in an element.
    pub width: usize,
    kind: ComponentType,
    normalized: bool,
}

impl Data<'_> {
    /// Count and type of an accessor; reads no buffer.
    pub fn shape(&self, index: usize) -> Result<Shape, Cause> {
        let accessor = pick(&self.root.accessors, index, "accessor")?;
        let Checked::Valid(kind) = accessor.component_type else {
            return Err(Cause::Invalid("the component type is unknown".into()));
        };
        let width = match accessor.type_ {
            Checked::Valid(Type::Scalar) => 1,
            Checked::Valid(Type::Vec2) => 2,
            Checked::Valid(Type::Vec3) => 3,
            Checked::Valid(Type::Vec4) => 4,
            Checked::Valid(_) => return Err(Cause::Invalid("is a matrix where vectors are expected".into())),
            Checked::Invalid => return Err(Cause::Invalid("the element type is unknown".into())),
        };
        let count = usize::try_from(accessor.count.0).map_err(|_| too_many(accessor.count.0))?;
        if count == 0 {
            return Err(Cause::Invalid("states 0 elements".into()));
        }
        Ok(Shape { count, width, kind: kind.0, normalized: accessor.normalized })
    }

    /// Vectors of `N` numbers; integers are scaled to [0, 1] or [-1, 1] when normalized. The caller has checked the
    /// count against the budget.
    pub fn vectors<const N: usize>(&self, index: usize) -> Result<Vec<[f32; N]>, Cause> {
        let shape = self.shape(index)?;
        if shape.width != N {
            return Err(Cause::Invalid(format!("has {} numbers in an element, expected {N}", shape.width)));
        }
        if shape.kind == ComponentType::U32 {
            return Err(Cause::Invalid("has 32-bit integers where floats are expected".into()));
        }
        let size = shape.kind.size();
        self.elements(index, &shape, [0.0; N], |bytes| {
            let mut vector = [0.0; N];
            for (number, bytes) in vector.iter_mut().zip(bytes.chunks_exact(size)) {
                *number = float(bytes, shape.kind, shape.normalized);
            }
            vector
        })
    }

    /// Vertex indices.
    pub fn indices(&self, index: usize) -> Result<Vec<u32>, Cause> {
        let shape = self.shape(index)?;
        let whole = matches!(shape.kind, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if shape.width != 1 || !whole {
            return Err(Cause::Invalid("indices must be single unsigned integers".into()));
        }
        self.elements(index, &shape, 0, |bytes| whole_number(bytes, shape.kind))
    }

    /// All elements: zeros or the buffer view's, then what a sparse part replaces.
    fn elements<T: Copy>(
        &self,
        index: usize,
        shape: &Shape,
        zero: T,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, Cause> {
        let accessor = pick(&self.root.accessors, index, "accessor")?;
        let size = shape.width * shape.kind.size();
        let mut list = match &accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |o| o.0);
                let layout = self.layout(view.value(), offset, shape.count, size)?;
                layout.bytes.chunks(layout.stride).map(|element| read(element.get(..size).unwrap_or(&[]))).collect()
            }
            None => vec![zero; shape.count],
        };
        if let Some(sparse) = &accessor.sparse {
            self.overlay(sparse, accessor, size, &mut list, read)?;
        }
        Ok(list)
    }

    fn overlay<T>(
        &self,
        sparse: &Sparse,
        accessor: &Accessor,
        size: usize,
        list: &mut [T],
        read: impl Fn(&[u8]) -> T,
    ) -> Result<(), Cause> {
        let count = usize::try_from(sparse.count.0).ok().filter(|c| *c <= list.len()).ok_or_else(|| {
            let (sparse, all) = (sparse.count.0, accessor.count.0);
            Cause::Invalid(format!("sparse part: replaces {sparse} of {all} elements"))
        })?;
        if count == 0 {
            return Ok(());
        }
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return Err(Cause::Invalid("sparse part: the type of the indices is unknown".into()));
        };
        let part = &sparse.indices;
        let places = self.layout(part.buffer_view.value(), part.byte_offset.0, count, kind.0.size())?;
        let part = &sparse.values;
        let values = self.layout(part.buffer_view.value(), part.byte_offset.0, count, size)?;
        for (place, value) in places.bytes.chunks(places.stride).zip(values.bytes.chunks(values.stride)) {
            let place = whole_number(place, kind.0) as usize;
            let Some(slot) = list.get_mut(place) else {
                let count = accessor.count.0;
                return Err(Cause::Index { what: "sparse part: element", index: place as u64, count });
            };
            *slot = read(value.get(..size).unwrap_or(&[]));
        }
        Ok(())
    }

    /// The bytes of `count` elements of `size` bytes, from `offset` in a buffer view.
    fn layout(&self, view: usize, offset: u64, count: usize, size: usize) -> Result<Layout<'_>, Cause> {
        let json = pick(&self.root.buffer_views, view, "buffer view")?;
        let bytes = self.view(view)?;
        let stride = json.byte_stride.map_or(size, |s| s.0);
        if stride < size {
            return Err(Cause::Invalid(format!(
                "buffer view {view}: a stride of {stride} for elements of {size} bytes"
            )));
        }
        let end = (count as u64 - 1)
            .checked_mul(stride as u64)
            .and_then(|last| last.checked_add(size as u64))
            .and_then(|length| length.checked_add(offset));
        let range = end.and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        let Some(bytes) = range.and_then(|range| bytes.get(range)) else {
            let have = bytes.len();
            let text = format!("{count} elements from byte {offset} pass the end of buffer view {view} ({have} bytes)");
            return Err(Cause::Invalid(text));
        };
        Ok(Layout { bytes, stride })
    }

    /// All bytes of a buffer view.
    pub fn view(&self, view: usize) -> Result<&[u8], Cause> {
        let json = pick(&self.root.buffer_views, view, "buffer view")?;
        let buffer = json.buffer.value();
        let Some(data) = pick(&self.buffers, buffer, "buffer")? else {
            return Err(Cause::Invalid(format!("buffer view {view}: buffer {buffer} could not be read")));
        };
        let (offset, length) = (json.byte_offset.map_or(0, |o| o.0), json.byte_length.0);
        let range =
            offset.checked_add(length).and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| data.get(range)).ok_or_else(|| {
            let have = data.len();
            let text = format!("{length} bytes from byte {offset} pass the end of buffer {buffer} ({have} bytes)");
            Cause::Invalid(format!("buffer view {view}: {text}"))
        })
    }
}

/// The first bytes as an array; the layout has made sure that they are there.
fn head<const K: usize>(bytes: &[u8]) -> [u8; K] {
    bytes.first_chunk().copied().unwrap_or([0; K])
}

/// One number; integers as they are, or normalized as glTF 2.0, 3.11 says (the most negative value is clamped).
fn float(bytes: &[u8], kind: ComponentType, normalized: bool) -> f32 {
    let (value, greatest) = match kind {
        ComponentType::F32 => return f32::from_le_bytes(head(bytes)),
        ComponentType::I8 => (f32::from(i8::from_le_bytes(head(bytes))), 127.0),
        ComponentType::U8 => (f32::from(u8::from_le_bytes(head(bytes))), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes(head(bytes))), 32767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes(head(bytes))), 65535.0),
        ComponentType::U32 => (u32::from_le_bytes(head(bytes)) as f32, 4294967295.0),
    };
    if normalized { (value / greatest).max(-1.0) } else { value }
}

fn whole_number(bytes: &[u8], kind: ComponentType) -> u32 {
    match kind {
        ComponentType::U8 => u32::from(u8::from_le_bytes(head(bytes))),
        ComponentType::U16 => u32::from(u16::from_le_bytes(head(bytes))),
        _ => u32::from_le_bytes(head(bytes)),
    }
}

fn too_many(count: u64) -> Cause {
    Cause::Limit { what: "elements", asked: count, limit: usize::MAX as u64 }
}
