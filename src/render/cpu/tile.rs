//! Visibility and resolve of one tile.
//!
//! A sample is inside when all three edge functions a x + b y + c are positive; a sample exactly on an edge belongs to the triangle for which that edge
//! is a top or left one. Neighbours see their common edge with exactly negated coefficients, in every rounding, so that no sample is drawn
//! twice or lost. Coefficients are formed in f64 relative to the tile's corner; within the tile f32 is ample.

use super::BackdropRow;
use super::shade::Lighting;
use super::triangles::{Projected, ScreenTriangle};
use crate::render::geometry::Surface;
use crate::render::portable::encode;
use glam::{BVec4A, Vec2, Vec3, Vec4};

pub(super) const TILE_WIDTH: usize = 32;
pub(super) const TILE_HEIGHT: usize = 16;

/// The usual four samples: each alone in its row and column of a 4 x 4 grid, their mean the pixel's centre.
const SAMPLES: [Vec2; 4] =
    [Vec2::new(0.375, 0.125), Vec2::new(0.875, 0.375), Vec2::new(0.125, 0.625), Vec2::new(0.625, 0.875)];

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

/// Nearest triangle at each sample. Triangles are numbered in f32, exact up to 16 million, so that one selection serves all four samples.
#[derive(Debug)]
pub(super) struct Tile {
    depth: Vec<Vec4>,
    triangle: Vec<Vec4>,
    origin: Vec2,
}

impl Default for Tile {
    fn default() -> Self {
        let pixels = TILE_WIDTH * TILE_HEIGHT;
        Self { depth: vec![Vec4::ZERO; pixels], triangle: vec![NOTHING; pixels], origin: Vec2::ZERO }
    }
}

/// No triangle at any sample.
const NOTHING: Vec4 = Vec4::NEG_ONE;

/// Linear function over the tile: value at the corner of its first pixel, change per pixel, and differences to the four samples.
#[derive(Clone, Copy)]
struct Ramp {
    origin: f32,
    x: f32,
    y: f32,
    samples: Vec4,
}

impl Ramp {
    fn new(origin: f32, x: f32, y: f32) -> Self {
        Self { origin, x, y, samples: Vec4::from_array(SAMPLES.map(|sample| x * sample.x + y * sample.y)) }
    }

    fn row(&self, row: usize) -> f32 {
        self.origin + self.y * row as f32
    }

    fn at(&self, row: f32, column: usize) -> Vec4 {
        Vec4::splat(row + self.x * column as f32) + self.samples
    }
}

/// Edge function from `p` to `q` and the least value that counts as inside.
fn edge(p: Vec2, q: Vec2, origin: Vec2) -> (Ramp, Vec4) {
    let ([px, py], [qx, qy]) = (p.as_dvec2().to_array(), q.as_dvec2().to_array());
    let (a, b) = (py - qy, qx - px);
    let value = (a * f64::from(origin.x) + b * f64::from(origin.y)) + (px * qy - qx * py);
    let (a, b) = (a as f32, b as f32);
    let top_or_left = a > 0.0 || (a == 0.0 && b > 0.0);
    (Ramp::new(value as f32, a, b), Vec4::splat(if top_or_left { 0.0 } else { f32::MIN_POSITIVE }))
}

impl Tile {
    /// Finds the nearest of `members` at every sample of the tile in the given column and row of tiles.
    pub fn find_visible(&mut self, projected: &Projected, members: &[u32], [column, row]: [usize; 2]) {
        self.depth.fill(Vec4::ZERO);
        self.triangle.fill(NOTHING);
        self.origin = Vec2::new((column * TILE_WIDTH) as f32, (row * TILE_HEIGHT) as f32);
        for &index in members {
            self.cover(&projected.triangles[index as usize], index);
        }
    }

