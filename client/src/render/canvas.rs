//! A small software rasteriser for art that is painted once: antialiased fills, soft shadows, glows and bevels of
//! [`Shape`]s, into pixels with premultiplied alpha. It knows nothing of tables, and nothing of the graphics card.
//!
//! A canvas may be a horizontal band of a larger picture, so that [`paint_in_bands`] can use every processor.

use macroquad::math::{Rect, Vec2, Vec3, Vec4, vec2};
use macroquad::texture::Image;

use super::shape::Shape;

/// A coat of paint: red, green and blue already multiplied by alpha. Alpha 0 with a colour only adds light.
pub(super) type Ink = Vec4;

/// Where the light of the whole picture comes from: up and to the left.
pub(super) const LIGHT: Vec2 = Vec2::new(-0.55, -0.835);

/// Paint of a colour that covers `alpha` of what lies below.
pub(super) fn ink(color: Vec3, alpha: f32) -> Ink {
    (color * alpha).extend(alpha)
}

/// Paint that only adds light.
pub(super) fn glow(color: Vec3, strength: f32) -> Ink {
    (color * strength).extend(0.0)
}

/// 0 below `from`, 1 above `to`, and a soft step between.
pub(super) fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// A repeatable random number in 0..1 for a pixel.
pub(super) fn noise(x: i32, y: i32) -> f32 {
    let mut bits = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2C1B_3C6D);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297A_2D39);
    (bits >> 8) as f32 / 16_777_216.0
}

/// Smooth random hills over the plane, a hill to each unit, 0..1.
pub(super) fn hills(p: Vec2) -> f32 {
    let cell = p.floor();
    let (x, y) = (cell.x as i32, cell.y as i32);
    let share = p - cell;
    let share = share * share * (Vec2::splat(3.0) - 2.0 * share);
    let row = |y: i32| noise(x, y) + (noise(x + 1, y) - noise(x, y)) * share.x;
    row(y) + (row(y + 1) - row(y)) * share.y
}

/// Clouds: hills of three sizes, each turned against the others so that no grid shows, 0..1.
pub(super) fn clouds(p: Vec2) -> f32 {
    const TURN: Vec2 = Vec2::new(0.8, 0.6);
    let middle = TURN.rotate(p) * 2.1 + 7.0;
    let fine = TURN.rotate(middle) * 2.3 + 31.0;
    hills(p) * 0.5 + hills(middle) * 0.32 + hills(fine) * 0.18
}

/// Pixels to paint on.
#[derive(Debug)]
pub(super) struct Canvas {
    width: usize,
    height: usize,
    /// Row of the whole picture that is this canvas's first.
    top: usize,
    pixels: Vec<Vec4>,
}

