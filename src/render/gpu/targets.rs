//! Textures and buffers that depend on the picture's size, and reading the picture back.

use super::pipelines::{COLOUR, DEPTH, SAMPLES};
use crate::render::RenderError;
use image::RgbaImage;
use std::sync::mpsc;
use std::time::Duration;
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device, Extent3d, MapMode, PollType, SubmissionIndex,
    TexelCopyBufferInfo, TexelCopyBufferLayout, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages, TextureView, TextureViewDescriptor,
};

/// A device that has not drawn a picture by then hangs: software Vulkan needs 0.2 s for a large one.
pub(super) const PATIENCE: Duration = Duration::from_secs(30);

#[derive(Debug)]
pub(super) struct Targets {
    pub size: [u32; 2],
    pub samples: TextureView,
    pub depth: TextureView,
    pub resolved: TextureView,
    picture: Texture,
    staging: Buffer,
    row_bytes: u32,
}

/// A two-dimensional texture with one level.
pub(super) fn texture(
    device: &Device,
    size: [u32; 2],
    sample_count: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: None,
        size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

pub(super) fn view(texture: &Texture) -> TextureView {
    texture.create_view(&TextureViewDescriptor::default())
}

impl Targets {
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let picture = texture(device, size, 1, COLOUR, attachment | TextureUsages::COPY_SRC);
        // Copies want rows of whole multiples of 256 bytes.
        let row_bytes = (4 * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = device.create_buffer(&BufferDescriptor {
            label: Some("staging"),
            size: u64::from(row_bytes) * u64::from(size[1]),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Self {
            size,
            samples: view(&texture(device, size, SAMPLES, COLOUR, attachment)),
            depth: view(&texture(device, size, SAMPLES, DEPTH, attachment)),
            resolved: view(&picture),
            picture,
            staging,
            row_bytes,
        }
    }

    /// Records the copy from the picture to the staging buffer.
    pub fn copy(&self, encoder: &mut CommandEncoder) {
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.row_bytes), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.picture.as_image_copy(),
            TexelCopyBufferInfo { buffer: &self.staging, layout },
            self.picture.size(),
        );
    }

    /// Waits for the drawing and fetches the picture, without the padding of its rows.
    pub fn read(&self, device: &Device, drawn: SubmissionIndex) -> Result<RgbaImage, RenderError> {
        let fail = |reason: String| RenderError::Device { doing: "reading the picture back", reason };
        let (sender, receiver) = mpsc::channel();
        self.staging.map_async(MapMode::Read, .., move |outcome| {
            // The receiver is gone only after a timeout, which has been reported.
            let _ = sender.send(outcome);
        });
        let wait = PollType::Wait { submission_index: Some(drawn), timeout: Some(PATIENCE) };
        device.poll(wait).map_err(|error| fail(error.to_string()))?;
        let mapped = receiver.recv_timeout(PATIENCE).map_err(|error| fail(error.to_string()))?;
        mapped.map_err(|error| fail(error.to_string()))?;
        let [width, height] = self.size;
        let mut image = RgbaImage::new(width, height);
        {
            let bytes = self.staging.get_mapped_range(..).map_err(|error| fail(error.to_string()))?;
            let rows = image.chunks_exact_mut(4 * width as usize);
            for (row, padded) in rows.zip(bytes.chunks_exact(self.row_bytes as usize)) {
                row.copy_from_slice(&padded[..row.len()]);
            }
        }
        self.staging.unmap();
        Ok(image)
    }
}
