//! Everything that moves or changes, painted once at the size in which it is drawn, and packed into one atlas.

use macroquad::math::{Rect, Vec2, Vec3, Vec4, vec2};
use macroquad::texture::Image;
use shared::table::TableFile;
use shared::table::format::{ElementFile, FlipperFile, Hand, LightColor};

use super::atlas::{Batch, Packer, Sprite, Ticket};
use super::canvas::{Canvas, LIGHT, glow, ink, smooth};
use super::dot_matrix::{FontTickets, Fonts};
use super::inserts::insert_shape;
use super::layout::Layout;
use super::palette::{self, AMBER, IVORY, NIGHT, RED, STEEL};
use super::panels::Panels;
use super::shape::{Shape, star};

/// A sprite and the point of it that is put on the element's own point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pinned<S> {
    pub(super) sprite: S,
    pub(super) pivot: Vec2,
}

/// The sprites that belong to one element of the table.
#[derive(Debug, Clone, Copy)]
pub(super) enum Own<S> {
    /// Drawn by general sprites, or not at all.
    Nothing,
    /// A lit insert; the pivot is its centre.
    Light(Pinned<S>),
    /// Cap, and the ring that flares when it kicks.
    Bumper { cap: S, flare: S },
    /// Body and shadow, both pointing right, the pivot at the axis.
    Flipper { body: Pinned<S>, shadow: Pinned<S> },
}

/// All sprites of a layout.
#[derive(Debug)]
pub(super) struct Sprites<S> {
    pub(super) ball: S,
    pub(super) ball_shadow: S,
    /// One colour all over; stretched to any rectangle.
    pub(super) dot: S,
    /// Round soft light.
    pub(super) halo: S,
    /// A line with soft edges; stretched to any length and width.
    pub(super) bar: S,
    /// The same, shaded as a round rod.
    pub(super) rod: S,
    /// What a fast ball leaves behind: bright at its right end, fading to the left.
    pub(super) streak: S,
    /// The plate behind the banner.
    pub(super) plate: S,
    /// For each element of the table, in order.
    pub(super) own: Vec<Own<S>>,
}

/// Paints sprites and fonts, and makes the batch that draws them.
pub(super) fn build(
    layout: &Layout,
    panels: &Panels,
    marked_lights: bool,
    table: &TableFile,
) -> (Batch, Sprites<Sprite>, Fonts) {
    let mut packer = Packer::default();
    let fonts = FontTickets::paint(&mut packer, panels.pitches());
    let ball_radius = layout.length(table.ball.radius);
    let tickets = Sprites {
        ball: packer.add(ball(ball_radius)),
        ball_shadow: packer.add(ball_shadow(ball_radius)),
        dot: packer.add(dot()),
        halo: packer.add(halo()),
        bar: packer.add(profile(|_| ink(Vec3::ONE, 1.0))),
        rod: packer.add(profile(|across| {
            let tilt = -across * 0.8;
            let level = 0.55 + 0.4 * tilt + 0.5 * smooth(0.4, 0.0, (tilt - 0.4).abs());
            ink(Vec3::splat(level.min(1.0)), 1.0)
        })),
        streak: packer.add(streak()),
        plate: packer.add(plate(banner_area(layout, panels))),
        own: table.elements.iter().map(|element| own(&mut packer, layout, marked_lights, table, element)).collect(),
    };
    let (picture, sprite) = packer.pack();
    let batch = Batch::new(&picture);
    (batch, tickets.resolve(&sprite), fonts.resolve(&sprite))
}

/// Where the banner's plate stands: across the playfield, between its middle and the flippers: there is the least to be
/// hidden.
pub(super) fn banner_area(layout: &Layout, panels: &Panels) -> Rect {
    let field = layout.seen_playfield();
    let height = f32::from(panels.banner) * 22.0;
    let width = (field.w * 0.96).round();
    Rect::new((field.center().x - width / 2.0).round(), (field.y + field.h * 0.585).round(), width, height.round())
}

