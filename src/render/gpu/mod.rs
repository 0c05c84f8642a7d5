//! The back end on a graphics adapter: the picture of the CPU rasteriser, drawn through Vulkan, OpenGL, Metal or Direct3D 12.
//!
//! One pass draws the shadow map, one the picture with four samples a pixel; it is read back, and the overlay is blended on the CPU.

mod adapter;
mod numbers;
mod pipelines;
mod targets;
mod trial;

use super::alpha::straighten_light;
use super::draw_list::DrawList;
use super::geometry::Geometry;
use super::overlay::Overlay;
use super::renderer::{AdapterInfo, DrawTimes, Renderer};
use super::view::{LightView, SHADOW_SIZE, camera_matrix, check_size};
use super::{RenderError, RendererChoice};
use adapter::{Candidate, backend_name, candidates, wanted};
use image::RgbaImage;
use numbers::{FRAME_BYTES, LIGHT_BYTES, frame_numbers, light_numbers, vertex_numbers};
use pipelines::{DEPTH, Pipelines};
use std::sync::{Arc, Mutex};
use std::time::Instant;
use targets::{Targets, texture, view};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferDescriptor, BufferUsages, Color,
    CommandEncoder, CompareFunction, Device, DeviceDescriptor, FilterMode, IndexFormat, LoadOp, Operations, Queue,
    RenderPassColorAttachment, RenderPassDepthStencilAttachment, RenderPassDescriptor, SamplerDescriptor, StoreOp,
    TextureUsages, TextureView,
};

/// Draws on a graphics adapter.
#[derive(Debug)]
pub(super) struct GpuRenderer {
    info: AdapterInfo,
    device: Device,
    queue: Queue,
    pipelines: Pipelines,
    shadow_map: TextureView,
    frame: Buffer,
    light: Buffer,
    shadow_group: BindGroup,
    scene_group: BindGroup,
    vertices: Buffer,
    indices: Buffer,
    targets: Option<Targets>,
    overlay: Overlay,
    /// What the driver complained about since it was last asked.
    complaint: Arc<Mutex<Option<String>>>,
}

impl GpuRenderer {
    /// The first adapter fitting the choice that opens.
    pub fn open(choice: RendererChoice) -> Result<Self, RenderError> {
        let mut failures = Vec::new();
        for candidate in candidates(choice)? {
            match Self::on(&candidate) {
                Ok(renderer) => return Ok(renderer),
                Err(error) => failures.push(format!("{}: {error}", candidate.adapter.get_info().name)),
            }
        }
        Err(RenderError::NoAdapter { wanted: wanted(choice).into(), reason: failures.join("; ") })
    }