impl Canvas {
    /// A transparent canvas.
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self::band(width, 0, height)
    }

    /// The rows from `top` on of a larger picture, as many as `height`.
    fn band(width: usize, top: usize, height: usize) -> Self {
        Self { width, height, top, pixels: vec![Vec4::ZERO; width * height] }
    }

    /// Lays a coat over every pixel of a rectangle; `coat` is asked at the pixel's centre.
    pub(super) fn wash(&mut self, area: Rect, coat: impl Fn(Vec2) -> Ink) {
        let clip = |value: f32, end: usize| value.clamp(0.0, end as f32) as usize;
        let columns = clip(area.x.floor(), self.width)..clip((area.x + area.w).ceil(), self.width);
        let rows = clip(area.y.floor() - self.top as f32, self.height)
            ..clip((area.y + area.h).ceil() - self.top as f32, self.height);
        for row in rows {
            let y = (row + self.top) as f32 + 0.5;
            let line = &mut self.pixels[row * self.width..][columns.clone()];
            for (pixel, column) in line.iter_mut().zip(columns.clone()) {
                let coat = coat(vec2(column as f32 + 0.5, y));
                *pixel = *pixel * (1.0 - coat.w) + coat;
            }
        }
    }

    /// Fills a shape; `coat` gets the point and its signed distance to the outline.
    pub(super) fn fill(&mut self, shape: &Shape, coat: impl Fn(Vec2, f32) -> Ink) {
        self.wash(widen(shape.bounds(), 1.0), |p| {
            let distance = shape.distance(p);
            let cover = coverage(distance);
            if cover > 0.0 { coat(p, distance) * cover } else { Vec4::ZERO }
        });
    }

    /// Fills a shape with one coat.
    pub(super) fn flat(&mut self, shape: &Shape, coat: Ink) {
        self.fill(shape, |_, _| coat);
    }

    /// A line of `width` along the outline of a shape, centred on it.
    pub(super) fn outline(&mut self, shape: &Shape, width: f32, coat: Ink) {
        self.wash(widen(shape.bounds(), width / 2.0 + 1.0), |p| coat * coverage(shape.distance(p).abs() - width / 2.0));
    }

    /// The shadow of a shape that stands `height` pixels above the ground.
    pub(super) fn shadow(&mut self, shape: &Shape, height: f32, strength: f32) {
        let offset = -LIGHT * height;
        let blur = height * 0.8 + 1.0;
        let bounds = shape.bounds();
        let area = Rect::new(bounds.x + offset.x, bounds.y + offset.y, bounds.w, bounds.h);
        self.wash(widen(area, blur), |p| {
            ink(Vec3::ZERO, strength * (1.0 - smooth(-blur, blur, shape.distance(p - offset))))
        });
    }

    /// Light around (and on) a shape that fades over `reach` pixels.
    pub(super) fn halo(&mut self, shape: &Shape, reach: f32, color: Vec3, strength: f32) {
        self.wash(widen(shape.bounds(), reach), |p| {
            let fade = 1.0 - (shape.distance(p).max(0.0) / reach).min(1.0);
            glow(color, strength * fade * fade)
        });
    }

    /// The edge of something raised: `width` pixels inside the outline, bright towards the light and dark away from it.
    pub(super) fn bevel(&mut self, shape: &Shape, width: f32, strength: f32) {
        self.fill(shape, |p, distance| {
            let fade = 1.0 + distance / width;
            if fade <= 0.0 {
                return Vec4::ZERO;
            }
            let facing = shape.normal(p).dot(LIGHT) * strength * fade.min(1.0);
            if facing > 0.0 { ink(Vec3::ONE, facing) } else { ink(Vec3::ZERO, -facing) }
        });
    }

    /// A round bar of `color` along a line: shaded across as a cylinder is, with a highlight.
    pub(super) fn tube(&mut self, shape: &Shape, radius: f32, color: Vec3, shine: f32) {
        self.fill(shape, |p, distance| {
            // 0 on the axis, 1 at the rim.
            let across = (1.0 + distance / radius).clamp(0.0, 1.0);
            let tilt = shape.normal(p).dot(LIGHT) * across;
            let diffuse = 0.55 + 0.45 * tilt;
            let specular = smooth(0.45, 0.0, (tilt - 0.35).abs()) * shine;
            ink((color * diffuse + Vec3::splat(specular)).min(Vec3::ONE), 1.0)
        });
    }

    /// The picture as eight-bit pixels with premultiplied alpha.
    pub(super) fn into_image(self) -> Image {
        let bytes = self.bytes();
        Image { width: self.width as u16, height: self.height as u16, bytes }
    }

    /// Eight-bit pixels. Half a step of noise hides the bands that dark gradients would show.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.pixels.len() * 4);
        for (index, pixel) in self.pixels.iter().enumerate() {
            let (x, y) = (index % self.width, index / self.width + self.top);
            let dither = noise(x as i32, y as i32);
            let level = |value: f32| (value.clamp(0.0, 1.0) * 255.0 + dither) as u8;
            // Alpha goes undithered: an opaque picture stays opaque, an empty pixel empty.
            let alpha = (pixel.w.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
            if alpha == 0 && pixel.max_element() <= 0.0 {
                bytes.extend_from_slice(&[0; 4]);
            } else {
                bytes.extend_from_slice(&[level(pixel.x), level(pixel.y), level(pixel.z), alpha]);
            }
        }
        bytes
    }
}

