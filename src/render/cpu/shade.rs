//! Light of four points of surfaces: sun with GGX highlight and shadow, hemisphere, tone mapping. The same as `gpu/scene.wgsl`.

use super::lanes::{Lanes3, fifth_power, smoothstep, square_root};
use super::shadow::ShadowMap;
use crate::render::draw_list::DrawList;
use crate::render::geometry::linear;
use crate::render::look::{FADE, HORIZON, PANEL, PLAIN_MIRROR, SKY_IN_SHADOW};
use glam::{Vec3, Vec4};

/// Four points to be lit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Points {
    pub position: Lanes3,
    /// Any length.
    pub normal: Lanes3,
    pub colour: Lanes3,
    pub roughness: Vec4,
    pub metallic: Vec4,
    pub glow: Vec4,
}

#[derive(Debug)]
pub(super) struct Lighting<'a> {
    eye: Lanes3,
    towards: Lanes3,
    sun: Lanes3,
    sky: Lanes3,
    ground: Lanes3,
    centre: Lanes3,
    radius: f32,
    shadow: &'a ShadowMap,
}

/// Whether surfaces are lit with the shadows on them.
#[derive(Debug, Clone, Copy)]
enum Shadows {
    Cast,
    LeftOut,
}

/// How a point stands to eye and sun; all vectors are unit vectors.
struct Stand {
    normal: Lanes3,
    view: Lanes3,
    facing_eye: Vec4,
    facing_sun: Vec4,
}

impl<'a> Lighting<'a> {
    pub fn new(list: &DrawList, shadow: &'a ShadowMap) -> Self {
        let light = &list.light;
        Self {
            eye: Lanes3::splat(list.camera.eye),
            towards: Lanes3::splat(light.direction.normalize_or(Vec3::Y)),
            sun: Lanes3::splat(linear(light.colour.0) * light.intensity),
            sky: Lanes3::splat(linear(light.sky.0)),
            ground: Lanes3::splat(linear(light.ground.0)),
            centre: Lanes3::splat(light.shadow_centre),
            radius: light.shadow_radius,
            shadow,
        }
    }

    /// Tone mapped linear light, faded into the backdrop.
    pub fn shade(&self, points: &Points, backdrop: Lanes3) -> Lanes3 {
        let distance = (points.position - self.centre).length() / self.radius;
        let fade = smoothstep(Vec4::splat(FADE[0]), Vec4::splat(FADE[1]), distance);
        if fade == Vec4::ONE {
            return backdrop;
        }
        let colour = tone_map(self.reflected(points, Shadows::Cast) + points.colour * points.glow);
        colour.towards(backdrop, fade)
    }

    /// Tone mapped linear light times opacity, and opacity, of points with nothing behind them. A surface with a glow below 0 shows its
    /// shadow alone: black, so opaque that it darkens the surface's own colour without shadow to the one with it.
    pub fn shade_before_nothing(&self, points: &Points) -> (Lanes3, Vec4) {
        let distance = (points.position - self.centre).length() / self.radius;
        let near = Vec4::ONE - smoothstep(Vec4::splat(FADE[0]), Vec4::splat(FADE[1]), distance);
        let glow = points.glow.max(Vec4::ZERO);
        let colour = tone_map(self.reflected(points, Shadows::Cast) + points.colour * glow);
        let is_clear = points.glow.cmplt(Vec4::ZERO);
        if !is_clear.any() {
            return (colour * near, near);
        }
        let bright = tone_map(self.reflected(points, Shadows::LeftOut));
        let kept = brightness(colour) / brightness(bright).max(Vec4::splat(1e-3));
        let dark = (Vec4::ONE - kept).clamp(Vec4::ZERO, Vec4::ONE) * near;
        let light = colour * Vec4::select(is_clear, Vec4::ZERO, near);
        (light, Vec4::select(is_clear, dark, near))
    }

    fn reflected(&self, points: &Points, shadows: Shadows) -> Lanes3 {
        let normal = points.normal.normalize();
        let view = (self.eye - points.position).normalize();
        let stand = Stand {
            normal,
            view,
            facing_eye: normal.dot(view).max(Vec4::splat(1e-3)),
            facing_sun: normal.dot(self.towards).max(Vec4::ZERO),
        };
        let lit = match shadows {
            Shadows::Cast => self.shadow.lit(points.position, normal, stand.facing_sun),
            Shadows::LeftOut => Vec4::ONE,
        };
        let matt = points.colour * (Vec4::ONE - points.metallic);
        let mirror = Lanes3::grey(Vec4::splat(PLAIN_MIRROR)).towards(points.colour, points.metallic);
        let mut light = self.ambient(&stand, matt, mirror, points.roughness, lit);
        if lit != Vec4::ZERO {
            let highlight = self.highlight(&stand, points.roughness, mirror);
            light = light + self.sun * (matt + highlight) * (stand.facing_sun * lit);
        }
        light
    }

