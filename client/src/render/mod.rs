//! Draws a [`View`]: the table, the panels beside it, and nothing else of the client.
//!
//! All art is drawn in code. What stands still is painted once for a size of the window (`cabinet`, `playfield`,
//! `furniture`, `mechanisms`, `ramps`, on a `canvas` of `shape`s): the room, and the whole table, which is shown through an
//! opening and scrolls if it is longer. What moves is cut out of one atlas of sprites (`sprites`, `dot_matrix`, `atlas`) and
//! placed by `scene`, `balls`, `mechanisms`, `flashes`, `overlay`, `hud` and `crowd`, as `lights`, `sparks` and `popups` say;
//! `minis` does both for boards that are small, `preview` for pictures of tables, `menu` for what lies over it all. `layout`, `panels` and `camera` say where; `back_buffer` shows whole frames
//! only.

mod atlas;
mod back_buffer;
mod balls;
mod cabinet;
mod camera;
mod canvas;
mod crowd;
mod dot_matrix;
mod film;
mod flashes;
mod furniture;
mod hud;
mod inserts;
mod layout;
mod lights;
mod mechanisms;
mod menu;
mod minis;
mod overlay;
mod palette;
mod panels;
mod playfield;
mod popups;
mod preview;
mod ramps;
mod scene;
mod shape;
mod sparks;
mod sprites;

use macroquad::color::WHITE;
use macroquad::material::{Material, MaterialParams, gl_use_default_material, gl_use_material, load_material};
use macroquad::math::{Rect, Vec2, vec2};
use macroquad::miniquad::{BlendFactor, BlendState, BlendValue, Equation, PipelineParams, ShaderSource};
use macroquad::texture::{DrawTextureParams, FilterMode, Image, Texture2D, draw_texture, draw_texture_ex};
use macroquad::window::{screen_dpi_scale, screen_height, screen_width};
use shared::table::TableFile;

use crate::menu::MenuView;
use crate::view::View;
use atlas::{Batch, Sprite};
use back_buffer::BackBuffer;
use camera::Camera;
use dot_matrix::Fonts;
pub(crate) use dot_matrix::grouped;
use hud::Writer;
use layout::{Layout, PixelSize};
use menu::MenuPainter;
use minis::Minis;
use overlay::OverlayPainter;
use panels::Panels;
use ramps::Ramps;
use scene::Stage;
use sprites::Sprites;

/// Draws frames. The only part of the client that draws to the screen.
pub(crate) struct Renderer {
    table: TableFile,
    blending: Blending,
    back_buffer: BackBuffer,
    camera: Camera,
    /// Everything painted for one size of the window; made by the first frame.
    art: Option<Art>,
    /// For menus; made by the first one.
    menu: Option<MenuPainter>,
}

/// What a person asks of the picture, as far as it is painted once.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Comfort {
    marked_lights: bool,
    text_scale: f32,
}

impl Comfort {
    fn of(view: &View) -> Self {
        Self { marked_lights: view.marked_lights, text_scale: view.text_scale.max(1.0) }
    }
}

/// What was painted for one size of the window.
struct Art {
    comfort: Comfort,
    layout: Layout,
    panels: Panels,
    /// The room and the panels.
    room: Texture2D,
    board: Board,
    sprites: Sprites<Sprite>,
    fonts: Fonts,
    batch: Batch,
    /// For boards that are small; made when there are any.
    minis: Option<Minis>,
}

/// What stands still of a table, as large as the table with its frame.
struct Board {
    still: Texture2D,
    /// What of it lies above balls on the board, on a clear ground, and where on the picture: most of that is empty.
    above: Option<(Texture2D, Vec2)>,
    /// The same two as they were painted: small boards are made of them.
    pictures: (Image, Option<Image>),
}

/// Why a frame was given up before it was whole.
#[derive(Debug, thiserror::Error)]
enum Abandoned {
    /// The view is of another table.
    #[error("the view has {view} elements, the table {table}")]
    OtherTable { view: usize, table: usize },
}

impl Renderer {
    /// A renderer for a table. Needs macroquad's window; paints nothing yet.
    pub(crate) fn new(table: &TableFile) -> Self {
        Self {
            table: table.clone(),
            blending: Blending::new(),
            back_buffer: BackBuffer::new(),
            camera: Camera::default(),
            art: None,
            menu: None,
        }
    }

    /// The item of the menu that is at a point of the window, as it was drawn last, and the share of its width at which.
    pub(crate) fn menu_hit(&self, at: Vec2) -> Option<(usize, f32)> {
        let (art, menu) = (self.art.as_ref()?, self.menu.as_ref()?);
        let window = vec2(screen_width(), screen_height()) * screen_dpi_scale();
        menu.hit(at * art.layout.size.to_vec() / window.max(Vec2::ONE))
    }