    fn on(candidate: &Candidate) -> Result<Self, RenderError> {
        let fail = |reason| RenderError::Device { doing: "opening the device", reason };
        let info = candidate.adapter.get_info();
        let limits = candidate.adapter.limits();
        let wish =
            DeviceDescriptor { label: Some("stickslip"), required_limits: limits, ..DeviceDescriptor::default() };
        let (device, queue) =
            pollster::block_on(candidate.adapter.request_device(&wish)).map_err(|error| fail(error.to_string()))?;
        let complaint = Arc::new(Mutex::new(None));
        let first = Arc::clone(&complaint);
        // Without a handler wgpu panics. The first complaint is the cause of the others.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut first) = first.lock() {
                first.get_or_insert_with(|| error.to_string());
            }
        }));
        let info = AdapterInfo {
            adapter: info.name,
            backend: backend_name(info.backend).into(),
            reason: candidate.reason.clone(),
        };
        let mut renderer = Self::with(info, device, queue, complaint);
        renderer.check("opening the device")?;
        trial::prove(&mut renderer)?;
        Ok(renderer)
    }

    fn with(info: AdapterInfo, device: Device, queue: Queue, complaint: Arc<Mutex<Option<String>>>) -> Self {
        let pipelines = Pipelines::new(&device);
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let shadow_map = view(&texture(&device, [SHADOW_SIZE; 2], 1, DEPTH, usage));
        let sampler = device.create_sampler(&SamplerDescriptor {
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            // Lit where the surface is not below the nearest caster.
            compare: Some(CompareFunction::GreaterEqual),
            ..SamplerDescriptor::default()
        });
        let frame = buffer(&device, "frame", FRAME_BYTES, BufferUsages::UNIFORM);
        let light = buffer(&device, "light", LIGHT_BYTES, BufferUsages::UNIFORM);
        let entry = |binding, resource| BindGroupEntry { binding, resource };
        let shadow_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("shadow"),
            layout: &pipelines.shadow_layout,
            entries: &[entry(0, light.as_entire_binding())],
        });
        let scene_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("scene"),
            layout: &pipelines.scene_layout,
            entries: &[
                entry(0, frame.as_entire_binding()),
                entry(1, BindingResource::TextureView(&shadow_map)),
                entry(2, BindingResource::Sampler(&sampler)),
            ],
        });
        Self {
            vertices: buffer(&device, "vertices", 1 << 20, BufferUsages::VERTEX),
            indices: buffer(&device, "indices", 1 << 18, BufferUsages::INDEX),
            info,
            pipelines,
            shadow_map,
            frame,
            light,
            shadow_group,
            scene_group,
            targets: None,
            overlay: Overlay::default(),
            complaint,
            device,
            queue,
        }
    }

    /// Reports what the driver complained about.
    fn check(&self, doing: &'static str) -> Result<(), RenderError> {
        let complaint = self.complaint.lock().ok().and_then(|mut complaint| complaint.take());
        complaint.map_or(Ok(()), |reason| Err(RenderError::Device { doing, reason }))
    }

    fn upload(&mut self, list: &DrawList, geometry: &Geometry) -> Result<(), RenderError> {
        let camera = camera_matrix(&list.camera, list.size)?;
        let view = LightView::new(&list.light)?;
        let numbers: Vec<f32> = geometry.vertices.iter().flat_map(|vertex| vertex_numbers(geometry, vertex)).collect();
        let light = light_numbers(&view);
        let frame = frame_numbers(list, &camera, &view);
        let indices = bytemuck::cast_slice(&geometry.triangles);
        let numbers = bytemuck::cast_slice(&numbers);
        fit(&self.device, &mut self.vertices, numbers.len(), BufferUsages::VERTEX);
        fit(&self.device, &mut self.indices, indices.len(), BufferUsages::INDEX);
        self.queue.write_buffer(&self.vertices, 0, numbers);
        self.queue.write_buffer(&self.indices, 0, indices);
        self.queue.write_buffer(&self.light, 0, bytemuck::cast_slice(&light));
        self.queue.write_buffer(&self.frame, 0, bytemuck::cast_slice(&frame));
        Ok(())
    }

    fn record_shadow(&self, encoder: &mut CommandEncoder, geometry: &Geometry) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(depth_attachment(&self.shadow_map, StoreOp::Store)),
            ..RenderPassDescriptor::default()
        });
        if geometry.casting > 0 {
            pass.set_pipeline(&self.pipelines.shadow);
            pass.set_bind_group(0, &self.shadow_group, &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..3 * geometry.casting as u32, 0, 0..1);
        }
    }

    fn record_scene(&self, encoder: &mut CommandEncoder, geometry: &Geometry, targets: &Targets, is_clear: bool) {
        let colour = RenderPassColorAttachment {
            view: &targets.samples,
            depth_slice: None,
            resolve_target: Some(&targets.resolved),
            ops: Operations { load: LoadOp::Clear(Color::TRANSPARENT), store: StoreOp::Discard },
        };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(colour)],
            depth_stencil_attachment: Some(depth_attachment(&targets.depth, StoreOp::Discard)),
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.scene_group, &[]);
        if !is_clear {
            pass.set_pipeline(&self.pipelines.backdrop);
            pass.draw(0..3, 0..1);
        }
        if !geometry.triangles.is_empty() {
            pass.set_pipeline(&self.pipelines.scene);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..3 * geometry.triangles.len() as u32, 0, 0..1);
        }
    }

    /// The scene, and when its drawing was handed to the device.
    fn draw_scene(&mut self, list: &DrawList) -> Result<(RgbaImage, Instant), RenderError> {
        let geometry = Geometry::gather(list)?;
        self.upload(list, &geometry)?;
        let targets = match self.targets.take().filter(|targets| targets.size == list.size) {
            Some(targets) => targets,
            None => Targets::new(&self.device, list.size),
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.record_shadow(&mut encoder, &geometry);
        self.record_scene(&mut encoder, &geometry, &targets, list.background.is_transparent());
        targets.copy(&mut encoder);
        let drawn = self.queue.submit([encoder.finish()]);
        let submitted = Instant::now();
        self.check("drawing")?;
        let mut image = targets.read(&self.device, drawn)?;
        self.check("reading the picture back")?;
        if list.background.is_transparent() {
            straighten_light(&mut image);
        }
        self.targets = Some(targets);
        Ok((image, submitted))
    }
}

impl Renderer for GpuRenderer {
    fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// `read_back` counts from the moment the device has its orders: it draws while the picture is waited for.
    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
        check_size(list, self.device.limits().max_texture_dimension_2d)?;
        let start = Instant::now();
        let (mut image, submitted) = self.draw_scene(list)?;
        let read = Instant::now();
        self.overlay.blend(list, &mut image)?;
        Ok((image, DrawTimes { draw: submitted - start, read_back: read - submitted, overlay: read.elapsed() }))
    }
}

fn buffer(device: &Device, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    let usage = usage | BufferUsages::COPY_DST;
    device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

/// Replaces a buffer that is too small by one of twice the need.
fn fit(device: &Device, buffer_: &mut Buffer, bytes: usize, usage: BufferUsages) {
    if buffer_.size() < bytes as u64 {
        *buffer_ = buffer(device, "geometry", 2 * bytes as u64, usage);
    }
}

/// Depth is greatest where nearest.
fn depth_attachment(view: &TextureView, store: StoreOp) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store }),
        stencil_ops: None,
    }
}
