//! Which graphics adapter, and why not the others.

use crate::render::{RenderError, RendererChoice};
use wgpu::{Adapter, Backend, Backends, DeviceType, Instance, InstanceDescriptor};

/// An adapter that may be tried, and what speaks for it.
#[derive(Debug)]
pub(super) struct Candidate {
    pub adapter: Adapter,
    pub reason: String,
}

/// Adapters that fit the choice, the best first.
///
/// # Errors
/// If none fits: names those that were found and why they were refused.
pub(super) fn candidates(choice: RendererChoice) -> Result<Vec<Candidate>, RenderError> {
    let backends = match choice {
        RendererChoice::Vulkan | RendererChoice::SoftwareVulkan => Backends::VULKAN,
        RendererChoice::Gl | RendererChoice::SoftwareGl => Backends::GL,
        _ => Backends::VULKAN | Backends::METAL | Backends::DX12 | Backends::GL,
    };
    let descriptor = InstanceDescriptor { backends, ..InstanceDescriptor::new_without_display_handle() };
    let found = pollster::block_on(Instance::new(descriptor).enumerate_adapters(backends));
    let (mut fitting, refused): (Vec<_>, Vec<_>) =
        found.into_iter().partition(|adapter| is_software(adapter) == choice.is_software());
    let refusals: Vec<String> = refused.iter().map(refusal).collect();
    if fitting.is_empty() {
        let reason = if refusals.is_empty() { "none is installed".into() } else { refusals.join("; ") };
        return Err(RenderError::NoAdapter { wanted: wanted(choice).into(), reason });
    }
    fitting.sort_by_key(rank);
    let passed_over = if refusals.is_empty() { String::new() } else { format!("; {}", refusals.join("; ")) };
    let reason = format!("best {} adapter{passed_over}", wanted(choice));
    Ok(fitting.into_iter().map(|adapter| Candidate { adapter, reason: reason.clone() }).collect())
}

/// A choice in words.
pub(super) fn wanted(choice: RendererChoice) -> &'static str {
    match choice {
        RendererChoice::Vulkan => "hardware Vulkan",
        RendererChoice::Gl => "hardware OpenGL",
        RendererChoice::Software => "software graphics",
        RendererChoice::SoftwareVulkan => "software Vulkan",
        RendererChoice::SoftwareGl => "software OpenGL",
        RendererChoice::Auto | RendererChoice::Gpu | RendererChoice::Cpu => "hardware graphics",
    }
}

/// OpenGL does not tell what kind of device draws, so the known programs are recognised by name.
fn is_software(adapter: &Adapter) -> bool {
    const NAMES: [&str; 6] = ["llvmpipe", "lavapipe", "softpipe", "swrast", "swiftshader", "basic render"];
    let info = adapter.get_info();
    let name = info.name.to_lowercase();
    info.device_type == DeviceType::Cpu || NAMES.iter().any(|known| name.contains(known))
}

fn refusal(adapter: &Adapter) -> String {
    let info = adapter.get_info();
    let kind = if is_software(adapter) { "draws in software" } else { "is no software adapter" };
    format!("refused {} through {}: it {kind}", info.name, backend_name(info.backend))
}

/// Vulkan and its peers before OpenGL, own memory before shared.
fn rank(adapter: &Adapter) -> (bool, u8) {
    let info = adapter.get_info();
    let kind = match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    (info.backend == Backend::Gl, kind)
}

pub(super) fn backend_name(backend: Backend) -> &'static str {
    match backend {
        Backend::Vulkan => "vulkan",
        Backend::Gl => "gl",
        Backend::Metal => "metal",
        Backend::Dx12 => "dx12",
        Backend::BrowserWebGpu => "webgpu",
        Backend::Noop => "noop",
    }
}
