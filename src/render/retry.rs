//! A back end that is opened again when its device is lost.

use super::draw_list::DrawList;
use super::renderer::{AdapterInfo, DrawTimes, Renderer};
use super::{RenderError, RendererChoice};
use image::RgbaImage;

/// Times a device is opened again for one picture.
const ATTEMPTS: usize = 2;

type Opened = Result<Box<dyn Renderer>, RenderError>;

/// Passes on what `inner` draws. Where its device fails the same device is opened again and the picture drawn anew; another device is
/// refused, since its pictures would differ.
pub(super) struct Persistent {
    choice: RendererChoice,
    open: fn(RendererChoice) -> Opened,
    inner: Box<dyn Renderer>,
}

impl Persistent {
    pub fn new(choice: RendererChoice, open: fn(RendererChoice) -> Opened) -> Result<Self, RenderError> {
        Ok(Self { choice, open, inner: open(choice)? })
    }

    fn reopen(&mut self) -> Result<(), RenderError> {
        let fresh = (self.open)(self.choice)?;
        let (old, new) = (self.inner.info(), fresh.info());
        if (&old.adapter, &old.backend) != (&new.adapter, &new.backend) {
            let reason = format!("{} was lost, and {} draws other pixels", old.adapter, new.adapter);
            return Err(RenderError::Device { doing: "opening the device again", reason });
        }
        self.inner = fresh;
        Ok(())
    }
}

impl Renderer for Persistent {
    fn info(&self) -> &AdapterInfo {
        self.inner.info()
    }

    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
        let mut result = self.inner.draw(list);
        for attempt in 1..=ATTEMPTS {
            let Err(RenderError::Device { doing, reason }) = &result else { break };
            tracing::warn!("{doing}: {reason}; the device is opened again, attempt {attempt} of {ATTEMPTS}");
            self.reopen()?;
            result = self.inner.draw(list);
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Background, Camera, Colour, Light};
    use glam::Vec3;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Draws one picture and is lost at the next; the third that is opened is another device.
    struct Fragile {
        info: AdapterInfo,
        left: usize,
    }

    impl Renderer for Fragile {
        fn info(&self) -> &AdapterInfo {
            &self.info
        }

        fn draw(&mut self, _: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
            if self.left == 0 {
                return Err(RenderError::Device { doing: "drawing", reason: "the device is lost".into() });
            }
            self.left -= 1;
            Ok((RgbaImage::new(1, 1), DrawTimes::default()))
        }
    }

    fn open(_: RendererChoice) -> Opened {
        static OPENED: AtomicUsize = AtomicUsize::new(0);
        let adapter = if OPENED.fetch_add(1, Ordering::SeqCst) < 2 { "first" } else { "other" };
        let info = AdapterInfo { adapter: adapter.into(), backend: "fake".into(), reason: "test".into() };
        Ok(Box::new(Fragile { info, left: 1 }))
    }

    fn broken(_: RendererChoice) -> Opened {
        let info = AdapterInfo { adapter: "broken".into(), backend: "fake".into(), reason: "test".into() };
        Ok(Box::new(Fragile { info, left: 0 }))
    }

    fn list() -> DrawList {
        let black = Colour::rgb(0);
        DrawList {
            size: [1, 1],
            background: Background { top: black, bottom: black },
            camera: Camera {
                eye: Vec3::Z,
                target: Vec3::ZERO,
                up: Vec3::Y,
                vertical_field_of_view: 1.0,
                viewport: [0.0, 0.0, 1.0, 1.0],
            },
            light: Light {
                direction: Vec3::Y,
                colour: black,
                intensity: 0.0,
                sky: black,
                ground: black,
                shadow_centre: Vec3::ZERO,
                shadow_radius: 1.0,
            },
            objects: Vec::new(),
            overlay: Vec::new(),
        }
    }

    #[test]
    fn a_lost_device_is_opened_again_and_another_one_refused() {
        let mut renderer = Persistent::new(RendererChoice::Auto, open).unwrap();
        assert!(renderer.draw(&list()).is_ok());
        assert!(renderer.draw(&list()).is_ok(), "the second picture is drawn on the device opened again");
        let error = renderer.draw(&list()).unwrap_err().to_string();
        assert!(error.contains("first") && error.contains("other"), "{error}");
    }

    #[test]
    fn a_device_that_stays_lost_is_an_error() {
        let mut renderer = Persistent::new(RendererChoice::Auto, broken).unwrap();
        assert!(matches!(renderer.draw(&list()), Err(RenderError::Device { .. })));
    }
}
