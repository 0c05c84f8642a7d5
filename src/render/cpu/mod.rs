//! The built-in back end: runs anywhere, and gives the same bytes on every machine and any number of threads.
//!
//! A frame passes through four stages: the shadow map is drawn; triangles are projected and sorted into tiles; every tile finds the nearest triangle
//! at four samples a pixel; every pixel is lit once for each triangle it shows, tone mapped, averaged over its samples and encoded.

mod bins;
mod lanes;
mod shade;
mod shadow;
mod tile;
mod triangles;

use super::RenderError;
use super::draw_list::{Background, DrawList};
use super::geometry::Geometry;
use super::overlay::Overlay;
use super::portable::decode;
use super::renderer::{AdapterInfo, DrawTimes, Renderer};
use super::view::{LightView, camera_matrix, check_size};
use bins::{TILE_HEIGHT, TileBins};
use glam::Vec3;
use image::RgbaImage;
use rayon::prelude::*;
use shade::Lighting;
use shadow::ShadowMap;
use std::time::Instant;
use tile::{Frame, Tile};
use triangles::Projected;

/// Largest side of a picture.
const LIMIT: u32 = 16_384;

/// Draws on the CPU, on the threads of the current rayon pool.
#[derive(Debug)]
pub struct CpuRenderer {
    info: AdapterInfo,
    overlay: Overlay,
    shadow: ShadowMap,
    bins: TileBins,
}

impl CpuRenderer {
    /// `reason` tells why this back end was taken.
    #[must_use]
    pub fn new(reason: impl Into<String>) -> Self {
        let info = AdapterInfo { adapter: "built-in rasteriser".into(), backend: "cpu".into(), reason: reason.into() };
        Self { info, overlay: Overlay::default(), shadow: ShadowMap::default(), bins: TileBins::default() }
    }

    fn draw_scene(&mut self, list: &DrawList) -> Result<RgbaImage, RenderError> {
        let camera = camera_matrix(&list.camera, list.size)?;
        let light = LightView::new(&list.light)?;
        let geometry = Geometry::gather(list)?;
        self.shadow.draw(&geometry, light);
        let projected = Projected::new(&geometry, &camera, list.size);
        self.bins.sort(&projected.triangles, list.size);
        let lighting = Lighting::new(list, &self.shadow);
        let is_clear = list.background.is_transparent();
        let frame = Frame { projected: &projected, surfaces: &geometry.surfaces, lighting, is_clear };
        let backdrop = if is_clear {
            vec![BackdropRow::CLEAR; list.size[1] as usize]
        } else {
            backdrop(&list.background, list.size[1])
        };
        let mut image = RgbaImage::new(list.size[0], list.size[1]);
        let row_bytes = 4 * list.size[0] as usize;
        image.par_chunks_mut(TILE_HEIGHT * row_bytes).enumerate().for_each_init(Tile::default, |tile, (band, rows)| {
            let backdrop = &backdrop[band * TILE_HEIGHT..];
            for (column, members) in self.bins.band(band).enumerate() {
                tile.find_visible(&projected, members, [column, band]);
                tile.resolve(&frame, backdrop, rows, row_bytes);
            }
        });
        Ok(image)
    }
}

impl Renderer for CpuRenderer {
    fn info(&self) -> &AdapterInfo {
        &self.info
    }

    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
        check_size(list, LIMIT)?;
        let start = Instant::now();
        let mut image = self.draw_scene(list)?;
        let drawn = Instant::now();
        self.overlay.blend(list, &mut image)?;
        Ok((image, DrawTimes { draw: drawn - start, overlay: drawn.elapsed(), ..DrawTimes::default() }))
    }
}

/// One row of the backdrop: its sRGB bytes, and the light they stand for.
#[derive(Debug, Clone, Copy)]
struct BackdropRow {
    bytes: [u8; 4],
    light: Vec3,
}

impl BackdropRow {
    /// Of a transparent background.
    const CLEAR: Self = Self { bytes: [0; 4], light: Vec3::ZERO };
}

/// The gradient runs evenly in sRGB, which is even to the eye.
fn backdrop(background: &Background, height: u32) -> Vec<BackdropRow> {
    (0..height)
        .map(|row| {
            let part = (row as f32 + 0.5) / height as f32;
            let code = |channel: usize| {
                let [top, bottom] = [background.top, background.bottom].map(|c| f32::from(c.0[channel]));
                top + (bottom - top) * part
            };
            let light = |channel| {
                let (code, below) = (code(channel), code(channel) as u8);
                let (low, high) = (decode(below), decode(below.saturating_add(1)));
                low + (high - low) * (code - f32::from(below))
            };
            let byte = |channel| (code(channel) + 0.5) as u8;
            BackdropRow { bytes: [byte(0), byte(1), byte(2), 255], light: Vec3::new(light(0), light(1), light(2)) }
        })
        .collect()
}
