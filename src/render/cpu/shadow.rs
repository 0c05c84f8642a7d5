//! Shadow map: height towards the light of the nearest caster over each texel, and its filtered lookup.

use super::lanes::Lanes3;
use crate::render::geometry::Geometry;
use crate::render::look::{BIAS, STEEPEST, TAPS};
use crate::render::view::{LightView, SHADOW_SIZE};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

const SIZE: usize = SHADOW_SIZE as usize;
/// Side of the blocks whose extremes decide most lookups at once. At least the filter's width, so that a lookup touches four at most.
const BLOCK: usize = 8;
const BLOCKS: usize = SIZE / BLOCK;
/// Texels that five bilinear taps reach.
const REACH: usize = TAPS.len() + 1;
/// Texels that are read: two groups of four.
const READ: usize = 8;

#[derive(Debug)]
pub(super) struct ShadowMap {
    view: LightView,
    height: Vec<f32>,
    /// Lowest and highest of each block.
    blocks: Vec<[f32; 2]>,
}

impl Default for ShadowMap {
    fn default() -> Self {
        let view =
            LightView { centre: Vec3::ZERO, axes: [Vec3::X, Vec3::Z, Vec3::Y], radius: 1.0, texel: 2.0 / SIZE as f32 };
        let empty = f32::NEG_INFINITY;
        Self { view, height: vec![empty; SIZE * SIZE], blocks: vec![[empty; 2]; BLOCKS * BLOCKS] }
    }
}

impl ShadowMap {
    pub fn draw(&mut self, geometry: &Geometry, view: LightView) {
        self.view = view;
        let projected: Vec<Vec3> = geometry.vertices.iter().map(|v| view.project(v.position)).collect();
        let mut bands: Vec<Vec<[Vec3; 3]>> = vec![Vec::new(); BLOCKS];
        for triangle in &geometry.triangles[..geometry.casting] {
            let corners = triangle.map(|index| projected[index as usize]);
            let [first, last] = rows(&corners);
            bands[first / BLOCK..last.div_ceil(BLOCK)].iter_mut().for_each(|band| band.push(corners));
        }
        let chunks = self.height.par_chunks_mut(SIZE * BLOCK).zip(self.blocks.par_chunks_mut(BLOCKS));
        chunks.zip(bands).enumerate().for_each(|(band, ((texels, blocks), triangles))| {
            // Nothing before, nothing now: most bands around a long and narrow scene.
            if triangles.is_empty() && blocks.iter().all(|block| block[1] == f32::NEG_INFINITY) {
                return;
            }
            texels.fill(f32::NEG_INFINITY);
            triangles.iter().for_each(|corners| raise(texels, band * BLOCK, corners));
            for (column, block) in blocks.iter_mut().enumerate() {
                let cells = texels.chunks_exact(SIZE).flat_map(|row| &row[column * BLOCK..(column + 1) * BLOCK]);
                *block = cells.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], &h| [low.min(h), high.max(h)]);
            }
        });
    }

    /// Part of the light, 0 to 1, that reaches four points with unit normals; 0 where `facing`, the normal's part along the light, is 0.
    pub fn lit(&self, position: Lanes3, normal: Lanes3, facing: Vec4) -> Vec4 {
        let [u, v, towards] = self.view.axes.map(Lanes3::splat);
        let from_centre = position - Lanes3::splat(self.view.centre);
        let across = |axis: Lanes3| (from_centre.dot(axis) + Vec4::splat(self.view.radius)) / self.view.texel;
        // Along the surface the height changes by this much per texel.
        let flat = Vec4::splat(-self.view.texel) / facing.max(Vec4::splat(1e-3));
        let limit = Vec4::splat(STEEPEST * self.view.texel);
        let slope = |axis: Lanes3| (normal.dot(axis) * flat).clamp(-limit, limit);
        let (slope_u, slope_v) = (slope(u), slope(v));
        let steepness = slope_u.abs() + slope_v.abs();
        let height = from_centre.dot(towards) + (steepness + Vec4::splat(self.view.texel)) * BIAS;
        let places = Lanes3 { x: across(u), y: across(v), z: height };
        let slopes = Lanes3 { x: slope_u, y: slope_v, z: steepness };
        let mut lit = [0.0; 4];
        for (lane, lit) in lit.iter_mut().enumerate().filter(|(lane, _)| facing[*lane] > 0.0) {
            *lit = self.look_up(places.lane(lane), slopes.lane(lane));
        }
        Vec4::from_array(lit)
    }

    /// `place` holds texels and height, `slope` the height's changes per texel and the sum of their sizes.
    fn look_up(&self, place: Vec3, slope: Vec3) -> f32 {
        let first = place.truncate() - Vec2::splat(0.5 + (REACH / 2 - 1) as f32);
        if !(first.min_element() >= 0.0 && first.max_element() < (SIZE - READ) as f32) {
            return 1.0;
        }
        let (column, row) = (first.x as usize, first.y as usize);
        let [low, high] = self.extremes(column, row);
        let reach = slope.z * (REACH as f32 / 2.0);
        if high <= place.z - reach {
            return 1.0;
        }
        if low > place.z + reach {
            return 0.0;
        }
        self.filtered(column, row, place.truncate(), place.z, slope.truncate())
    }

    /// Lowest and highest texel of the blocks the filter may touch.
    fn extremes(&self, column: usize, row: usize) -> [f32; 2] {
        let (left, right) = (column / BLOCK, (column + REACH - 1) / BLOCK);
        let (top, bottom) = (row / BLOCK, (row + REACH - 1) / BLOCK);
        [[top, left], [top, right], [bottom, left], [bottom, right]]
            .map(|[row, column]| self.blocks[row * BLOCKS + column])
            .into_iter()
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [l, h]| [low.min(l), high.max(h)])
    }

    fn filtered(&self, column: usize, row: usize, place: Vec2, height: f32, slope: Vec2) -> f32 {
        let centre = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) - place;
        let (across, down) = (weights(-centre.x), weights(-centre.y));
        let [left, right] = [0, 4].map(|start| Vec4::from_slice(&across[start..]));
        let steps = Vec4::new(0.0, 1.0, 2.0, 3.0) * slope.x;
        let mut lit = Vec4::ZERO;
        for (j, weight) in down.iter().enumerate().take(REACH) {
            let texels = &self.height[(row + j) * SIZE + column..][..READ];
            let start = height + slope.y * (centre.y + j as f32) + slope.x * centre.x;
            let surface = Vec4::splat(start) + steps;
            let clear = Vec4::from_slice(texels).cmple(surface);
            let clear_right = Vec4::from_slice(&texels[4..]).cmple(surface + Vec4::splat(4.0 * slope.x));
            let sum = Vec4::select(clear, left, Vec4::ZERO) + Vec4::select(clear_right, right, Vec4::ZERO);
            lit += sum * *weight;
        }
        (lit.x + lit.y) + (lit.z + lit.w)
    }
}

