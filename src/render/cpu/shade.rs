//! Light of a point of a surface: sun with GGX highlight and shadow, hemisphere, tone mapping. The same as `gpu/scene.wgsl`.

use super::shadow::ShadowMap;
use crate::render::draw_list::DrawList;
use crate::render::geometry::{Surface, linear};
use glam::Vec3;

/// Surfaces begin and end to fade into the backdrop at these multiples of the shadow radius.
pub(crate) const FADE: [f32; 2] = [1.0, 2.6];
/// Part of the sky's light that a point in full shadow still gets: what hides the sun hides some sky.
pub(crate) const SKY_IN_SHADOW: f32 = 0.72;

#[derive(Debug)]
pub(super) struct Lighting<'a> {
    eye: Vec3,
    towards: Vec3,
    sun: Vec3,
    sky: Vec3,
    ground: Vec3,
    centre: Vec3,
    radius: f32,
    shadow: &'a ShadowMap,
}

impl<'a> Lighting<'a> {
    pub fn new(list: &DrawList, shadow: &'a ShadowMap) -> Self {
        let light = &list.light;
        Self {
            eye: list.camera.eye,
            towards: light.direction.normalize_or(Vec3::Y),
            sun: linear(light.colour.0) * light.intensity,
            sky: linear(light.sky.0),
            ground: linear(light.ground.0),
            centre: light.shadow_centre,
            radius: light.shadow_radius,
            shadow,
        }
    }

    /// Tone mapped linear light, faded into the backdrop.
    pub fn shade(&self, position: Vec3, normal: Vec3, surface: &Surface, backdrop: Vec3) -> Vec3 {
        let fade = smoothstep(FADE, (position - self.centre).length() / self.radius);
        if fade >= 1.0 {
            return backdrop;
        }
        let normal = normal.normalize_or(Vec3::Y);
        let colour = tone_map(self.reflected(position, normal, surface) + surface.colour * surface.glow);
        colour + (backdrop - colour) * fade
    }

    fn reflected(&self, position: Vec3, normal: Vec3, surface: &Surface) -> Vec3 {
        let view = (self.eye - position).normalize_or(normal);
        let facing_eye = normal.dot(view).max(1e-3);
        let facing_sun = normal.dot(self.towards).max(0.0);
        let lit = if facing_sun > 0.0 { self.shadow.lit(position, normal) } else { 0.0 };
        let matt = surface.colour * (1.0 - surface.metallic);
        let mirror = Vec3::splat(0.04) + (surface.colour - Vec3::splat(0.04)) * surface.metallic;

        let sun = if lit > 0.0 {
            let highlight = self.highlight(normal, view, facing_eye, facing_sun, surface.roughness, mirror);
            self.sun * (matt + highlight) * (facing_sun * lit)
        } else {
            Vec3::ZERO
        };
        let diffuse = matt * self.hemisphere(normal.y * 0.5 + 0.5);
        let gloss = 1.0 - surface.roughness;
        let fresnel = mirror + (mirror.max(Vec3::splat(gloss)) - mirror) * fifth(1.0 - facing_eye);
        let bounced = normal * (2.0 * normal.dot(view)) - view;
        let ambient = diffuse + fresnel * self.surroundings(bounced.y, surface.roughness);
        sun + ambient * (SKY_IN_SHADOW + (1.0 - SKY_IN_SHADOW) * lit)
    }

    /// GGX distribution, Hammon's approximation of Smith's masking, Schlick's Fresnel; times pi, as the sun's intensity is what
    /// a white matt surface shows.
    fn highlight(
        &self,
        normal: Vec3,
        view: Vec3,
        facing_eye: f32,
        facing_sun: f32,
        roughness: f32,
        mirror: Vec3,
    ) -> Vec3 {
        let half = (view + self.towards).normalize_or(normal);
        let alpha = roughness * roughness;
        let across = normal.dot(half).max(0.0);
        let spread = across * across * (alpha * alpha - 1.0) + 1.0;
        let distribution = alpha * alpha / (spread * spread);
        let both = 2.0 * facing_eye * facing_sun;
        let visibility = 0.5 / (both + (facing_eye + facing_sun - both) * alpha);
        let fresnel = mirror + (Vec3::ONE - mirror) * fifth(1.0 - view.dot(half).max(0.0));
        fresnel * (distribution * visibility)
    }

    fn hemisphere(&self, up: f32) -> Vec3 {
        self.ground + (self.sky - self.ground) * up
    }

    /// What a mirror sees in a direction with the given height: ground, a horizon the softer the duller the mirror, sky, and in
    /// the sky a wide bright panel as photographers use it.
    fn surroundings(&self, up: f32, roughness: f32) -> Vec3 {
        let soft = 0.15 + 0.85 * roughness;
        let open = self.hemisphere(smoothstep([-soft, soft], up));
        let panel = smoothstep([0.45 - 0.4 * roughness, 0.75 + 0.4 * roughness], up);
        open + self.sky * (panel * 0.9)
    }
}

fn smoothstep([low, high]: [f32; 2], value: f32) -> f32 {
    let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

fn fifth(x: f32) -> f32 {
    let square = x * x;
    square * square * x
}

/// Khronos PBR neutral tone mapper (specification 1.0): leaves colours as they are up to 0.8, then rolls off without changing hue.
fn tone_map(colour: Vec3) -> Vec3 {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let least = colour.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let colour = colour - Vec3::splat(offset);
    let peak = colour.max_element();
    if peak < START {
        return colour;
    }
    let room = 1.0 - START;
    let rolled = 1.0 - room * room / (peak + room - START);
    let fade = 1.0 - 1.0 / (DESATURATION * (peak - rolled) + 1.0);
    let scaled = colour * (rolled / peak);
    scaled + (Vec3::splat(rolled) - scaled) * fade
}
