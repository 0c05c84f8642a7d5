//! Sorting of triangles into the tiles they touch.

use super::triangles::ScreenTriangle;

pub(super) const TILE_WIDTH: usize = 32;
pub(super) const TILE_HEIGHT: usize = 16;

/// Which triangles touch which tile.
#[derive(Debug, Default)]
pub(super) struct TileBins {
    columns: usize,
    members: Vec<Vec<u32>>,
}

impl TileBins {
    pub fn sort(&mut self, triangles: &[ScreenTriangle], [width, height]: [u32; 2]) {
        let rows = (height as usize).div_ceil(TILE_HEIGHT);
        self.columns = (width as usize).div_ceil(TILE_WIDTH);
        self.members.iter_mut().for_each(Vec::clear);
        self.members.resize_with(self.columns * rows, Vec::new);
        for (index, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.corners;
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            // Float to integer conversion saturates: what lies outside lands in the outermost tiles.
            let tile = |place: f32, side: usize, count: usize| ((place as usize) / side).min(count - 1);
            for row in tile(low.y, TILE_HEIGHT, rows)..=tile(high.y, TILE_HEIGHT, rows) {
                for column in tile(low.x, TILE_WIDTH, self.columns)..=tile(high.x, TILE_WIDTH, self.columns) {
                    self.members[row * self.columns + column].push(index as u32);
                }
            }
        }
    }

    /// Tiles of one band of rows, from left to right.
    pub fn band(&self, band: usize) -> impl Iterator<Item = &[u32]> {
        self.members[band * self.columns..(band + 1) * self.columns].iter().map(Vec::as_slice)
    }
}
