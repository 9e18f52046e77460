//! Pictures of moments that are always the same: `.ci/pictures` compares them with pictures that somebody has looked at.

use std::path::Path;
use std::sync::Arc;

use macroquad::texture::get_screen_data;
use macroquad::window::next_frame;
use shared::game::{Action, Bot, Game, Input, Phase};
use shared::table::{SHIPPED, Table};

use crate::assemble;
use crate::effects::Effects;
use crate::menu::{Facts, Menu, MenuView, Page, Shelved};
use crate::moment::Moment;
use crate::pictures;
use crate::render::Renderer;
use crate::screens::{self, Words};
use crate::settings::Settings;
use crate::view::{CrowdActionState, CrowdActionView, CrowdView, OtherBoard, SeatView, View};

/// The window's width and height.
pub(crate) const SIZE: (u16, u16) = (640, 360);
/// Seconds that the bot has played when a picture is taken, at the least: a ball is on its way, and something has been hit.
const PLAYED: [f64; 2] = [12.0, 9.0];
/// Frames before a picture: what is painted a piece a frame is whole then.
const FRAMES: usize = 8;
/// What the bot's habits follow from.
const SEED: u64 = 1;

/// A picture to be taken.
struct Still {
    name: String,
    table: Arc<Table>,
    view: View,
    menu: Option<MenuView>,
}

/// Takes all of them, into a folder.
///
/// # Errors
/// One line that says what is wrong.
pub(crate) async fn save(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    for still in stills()? {
        let mut renderer = Renderer::new(&still.table.file);
        for _ in 0..FRAMES {
            renderer.draw(&still.view, still.menu.as_ref());
            next_frame().await;
        }
        renderer.draw(&still.view, still.menu.as_ref());
        let file = folder.join(format!("{}.png", still.name));
        pictures::save(get_screen_data(), &file).map_err(|error| error.to_string())?;
        next_frame().await;
    }
    Ok(())
}

fn stills() -> Result<Vec<Still>, String> {
    let mut stills = Vec::new();
    let mut shelf = Vec::new();
    for shipped in SHIPPED {
        let table = Table::parse(shipped.name, shipped.source).map_err(|error| error.to_string())?;
        let table = Arc::new(table);
        let view = played(&table, PLAYED[0]);
        let shown = View { light_show: true, ..assemble::still_view(&table, Words::default(), 0.0) };
        shelf.push(Shelved { table: Arc::clone(&table), about: shipped.about.to_owned(), view: Arc::new(shown) });
        stills.push(Still { name: shipped.name.to_owned(), table, view, menu: None });
    }
    let Some(Still { table, view, .. }) = stills.first() else { return Err("no table is shipped".to_owned()) };
    let (table, view) = (Arc::clone(table), view.clone());
    let marked = View { marked_lights: true, reduced_flashing: true, text_scale: 1.6, ..view.clone() };
    let views = [("marked", marked), ("crowd", against_the_crowd(&view)), ("head-to-head", beside(&table, &view))];
    let of_view =
        |(name, view): (&str, View)| Still { name: name.to_owned(), table: Arc::clone(&table), view, menu: None };
    stills.extend(views.into_iter().map(of_view));

    let settings = Settings::default();
    let keys = screens::playing_keys(&settings.keys, table.file.cabinet.is_some());
    let facts = Facts { table: table.name.clone(), tables: shelf, keys, settings, ..Facts::default() };
    let pages = [
        ("title", Page::Title),
        ("tables", Page::Tables),
        ("against", Page::Against),
        ("settings", Page::Settings),
        ("keys", Page::Keys),
        ("how-to", Page::HowTo),
        ("pause", Page::Pause),
    ];
    stills.extend(pages.into_iter().map(|(name, page)| {
        let mut menu = Menu::default();
        menu.show(page);
        let menu = menu.view(&facts);
        Still { name: name.to_owned(), table: Arc::clone(&table), view: view.clone(), menu }
    }));
    Ok(stills)
}

/// A table on which the bot has played for so many seconds, and then until a ball is in the upper half, out of the
/// shooter lane.
fn played(table: &Arc<Table>, seconds: f64) -> View {
    let mut game = Game::new(Arc::clone(table));
    let mut bot = Bot::new(0, SEED);
    let mut effects = Effects::default();
    let tick_seconds = table.scene.tick_seconds;
    loop {
        let tick = game.tick();
        let loose: Vec<_> = Moment::of(&game, 0.0).balls.into_iter().filter(|ball| !ball.is_held).collect();
        let (width, length) = table.file.size;
        let is_high = loose.iter().any(|ball| ball.position.y > 0.5 * length && ball.position.x < 0.85 * width);
        if tick as f64 * tick_seconds >= seconds && is_high {
            break;
        }
        let mut inputs = Vec::new();
        if !matches!(game.phase(), Phase::Play { .. }) {
            inputs.extend([Action::Sit, Action::Start].map(|action| Input { tick, seat: 0, action }));
        }
        bot.play(&game, |action| inputs.push(Input { tick, seat: 0, action }));
        for event in game.step(&inputs) {
            effects.note(event, table, loose.len(), tick as f64 * tick_seconds);
        }
    }
    let words = Words { message: "SHOOT".to_owned(), keys: Vec::new(), ..Words::default() };
    let moment = Moment::of(&game, 0.0);
    let mut view = assemble::board_view(&moment, &mut effects, words, game.tick() as f64 * tick_seconds);
    assemble::fill_counters(&mut view.hud, &moment);
    let score = game.seats()[0].score.points;
    view.hud.title = "CHALLENGE".to_owned();
    view.hud.seats = vec![
        SeatView { name: "ANN".to_owned(), score, active: true, you: true, wins: 2 },
        SeatView { name: "BOB".to_owned(), score: 24_680, ..SeatView::default() },
    ];
    (view.hud.spectators, view.hud.waiting, view.hud.queue) = (12, 1, vec!["CID".to_owned()]);
    view
}

/// The same, with something that the crowd has announced.
fn against_the_crowd(view: &View) -> View {
    let states = [
        CrowdActionState::Announced(1.5),
        CrowdActionState::Ready,
        CrowdActionState::TooDear,
        CrowdActionState::AtWork(4.0),
        CrowdActionState::CoolsDown(12.0),
    ];
    let names = ["RAISE POST", "SHUT LANE", "RESET BANK", "DIM LIGHTS", "PULSE MAGNET"];
    let action = |(place, (state, name)): (usize, (CrowdActionState, &str))| CrowdActionView {
        name: name.to_owned(),
        cost: 20 + 10 * place as u32,
        state,
        votes: 5 - place as u32,
        yours: place == 1,
    };
    let actions = states.into_iter().zip(names).enumerate().map(action).collect();
    let mut view = view.clone();
    view.hud.title = "THE CROWD AGAINST ANN".to_owned();
    view.hud.crowd = Some(CrowdView { energy: (60, 100), actions, closes_in: Some(3.2), can_vote: true });
    view.hud.alarm = Some(["IN 2 S:".to_owned(), "RAISE POST".to_owned()]);
    view
}

/// The same, with another board beside it.
fn beside(table: &Arc<Table>, view: &View) -> View {
    let other = View { popups: Vec::new(), ..played(table, PLAYED[1]) };
    let mut view = view.clone();
    view.hud.title = "HEAD TO HEAD".to_owned();
    let score = 24_680;
    view.others = vec![OtherBoard { view: other, name: "BOB".to_owned(), score, state: "BALL 1".to_owned() }];
    view
}