fn own(
    packer: &mut Packer,
    layout: &Layout,
    marked_lights: bool,
    table: &TableFile,
    element: &ElementFile,
) -> Own<Ticket> {
    match element {
        ElementFile::Light(light) => {
            let shape = insert_shape(layout, table, light);
            let center = layout.written(light.center);
            let mark = marked_lights.then_some(light.color);
            Own::Light(lit_insert(packer, &shape, center, palette::light(light.color), mark))
        }
        ElementFile::Bumper(bumper) => {
            let radius = layout.length(bumper.radius);
            Own::Bumper { cap: packer.add(cap(radius)), flare: packer.add(flare(radius)) }
        }
        ElementFile::Flipper(flipper) => Own::Flipper {
            body: flipper_body(packer, layout, flipper),
            shadow: flipper_shadow(packer, layout, flipper),
        },
        _ => Own::Nothing,
    }
}

impl Sprites<Ticket> {
    fn resolve(self, sprite: impl Fn(Ticket) -> Sprite) -> Sprites<Sprite> {
        let pinned = |pinned: Pinned<Ticket>| Pinned { sprite: sprite(pinned.sprite), pivot: pinned.pivot };
        let own = |own: Own<Ticket>| match own {
            Own::Nothing => Own::Nothing,
            Own::Light(light) => Own::Light(pinned(light)),
            Own::Bumper { cap, flare } => Own::Bumper { cap: sprite(cap), flare: sprite(flare) },
            Own::Flipper { body, shadow } => Own::Flipper { body: pinned(body), shadow: pinned(shadow) },
        };
        Sprites {
            ball: sprite(self.ball),
            ball_shadow: sprite(self.ball_shadow),
            dot: sprite(self.dot).inner_part(),
            halo: sprite(self.halo),
            bar: sprite(self.bar),
            rod: sprite(self.rod),
            streak: sprite(self.streak),
            plate: sprite(self.plate),
            own: self.own.into_iter().map(own).collect(),
        }
    }
}

/// A square canvas with room for a disc, and its middle.
fn disc_canvas(radius: f32) -> (Canvas, Vec2) {
    let side = (radius.ceil() as usize + 2) * 2;
    (Canvas::new(side, side), Vec2::splat(side as f32 / 2.0))
}

/// A chrome sphere: it mirrors the lamps above, the dark room around, and at its lower rim the lit board.
pub(super) fn ball(radius: f32) -> Image {
    let (mut canvas, center) = disc_canvas(radius);
    canvas.fill(&Shape::circle(center, radius), |p, _| {
        let flat = (p - center) / radius;
        let from_lamp = (flat - LIGHT * 0.38).length();
        let steel = Vec3::new(0.93, 0.95, 1.0).lerp(Vec3::new(0.42, 0.46, 0.56), smooth(0.15, 1.05, from_lamp));
        let board = Vec3::new(0.55, 0.62, 0.85) * smooth(1.02, 1.30, from_lamp) * 0.75;
        let rim = smooth(0.0, 0.16, 1.0 - flat.length());
        let spot = smooth(0.36, 0.14, from_lamp);
        ink(((steel + board) * (0.45 + 0.55 * rim)).lerp(Vec3::ONE, spot).min(Vec3::ONE), 1.0)
    });
    canvas.into_image()
}

fn ball_shadow(radius: f32) -> Image {
    let (mut canvas, center) = disc_canvas(radius * 1.5);
    let area = Rect::new(0.0, 0.0, center.x * 2.0, center.y * 2.0);
    canvas.wash(area, |p| ink(Vec3::ZERO, 0.62 * smooth(radius * 1.45, radius * 0.55, p.distance(center))));
    canvas.into_image()
}

fn halo() -> Image {
    const RADIUS: f32 = 30.0;
    let (mut canvas, center) = disc_canvas(RADIUS);
    canvas.fill(&Shape::circle(center, RADIUS), |p, _| {
        let fade = 1.0 - p.distance(center) / RADIUS;
        ink(Vec3::ONE, fade * fade)
    });
    canvas.into_image()
}

fn streak() -> Image {
    const SIZE: Vec2 = Vec2::new(48.0, 24.0);
    let mut canvas = Canvas::new(SIZE.x as usize, SIZE.y as usize);
    canvas.wash(Rect::new(0.0, 0.0, SIZE.x, SIZE.y), |p| {
        let along = p.x / SIZE.x;
        let across = (p.y / SIZE.y * 2.0 - 1.0).abs();
        ink(Vec3::ONE, along * along * smooth(0.35 + 0.6 * along, 0.0, across))
    });
    canvas.into_image()
}

