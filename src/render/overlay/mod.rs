//! Flat vector graphics and text, drawn by `vello_cpu` straight over a finished picture: the same for every back end.
//!
//! Only tiles in which something is drawn are touched. Pixel centres lie at half coordinates: a vertical line one pixel wide is crisp at x = n + 0.5,
//! a box at whole coordinates.

mod text;

pub use text::text_width;

use super::RenderError;
use super::alpha::{premultiply, straighten};
use super::draw_list::{Colour, DrawList, OverlayItem, Rectangle, Stroke};
use glam::Vec2;
use image::RgbaImage;
use std::sync::Arc;
use text::Fonts;
use vello_cpu::color::AlphaColor;
use vello_cpu::kurbo::{Affine, BezPath, Cap, Circle, Join, Point, Rect, RoundedRect, Shape, Stroke as Pen};
use vello_cpu::peniko::{ImageQuality, ImageSampler};
use vello_cpu::{
    Image, ImageSource, Level, Pixmap, PixmapMut, RasterizerSettings, RenderContext, RenderSettings, Resources,
    TargetInit,
};

/// Largest error of a curve's polygon, in pixels.
const FLATNESS: f64 = 0.05;
/// No coordinate of a picture is near this; beyond it fixed-point rasterisers overflow.
const LARGEST: f32 = 1e5;

/// Draws overlays; keeps its buffers and glyphs from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Overlay {
    canvas: Option<RenderContext>,
    resources: Resources,
    fonts: Fonts,
}

impl Overlay {
    /// Blends the items over a picture, which is opaque or has straight alpha.
    pub fn blend(&mut self, list: &DrawList, image: &mut RgbaImage) -> Result<(), RenderError> {
        if !list.background.is_transparent() {
            self.blend_over(&list.overlay, image)?;
            // Blending rounds the opacity of an opaque ground down, by up to 7 of 255 under several soft edges.
            image.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
            return Ok(());
        }
        premultiply(image);
        let blended = self.blend_over(&list.overlay, image);
        straighten(image);
        blended
    }

    /// All over a picture whose colours are multiplied by their alpha.
    fn blend_over(&mut self, items: &[OverlayItem], image: &mut RgbaImage) -> Result<(), RenderError> {
        if items.is_empty() {
            return Ok(());
        }
        let (width, height) = image.dimensions();
        let refuse = || RenderError::Size { width, height, limit: u32::from(u16::MAX) };
        let (columns, rows) =
            (u16::try_from(width).map_err(|_| refuse())?, u16::try_from(height).map_err(|_| refuse())?);
        let mut canvas = self.canvas.take().unwrap_or_else(|| new_canvas(columns, rows));
        canvas.reset_and_resize(columns, rows);
        for (index, item) in items.iter().enumerate() {
            let refuse = |problem: String| RenderError::Overlay { item: index, problem };
            check(item).map_err(refuse)?;
            self.draw(&mut canvas, item).map_err(refuse)?;
        }
        canvas.flush();
        let target = PixmapMut::new(columns, rows, image).ok_or_else(refuse)?;
        let over = RasterizerSettings { target_init: TargetInit::SrcOver, ..RasterizerSettings::default() };
        canvas.render_with(target, &mut self.resources, over);
        self.canvas = Some(canvas);
        Ok(())
    }

    fn draw(&mut self, canvas: &mut RenderContext, item: &OverlayItem) -> Result<(), String> {
        match item {
            OverlayItem::Box { area, corner_radius, fill, stroke } => {
                let corner = f64::from(corner_radius.max(0.0));
                shape(canvas, RoundedRect::from_rect(rectangle(area), corner), *fill, *stroke);
            }
            OverlayItem::Disc { centre, radius, fill, stroke } => {
                shape(canvas, Circle::new(point(*centre), f64::from(radius.max(0.0))), *fill, *stroke);
            }
            OverlayItem::Line { points, stroke, clip } => {
                clipped(canvas, clip, |canvas| draw_stroke(canvas, &path(points), *stroke));
            }
            OverlayItem::Polygon { points, fill, clip } => clipped(canvas, clip, |canvas| {
                let mut outline = path(points);
                outline.close_path();
                set_colour(canvas, *fill);
                canvas.fill_path(&outline);
            }),
            OverlayItem::Raster { area, columns, cells } => raster(canvas, area, *columns, cells)?,
            OverlayItem::Text { position, anchor, size, colour, bold, text } => {
                set_colour(canvas, *colour);
                let line = self.fonts.face(*bold).lay_out(text, *size, *anchor, *position);
                canvas
                    .glyph_run(&mut self.resources, self.fonts.face(*bold).data())
                    .font_size(*size)
                    .fill_glyphs(line.into_iter())
                    .map_err(|error| error.to_string())?;
            }
        }
        Ok(())
    }
}

