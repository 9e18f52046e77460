//! Double buffering: a frame is painted whole into a hidden target, and only a whole one is ever shown.
//!
//! [`Swap`] is the logic, and knows nothing of windows; [`BackBuffer`] is the same with macroquad's render targets.
//! A frame that its painter abandons stays hidden: what is shown is still the last whole one.

use macroquad::camera::{Camera2D, set_camera, set_default_camera};
use macroquad::color::{BLACK, WHITE};
use macroquad::math::{Rect, vec2};
use macroquad::texture::{DrawTextureParams, FilterMode, RenderTarget, draw_texture_ex, render_target};
use macroquad::window::{clear_background, screen_height, screen_width};

use super::layout::{PixelSize, letterbox};

/// Two targets: the last whole frame in front, the one being painted at the back.
#[derive(Debug)]
struct Swap<T> {
    front: Option<Slot<T>>,
    back: Option<Slot<T>>,
}

/// A target, and the size that it was made for.
#[derive(Debug)]
struct Slot<T> {
    size: PixelSize,
    target: T,
}

/// A whole frame. There is no way to one but through [`Swap`], and while it is held nothing can be painted.
#[derive(Debug)]
pub(super) struct Finished<'a, T>(&'a Slot<T>);

impl<T> Swap<T> {
    const fn new() -> Self {
        Self { front: None, back: None }
    }

    /// Paints a frame of `size` at the back, and brings it to the front if `paint` succeeds. The target at the back is
    /// made anew when its size differs. If `paint` fails (or panics), the front is as it was.
    fn frame<E>(
        &mut self,
        size: PixelSize,
        make: impl FnOnce(PixelSize) -> T,
        paint: impl FnOnce(&mut T) -> Result<(), E>,
    ) -> Result<Finished<'_, T>, E> {
        // One of another size is dropped first, so that its memory is free for the new one.
        let reusable = self.back.take().filter(|slot| slot.size == size);
        let mut slot = reusable.unwrap_or_else(|| Slot { size, target: make(size) });
        if let Err(reason) = paint(&mut slot.target) {
            self.back = Some(slot);
            return Err(reason);
        }
        self.back = self.front.take();
        Ok(Finished(self.front.insert(slot)))
    }

    /// The last whole frame, if there has been one.
    fn last_whole(&self) -> Option<Finished<'_, T>> {
        self.front.as_ref().map(Finished)
    }
}

/// The double buffer of the window.
#[derive(Debug)]
pub(super) struct BackBuffer {
    swap: Swap<RenderTarget>,
}

impl BackBuffer {
    /// Without any target yet.
    pub(super) const fn new() -> Self {
        Self { swap: Swap::new() }
    }

    /// Paints a frame into the hidden target, with a camera whose unit is one pixel, y down. What is painted where an
    /// earlier frame has been is up to `paint`: it must cover every pixel.
    pub(super) fn frame<E>(
        &mut self,
        size: PixelSize,
        paint: impl FnOnce() -> Result<(), E>,
    ) -> Result<Finished<'_, RenderTarget>, E> {
        self.swap.frame(size, make_target, |target| {
            let (width, height) = (f32::from(size.width), f32::from(size.height));
            let mut camera = Camera2D::from_display_rect(Rect::new(0.0, 0.0, width, height));
            camera.render_target = Some(target.clone());
            set_camera(&camera);
            let painted = paint();
            // Flushes what was painted into the target, also that of an abandoned frame, which nobody will see.
            set_default_camera();
            painted
        })
    }

    /// The last whole frame, if there has been one.
    pub(super) fn last_whole(&self) -> Option<Finished<'_, RenderTarget>> {
        self.swap.last_whole()
    }
}

impl Finished<'_, RenderTarget> {
    /// Shows the frame in the window: one blit, with black bars where its shape differs from the window's.
    pub(super) fn present(self) {
        let Slot { size, target } = self.0;
        set_default_camera();
        // A default camera counts in points, of which a screen of high density has fewer than pixels.
        let window = vec2(screen_width(), screen_height());
        let place = letterbox(*size, window);
        if place.size() != window {
            clear_background(BLACK);
        }
        let params = DrawTextureParams {
            dest_size: Some(vec2(place.w, place.h)),
            // A render target's first row is its lowest.
            flip_y: true,
            ..DrawTextureParams::default()
        };
        draw_texture_ex(&target.texture, place.x, place.y, WHITE, params);
    }
}