/// What five bilinear taps add up to on six texels (two more stay zero), when the surface lies `offset` (2 to 3) texels beyond the first one's centre.
fn weights(offset: f32) -> [f32; READ] {
    let part = offset - (REACH / 2 - 1) as f32;
    let mut weights = [0.0; READ];
    for (tap, weight) in TAPS.iter().enumerate() {
        weights[tap] += weight * (1.0 - part);
        weights[tap + 1] += weight * part;
    }
    weights
}

/// First and past-the-last row of texels that a triangle may touch.
fn rows([a, b, c]: &[Vec3; 3]) -> [usize; 2] {
    let clamp = |place: f32| place.clamp(0.0, SIZE as f32) as usize;
    let (low, high) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    if high < 0.0 { [0, 0] } else { [clamp(low), (clamp(high) + 1).min(SIZE)] }
}

/// Raises the texels of one band under a triangle to its height.
fn raise(texels: &mut [f32], first_row: usize, corners: &[Vec3; 3]) {
    let [a, b, c] = *corners;
    let (ab, ac) = (b - a, c - a);
    let area = ab.x * ac.y - ac.x * ab.y;
    if area == 0.0 {
        return;
    }
    let per_area = 1.0 / area;
    let [start, end] = rows(corners);
    let column = |place: f32| place.clamp(0.0, SIZE as f32) as usize;
    let columns = column(a.x.min(b.x).min(c.x))..(column(a.x.max(b.x).max(c.x)) + 1).min(SIZE);
    for row in start.max(first_row)..end.min(first_row + BLOCK) {
        let line = &mut texels[(row - first_row) * SIZE..][..SIZE];
        let y = row as f32 + 0.5 - a.y;
        for (x, texel) in columns.clone().zip(&mut line[columns.clone()]) {
            let x = x as f32 + 0.5 - a.x;
            let second = (x * ac.y - y * ac.x) * per_area;
            let third = (y * ab.x - x * ab.y) * per_area;
            let height = a.z + second * ab.z + third * ac.z;
            if second >= 0.0 && third >= 0.0 && second + third <= 1.0 && height > *texel {
                *texel = height;
            }
        }
    }
}