/// A strip whose rows are `coat` from -1 at the upper side to 1 at the lower, with transparent edges.
fn profile(coat: impl Fn(f32) -> Vec4) -> Image {
    const ROWS: usize = 12;
    let mut canvas = Canvas::new(4, ROWS);
    canvas.wash(Rect::new(0.0, 0.0, 4.0, ROWS as f32), |p| {
        let across = p.y / ROWS as f32 * 2.0 - 1.0;
        coat(across) * smooth(0.0, 1.0, p.y.min(ROWS as f32 - p.y) / 1.6)
    });
    canvas.into_image()
}

/// A few equal pixels.
pub(super) fn dot() -> Image {
    const SIDE: u16 = 4;
    Image { width: SIDE, height: SIDE, bytes: vec![u8::MAX; usize::from(SIDE) * usize::from(SIDE) * 4] }
}

/// Dark glass with bright lines above and below.
fn plate(area: Rect) -> Image {
    let (width, height) = (area.w.max(2.0), area.h.max(2.0));
    let mut canvas = Canvas::new(width as usize, height as usize);
    let shape = Shape::Plate { rect: Rect::new(1.0, 1.0, width - 2.0, height - 2.0), corner: height * 0.12 };
    canvas.fill(&shape, |p, _| ink(NIGHT * 0.6 + Vec3::splat(0.03 * (1.0 - p.y / height)), 0.86));
    canvas.outline(&shape, (height * 0.02).max(1.0), ink(AMBER, 0.75));
    canvas.into_image()
}

/// A lit insert: white hot in the middle, its own colour at the rim; marked, with a white ring around it and a dark sign in it.
fn lit_insert(
    packer: &mut Packer,
    shape: &Shape,
    center: Vec2,
    color: Vec3,
    mark: Option<LightColor>,
) -> Pinned<Ticket> {
    let bounds = shape.bounds();
    let reach = bounds.w.max(bounds.h) / 2.0;
    let ring = if mark.is_some() { (reach * 0.34).max(2.0) } else { 0.0 };
    let margin = (ring * 1.5).ceil() + 2.0;
    let corner = vec2(bounds.x, bounds.y).floor() - margin;
    let side = (vec2(bounds.right(), bounds.bottom()).ceil() + margin - corner).as_uvec2();
    let sign = mark.and_then(|color| sign(center, reach * 0.5, color));
    let mut canvas = Canvas::new(side.x as usize, side.y as usize);
    canvas.wash(Rect::new(0.0, 0.0, side.x as f32, side.y as f32), |p| {
        let p = p + corner;
        let distance = shape.distance(p);
        let cover = |distance: f32| (0.5 - distance).clamp(0.0, 1.0);
        let hot = smooth(reach * 0.85, 0.0, p.distance(center));
        let glass = ink(color.lerp(Vec3::ONE, hot * 0.72), cover(distance));
        // A dark gap sets the ring off from the glass.
        let gap = ring * 0.4;
        let is_ringed = f32::from(u8::from(ring > 0.0));
        let around = ink(Vec3::ONE, is_ringed * cover((distance - gap - ring / 2.0).abs() - ring / 2.0));
        let dark = sign.as_ref().map_or(0.0, |sign| cover(sign.distance(p))) * 0.9;
        glass * (1.0 - dark) + ink(NIGHT, dark) + around
    });
    Pinned { sprite: packer.add(canvas.into_image()), pivot: center - corner }
}

/// The sign of a colour: white has none, amber a dot, red a bar upright, green one that lies, blue a cross.
fn sign(center: Vec2, reach: f32, color: LightColor) -> Option<Shape> {
    let thin = (reach * 0.34).max(1.0);
    let bar = |ahead: Vec2| Shape::rod(center - ahead * reach, center + ahead * reach, thin);
    match color {
        LightColor::White => None,
        LightColor::Amber => Some(Shape::circle(center, (reach * 0.6).max(1.5))),
        LightColor::Red => Some(bar(Vec2::Y)),
        LightColor::Green => Some(bar(Vec2::X)),
        LightColor::Blue => Some(Shape::Union(vec![bar(Vec2::X), bar(Vec2::Y)])),
    }
}

