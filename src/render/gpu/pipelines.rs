//! The three pipelines, shadow, backdrop and scene, and the layouts they share.

use crate::render::look::{BIAS, FADE, HORIZON, PANEL, PLAIN_MIRROR, SKY_IN_SHADOW, STEEPEST, TAPS};
use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BufferBindingType, CompareFunction,
    DepthStencilState, Device, Face, FragmentState, MultisampleState, PipelineCompilationOptions,
    PipelineLayoutDescriptor, PrimitiveState, RenderPipeline, RenderPipelineDescriptor, SamplerBindingType,
    ShaderModule, ShaderModuleDescriptor, ShaderSource, ShaderStages, TextureFormat, TextureSampleType,
    TextureViewDimension, VertexBufferLayout, VertexState, VertexStepMode, vertex_attr_array,
};

pub(super) const COLOUR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
pub(super) const SAMPLES: u32 = 4;
/// Position, normal, colour and finish, three numbers each.
pub(super) const VERTEX_FLOATS: usize = 12;

#[derive(Debug)]
pub(super) struct Pipelines {
    pub shadow_layout: BindGroupLayout,
    pub scene_layout: BindGroupLayout,
    pub shadow: RenderPipeline,
    pub backdrop: RenderPipeline,
    pub scene: RenderPipeline,
}

impl Pipelines {
    pub fn new(device: &Device) -> Self {
        let shader = |label, source: &'static str| {
            device.create_shader_module(ShaderModuleDescriptor {
                label: Some(label),
                source: ShaderSource::Wgsl(source.into()),
            })
        };
        let shadow_shader = shader("shadow", include_str!("shadow.wgsl"));
        let scene_shader = shader("scene", include_str!("scene.wgsl"));
        let shadow_layout = layout(device, "shadow", &[uniform(ShaderStages::VERTEX)]);
        let scene_layout =
            layout(device, "scene", &[uniform(ShaderStages::VERTEX_FRAGMENT), shadow_texture(), shadow_sampler()]);
        let shadow = Stages { shader: &shadow_shader, vertex: "shadow_vertex", fragment: None };
        let backdrop = Stages { shader: &scene_shader, vertex: "backdrop_vertex", fragment: Some("backdrop_fragment") };
        let scene = Stages { shader: &scene_shader, vertex: "scene_vertex", fragment: Some("scene_fragment") };
        Self {
            shadow: shadow.pipeline(device, &shadow_layout),
            backdrop: backdrop.pipeline(device, &scene_layout),
            scene: scene.pipeline(device, &scene_layout),
            shadow_layout,
            scene_layout,
        }
    }
}

/// What tells the three pipelines apart.
struct Stages<'a> {
    shader: &'a ShaderModule,
    vertex: &'static str,
    fragment: Option<&'static str>,
}

impl Stages<'_> {
    fn pipeline(&self, device: &Device, group: &BindGroupLayout) -> RenderPipeline {
        let label = Some(self.vertex);
        let groups = [Some(group)];
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x3];
        let is_backdrop = self.fragment == Some("backdrop_fragment");
        let used = if self.fragment.is_some() { &attributes[..] } else { &attributes[..1] };
        let array_stride = (VERTEX_FLOATS * size_of::<f32>()) as u64;
        let vertices = [Some(VertexBufferLayout { array_stride, step_mode: VertexStepMode::Vertex, attributes: used })];
        let constants = look();
        let options = || PipelineCompilationOptions {
            constants: if self.fragment.is_some() { &constants } else { &[] },
            ..PipelineCompilationOptions::default()
        };
        let targets = [Some(COLOUR.into())];
        device.create_render_pipeline(&RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: VertexState {
                module: self.shader,
                entry_point: Some(self.vertex),
                compilation_options: options(),
                buffers: if is_backdrop { &[] } else { &vertices },
            },
            // The shadow map takes the side nearest to the light by itself.
            primitive: PrimitiveState {
                cull_mode: self.fragment.filter(|_| !is_backdrop).map(|_| Face::Back),
                ..PrimitiveState::default()
            },
            depth_stencil: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(!is_backdrop),
                depth_compare: Some(if is_backdrop { CompareFunction::Always } else { CompareFunction::Greater }),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: MultisampleState {
                count: if self.fragment.is_some() { SAMPLES } else { 1 },
                ..Default::default()
            },
            fragment: self.fragment.map(|entry| FragmentState {
                module: self.shader,
                entry_point: Some(entry),
                compilation_options: options(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The shader's overridable constants.
fn look() -> Vec<(&'static str, f64)> {
    [
        ("FADE_START", FADE[0]),
        ("FADE_END", FADE[1]),
        ("SKY_IN_SHADOW", SKY_IN_SHADOW),
        ("PLAIN_MIRROR", PLAIN_MIRROR),
        ("HORIZON", HORIZON),
        ("PANEL_LOW", PANEL.low),
        ("PANEL_HIGH", PANEL.high),
        ("PANEL_BLUR", PANEL.blur),
        ("PANEL_STRENGTH", PANEL.strength),
        ("BIAS", BIAS),
        ("STEEPEST", STEEPEST),
        ("TAP_0", TAPS[2]),
        ("TAP_1", TAPS[1]),
        ("TAP_2", TAPS[0]),
    ]
    .into_iter()
    .map(|(name, value)| (name, f64::from(value)))
    .collect()
}

fn layout(device: &Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries })
}

fn uniform(visibility: ShaderStages) -> BindGroupLayoutEntry {
    let ty = BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
    BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }
}

fn shadow_texture() -> BindGroupLayoutEntry {
    let ty = BindingType::Texture {
        sample_type: TextureSampleType::Depth,
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    BindGroupLayoutEntry { binding: 1, visibility: ShaderStages::FRAGMENT, ty, count: None }
}

fn shadow_sampler() -> BindGroupLayoutEntry {
    let ty = BindingType::Sampler(SamplerBindingType::Comparison);
    BindGroupLayoutEntry { binding: 2, visibility: ShaderStages::FRAGMENT, ty, count: None }
}
