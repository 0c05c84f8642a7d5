//! A figure as SVG or PNG.

use super::canvas::{Canvas, FONT, Medium};
use super::draw::draw;
use super::error::ReportError;
use super::figure::Figure;
use super::slim::slim;
use crate::store::write_atomically;
use plotters::prelude::{BitMapBackend, SVGBackend};
use plotters::style::{FontStyle, register_font};
use std::path::Path;

/// Units of the view box in a CSS pixel: curves are smooth to a tenth of a pixel.
const VECTOR_SCALE: u32 = 10;
/// Pixels of a PNG in a CSS pixel.
const DENSITY: u32 = 2;
/// Samples of a PNG's pixel, in each direction.
const SAMPLES: u32 = 3;

impl Figure {
    /// Writes the picture atomically, as SVG or PNG by the extension of `path`.
    ///
    /// # Errors
    /// [`ReportError::UnknownFormat`], [`ReportError::Store`] if the file cannot be written, and as [`Self::svg`].
    pub fn write(&self, path: &Path) -> Result<(), ReportError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let bytes = match extension.as_deref() {
            Some("svg") => self.svg()?.into_bytes(),
            Some("png") => self.png()?,
            _ => return Err(ReportError::UnknownFormat { path: path.to_owned() }),
        };
        Ok(write_atomically(path, |writer| writer.write_all(&bytes))?)
    }

    /// The picture as SVG text.
    ///
    /// # Errors
    /// [`ReportError::Empty`] for an axis without range and data, [`ReportError::BadRange`], and [`ReportError::Drawing`].
    pub fn svg(&self) -> Result<String, ReportError> {
        self.prepare()?;
        let [width, height] = self.side(VECTOR_SCALE);
        let mut text = String::new();
        let mut backend = SVGBackend::with_string(&mut text, (width, height));
        draw(self, &mut Canvas { backend: &mut backend, scale: f64::from(VECTOR_SCALE), medium: Medium::Vector })?;
        drop(backend);
        // The view box keeps the fine units, the picture has its size in CSS pixels.
        let fine = format!("width=\"{width}\" height=\"{height}\" viewBox");
        let shown = format!("width=\"{}\" height=\"{}\" viewBox", self.size.0, self.size.1);
        Ok(slim(&text.replacen(&fine, &shown, 1)))
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// As [`Self::svg`].
    pub fn png(&self) -> Result<Vec<u8>, ReportError> {
        self.prepare()?;
        let [wide, tall] = self.side(DENSITY * SAMPLES);
        let mut pixels = vec![0; wide as usize * tall as usize * 3];
        let mut backend = BitMapBackend::with_buffer(&mut pixels, (wide, tall));
        let scale = f64::from(DENSITY * SAMPLES);
        draw(self, &mut Canvas { backend: &mut backend, scale, medium: Medium::Bitmap })?;
        drop(backend);
        let [width, height] = self.side(DENSITY);
        let pixels = averaged(&pixels, width as usize, height as usize);
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&pixels))
            .map_err(|error| self.failed(error))?;
        Ok(file)
    }

    /// What errors call the figure.
    pub(super) fn name(&self) -> String {
        let titles = std::iter::once(&self.title).chain(self.panels.iter().map(|panel| &panel.title));
        titles.into_iter().find(|title| !title.is_empty()).cloned().unwrap_or_default()
    }

    fn side(&self, scale: u32) -> [u32; 2] {
        [self.size.0 * scale, self.size.1 * scale]
    }

    fn prepare(&self) -> Result<(), ReportError> {
        /// Larger pictures are a mistake, and would take gigabytes to draw.
        const LARGEST: u32 = 4000;
        if self.size.0.min(self.size.1) == 0 || self.size.0.max(self.size.1) > LARGEST {
            let (width, height) = self.size;
            return Err(self.failed(format!("{width} x {height} pixels: sides from 1 to {LARGEST} are allowed")));
        }
        for (style, file) in [(FontStyle::Normal, dejavu::sans::regular()), (FontStyle::Bold, dejavu::sans::bold())] {
            register_font(FONT, style, file).map_err(|_| self.failed("the built-in font is damaged"))?;
        }
        Ok(())
    }

    fn failed(&self, reason: impl std::fmt::Display) -> ReportError {
        ReportError::Drawing { title: self.name(), reason: reason.to_string() }
    }
}

/// Means of squares of samples.
fn averaged(samples: &[u8], width: usize, height: usize) -> Vec<u8> {
    let side = SAMPLES as usize;
    let row = width * side * 3;
    let mut pixels = Vec::with_capacity(width * height * 3);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let mut sum = 0;
                for line in 0..side {
                    let first = (y * side + line) * row + x * side * 3 + channel;
                    sum += (0..side).map(|n| u32::from(samples[first + 3 * n])).sum::<u32>();
                }
                pixels.push((sum / (SAMPLES * SAMPLES)) as u8);
            }
        }
    }
    pixels
}