/// A white mushroom with a red ring and a star.
fn cap(radius: f32) -> Image {
    let radius = radius * 0.80;
    let (mut canvas, center) = disc_canvas(radius);
    let dome = Shape::circle(center, radius);
    canvas.fill(&dome, |p, distance| {
        let flat = (p - center) / radius;
        let lit = 0.80 + 0.28 * flat.dot(LIGHT) - 0.22 * flat.length_squared();
        let ring = smooth(0.5, 0.0, ((distance / radius + 0.30).abs() - 0.085) * radius);
        ink((IVORY.lerp(RED, ring) * lit).min(Vec3::ONE), 1.0)
    });
    canvas.flat(&star(center, 5, radius * 0.46, radius * 0.20, 0.0), ink(RED * 0.8, 1.0));
    canvas.wash(Rect::new(0.0, 0.0, center.x * 2.0, center.y * 2.0), |p| {
        glow(Vec3::ONE, 0.30 * smooth(radius * 0.42, 0.0, (p - center - LIGHT * radius * 0.45).length()))
    });
    canvas.into_image()
}

/// Light from the skirt of a bumper that kicks.
fn flare(radius: f32) -> Image {
    let (mut canvas, center) = disc_canvas(radius * 2.2);
    let ring = Shape::Arc { center, radius: radius * 0.92, from: 0.0, to: 7.0, half_width: radius * 0.10 };
    canvas.halo(&ring, radius * 1.15, RED.lerp(AMBER, 0.45), 0.75);
    canvas.flat(&ring, glow(Vec3::new(1.0, 0.9, 0.75), 0.9));
    canvas.into_image()
}

/// The body of a flipper that points right, on a canvas with the axis at the returned point.
fn flipper_canvas(layout: &Layout, flipper: &FlipperFile, margin: f32) -> (Canvas, Vec2, Shape) {
    let (base, tip) = (layout.length(flipper.base_radius), layout.length(flipper.tip_radius));
    let length = layout.length(flipper.length);
    let thick = base.max(tip);
    let axis = Vec2::splat((thick + margin).ceil() + 1.0);
    let width = axis.x + length + tip + margin + 2.0;
    let canvas = Canvas::new(width.ceil() as usize, (axis.y * 2.0) as usize);
    let shape = Shape::Capsule { from: axis, to: axis + vec2(length, 0.0), from_radius: base, to_radius: tip };
    (canvas, axis, shape)
}

/// White body, red rubber, a steel axis. The light is on the flipper's upper side whichever way it points.
fn flipper_body(packer: &mut Packer, layout: &Layout, flipper: &FlipperFile) -> Pinned<Ticket> {
    let (mut canvas, axis, shape) = flipper_canvas(layout, flipper, 1.0);
    let rubber = layout.length(0.0030).max(1.5);
    // A right flipper is turned by about 180 degrees: its upper side is the canvas's lower one.
    let up = if flipper.hand == Hand::Left { -1.0 } else { 1.0 };
    canvas.fill(&shape, |p, distance| {
        let facing = shape.normal(p).y * up;
        let body = IVORY * (0.86 + 0.14 * facing * smooth(-rubber * 3.0, -rubber, distance));
        let across = smooth(-rubber, 0.0, distance);
        let band = RED * (0.85 + 0.35 * facing * across - 0.25 * across);
        ink(body.lerp(band.max(Vec3::ZERO), smooth(-rubber - 0.5, -rubber + 0.5, distance)), 1.0)
    });
    let hub = layout.length(flipper.base_radius) * 0.42;
    canvas.tube(&Shape::circle(axis, hub), hub, STEEL, 0.4);
    Pinned { sprite: packer.add(canvas.into_image()), pivot: axis }
}

fn flipper_shadow(packer: &mut Packer, layout: &Layout, flipper: &FlipperFile) -> Pinned<Ticket> {
    let blur = layout.length(0.005);
    let (mut canvas, axis, shape) = flipper_canvas(layout, flipper, blur);
    let bounds = shape.bounds();
    let area = Rect::new(bounds.x - blur, bounds.y - blur, bounds.w + 2.0 * blur, bounds.h + 2.0 * blur);
    canvas.wash(area, |p| ink(Vec3::ZERO, 0.55 * smooth(blur, -blur, shape.distance(p))));
    Pinned { sprite: packer.add(canvas.into_image()), pivot: axis }
}
