//! Shared code of binary formats: numbers in a header, and heights stored as numbers of one kind.

use super::{cells, finite, x_fastest};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Byte order of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Order {
    Little,
    Big,
}

/// Storage format of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    Uint8,
    Uint16,
    Uint32,
    Uint64,
    Int8,
    Int16,
    Int32,
    Int64,
    Float32,
    Float64,
}

impl Number {
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Uint8 | Self::Int8 => 1,
            Self::Uint16 | Self::Int16 => 2,
            Self::Uint32 | Self::Int32 | Self::Float32 => 4,
            Self::Uint64 | Self::Int64 | Self::Float64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::Float32 | Self::Float64)
    }

    /// Reads consecutive numbers into `numbers`, starting at index `first`.
    fn read(self, order: Order, data: &[u8], first: usize, numbers: &mut [f64]) {
        use Order::{Big, Little};
        match (self, order) {
            (Self::Uint8, _) => convert(data, first, numbers, |[byte]| f64::from(byte)),
            (Self::Int8, _) => convert(data, first, numbers, |[byte]| f64::from(byte.cast_signed())),
            (Self::Uint16, Little) => convert(data, first, numbers, |n| f64::from(u16::from_le_bytes(n))),
            (Self::Uint16, Big) => convert(data, first, numbers, |n| f64::from(u16::from_be_bytes(n))),
            (Self::Uint32, Little) => convert(data, first, numbers, |n| f64::from(u32::from_le_bytes(n))),
            (Self::Uint32, Big) => convert(data, first, numbers, |n| f64::from(u32::from_be_bytes(n))),
            // Beyond 2⁵³ the nearest f64; no height in metres is that large.
            (Self::Uint64, Little) => convert(data, first, numbers, |n| u64::from_le_bytes(n) as f64),
            (Self::Uint64, Big) => convert(data, first, numbers, |n| u64::from_be_bytes(n) as f64),
            (Self::Int16, Little) => convert(data, first, numbers, |n| f64::from(i16::from_le_bytes(n))),
            (Self::Int16, Big) => convert(data, first, numbers, |n| f64::from(i16::from_be_bytes(n))),
            (Self::Int32, Little) => convert(data, first, numbers, |n| f64::from(i32::from_le_bytes(n))),
            (Self::Int32, Big) => convert(data, first, numbers, |n| f64::from(i32::from_be_bytes(n))),
            (Self::Int64, Little) => convert(data, first, numbers, |n| i64::from_le_bytes(n) as f64),
            (Self::Int64, Big) => convert(data, first, numbers, |n| i64::from_be_bytes(n) as f64),
            (Self::Float32, Little) => convert(data, first, numbers, |n| f64::from(f32::from_le_bytes(n))),
            (Self::Float32, Big) => convert(data, first, numbers, |n| f64::from(f32::from_be_bytes(n))),
            (Self::Float64, Little) => convert(data, first, numbers, f64::from_le_bytes),
            (Self::Float64, Big) => convert(data, first, numbers, f64::from_be_bytes),
        }
    }
}

fn convert<const N: usize>(data: &[u8], first: usize, numbers: &mut [f64], number: impl Fn([u8; N]) -> f64) {
    for (cell, bytes) in numbers.iter_mut().zip(&data.as_chunks().0[first..]) {
        *cell = number(*bytes);
    }
}

/// Stored heights: numbers of one kind.
pub(super) struct Raster<'a> {
    pub(super) shape: [usize; 2],
    number: Number,
    order: Order,
    data: &'a [u8],
}

impl<'a> Raster<'a> {
    /// Creates the raster at the start of `data`.
    pub(super) fn new(
        shape: [usize; 2],
        number: Number,
        order: Order,
        data: &'a [u8],
    ) -> Result<Self, Defect> {
        let needed = shape[0] * shape[1] * number.bytes();
        let found = data.len() as u64;
        let data = data.get(..needed).ok_or(Defect::Length {
            what: "the part of the heights",
            expected: needed as u64,
            found,
        })?;
        Ok(Self { shape, number, order, data })
    }

