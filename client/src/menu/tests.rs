//! Menus without a window.

use super::*;

fn title() -> Menu {
    let mut menu = Menu::default();
    menu.show(Page::Title);
    menu
}

fn facts() -> Facts {
    Facts { table: "Classic".to_owned(), ..Facts::default() }
}

fn press(menu: &mut Menu, keys: &[KeyCode]) -> Option<MenuAct> {
    keys.iter().fold(None, |done, key| done.or(menu.input(MenuInput::Key(*key), &facts())))
}

fn label(menu: &Menu) -> String {
    let view = menu.view(&facts()).unwrap();
    view.items[view.focus].label.clone()
}

/// Goes down to an item.
fn to(menu: &mut Menu, wanted: &str) {
    for _ in 0..20 {
        if label(menu) == wanted {
            return;
        }
        press(menu, &[KeyCode::Down]);
    }
    panic!("no item {wanted}");
}

#[test]
fn enter_on_the_title_plays() {
    assert_eq!(press(&mut title(), &[KeyCode::Enter]), Some(MenuAct::Play));
    assert_eq!(press(&mut title(), &[KeyCode::Space]), Some(MenuAct::Play));
}

#[test]
fn the_focus_goes_round_and_skips_what_can_only_be_read() {
    let mut menu = title();
    press(&mut menu, &[KeyCode::Up]);
    assert_eq!(label(&menu), "QUIT");
    press(&mut menu, &[KeyCode::Down]);
    assert_eq!(label(&menu), "PLAY");
    to(&mut menu, "AGAINST SPECTATORS");
    press(&mut menu, &[KeyCode::Enter]);
    assert_eq!((menu.page(), label(&menu)), (Some(Page::Against), "CHALLENGE".to_owned()));
    menu.input(MenuInput::Hover(0), &facts());
    assert_eq!(label(&menu), "CHALLENGE", "a heading has no focus");
    menu.input(MenuInput::Wheel(-1), &facts());
    assert_eq!(label(&menu), "CHALLENGE", "a wheel does not go round");
}

#[test]
fn escape_goes_back_page_by_page_and_quits_from_the_title_at_the_second_time_only() {
    let mut menu = title();
    to(&mut menu, "AGAINST SPECTATORS");
    press(&mut menu, &[KeyCode::Enter]);
    to(&mut menu, "JOIN BY ADDRESS");
    press(&mut menu, &[KeyCode::Enter]);
    assert_eq!(menu.page(), Some(Page::Join(Role::Play)));
    press(&mut menu, &[KeyCode::Escape]);
    assert_eq!((menu.page(), label(&menu)), (Some(Page::Against), "JOIN BY ADDRESS".to_owned()));
    press(&mut menu, &[KeyCode::Escape]);
    assert_eq!(press(&mut menu, &[KeyCode::Escape]), None);
    assert_eq!(press(&mut menu, &[KeyCode::Escape]), Some(MenuAct::Quit));
    let mut paused = Menu::default();
    paused.show(Page::Pause);
    assert_eq!(press(&mut paused, &[KeyCode::Escape]), Some(MenuAct::Resume));
}

#[test]
fn the_pointer_focuses_and_presses() {
    let mut menu = title();
    assert_eq!(menu.input(MenuInput::Hover(2), &facts()), None);
    assert_eq!(label(&menu), "WATCH");
    assert_eq!(menu.input(MenuInput::Press(6, 0.0), &facts()), Some(MenuAct::Quit));
    assert_eq!(menu.input(MenuInput::Press(99, 0.0), &facts()), None);
}

#[test]
fn an_address_is_typed_checked_and_joined() {
    let mut menu = title();
    to(&mut menu, "WATCH");
    press(&mut menu, &[KeyCode::Enter]);
    assert_eq!(press(&mut menu, &[KeyCode::Enter]), None);
    assert!(menu.view(&facts()).unwrap().problem.contains("would be right"));
    for letter in "local host\u{e9}".chars() {
        menu.input(MenuInput::Char(letter), &facts());
    }
    assert_eq!(label(&menu), "localhost");
    assert!(menu.view(&facts()).unwrap().problem.is_empty(), "it is mended");
    let join = |address: &str| Some(MenuAct::Join { address: address.to_owned(), role: Role::Watch });
    assert_eq!(press(&mut menu, &[KeyCode::Enter]), join("localhost:7777"));
    menu.input(MenuInput::Paste(" :1x \n".to_owned()), &facts());
    press(&mut menu, &[KeyCode::Backspace]);
    assert_eq!(press(&mut menu, &[KeyCode::Down, KeyCode::Enter]), join("localhost:1"));
    menu.input(MenuInput::Press(1, 0.5), &facts());
    menu.input(MenuInput::Paste("9".repeat(1000)), &facts());
    assert!(label(&menu).len() <= MOST_ADDRESS);
}

#[test]
fn every_page_has_something_to_choose_and_a_way_back() {
    let rooms = [Room::Own, Room::Hosted("10.0.0.1:7777".to_owned()), Room::Guest("far:1".to_owned())];
    for room in rooms {
        for has_place in [false, true] {
            let facts = Facts { room: room.clone(), has_place, ..facts() };
            for page in [
                Page::Title,
                Page::Against,
                Page::Join(Role::Play),
                Page::Join(Role::Watch),
                Page::Tables,
                Page::Settings,
                Page::Keys,
                Page::HowTo,
                Page::Pause,
                Page::Opened,
                Page::Connecting,
                Page::Lost,
            ] {
                let mut menu = Menu::default();
                menu.show(page);
                let view = menu.view(&facts).unwrap();
                assert!(view.items[view.focus].can_have_focus(), "{page:?}");
                let leaves = |item: &Item| match &item.control {
                    Control::Back => true,
                    Control::Act(act) => matches!(act, MenuAct::Quit | MenuAct::LeaveToTitle | MenuAct::Resume),
                    _ => false,
                };
                assert!(view.items.iter().any(leaves), "{page:?}");
            }
        }
    }
}

