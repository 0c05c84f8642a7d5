//! The two projections: camera to pixels, light to shadow map.
//!
//! The camera's depth is near / distance: 1 at the near plane, 0 infinitely far, linear over the screen, and nowhere short of precision.

use super::RenderError;
use super::draw_list::{Camera, DrawList, Light};
use super::portable::tan_half;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Texels along each side of the shadow map.
pub(crate) const SHADOW_SIZE: u32 = 1024;

/// The near plane, as a part of the distance from eye to target.
const NEAR: f32 = 0.02;

/// World to clip space, x and y in -1..1 across the whole picture (y up), reversed depth.
pub(crate) fn camera_matrix(camera: &Camera, [width, height]: [u32; 2]) -> Result<Mat4, RenderError> {
    let fail = |problem| Err(RenderError::View { problem });
    let forward = camera.target - camera.eye;
    let right = forward.cross(camera.up);
    // False for everything that is not a number.
    let usable = right.length() > 1e-6 * forward.length() * camera.up.length() && right.is_finite();
    if !usable {
        return fail("the camera needs an eye apart from its target and an up that does not point along the view");
    }
    let angle = camera.vertical_field_of_view;
    if !(0.01..3.1).contains(&angle) {
        return fail("the camera's field of view must be 0.01 to 3.1 rad");
    }
    let [left, top, end, bottom] = camera.viewport;
    if !(left < end && top < bottom && camera.viewport.iter().all(|edge| (-8.0..=8.0).contains(edge))) {
        return fail("the camera's viewport must have left below right and top below bottom");
    }
    let (back, right) = (-forward.normalize(), right.normalize());
    let up = back.cross(right);
    let row = |axis: Vec3| axis.extend(-axis.dot(camera.eye));
    // The field of view spans the viewport's height; the picture is larger by one over it.
    let scale = (bottom - top) / tan_half(angle);
    let centre = [left + end - 1.0, 1.0 - top - bottom];
    let distance = -row(back);
    let x = row(right) * (scale * height as f32 / width as f32) + distance * centre[0];
    let y = row(up) * scale + distance * centre[1];
    let z = Vec4::W * (NEAR * forward.length());
    Ok(Mat4::from_cols(x, y, z, distance).transpose())
}

impl Camera {
    /// Overlay pixel at which a point of the world is seen in a picture of the given size; `None` behind the eye, and for cameras
    /// that cannot be drawn with.
    #[must_use]
    pub fn project(&self, point: Vec3, size: [u32; 2]) -> Option<Vec2> {
        let clip = camera_matrix(self, size).ok()? * point.extend(1.0);
        let picture = Vec2::new(size[0] as f32, size[1] as f32);
        (clip.w > clip.z).then(|| Vec2::new(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * picture)
    }
}

/// World to shadow map: texels along `u` and `v`, `height` towards the light in world units, all relative to the shadow sphere's centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightView {
    pub centre: Vec3,
    /// Unit vectors across the light and towards it.
    pub axes: [Vec3; 3],
    pub radius: f32,
    /// World units of one texel.
    pub texel: f32,
}

impl LightView {
    pub fn new(light: &Light) -> Result<Self, RenderError> {
        let towards = light.direction.normalize_or_zero();
        let usable = light.shadow_radius > 0.0 && light.shadow_radius.is_finite() && light.shadow_centre.is_finite();
        if towards == Vec3::ZERO || !usable || !(light.intensity >= 0.0 && light.intensity.is_finite()) {
            let problem =
                "the light needs a direction, an intensity of at least 0 and a shadow sphere with a positive radius";
            return Err(RenderError::View { problem });
        }
        let aside = if towards.x.abs() < 0.7 { Vec3::X } else { Vec3::Z };
        let v = towards.cross(aside).normalize();
        let u = v.cross(towards);
        let texel = 2.0 * light.shadow_radius / SHADOW_SIZE as f32;
        Ok(Self { centre: light.shadow_centre, axes: [u, v, towards], radius: light.shadow_radius, texel })
    }

    /// Place in texels, and height in world units.
    pub fn project(&self, position: Vec3) -> Vec3 {
        let from_centre = position - self.centre;
        let across = |axis: Vec3| (from_centre.dot(axis) + self.radius) / self.texel;
        Vec3::new(across(self.axes[0]), across(self.axes[1]), from_centre.dot(self.axes[2]))
    }
}

/// What both back ends check before they draw.
pub(crate) fn check_size(list: &DrawList, limit: u32) -> Result<(), RenderError> {
    let [width, height] = list.size;
    if list.size.iter().all(|side| (1..=limit).contains(side)) {
        return Ok(());
    }
    Err(RenderError::Size { width, height, limit })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            eye: Vec3::new(0.0, 0.0, 4.0),
            target: Vec3::ZERO,
            up: Vec3::Y,
            vertical_field_of_view: std::f32::consts::FRAC_PI_2,
            viewport: [0.0, 0.0, 1.0, 1.0],
        }
    }

    fn seen(camera: &Camera, point: Vec3) -> Vec3 {
        camera_matrix(camera, [200, 100]).unwrap().project_point3(point)
    }

    /// At 90 degrees the half height at distance 4 is 4, the half width 8 for a picture twice as wide.
    #[test]
    fn corners_of_the_view_reach_corners_of_the_picture() {
        let corner = seen(&camera(), Vec3::new(8.0, 4.0, 0.0));
        assert!((corner - Vec3::new(1.0, 1.0, NEAR)).length() < 1e-6, "{corner}");
    }

    #[test]
    fn the_viewport_moves_the_target_to_its_middle_and_scales_by_its_height() {
        let shifted = Camera { viewport: [0.0, 0.0, 0.5, 0.5], ..camera() };
        assert!((seen(&shifted, Vec3::ZERO).truncate() - glam::Vec2::new(-0.5, 0.5)).length() < 1e-6);
        assert!((seen(&shifted, Vec3::Y * 4.0).y - 1.0).abs() < 1e-6);
    }

    /// At 90 degrees a point one unit aside at distance 4 is seen at an eighth of the height from the middle.
    #[test]
    fn points_are_projected_to_overlay_pixels() {
        let place = camera().project(Vec3::new(1.0, 1.0, 0.0), [200, 100]).unwrap();
        assert!((place - Vec2::new(112.5, 37.5)).length() < 1e-4, "{place}");
        assert_eq!(camera().project(Vec3::new(0.0, 0.0, 5.0), [200, 100]), None);
    }

    #[test]
    fn useless_cameras_and_lights_are_refused() {
        let same = Camera { target: Vec3::new(0.0, 0.0, 4.0), ..camera() };
        let along = Camera { up: Vec3::Z, ..camera() };
        let wide = Camera { vertical_field_of_view: 4.0, ..camera() };
        let lost = Camera { eye: Vec3::NAN, ..camera() };
        let empty = Camera { viewport: [0.5, 0.0, 0.5, 1.0], ..camera() };
        for useless in [same, along, wide, lost, empty] {
            assert!(camera_matrix(&useless, [200, 100]).is_err(), "{useless:?}");
        }
    }
}