/// The instruction set that every machine of a kind has: a wider one rounds differently.
fn new_canvas(width: u16, height: u16) -> RenderContext {
    RenderContext::new_with(width, height, RenderSettings { level: Level::baseline(), num_threads: 0 })
}

/// Why an item cannot be drawn.
fn check(item: &OverlayItem) -> Result<(), String> {
    let fits = |values: &[f32]| values.iter().all(|value| value.abs() <= LARGEST);
    let places = |points: &[Vec2]| points.iter().all(|p| fits(&p.to_array()));
    let window = |clip: &Option<Rectangle>| clip.is_none_or(|r| places(&[r.min, r.max]));
    let pen = |stroke: &Option<Stroke>| stroke.is_none_or(|s| fits(&[s.width]));
    let drawable = match item {
        OverlayItem::Box { area, corner_radius, stroke, .. } => {
            places(&[area.min, area.max]) && fits(&[*corner_radius]) && pen(stroke)
        }
        OverlayItem::Line { points, stroke, clip } => places(points) && fits(&[stroke.width]) && window(clip),
        OverlayItem::Polygon { points, clip, .. } => places(points) && window(clip),
        OverlayItem::Disc { centre, radius, stroke, .. } => places(&[*centre]) && fits(&[*radius]) && pen(stroke),
        OverlayItem::Raster { area, .. } => places(&[area.min, area.max]),
        OverlayItem::Text { position, size, .. } => places(&[*position]) && fits(&[*size]) && *size > 0.0,
    };
    if drawable {
        Ok(())
    } else {
        Err("its coordinates and sizes must be numbers below 100000 pixels, a font size above 0".into())
    }
}

fn point(place: Vec2) -> Point {
    Point::new(f64::from(place.x), f64::from(place.y))
}

fn rectangle(area: &Rectangle) -> Rect {
    Rect::from_points(point(area.min), point(area.max))
}

fn path(points: &[Vec2]) -> BezPath {
    let mut path = BezPath::new();
    for (index, place) in points.iter().enumerate() {
        if index == 0 { path.move_to(point(*place)) } else { path.line_to(point(*place)) }
    }
    path
}

fn set_colour(canvas: &mut RenderContext, colour: Colour) {
    let [r, g, b, a] = colour.0;
    canvas.set_paint(AlphaColor::from_rgba8(r, g, b, a));
}

fn shape(canvas: &mut RenderContext, shape: impl Shape, fill: Colour, stroke: Option<Stroke>) {
    let outline = shape.to_path(FLATNESS);
    if fill.0[3] > 0 {
        set_colour(canvas, fill);
        canvas.fill_path(&outline);
    }
    if let Some(stroke) = stroke {
        draw_stroke(canvas, &outline, stroke);
    }
}

fn draw_stroke(canvas: &mut RenderContext, outline: &BezPath, stroke: Stroke) {
    if stroke.width > 0.0 {
        set_colour(canvas, stroke.colour);
        canvas.set_stroke(Pen::new(f64::from(stroke.width)).with_join(Join::Round).with_caps(Cap::Round));
        canvas.stroke_path(outline);
    }
}

/// The cells as an image, stretched without smoothing.
fn raster(canvas: &mut RenderContext, area: &Rectangle, columns: usize, cells: &[Colour]) -> Result<(), String> {
    let side = |count: usize| u16::try_from(count).ok().filter(|count| *count > 0);
    let rows = cells.len().checked_div(columns).filter(|rows| rows * columns == cells.len());
    let sides = side(columns).zip(rows.and_then(side));
    let (width, height) = sides.ok_or("a raster needs 1 to 65535 whole rows and columns")?;
    let mut image = Pixmap::new(width, height);
    for (pixel, cell) in image.data_as_u8_slice_mut().as_chunks_mut::<4>().0.iter_mut().zip(cells) {
        let [r, g, b, _] = cell.0;
        *pixel = [r, g, b, u8::MAX];
    }
    let (from, size) = (point(area.min), area.max - area.min);
    let scale = [size.x / f32::from(width), size.y / f32::from(height)].map(f64::from);
    canvas.set_paint(Image {
        image: ImageSource::Pixmap(Arc::new(image)),
        sampler: ImageSampler { quality: ImageQuality::Low, ..ImageSampler::default() },
    });
    canvas.set_paint_transform(Affine::translate(from.to_vec2()) * Affine::scale_non_uniform(scale[0], scale[1]));
    canvas.fill_rect(&rectangle(area));
    canvas.reset_paint_transform();
    Ok(())
}

fn clipped(canvas: &mut RenderContext, clip: &Option<Rectangle>, draw: impl FnOnce(&mut RenderContext)) {
    if let Some(area) = clip {
        canvas.push_clip_rect(&rectangle(area));
    }
    draw(canvas);
    if clip.is_some() {
        canvas.pop_clip();
    }
}