fn settings_of(facts: &Facts, page: Page) -> (Menu, MenuView) {
    let mut menu = Menu::default();
    menu.show(page);
    let view = menu.view(facts).unwrap();
    (menu, view)
}

#[test]
fn settings_are_changed_by_arrows_enter_and_pointer_within_their_ranges() {
    let mut facts = facts();
    facts.settings.volume = 95;
    let (mut menu, view) = settings_of(&facts, Page::Settings);
    let volume = view.items.iter().position(|item| item.label == "VOLUME").unwrap();
    menu.input(MenuInput::Hover(volume), &facts);
    let key = |menu: &mut Menu, key| menu.input(MenuInput::Key(key), &facts);
    let set = |value| Some(MenuAct::Set(Setting::Volume, value));
    assert_eq!((key(&mut menu, KeyCode::Right), key(&mut menu, KeyCode::Left)), (set(100), set(85)));
    assert_eq!(menu.input(MenuInput::Press(volume, 0.52), &facts), set(50));
    assert_eq!(menu.input(MenuInput::Press(volume, f32::NAN), &facts), set(0));
    let screen = view.items.iter().position(|item| item.label == "FULL SCREEN").unwrap();
    assert_eq!(menu.input(MenuInput::Press(screen, 0.0), &facts), Some(MenuAct::Set(Setting::FullScreen, 1)));
}

#[test]
fn a_name_is_taken_as_it_is_typed_when_others_can_be_shown_it() {
    let facts = facts();
    let (mut menu, _) = settings_of(&facts, Page::Settings);
    let named = |name: &str| Some(MenuAct::Name(name.to_owned()));
    assert_eq!(menu.input(MenuInput::Char('A'), &facts), named("A"));
    assert_eq!(menu.input(MenuInput::Char(' '), &facts), named("A"));
    assert_eq!(menu.input(MenuInput::Char('B'), &facts), named("A B"));
    assert_eq!(menu.input(MenuInput::Paste("x".repeat(99)), &facts), named(&format!("A B{}", "x".repeat(21))));
    assert_eq!(menu.input(MenuInput::Char('\u{202e}'), &facts), named(&format!("A B{}", "x".repeat(21))));
    menu.input(MenuInput::Key(KeyCode::Backspace), &facts);
    assert_eq!(menu.input(MenuInput::Char('\u{202e}'), &facts), None);
    assert!(!menu.view(&facts).unwrap().problem.is_empty());
}

#[test]
fn a_key_is_added_taken_away_or_refused() {
    let mut facts = facts();
    let (mut menu, _) = settings_of(&facts, Page::Keys);
    let keys = |facts: &Facts| facts.settings.keys.labels(settings::Control::LeftFlipper, MOST_KEYS);
    let press = |menu: &mut Menu, facts: &mut Facts, key| {
        if let Some(MenuAct::Bind(bindings)) = menu.input(MenuInput::Key(key), facts) {
            facts.settings.keys = bindings;
        }
    };
    press(&mut menu, &mut facts, KeyCode::Enter);
    press(&mut menu, &mut facts, KeyCode::X);
    assert_eq!(keys(&facts), "X, L SHIFT, Z, LEFT ARROW");
    press(&mut menu, &mut facts, KeyCode::Enter);
    press(&mut menu, &mut facts, KeyCode::RightShift);
    assert!(menu.view(&facts).unwrap().problem.contains("RIGHT FLIPPER"));
    press(&mut menu, &mut facts, KeyCode::Tab);
    assert!(menu.view(&facts).unwrap().problem.contains("needs that key"));
    press(&mut menu, &mut facts, KeyCode::LeftShift);
    assert_eq!(keys(&facts), "X, Z, LEFT ARROW");
    press(&mut menu, &mut facts, KeyCode::Enter);
    press(&mut menu, &mut facts, KeyCode::Escape);
    assert_eq!((menu.page(), keys(&facts).as_str()), (Some(Page::Keys), "X, Z, LEFT ARROW"), "only the waiting ends");
}

#[test]
fn a_table_is_played_at_once_or_taken_for_a_room() {
    let table = std::sync::Arc::new(shared::table::Table::shipped("classic").unwrap().unwrap());
    let shelved = Shelved { table, about: String::new(), view: Default::default() };
    let facts = Facts { tables: vec![shelved.clone()], ..facts() };
    let mut menu = title();
    to(&mut menu, "TABLES");
    press(&mut menu, &[KeyCode::Enter]);
    assert_eq!(menu.input(MenuInput::Press(0, 0.5), &facts), Some(MenuAct::PlayOn(shelved.clone())));
    press(&mut menu, &[KeyCode::Escape]);
    to(&mut menu, "AGAINST SPECTATORS");
    press(&mut menu, &[KeyCode::Enter]);
    to(&mut menu, "TABLE: Classic");
    press(&mut menu, &[KeyCode::Enter]);
    assert_eq!(menu.input(MenuInput::Key(KeyCode::Enter), &facts), Some(MenuAct::Take(shelved)));
    menu.show_title();
    assert_eq!(menu.page(), Some(Page::Against), "it is above the title");
}