    fn cover(&mut self, triangle: &ScreenTriangle, index: u32) {
        let [a, b, c] = triangle.corners;
        let (low, high) = (a.min(b).min(c) - self.origin, a.max(b).max(c) - self.origin);
        let columns = low.x as usize..(high.x as usize + 1).min(TILE_WIDTH);
        let rows = low.y as usize..(high.y as usize + 1).min(TILE_HEIGHT);
        let edges = [edge(a, b, self.origin), edge(b, c, self.origin), edge(c, a, self.origin)];
        let plane = &triangle.inverse_distance;
        let depth = Ramp::new(plane.at(self.origin - a), plane.slope.x, plane.slope.y);
        let number = Vec4::splat(index as f32);
        for row in rows {
            let starts = edges.map(|(ramp, _)| ramp.row(row));
            let depth_start = depth.row(row);
            for column in columns.clone() {
                let inside = |i: usize| edges[i].0.at(starts[i], column).cmpge(edges[i].1);
                let covered: BVec4A = inside(0) & inside(1) & inside(2);
                if !covered.any() {
                    continue;
                }
                let pixel = row * TILE_WIDTH + column;
                let nearness = depth.at(depth_start, column);
                let wins = covered & nearness.cmpgt(self.depth[pixel]);
                self.depth[pixel] = Vec4::select(wins, nearness, self.depth[pixel]);
                self.triangle[pixel] = Vec4::select(wins, number, self.triangle[pixel]);
            }
        }
    }

    /// Lights what is visible and writes the tile into the band of image rows it lies in.
    #[expect(clippy::too_many_arguments, reason = "the whole state of a frame meets here, once")]
    pub fn resolve(
        &self,
        projected: &Projected,
        surfaces: &[Surface],
        lighting: &Lighting<'_>,
        backdrop: &[BackdropRow],
        rows: &mut [u8],
        row_bytes: usize,
        column: usize,
    ) {
        let left = column * TILE_WIDTH * 4;
        for (y, (row, backdrop)) in rows.chunks_exact_mut(row_bytes).zip(backdrop).enumerate() {
            for (x, pixel) in row[left..].chunks_exact_mut(4).take(TILE_WIDTH).enumerate() {
                let seen = self.triangle[y * TILE_WIDTH + x];
                let corner = self.origin + Vec2::new(x as f32, y as f32);
                let light = |number: f32, place: Vec2| {
                    fragment(projected, surfaces, lighting, number, corner + place, backdrop)
                };
                let first = seen.x;
                let bytes = if seen == NOTHING {
                    backdrop.bytes
                } else if seen == Vec4::splat(first) {
                    bytes(light(first, Vec2::splat(0.5)))
                } else {
                    bytes(blend(seen.to_array(), light, backdrop.light))
                };
                pixel.copy_from_slice(&bytes);
            }
        }
    }
}

/// Mean of the samples, each triangle lit once, in the middle of the samples it covers.
fn blend(seen: [f32; 4], light: impl Fn(f32, Vec2) -> Vec3, backdrop: Vec3) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for (sample, &number) in seen.iter().enumerate() {
        if seen[..sample].contains(&number) {
            continue;
        }
        let covered = || (0..4).filter(|&other| seen[other] == number);
        let count = covered().count() as f32;
        let middle = covered().map(|other| SAMPLES[other]).sum::<Vec2>() / count;
        sum += if number < 0.0 { backdrop } else { light(number, middle) } * (count / 4.0);
    }
    sum
}

/// Tone mapped light of a triangle at a place on the screen.
fn fragment(
    projected: &Projected,
    surfaces: &[Surface],
    lighting: &Lighting<'_>,
    number: f32,
    place: Vec2,
    backdrop: &BackdropRow,
) -> Vec3 {
    let triangle = &projected.triangles[number as usize];
    let [a, b, c] = triangle.vertices.map(|vertex| &projected.vertices[vertex as usize]);
    let from = place - triangle.corners[0];
    let distance = 1.0 / triangle.inverse_distance.at(from);
    let [second, third] = triangle.weights.map(|plane| plane.at(from) * distance);
    let position = a.position + (b.position - a.position) * second + (c.position - a.position) * third;
    let normal = a.normal + (b.normal - a.normal) * second + (c.normal - a.normal) * third;
    lighting.shade(position, normal, &surfaces[a.surface as usize], backdrop.light)
}

fn bytes(light: Vec3) -> [u8; 4] {
    [encode(light.x), encode(light.y), encode(light.z), 255]
}