    /// Sky and ground, matt and mirrored.
    fn ambient(&self, stand: &Stand, matt: Lanes3, mirror: Lanes3, roughness: Vec4, lit: Vec4) -> Lanes3 {
        let half = Vec4::splat(0.5);
        let diffuse = matt * self.hemisphere(stand.normal.y * half + half);
        let glancing = fifth_power(Vec4::ONE - stand.facing_eye);
        let fresnel = mirror.towards(mirror.max(Lanes3::grey(Vec4::ONE - roughness)), glancing);
        // Normals of a bevel are mixed and may point away from the eye at its far edge: there it mirrors what lies beyond it, not the sky.
        let bounced = stand.normal.y * (stand.facing_eye * 2.0) - stand.view.y;
        let sky = Vec4::splat(SKY_IN_SHADOW) + lit * (1.0 - SKY_IN_SHADOW);
        (diffuse + fresnel * self.surroundings(bounced, roughness)) * sky
    }

    /// GGX distribution, Hammon's approximation of Smith's masking, Schlick's Fresnel; times pi, as the sun's intensity is what
    /// a white matt surface shows.
    fn highlight(&self, stand: &Stand, roughness: Vec4, mirror: Lanes3) -> Lanes3 {
        let half = (stand.view + self.towards).normalize();
        let alpha = roughness * roughness;
        let across = stand.normal.dot(half).max(Vec4::ZERO);
        let spread = across * across * (alpha * alpha - Vec4::ONE) + Vec4::ONE;
        let both = stand.facing_eye * stand.facing_sun * 2.0;
        let masking = both + (stand.facing_eye + stand.facing_sun - both) * alpha;
        let strength = alpha * alpha * 0.5 / (spread * spread * masking);
        let glancing = fifth_power(Vec4::ONE - stand.view.dot(half).max(Vec4::ZERO));
        mirror.towards(Lanes3::grey(Vec4::ONE), glancing) * strength
    }

    fn hemisphere(&self, up: Vec4) -> Lanes3 {
        self.ground.towards(self.sky, up)
    }

    /// What a mirror sees in a direction of the given height: ground, a horizon the softer the duller the mirror, sky, and in
    /// the sky a wide bright panel as photographers use it.
    fn surroundings(&self, up: Vec4, roughness: Vec4) -> Lanes3 {
        let soft = Vec4::splat(HORIZON) + roughness * (1.0 - HORIZON);
        let open = self.hemisphere(smoothstep(-soft, soft, up));
        let low = Vec4::splat(PANEL.low) - roughness * PANEL.blur;
        let high = Vec4::splat(PANEL.high) + roughness * PANEL.blur;
        open + self.sky * (smoothstep(low, high, up) * PANEL.strength)
    }
}

/// Khronos PBR neutral tone mapper (specification 1.0): leaves colours as they are up to 0.8, then rolls off without changing hue.
fn tone_map(colour: Lanes3) -> Lanes3 {
    const START: f32 = 0.8 - 0.04;
    const ROOM: f32 = 1.0 - START;
    const DESATURATION: f32 = 0.15;
    let least = colour.x.min(colour.y).min(colour.z);
    let toe = least - least * least * 6.25;
    let offset = Vec4::select(least.cmplt(Vec4::splat(0.08)), toe, Vec4::splat(0.04));
    let colour = colour - Lanes3::grey(offset);
    let peak = colour.x.max(colour.y).max(colour.z);
    let bright = peak.cmpge(Vec4::splat(START));
    if !bright.any() {
        return colour;
    }
    let peak = peak.max(Vec4::splat(START));
    let rolled = Vec4::ONE - Vec4::splat(ROOM * ROOM) / (peak + Vec4::splat(ROOM - START));
    let fade = Vec4::ONE - Vec4::ONE / ((peak - rolled) * DESATURATION + Vec4::ONE);
    let mapped = (colour * (rolled / peak)).towards(Lanes3::grey(rolled), fade);
    let pick = |mapped, colour| Vec4::select(bright, mapped, colour);
    Lanes3 { x: pick(mapped.x, colour.x), y: pick(mapped.y, colour.y), z: pick(mapped.z, colour.z) }
}

/// Sum of the sRGB codes of three channels of light, each 0 to 1, to about 0.002: roots stand in for the power 1/2.4 (fit by C. Taylor).
fn brightness(light: Lanes3) -> Vec4 {
    let code = |light: Vec4| {
        let light = light.max(Vec4::ZERO);
        let second = square_root(light);
        let fourth = square_root(second);
        let curve = second * 0.585_122_4 + fourth * 0.783_140_4 - square_root(fourth) * 0.368_262_7;
        Vec4::select(light.cmple(Vec4::splat(0.003_130_8)), light * 12.92, curve)
    };
    code(light.x) + code(light.y) + code(light.z)
}