    /// Draws one frame and shows it, with a menu over it. If the view does not belong to the table, the last whole frame stays.
    pub(crate) fn draw(&mut self, view: &View, menu: Option<&MenuView>) {
        let Self { table, blending, back_buffer, camera, art, menu: painter } = self;

        // 1. The art for the window's size.
        let dpi_scale = screen_dpi_scale();
        let size = PixelSize::of_window(screen_width() * dpi_scale, screen_height() * dpi_scale);
        let comfort = Comfort::of(view);
        let current = art.take().filter(|art| art.layout.size == size && art.comfort == comfort);
        let art = art.insert(current.unwrap_or_else(|| Art::paint(size, comfort, table)));

        let painter = match menu {
            Some(menu) => {
                let current = painter.take().filter(|painter| painter.fits(size, comfort.text_scale));
                let painter = painter.insert(current.unwrap_or_else(|| MenuPainter::new(size, comfort.text_scale)));
                painter.lay_out(menu, art.panels.below_title());
                painter.paint_preview(menu, blending);
                Some((painter, menu))
            }
            None => None,
        };

        // 2. The frame, whole, into the back buffer.
        let bottom = camera.follow(view, art.layout.reach());
        let painted = back_buffer.frame(size, || {
            paint_frame(table, blending, art, view, bottom).map(|()| {
                if let Some((painter, menu)) = painter {
                    blending.layer();
                    painter.draw(menu, view.clock);
                }
            })
        });

        // 3. The newest whole frame on the screen, in one blit.
        blending.overwrite();
        match painted {
            Ok(finished) => finished.present(),
            Err(reason) => {
                tracing::debug!(%reason, "frame abandoned");
                if let Some(finished) = back_buffer.last_whole() {
                    finished.present();
                }
            }
        }
        gl_use_default_material();
    }
}

/// Paints one frame with the camera that is set; of a table that scrolls, the part from `bottom` metres up.
fn paint_frame(
    table: &TableFile,
    blending: &Blending,
    art: &mut Art,
    view: &View,
    bottom: f32,
) -> Result<(), Abandoned> {
    let counts = (view.elements.len(), table.elements.len());
    if counts.0 != counts.1 {
        return Err(Abandoned::OtherTable { view: counts.0, table: counts.1 });
    }
    let Art { comfort, layout: resting, panels, room, board, sprites, fonts, batch, minis } = art;
    let calmed = view.reduced_flashing.then(|| lights::calmed(view));
    let view = calmed.as_ref().unwrap_or(view);
    let shaken = resting.scrolled(bottom).shaken(view.cabinet);
    let layout = &match view.tilt.filter(|_| !view.reduced_flashing) {
        Some(seconds) => shaken.jolted(seconds),
        None => shaken,
    };
    let corner = layout.cabinet.point();

    // 1. What stands still covers every pixel of the last frame.
    blending.overwrite();
    for part in around(resting.size.to_vec(), layout.covered()) {
        let params = DrawTextureParams { source: Some(part), ..DrawTextureParams::default() };
        draw_texture_ex(room, part.x, part.y, WHITE, params);
    }
    draw_texture(&board.still, corner.x, corner.y, WHITE);

    // 2. What moves on the table.
    blending.layer();
    let draw_above = || {
        if let Some((above, place)) = &board.above {
            draw_texture(above, corner.x + place.x, corner.y + place.y, WHITE);
        }
    };
    let mut stage = Stage { layout, panels, table, sprites, fonts, batch };
    stage.draw(view, draw_above);

    // 3. What the physics sees of it.
    if let Some(overlay) = &view.overlay {
        OverlayPainter { layout, panels, sprites, fonts, batch }.draw(overlay);
    }
    batch.flush();

    // 4. The panels once more where a table scrolls below them.
    if layout.cabinet.y < layout.opening.y {
        let above = Rect { h: layout.opening.y, y: 0.0, ..layout.opening };
        let params = DrawTextureParams { source: Some(above), ..DrawTextureParams::default() };
        blending.overwrite();
        draw_texture_ex(room, above.x, above.y, WHITE, params);
        blending.layer();
    }

    // 5. Text.
    if let Some(overlay) = &view.overlay {
        OverlayPainter { layout, panels, sprites, fonts, batch }.words(overlay);
    }
    let mut writer = Writer { panels, fonts, batch };
    let slots = writer.panels(view, vec2(table.size.0 as f32, table.size.1 as f32));
    writer.banner(&view.hud, sprites.plate, sprites::banner_area(resting, panels));
    let blinking = if view.reduced_flashing { 0.0 } else { view.clock };
    writer.alarm(&view.hud, sprites.plate, sprites.dot, crowd::alarm_area(resting, panels), blinking);
    writer.film(view.film.as_ref(), sprites.plate, sprites.dot, film::film_area(resting, panels));
    batch.flush();

    // 6. The boards that are small.
    for (slot, other) in slots.iter().zip(&view.others) {
        let current = minis.take().filter(|minis| minis.fits(slot.board));
        let minis =
            minis.insert(current.unwrap_or_else(|| Minis::paint(slot.board, board, comfort.marked_lights, table)));
        let calmed = view.reduced_flashing.then(|| lights::calmed(&other.view));
        minis.draw(slot.board, table, calmed.as_ref().unwrap_or(&other.view), blending);
    }
    Ok(())
}

