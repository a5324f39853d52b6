//! Accessors: typed arrays in buffers, strided, normalised, sparse, or all zero.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*, sections 3.6.2.2 to 3.6.2.4. Every bound is checked here, against
//! the bytes that exist, not those that the file declares.

use super::{
    LoadError,
    document::{self, Document, place},
    limits::MemoryBudget,
    resources::Buffers,
};
use crate::words::{counted, either};

/// What is needed to read accessors.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a> {
    pub doc: &'a Document,
    pub buffers: &'a Buffers,
    pub budget: &'a MemoryBudget,
}

#[derive(Clone, Copy, PartialEq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

/// Elements in a buffer: `count` of `size` bytes, `stride` bytes apart. All of them are inside `bytes`.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl Component {
    fn from_code(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The value before normalisation.
    fn plain(self, b: &[u8]) -> f32 {
        match (self, b) {
            (Self::I8, &[a, ..]) => f32::from(a as i8),
            (Self::U8, &[a, ..]) => f32::from(a),
            (Self::I16, &[a, b, ..]) => f32::from(i16::from_le_bytes([a, b])),
            (Self::U16, &[a, b, ..]) => f32::from(u16::from_le_bytes([a, b])),
            (Self::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]) as f32,
            (Self::F32, &[a, b, c, d, ..]) => f32::from_le_bytes([a, b, c, d]),
            _ => 0.0,
        }
    }

    /// Divisor of normalised values.
    fn range(self) -> f32 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 => u32::MAX as f32,
            Self::F32 => 1.0,
        }
    }

    fn unsigned(self, b: &[u8]) -> u32 {
        match (self, b) {
            (Self::U8, &[a, ..]) => a.into(),
            (Self::U16, &[a, b, ..]) => u16::from_le_bytes([a, b]).into(),
            (Self::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
            _ => 0,
        }
    }
}

/// Number of components of an element of this type.
pub(super) fn lanes_of(shape: &str) -> Option<usize> {
    Some(match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" | "MAT2" => 4,
        "MAT3" => 9,
        "MAT4" => 16,
        _ => return None,
    })
}

/// The least and the largest value of each component, as they are stored (not normalised).
pub(super) fn stored_range(component_type: u64, packed: &[u8], lanes: usize) -> Option<[Vec<f64>; 2]> {
    let component = Component::from_code(component_type)?;
    let mut low = vec![f64::INFINITY; lanes];
    let mut high = vec![f64::NEG_INFINITY; lanes];
    for (at, bytes) in packed.chunks_exact(component.width()).enumerate() {
        let value = match component {
            Component::U32 => f64::from(component.unsigned(bytes)),
            _ => f64::from(component.plain(bytes)),
        };
        let (low, high) = (low.get_mut(at % lanes)?, high.get_mut(at % lanes)?);
        (*low, *high) = (low.min(value), high.max(value));
    }
    Some([low, high])
}

/// Bytes of an element; the columns of matrices begin at multiples of four bytes.
fn stored_size(shape: &str, width: usize) -> Option<usize> {
    let column = |rows: usize| (rows * width).next_multiple_of(4);
    Some(match shape {
        "MAT2" => 2 * column(2),
        "MAT3" => 3 * column(3),
        "MAT4" => 4 * column(4),
        _ => lanes_of(shape)? * width,
    })
}

impl<'a> Reader<'a> {
    /// Elements of `N` numbers; normalised integers become fractions in [0, 1] or [-1, 1].
    pub fn floats<const N: usize>(&self, index: usize) -> Result<Vec<[f32; N]>, LoadError> {
        let (accessor, component) = self.typed::<N>(index)?;
        if !accessor.normalized || component == Component::F32 {
            return self.values(index, &accessor, component, |b| component.plain(b));
        }
        let range = component.range();
        self.values(index, &accessor, component, |b| (component.plain(b) / range).max(-1.0))
    }

    /// Elements of `N` unsigned integers.
    pub fn integers<const N: usize>(&self, index: usize) -> Result<Vec<[u32; N]>, LoadError> {
        let (accessor, component) = self.typed::<N>(index)?;
        match component {
            Component::U8 | Component::U16 | Component::U32 => {
                self.values(index, &accessor, component, |b| component.unsigned(b))
            }
            _ => Err(wrong(index, format!("component type {} is not an unsigned integer", accessor.component_type))),
        }
    }

    /// The elements as they are stored, packed without gaps, and the bytes of one. Sparse elements are in their places.
    pub fn packed(&self, index: usize) -> Result<(Vec<u8>, usize), LoadError> {
        let accessor: document::JsonAccessor = self.doc.get(index)?;
        let component = component(index, accessor.component_type)?;
        let size = stored_size(&accessor.shape, component.width())
            .ok_or_else(|| wrong(index, format!("unknown type {}", accessor.shape)))?;
        let mut bytes = match accessor.buffer_view {
            Some(view) => self
                .elements(index, view, accessor.byte_offset, accessor.count, size)?
                .iter()
                .flatten()
                .copied()
                .collect(),
            None => vec![0; accessor.count as usize * size],
        };
        if let Some(sparse) = &accessor.sparse {
            let elements =
                self.elements(index, sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size)?;
            for (at, element) in self.sparse_indices(index, sparse)?.zip(elements.iter()) {
                let place = at.checked_mul(size).and_then(|start| bytes.get_mut(start..start + size));
                place
                    .ok_or_else(|| wrong(index, format!("its sparse index {at} is too large")))?
                    .copy_from_slice(element);
            }
        }
        Ok((bytes, size))
    }

