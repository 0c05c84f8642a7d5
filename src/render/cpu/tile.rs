//! Visibility and resolve of one tile.
//!
//! A sample is inside when all three edge functions a x + b y + c are positive; a sample exactly on an edge belongs to the triangle for which that edge
//! is a top or left one. Neighbours see their common edge with exactly negated coefficients, in every rounding, so that no sample is drawn
//! twice or lost. Coefficients are formed in f64 relative to the tile's corner; within the tile f32 is ample.

use super::BackdropRow;
use super::bins::{TILE_HEIGHT, TILE_WIDTH};
use super::lanes::Lanes3;
use super::shade::{Lighting, Points};
use super::triangles::{Projected, ScreenTriangle};
use crate::render::geometry::Surface;
use crate::render::portable::encode;
use glam::{BVec4A, Vec2, Vec3, Vec4};

/// The usual four samples: each alone in its row and column of a 4 x 4 grid, their mean the pixel's centre.
const SAMPLES: [Vec2; 4] =
    [Vec2::new(0.375, 0.125), Vec2::new(0.875, 0.375), Vec2::new(0.125, 0.625), Vec2::new(0.625, 0.875)];

/// Nearest triangle at each sample. Triangles are numbered in f32, exact up to 16 million, so that one selection serves all four samples.
#[derive(Debug)]
pub(super) struct Tile {
    depth: Vec<Vec4>,
    triangle: Vec<Vec4>,
    /// No triangle touches the tile: the fields above are stale then.
    is_empty: bool,
    origin: Vec2,
    /// Of the row that is being lit.
    fragments: Vec<Fragment>,
    light: Vec<Vec3>,
    /// Of a picture with a transparent background.
    opacity: Vec<f32>,
}

impl Default for Tile {
    fn default() -> Self {
        let pixels = TILE_WIDTH * TILE_HEIGHT;
        Self {
            depth: vec![Vec4::ZERO; pixels],
            triangle: vec![NOTHING; pixels],
            is_empty: true,
            origin: Vec2::ZERO,
            fragments: Vec::new(),
            light: vec![Vec3::ZERO; TILE_WIDTH],
            opacity: vec![0.0; TILE_WIDTH],
        }
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
        self.is_empty = members.is_empty();
        if !self.is_empty {
            self.depth.fill(Vec4::ZERO);
            self.triangle.fill(NOTHING);
        }
        self.origin = Vec2::new((column * TILE_WIDTH) as f32, (row * TILE_HEIGHT) as f32);
        for &index in members {
            self.cover(&projected.triangles[index as usize], index);
        }
    }