impl Art {
    /// Paints everything for a size of the window.
    fn paint(size: PixelSize, comfort: Comfort, table: &TableFile) -> Self {
        let layout = Layout::new(size, vec2(table.size.0 as f32, table.size.1 as f32));
        let panels = Panels::new(&layout, comfort.text_scale);
        let room = still_texture(&canvas::paint_in_bands(size.width, size.height, |canvas| {
            cabinet::paint(canvas, &layout, &panels);
        }));
        let board = Board::paint(&layout.of_board(), table);
        let (batch, sprites, fonts) = sprites::build(&layout, &panels, comfort.marked_lights, table);
        Self { comfort, layout, panels, room, board, sprites, fonts, batch, minis: None }
    }
}

impl Board {
    /// Paints a layout of the table alone.
    fn paint(layout: &Layout, table: &TableFile) -> Self {
        let PixelSize { width, height } = layout.size;
        let still = canvas::paint_in_bands(width, height, |canvas| {
            cabinet::room(canvas, layout);
            playfield::paint(canvas, layout, table);
            mechanisms::paint(canvas, layout, table, false);
            furniture::paint(canvas, layout, table);
        });
        let ramps = Ramps::of(layout, table);
        let above = ramps.map(|ramps| canvas::paint_in_bands(width, height, |canvas| ramps.paint(canvas)));
        Self::of((still, above))
    }

    /// Of what was painted.
    fn of(pictures: (Image, Option<Image>)) -> Self {
        let above = pictures.1.as_ref().map(|above| {
            let (part, place) = canvas::cropped(above);
            (still_texture(&part), place)
        });
        Self { still: still_texture(&pictures.0), above, pictures }
    }

    /// The same at another size, smaller: made within milliseconds, where painting anew would hold up the game.
    fn reduced(&self, size: PixelSize) -> Self {
        let reduced = |picture: &Image| canvas::reduced(picture, size.width, size.height);
        let (still, above) = &self.pictures;
        Self::of((reduced(still), above.as_ref().map(reduced)))
    }
}

/// The parts of a picture around a place in it.
fn around(picture: Vec2, place: Rect) -> impl Iterator<Item = Rect> {
    let upper = Rect::new(0.0, 0.0, picture.x, place.y);
    let lower = Rect::new(0.0, place.bottom(), picture.x, picture.y - place.bottom());
    let left = Rect::new(0.0, place.y, place.x, place.h);
    let right = Rect::new(place.right(), place.y, picture.x - place.right(), place.h);
    [upper, lower, left, right].into_iter().filter(|part| part.w > 0.0 && part.h > 0.0)
}

/// A picture that is drawn pixel for pixel.
fn still_texture(picture: &Image) -> Texture2D {
    let texture = Texture2D::from_image(picture);
    texture.set_filter(FilterMode::Nearest);
    texture
}

/// How colours are laid over each other.
struct Blending {
    overwrite: Option<Material>,
    layer: Option<Material>,
}

impl Blending {
    /// Should a driver refuse our materials, everything is drawn with macroquad's own: lights are then too dark, but
    /// the game is playable.
    fn new() -> Self {
        let premultiplied =
            BlendState::new(Equation::Add, BlendFactor::One, BlendFactor::OneMinusValue(BlendValue::SourceAlpha));
        Self { overwrite: material(None), layer: material(Some(premultiplied)) }
    }

    /// From here on, pixels replace what is below them.
    fn overwrite(&self) {
        use_material(self.overwrite.as_ref());
    }

    /// From here on, pixels have premultiplied alpha: they cover, or add light where their alpha is 0.
    fn layer(&self) {
        use_material(self.layer.as_ref());
    }
}

fn use_material(material: Option<&Material>) {
    match material {
        Some(material) => gl_use_material(material),
        None => gl_use_default_material(),
    }
}

fn material(color_blend: Option<BlendState>) -> Option<Material> {
    const VERTEX: &str = "#version 100
        attribute vec3 position;
        attribute vec2 texcoord;
        attribute vec4 color0;
        varying highp vec2 uv;
        varying lowp vec4 color;
        uniform mat4 Model;
        uniform mat4 Projection;
        void main() {
            gl_Position = Projection * Model * vec4(position, 1);
            color = color0 / 255.0;
            uv = texcoord;
        }";
    const FRAGMENT: &str = "#version 100
        varying lowp vec4 color;
        varying highp vec2 uv;
        uniform sampler2D Texture;
        void main() {
            gl_FragColor = color * texture2D(Texture, uv);
        }";
    let params = MaterialParams {
        pipeline_params: PipelineParams { color_blend, ..PipelineParams::default() },
        ..MaterialParams::default()
    };
    let loaded = load_material(ShaderSource::Glsl { vertex: VERTEX, fragment: FRAGMENT }, params);
    loaded.inspect_err(|error| tracing::warn!(%error, "material refused, drawing without it")).ok()
}