    /// Number of components of an element.
    pub fn lanes(&self, index: usize) -> Result<usize, LoadError> {
        let accessor: document::JsonAccessor = self.doc.get(index)?;
        lanes_of(&accessor.shape).ok_or_else(|| wrong(index, format!("unknown type {}", accessor.shape)))
    }

    /// Whether the accessor has data; without, all its elements are zero.
    pub fn has_data(&self, index: usize) -> bool {
        let accessor = self.doc.get::<document::JsonAccessor>(index);
        accessor.is_ok_and(|accessor| accessor.buffer_view.is_some() || accessor.sparse.is_some())
    }

    fn typed<const N: usize>(&self, index: usize) -> Result<(document::JsonAccessor, Component), LoadError> {
        let accessor: document::JsonAccessor = self.doc.get(index)?;
        let component = component(index, accessor.component_type)?;
        if accessor.count >= u64::from(u32::MAX) {
            self.budget.take(accessor.count, 4 * N as u64, || place::<document::JsonAccessor>(index))?;
            return Err(wrong(
                index,
                format!("it has {} elements, more than a 32-bit index can address", accessor.count),
            ));
        }
        match self.lanes(index)? == N {
            true => Ok((accessor, component)),
            false => Err(wrong(index, format!("type {} where {N} numbers an element are needed", accessor.shape))),
        }
    }

    fn values<T: Copy + Default, const N: usize>(
        &self,
        index: usize,
        accessor: &document::JsonAccessor,
        component: Component,
        convert: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>, LoadError> {
        let what = || format!("{} with {} elements", place::<document::JsonAccessor>(index), accessor.count);
        let (width, size) = (component.width(), component.width() * N);
        let take = |e: &Elements| e.iter().map(|b| element(b, width, &convert)).collect();
        let mut values: Vec<[T; N]> = match accessor.buffer_view {
            Some(view) => {
                let elements = self.elements(index, view, accessor.byte_offset, accessor.count, size)?;
                self.budget.take(accessor.count, size_of::<[T; N]>() as u64, what)?;
                take(&elements)
            }
            None => {
                self.budget.take(accessor.count, size_of::<[T; N]>() as u64, what)?;
                vec![[T::default(); N]; accessor.count as usize]
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let elements =
                self.elements(index, sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size)?;
            for (at, bytes) in self.sparse_indices(index, sparse)?.zip(elements.iter()) {
                let entry =
                    values.get_mut(at).ok_or_else(|| wrong(index, format!("its sparse index {at} is too large")))?;
                *entry = element(bytes, width, &convert);
            }
        }
        Ok(values)
    }

    fn sparse_indices(
        &self,
        index: usize,
        sparse: &document::Sparse,
    ) -> Result<impl Iterator<Item = usize> + 'a, LoadError> {
        let indices = &sparse.indices;
        let component = component(index, indices.component_type)?;
        let elements =
            self.elements(index, indices.buffer_view, indices.byte_offset, sparse.count, component.width())?;
        Ok(elements.into_iter().map(move |b| component.unsigned(b) as usize))
    }

    /// Bytes of `count` elements, all of them inside the view.
    fn elements(
        &self,
        index: usize,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
    ) -> Result<Elements<'a>, LoadError> {
        let (bytes, stride) = self.buffers.view(self.doc, view)?;
        let stride = stride.filter(|&stride| stride > 0).unwrap_or(size as u64);
        let needed = match count {
            0 => 0,
            _ => (count - 1).saturating_mul(stride).saturating_add(size as u64).saturating_add(offset),
        };
        if needed > bytes.len() as u64 {
            let (elements, need) = (counted(count, "element"), either(count, "needs", "need"));
            let problem =
                format!("its {elements} {need} {needed} bytes of bufferViews[{view}], which has {}", bytes.len());
            return Err(LoadError::structure(place::<document::JsonAccessor>(index), problem));
        }
        let bytes = bytes.get(offset as usize..).unwrap_or(&[]);
        Ok(Elements { bytes, stride: stride as usize, size, count: count as usize })
    }
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |i| bytes.get(i * stride..i * stride + size).unwrap_or(&[]))
    }

    fn into_iter(self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        self.iter()
    }
}

fn element<T: Copy + Default, const N: usize>(bytes: &[u8], width: usize, convert: &impl Fn(&[u8]) -> T) -> [T; N] {
    let mut lanes = bytes.chunks_exact(width);
    [(); N].map(|()| lanes.next().map(convert).unwrap_or_default())
}

fn component(index: usize, code: u64) -> Result<Component, LoadError> {
    Component::from_code(code).ok_or_else(|| wrong(index, format!("unknown component type {code}")))
}

fn wrong(index: usize, problem: String) -> LoadError {
    LoadError::structure(place::<document::JsonAccessor>(index), problem)
}
