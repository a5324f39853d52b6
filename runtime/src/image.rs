//! Pictures as numbers: a rectangle of pixels in row order.

/// Pixels in rows, the upper left one first.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster<T> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Row order, from the top.
    pub pixels: Vec<T>,
}

impl<T: Clone> Raster<T> {
    /// A raster whose pixels are all `pixel`.
    pub fn filled(size: [u32; 2], pixel: T) -> Self {
        Self { size, pixels: vec![pixel; size[0] as usize * size[1] as usize] }
    }
}

impl<T> Raster<T> {
    /// The pixel at a column and a row, both from 0.
    pub fn at(&self, column: u32, row: u32) -> &T {
        &self.pixels[row as usize * self.size[0] as usize + column as usize]
    }
}

impl<T> Raster<T>
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>,
{
    /// Means of blocks of `n` by `n` pixels.
    pub fn reduced(&self, n: u32) -> Self {
        if n <= 1 {
            return Self { size: self.size, pixels: self.pixels.clone() };
        }
        let size = self.size.map(|edge| edge / n);
        let mut pixels = Vec::with_capacity(size[0] as usize * size[1] as usize);
        for row in 0..size[1] {
            for column in 0..size[0] {
                let places = (0..n * n).map(|i| *self.at(column * n + i % n, row * n + i / n));
                let sum = places.reduce(|a, b| a + b);
                pixels.extend(sum.map(|sum| sum * (1.0 / (n * n) as f32)));
            }
        }
        Self { size, pixels }
    }
}