    /// Size in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.data.len()
    }

    /// Converts the numbers, x fastest, to heights; non-finite ones are missing.
    pub(super) fn heights(&self, height: impl Fn(f64) -> f64) -> Field {
        x_fastest(self.shape, |first, heights| self.read(first, heights, &height))
    }

    /// Converts the numbers, y fastest, to heights.
    pub(super) fn heights_with_y_fastest(&self, height: impl Fn(f64) -> f64) -> Field {
        // One part at a time, which stays in the first-level cache between the two loops over it.
        const PART: usize = 1024;
        let mut field = Field::zeros(self.shape);
        let cells = field.as_slice_mut().expect("a new field is in standard layout");
        for (index, part) in cells.chunks_mut(PART).enumerate() {
            self.read(PART * index, part, &height);
        }
        field
    }

    fn read(&self, first: usize, heights: &mut [f64], height: impl Fn(f64) -> f64) {
        self.number.read(self.order, self.data, first, heights);
        for cell in heights {
            *cell = finite(height(*cell));
        }
    }
}

/// Returns the shape from the sizes in a header, if it is valid.
pub(super) fn shape(sizes: [impl Into<i64>; 2]) -> Result<[usize; 2], Defect> {
    let [nx, ny] = sizes.map(Into::into);
    for (what, size) in [("the size along x", nx), ("the size along y", ny)] {
        if size < 1 {
            return Err(Defect::Value { what, found: size.to_string(), expected: "at least 1" });
        }
    }
    cells(&[nx as u64, ny as u64])?;
    Ok([nx as usize, ny as usize])
}

/// Reads a part of a file from front to back; reading beyond its end is an error.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    what: &'static str,
    order: Order,
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    /// Creates a cursor at the start of `bytes`, called `what` in errors.
    pub(super) fn new(bytes: &'a [u8], order: Order, what: &'static str) -> Self {
        Self { what, order, bytes, at: 0 }
    }

    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Defect> {
        let end = self.at.saturating_add(count);
        let part = self.bytes.get(self.at..end).ok_or(Defect::Length {
            what: self.what,
            expected: end as u64,
            found: self.bytes.len() as u64,
        })?;
        self.at = end;
        Ok(part)
    }

    /// Moves to `at`, relative to the start.
    pub(super) fn seek(&mut self, at: usize) -> Result<(), Defect> {
        self.at = 0;
        self.take(at).map(|_| ())
    }

    /// Returns the remaining bytes.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Returns the bytes before the next zero, and skips the zero.
    pub(super) fn until_zero(&mut self) -> Result<&'a [u8], Defect> {
        let length = self.rest().iter().position(|byte| *byte == 0);
        let length = length.ok_or(Defect::Missing("zero that ends a text"))?;
        self.take(length + 1).map(|text| &text[..length])
    }

    pub(super) fn u8(&mut self) -> Result<u8, Defect> {
        Ok(self.take(1)?[0])
    }

    pub(super) fn u16(&mut self) -> Result<u16, Defect> {
        self.array().map(|bytes| match self.order {
            Order::Little => u16::from_le_bytes(bytes),
            Order::Big => u16::from_be_bytes(bytes),
        })
    }

    pub(super) fn u32(&mut self) -> Result<u32, Defect> {
        self.array().map(|bytes| match self.order {
            Order::Little => u32::from_le_bytes(bytes),
            Order::Big => u32::from_be_bytes(bytes),
        })
    }

    pub(super) fn u64(&mut self) -> Result<u64, Defect> {
        self.array().map(|bytes| match self.order {
            Order::Little => u64::from_le_bytes(bytes),
            Order::Big => u64::from_be_bytes(bytes),
        })
    }

    pub(super) fn i32(&mut self) -> Result<i32, Defect> {
        self.u32().map(u32::cast_signed)
    }

    pub(super) fn f32(&mut self) -> Result<f64, Defect> {
        self.u32().map(|bits| f64::from(f32::from_bits(bits)))
    }

    pub(super) fn f64(&mut self) -> Result<f64, Defect> {
        self.array().map(|bytes| match self.order {
            Order::Little => f64::from_le_bytes(bytes),
            Order::Big => f64::from_be_bytes(bytes),
        })
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Defect> {
        self.take(N).map(|bytes| *bytes.first_chunk().expect("of the length asked for"))
    }
}

/// Decodes text padded with spaces or zeros, in UTF-8 or Latin-1.
pub(super) fn text(bytes: &[u8]) -> String {
    let bytes = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
    match std::str::from_utf8(bytes) {
        Ok(text) => text.trim().to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect::<String>().trim().to_owned(),
    }
}
