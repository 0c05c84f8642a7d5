//! The constants of the shading model, shared by both back ends: the shaders get them as overridable constants of the same names.

/// Surfaces begin and end to fade into the backdrop at these multiples of the shadow radius from the shadow sphere's centre.
pub(crate) const FADE: [f32; 2] = [1.0, 2.6];
/// Part of the sky's light that a point in full shadow still gets: what hides the sun hides some sky.
pub(crate) const SKY_IN_SHADOW: f32 = 0.72;
/// Reflectance of paint and plastic seen straight on.
pub(crate) const PLAIN_MIRROR: f32 = 0.04;
/// Half height of the horizon in a perfect mirror.
pub(crate) const HORIZON: f32 = 0.15;

/// A bright panel in the sky that only mirrors see, from `low` to `high` in the direction's height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Panel {
    pub low: f32,
    pub high: f32,
    /// Widening in a dull mirror.
    pub blur: f32,
    /// As a multiple of the sky.
    pub strength: f32,
}

pub(crate) const PANEL: Panel = Panel { low: 0.45, high: 0.75, blur: 0.4, strength: 0.9 };

/// Filter weights of five bilinear taps along each axis of the shadow map.
pub(crate) const TAPS: [f32; 5] = [1.0 / 9.0, 2.0 / 9.0, 3.0 / 9.0, 2.0 / 9.0, 1.0 / 9.0];
/// Texels by which a surface must lie below a caster to be in its shadow.
pub(crate) const BIAS: f32 = 1.0;
/// Slopes against the light beyond which the filter follows the surface no further.
pub(crate) const STEEPEST: f32 = 4.0;