    fn cover(&mut self, triangle: &ScreenTriangle, index: u32) {
        let [a, b, c] = triangle.corners;
        let (low, high) = (a.min(b).min(c) - self.origin, a.max(b).max(c) - self.origin);
        let columns = low.x as usize..(high.x as usize).min(TILE_WIDTH - 1) + 1;
        let rows = low.y as usize..(high.y as usize).min(TILE_HEIGHT - 1) + 1;
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
    pub fn resolve(&mut self, frame: &Frame<'_>, backdrop: &[BackdropRow], rows: &mut [u8], row_bytes: usize) {
        let left = self.origin.x as usize * 4;
        let width = TILE_WIDTH.min((row_bytes - left) / 4);
        for (y, backdrop) in backdrop.iter().enumerate().take(rows.len() / row_bytes) {
            let row = &mut rows[y * row_bytes + left..][..width * 4];
            if self.is_empty {
                row.chunks_exact_mut(4).for_each(|pixel| pixel.copy_from_slice(&backdrop.bytes));
                continue;
            }
            self.list_fragments(y, width, backdrop.light);
            if frame.is_clear {
                self.light_before_nothing(frame);
                for (pixel, (light, opacity)) in row.chunks_exact_mut(4).zip(self.light.iter().zip(&self.opacity)) {
                    pixel.copy_from_slice(&translucent(*light, *opacity));
                }
                continue;
            }
            self.light_fragments(frame, backdrop.light);
            for (x, pixel) in row.chunks_exact_mut(4).enumerate() {
                let empty = self.triangle[y * TILE_WIDTH + x] == NOTHING;
                pixel.copy_from_slice(&if empty { backdrop.bytes } else { bytes(self.light[x]) });
            }
        }
    }

    /// What must be lit in one row: each triangle once a pixel, in the middle of the samples it covers.
    fn list_fragments(&mut self, row: usize, width: usize, backdrop: Vec3) {
        self.fragments.clear();
        self.light.fill(Vec3::ZERO);
        for column in 0..width {
            let seen = self.triangle[row * TILE_WIDTH + column];
            let corner = self.origin + Vec2::new(column as f32, row as f32);
            if seen == NOTHING {
                continue;
            }
            if seen == Vec4::splat(seen.x) {
                let (place, triangle) = (corner + Vec2::splat(0.5), seen.x as u32);
                self.fragments.push(Fragment { triangle, place, pixel: column, weight: 1.0 });
                continue;
            }
            let seen = seen.to_array();
            for (sample, &number) in
                seen.iter().enumerate().filter(|&(sample, number)| !seen[..sample].contains(number))
            {
                let covered = || (sample..4).filter(|&other| seen[other] == number);
                let count = covered().count() as f32;
                let weight = count / 4.0;
                if number < 0.0 {
                    self.light[column] += backdrop * weight;
                    continue;
                }
                let place = corner + covered().map(|other| SAMPLES[other]).sum::<Vec2>() / count;
                self.fragments.push(Fragment { triangle: number as u32, place, pixel: column, weight });
            }
        }
    }

    fn light_fragments(&mut self, frame: &Frame<'_>, backdrop: Vec3) {
        for group in self.fragments.chunks(4) {
            // The last group repeats its last member and drops the surplus.
            let member = |lane: usize| &group[lane.min(group.len() - 1)];
            let points = frame.points([member(0), member(1), member(2), member(3)]);
            let lights = frame.lighting.shade(&points, Lanes3::splat(backdrop));
            for (lane, fragment) in group.iter().enumerate() {
                self.light[fragment.pixel] += lights.lane(lane) * fragment.weight;
            }
        }
    }

    /// Light times opacity, and opacity.
    fn light_before_nothing(&mut self, frame: &Frame<'_>) {
        self.opacity.fill(0.0);
        for group in self.fragments.chunks(4) {
            let member = |lane: usize| &group[lane.min(group.len() - 1)];
            let points = frame.points([member(0), member(1), member(2), member(3)]);
            let (lights, opacity) = frame.lighting.shade_before_nothing(&points);
            for (lane, fragment) in group.iter().enumerate() {
                self.light[fragment.pixel] += lights.lane(lane) * fragment.weight;
                self.opacity[fragment.pixel] += opacity[lane] * fragment.weight;
            }
        }
    }
}

/// A triangle in a pixel.
#[derive(Debug, Clone, Copy)]
struct Fragment {
    triangle: u32,
    /// Where on the screen it is lit.
    place: Vec2,
    /// Column in the tile.
    pixel: usize,
    /// Part of the pixel's samples.
    weight: f32,
}

/// All that resolving a tile reads.
#[derive(Debug)]
pub(super) struct Frame<'a> {
    pub projected: &'a Projected,
    pub surfaces: &'a [Surface],
    pub lighting: Lighting<'a>,
    /// The background is transparent.
    pub is_clear: bool,
}

impl Frame<'_> {
    /// Interpolates four fragments, correct in perspective.
    fn points(&self, fragments: [&Fragment; 4]) -> Points {
        // Lane by lane into plain arrays: the compiler keeps the loop flat, which it does not for nested maps.
        let mut lanes = [[0.0; 4]; 12];
        for (lane, fragment) in fragments.into_iter().enumerate() {
            let triangle = &self.projected.triangles[fragment.triangle as usize];
            let [a, b, c] = triangle.vertices;
            let vertices = &self.projected.vertices;
            let (a, b, c) = (&vertices[a as usize], &vertices[b as usize], &vertices[c as usize]);
            let from = fragment.place - triangle.corners[0];
            let distance = 1.0 / triangle.inverse_distance.at(from);
            let second = triangle.weights[0].at(from) * distance;
            let third = triangle.weights[1].at(from) * distance;
            let position = a.position + (b.position - a.position) * second + (c.position - a.position) * third;
            let normal = a.normal + (b.normal - a.normal) * second + (c.normal - a.normal) * third;
            let surface = &self.surfaces[a.surface as usize];
            let colour = surface.colour;
            let values = [
                position.x,
                position.y,
                position.z,
                normal.x,
                normal.y,
                normal.z,
                colour.x,
                colour.y,
                colour.z,
                surface.roughness,
                surface.metallic,
                surface.glow,
            ];
            for (row, value) in lanes.iter_mut().zip(values) {
                row[lane] = value;
            }
        }
        let four = |row: usize| Vec4::from_array(lanes[row]);
        let three = |row: usize| Lanes3 { x: four(row), y: four(row + 1), z: four(row + 2) };
        Points {
            position: three(0),
            normal: three(3),
            colour: three(6),
            roughness: four(9),
            metallic: four(10),
            glow: four(11),
        }
    }
}

fn bytes(light: Vec3) -> [u8; 4] {
    [encode(light.x), encode(light.y), encode(light.z), 255]
}

/// Straight alpha, from light times opacity.
fn translucent(light: Vec3, opacity: f32) -> [u8; 4] {
    let light = light / opacity.max(1e-6);
    [encode(light.x), encode(light.y), encode(light.z), (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8]
}
