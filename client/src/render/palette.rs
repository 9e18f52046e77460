//! The colours of the picture: few, and one accent for each thing that a player must tell apart.

use macroquad::color::Color;
use macroquad::math::Vec3;
use shared::table::format::LightColor;

/// Playfield far from the light.
pub(super) const NIGHT: Vec3 = hex(0x04_08_1C);
/// Playfield in the light.
pub(super) const DUSK: Vec3 = hex(0x20_3A_8C);
/// Painted decor on the playfield.
pub(super) const DECOR: Vec3 = hex(0x4A_6C_D0);
/// Top of raised plastic.
pub(super) const PLASTIC: Vec3 = hex(0x5A_2A_86);
/// Its lower end.
pub(super) const PLASTIC_DEEP: Vec3 = hex(0x27_10_4E);
/// Printed lines on plastic.
pub(super) const PRINT: Vec3 = hex(0xE0_8C_E8);
/// Outer frame and shooter lane.
pub(super) const WOOD: Vec3 = hex(0x5A_30_18);
/// Grain of the same.
pub(super) const WOOD_DARK: Vec3 = hex(0x26_12_0A);
/// Rails, gates, the ball.
pub(super) const STEEL: Vec3 = hex(0xB4_BE_CE);
/// Coils.
pub(super) const COPPER: Vec3 = hex(0xC4_76_3C);
/// Rubber rings.
pub(super) const RUBBER: Vec3 = hex(0xB9_B4_A6);
/// Caps of bumpers and bodies of flippers.
pub(super) const IVORY: Vec3 = hex(0xE8_E4_D8);
/// What kicks, and warnings.
pub(super) const RED: Vec3 = hex(0xE2_32_2C);
/// Lit dots of the display, and whatever asks for attention.
pub(super) const AMBER: Vec3 = hex(0xFF_A8_20);
/// Quiet text.
pub(super) const AMBER_DIM: Vec3 = hex(0xA8_66_18);
/// Dots of the display that are not lit.
pub(super) const DOT_OFF: Vec3 = hex(0x24_17_0A);
/// Glass of the display.
pub(super) const GLASS: Vec3 = hex(0x0B_07_06);
/// Second accent: what is safe or good.
pub(super) const ICE: Vec3 = hex(0x7C_C8_FF);

/// A colour as written on a web page.
const fn hex(code: u32) -> Vec3 {
    Vec3::new(((code >> 16) & 0xFF) as f32 / 255.0, ((code >> 8) & 0xFF) as f32 / 255.0, (code & 0xFF) as f32 / 255.0)
}

/// The shade of a lit insert.
pub(super) const fn light(color: LightColor) -> Vec3 {
    match color {
        LightColor::Amber => hex(0xFF_B0_28),
        LightColor::Red => hex(0xFF_3C_30),
        LightColor::Blue => hex(0x38_9C_FF),
        LightColor::Green => hex(0x48_E8_8C),
        LightColor::White => hex(0xF4_F0_E0),
    }
}

/// Tint of a sprite that covers what lies below.
pub(super) fn tint(color: Vec3, alpha: f32) -> Color {
    Color::new(color.x * alpha, color.y * alpha, color.z * alpha, alpha)
}

/// Tint of a sprite that only adds light.
pub(super) fn shine(color: Vec3, strength: f32) -> Color {
    Color::new(color.x * strength, color.y * strength, color.z * strength, 0.0)
}