/// Paints a picture by bands, one thread for each processor: `paint` is called for every band and must paint the
/// whole picture; what lies outside the band costs next to nothing.
pub(super) fn paint_in_bands(width: u16, height: u16, paint: impl Fn(&mut Canvas) + Sync) -> Image {
    // More bands than threads would need, since some are busier than others; and no less than 16 rows each.
    const BANDS_PER_THREAD: usize = 4;
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(8);
    let rows = usize::from(height).div_ceil(threads * BANDS_PER_THREAD).max(16);
    let band_count = usize::from(height).div_ceil(rows);
    let next = std::sync::atomic::AtomicUsize::new(0);
    let done = std::sync::Mutex::new(vec![Vec::new(); band_count]);
    let work = || {
        loop {
            let index = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            if index >= band_count {
                return;
            }
            let top = index * rows;
            let mut canvas = Canvas::band(usize::from(width), top, rows.min(usize::from(height) - top));
            paint(&mut canvas);
            let bytes = canvas.bytes();
            done.lock().unwrap_or_else(std::sync::PoisonError::into_inner)[index] = bytes;
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    let bands = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    Image { width, height, bytes: bands.concat() }
}

/// The part of a picture that is not empty, and where its corner is; a single empty pixel if there is none.
pub(super) fn cropped(picture: &Image) -> (Image, Vec2) {
    let width = usize::from(picture.width);
    let is_painted = |place: usize| picture.bytes[place * 4..][..4] != [0; 4];
    let painted =
        (0..picture.bytes.len() / 4).filter(|place| is_painted(*place)).map(|place| (place % width, place / width));
    let bounds = painted.fold(None, |bounds: Option<[usize; 4]>, (x, y)| {
        let [left, top, right, bottom] = bounds.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    });
    let [left, top, right, bottom] = bounds.unwrap_or_default();
    let rows = (top..=bottom).map(|row| &picture.bytes[(row * width + left) * 4..=(row * width + right) * 4 + 3]);
    let bytes = rows.collect::<Vec<_>>().concat();
    let part = Image { width: (right - left + 1) as u16, height: (bottom - top + 1) as u16, bytes };
    (part, vec2(left as f32, top as f32))
}

/// A picture reduced to so many pixels, or as it is where it is smaller: each is the mean of what it covers, by area.
pub(super) fn reduced(picture: &Image, width: u16, height: u16) -> Image {
    let (width, height) = (width.clamp(1, picture.width.max(1)), height.clamp(1, picture.height.max(1)));
    // What each of so many pixels covers of a side, and how much of each of that.
    let shares = |of: u16, into: u16| -> Vec<Vec<(usize, f32)>> {
        let step = f32::from(of) / f32::from(into);
        let cover = |place: u16| {
            let (from, to) = (f32::from(place) * step, (f32::from(place) + 1.0) * step);
            let cells = from as usize..(to.ceil() as usize).min(usize::from(of));
            cells.map(|cell| (cell, (to.min(cell as f32 + 1.0) - from.max(cell as f32)) / step)).collect()
        };
        (0..into).map(cover).collect()
    };
    let columns = shares(picture.width, width);
    let mut bytes = Vec::with_capacity(usize::from(width) * usize::from(height) * 4);
    for rows in shares(picture.height, height) {
        for columns in &columns {
            let mut sum = Vec4::ZERO;
            for &(row, of_row) in &rows {
                for &(column, of_column) in columns {
                    let place = (row * usize::from(picture.width) + column) * 4;
                    let pixel = [0, 1, 2, 3].map(|part| f32::from(picture.bytes[place + part]));
                    sum += Vec4::from_array(pixel) * (of_row * of_column);
                }
            }
            bytes.extend(sum.to_array().map(|part| (part + 0.5) as u8));
        }
    }
    Image { width, height, bytes }
}

/// How much of a pixel at this distance a shape covers.
fn coverage(distance: f32) -> f32 {
    (0.5 - distance).clamp(0.0, 1.0)
}

fn widen(rect: Rect, margin: f32) -> Rect {
    Rect::new(rect.x - margin, rect.y - margin, rect.w + 2.0 * margin, rect.h + 2.0 * margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn white_circle(radius: f32) -> Canvas {
        let mut canvas = Canvas::new(64, 64);
        canvas.flat(&Shape::circle(vec2(31.3, 32.1), radius), ink(Vec3::ONE, 1.0));
        canvas
    }

    #[test]
    fn the_area_of_a_circle_is_right_within_a_hundredth() {
        for radius in [3.0, 8.5, 20.0, 30.0] {
            let area: f32 = white_circle(radius).pixels.iter().map(|pixel| pixel.w).sum();
            let right = std::f32::consts::PI * radius * radius;
            assert!((area / right - 1.0).abs() < 0.01, "radius {radius}: {area} instead of {right}");
        }
    }

    #[test]
    fn an_edge_never_brightens_outwards() {
        let canvas = white_circle(20.0);
        let row = &canvas.pixels[32 * 64 + 31..33 * 64];
        assert!(row.windows(2).all(|pair| pair[0].w >= pair[1].w));
        assert!(row.iter().any(|pixel| pixel.w > 0.05 && pixel.w < 0.95), "no antialiasing");
    }

    #[test]
    fn nothing_is_painted_outside_the_canvas() {
        let mut canvas = Canvas::new(8, 8);
        canvas.flat(&Shape::circle(vec2(-40.0, 3.0), 10.0), ink(Vec3::ONE, 1.0));
        canvas.shadow(&Shape::circle(vec2(300.0, 300.0), 10.0), 4.0, 1.0);
        assert!(canvas.pixels.iter().all(|pixel| *pixel == Vec4::ZERO));
    }

    #[test]
    fn bands_make_the_same_picture_as_one_canvas() {
        let paint = |canvas: &mut Canvas| {
            canvas.wash(Rect::new(0.0, 0.0, 50.0, 77.0), |p| ink(Vec3::splat(p.y / 77.0), 1.0));
            canvas.tube(&Shape::rod(vec2(5.0, 5.0), vec2(40.0, 70.0), 6.0), 6.0, Vec3::ONE, 0.5);
        };
        let mut whole = Canvas::new(50, 77);
        paint(&mut whole);
        assert_eq!(paint_in_bands(50, 77, paint).bytes, whole.into_image().bytes);
    }

    #[test]
    fn a_cropped_picture_is_what_is_painted_of_it() {
        let mut canvas = Canvas::new(9, 7);
        canvas.wash(Rect::new(3.0, 2.0, 4.0, 3.0), |_| ink(Vec3::ONE, 1.0));
        let (part, corner) = cropped(&canvas.into_image());
        assert_eq!((part.width, part.height, corner), (4, 3, vec2(3.0, 2.0)));
        assert_eq!(part.bytes, [255; 48]);
        let (nothing, _) = cropped(&Canvas::new(9, 7).into_image());
        assert_eq!((nothing.width, nothing.height, nothing.bytes.len()), (1, 1, 4));
    }

    #[test]
    fn a_reduced_picture_is_the_mean_of_what_it_was() {
        let bytes = [[0, 0, 0, 255], [200, 0, 0, 255], [100, 0, 0, 255], [100, 40, 0, 255]].concat();
        let picture = Image { width: 2, height: 2, bytes };
        assert_eq!(reduced(&picture, 1, 1).bytes, [100, 10, 0, 255]);
        assert_eq!(reduced(&picture, 9, 9).bytes, picture.bytes);
        let flat = Image { width: 37, height: 23, bytes: [9, 8, 7, 6].repeat(37 * 23) };
        assert_eq!(reduced(&flat, 10, 7).bytes, [9, 8, 7, 6].repeat(70));
    }

    #[test]
    fn glow_adds_light_and_covers_nothing() {
        let mut canvas = Canvas::new(1, 1);
        canvas.wash(Rect::new(0.0, 0.0, 1.0, 1.0), |_| ink(Vec3::splat(0.2), 1.0));
        canvas.wash(Rect::new(0.0, 0.0, 1.0, 1.0), |_| glow(Vec3::splat(0.3), 1.0));
        assert!((canvas.pixels[0].x - 0.5).abs() < 1e-6 && canvas.pixels[0].w == 1.0);
    }
}