fn make_target(size: PixelSize) -> RenderTarget {
    let target = render_target(u32::from(size.width), u32::from(size.height));
    // The blit is pixel for pixel, but for the moment of a resize.
    target.texture.set_filter(FilterMode::Nearest);
    target
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A target without a window: what was painted, stroke by stroke.
    type Strokes = Vec<&'static str>;

    const SMALL: PixelSize = PixelSize { width: 4, height: 3 };
    const LARGE: PixelSize = PixelSize { width: 8, height: 6 };

    /// Paints `name` in two strokes, or gives up between them.
    fn paint(swap: &mut Swap<Strokes>, size: PixelSize, name: &'static str, whole: bool) -> Option<Strokes> {
        let frame = swap.frame(
            size,
            |_| Strokes::new(),
            |target| {
                target.clear();
                target.push(name);
                if !whole {
                    return Err(());
                }
                target.push("done");
                Ok(())
            },
        );
        frame.ok().map(|finished| finished.0.target.clone())
    }

    fn shown(swap: &Swap<Strokes>) -> Option<Strokes> {
        swap.last_whole().map(|finished| finished.0.target.clone())
    }

    #[test]
    fn nothing_is_shown_before_the_first_whole_frame() {
        let mut swap = Swap::new();
        assert_eq!(shown(&swap), None);
        assert_eq!(paint(&mut swap, SMALL, "one", false), None);
        assert_eq!(shown(&swap), None);
    }

    #[test]
    fn the_newest_whole_frame_is_shown() {
        let mut swap = Swap::new();
        for name in ["one", "two", "three", "four"] {
            assert_eq!(paint(&mut swap, SMALL, name, true), Some(vec![name, "done"]));
            assert_eq!(shown(&swap), Some(vec![name, "done"]));
        }
    }

    #[test]
    fn a_half_painted_frame_leaves_the_last_whole_one() {
        let mut swap = Swap::new();
        paint(&mut swap, SMALL, "one", true);
        paint(&mut swap, SMALL, "two", true);
        for _ in 0..3 {
            assert_eq!(paint(&mut swap, SMALL, "half", false), None);
            assert_eq!(shown(&swap), Some(vec!["two", "done"]));
        }
        paint(&mut swap, SMALL, "three", true);
        assert_eq!(shown(&swap), Some(vec!["three", "done"]));
    }

    #[test]
    fn a_painter_that_panics_leaves_the_last_whole_frame() {
        let mut swap = Swap::new();
        paint(&mut swap, SMALL, "one", true);
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            let _frame: Result<_, ()> = swap.frame(
                SMALL,
                |_| Strokes::new(),
                |target| {
                    target.push("half");
                    panic!("on purpose")
                },
            );
        }));
        assert!(panicked.is_err());
        assert_eq!(shown(&swap), Some(vec!["one", "done"]));
    }

    #[test]
    fn targets_are_made_anew_for_another_size_only() {
        let mut swap = Swap::new();
        let mut made = Vec::new();
        for size in [SMALL, SMALL, SMALL, LARGE, LARGE, LARGE, SMALL] {
            let frame: Result<_, ()> = swap.frame(
                size,
                |size| {
                    made.push(size);
                    Strokes::new()
                },
                |_| Ok(()),
            );
            assert_eq!(frame.map(|finished| finished.0.size), Ok(size));
        }
        // Two targets for each size, and one for the way back.
        assert_eq!(made, [SMALL, SMALL, LARGE, LARGE, SMALL]);
    }

    #[test]
    fn an_abandoned_resize_still_shows_the_frame_of_the_old_size() {
        let mut swap = Swap::new();
        paint(&mut swap, SMALL, "one", true);
        paint(&mut swap, LARGE, "half", false);
        assert_eq!(swap.last_whole().map(|finished| finished.0.size), Some(SMALL));
        assert_eq!(shown(&swap), Some(vec!["one", "done"]));
    }
}
