//! Rules, one event at a time: what they go by is how things were when it happened.

use std::sync::Arc;

use super::{Effect, Occasion, RuleState, Score, run};
use crate::physics::{EventKind, World};
use crate::table::Table;

/// Elements: 0 the frame, 1 to 3 drop targets, 4 a rollover, 5 to 8 lights, 9 the drain.
const TABLE: &str = r#"(
    format: 1, physics: 3, name: "Rules", size: (0.4, 0.8), gravity: (0.0, -0.793), rest_speed: 0.02,
    ball: (radius: 0.0135, mass: 0.08, start: (0.2, 0.7)),
    materials: { "wood": (restitution: 0.3) },
    elements: [
        Wall(name: "frame", material: "wood", points: [(0.0, 0.0), (0.0, 0.8), (0.4, 0.8), (0.4, 0.0), (0.0, 0.0)]),
        DropTarget(name: "drop 1", material: "wood", from: (0.1, 0.5), to: (0.13, 0.5), threshold: 0.1),
        DropTarget(name: "drop 2", material: "wood", from: (0.2, 0.5), to: (0.23, 0.5), threshold: 0.1),
        DropTarget(name: "other", material: "wood", from: (0.3, 0.5), to: (0.33, 0.5), threshold: 0.1),
        Rollover(name: "lane", from: (0.0, 0.4), to: (0.05, 0.4)),
        Light(name: "a", center: (0.1, 0.3), radius: 0.01, color: Red),
        Light(name: "b", center: (0.2, 0.3), radius: 0.01, color: Red),
        Light(name: "c", center: (0.3, 0.3), radius: 0.01, color: Red),
        Light(name: "d", center: (0.3, 0.2), radius: 0.01, color: Red),
        Drain(name: "drain", from: (0.0, 0.05), to: (0.4, 0.05)),
    ],
    groups: { "bank": ["drop 1", "drop 2"], "a and b": ["a", "b"] },
    rules: (balls: 1, max_multiplier: 1, max_extra_balls: 1, ball_save: (lasts: 5.0), on: [RULES]))"#;

const PASS: Occasion = Occasion::Physics(EventKind::Passed { element: 4 });

struct Stage {
    table: Table,
    world: World,
    state: RuleState,
    score: Score,
}

impl Stage {
    fn new(rules: &str) -> Self {
        let table = match Table::parse("rules.ron", &TABLE.replace("RULES", rules)) {
            Ok(table) => table,
            Err(error) => panic!("{error}"),
        };
        let world = World::new(Arc::clone(&table.scene));
        let mut state = RuleState::default();
        state.lights.reserve();
        Self { table, world, state, score: Score::default() }
    }

    /// The points that an event makes.
    fn points(&mut self, occasion: Occasion) -> u64 {
        let before = self.score.points;
        self.effects(occasion);
        self.score.points - before
    }

    fn effects(&mut self, occasion: Occasion) -> Vec<Effect> {
        let mut effects = Vec::new();
        run(&self.table, occasion, &mut self.score, &mut self.state, &mut self.world, |effect| effects.push(effect));
        effects
    }

    /// A target falls, as the physics tells of it.
    fn fell(&mut self, target: u16) -> u64 {
        self.world.lower(target);
        self.points(Occasion::Physics(EventKind::Felled { element: target + 1, speed: 1.0 }))
    }
}

#[test]
fn what_one_rule_raises_is_down_for_every_other_rule_of_the_event() {
    let mut stage = Stage::new(
        r#"(event: Hit("drop 2"), run: [Score(1), Raise("bank")]),
           (event: AllDown("bank"), run: [Score(10), Raise("bank")]),
           (event: AllDown("bank"), when: [Lit("a")], run: [Score(100)]),
           (event: Hit("drop 2"), when: [Down("bank")], run: [Score(1000)]),
           (event: Hit("drop 2"), when: [Up("other")], run: [Score(10000), Lower("other")]),
           (event: Hit("drop 2"), when: [Up("other")], run: [Score(100000)]),"#,
    );
    stage.state.lights.light(0b1);
    assert_eq!(stage.fell(0), 0);
    assert_eq!(stage.fell(1), 111_111);
}

#[test]
fn lights_that_one_rule_switches_are_as_they_were_for_every_other_rule_of_the_event() {
    let mut stage = Stage::new(
        r#"(event: Pass("lane"), when: [Unlit("a")], run: [Score(1), Light("a")]),
           (event: Pass("lane"), when: [Lit("a")], run: [Score(10), Unlight("a"), Light("b")]),
           (event: Pass("lane"), when: [Lit("a")], run: [Score(100)]),
           (event: Pass("lane"), when: [Lit("b")], run: [Score(1000)]),"#,
    );
    assert_eq!([(); 3].map(|()| stage.points(PASS)), [1, 110, 1001]);
}

#[test]
fn a_group_is_lit_if_all_of_it_is_and_unlit_if_nothing_of_it_is() {
    let mut stage = Stage::new(
        r#"(event: Pass("lane"), when: [Lit("a and b")], run: [Score(1)]),
           (event: Pass("lane"), when: [AnyLit("a and b")], run: [Score(10)]),
           (event: Pass("lane"), when: [Unlit("a and b")], run: [Score(100)]),
           (event: Pass("lane"), when: [AnyLit("a and b"), Unlit("c")], run: [Score(1000)]),
           (event: Pass("lane"), when: [OneBall], run: [Score(10000)]),
           (event: Pass("lane"), when: [Multiball], run: [Score(100000)]),"#,
    );
    assert_eq!(stage.points(PASS), 10_100);
    stage.state.lights.light(0b1);
    assert_eq!(stage.points(PASS), 11_010);
    stage.state.lights.light(0b110);
    for place in [0.1, 0.3] {
        stage.world.serve(glam::DVec2::new(place, 0.7));
    }
    assert_eq!(stage.points(PASS), 100_011);
}

#[test]
fn every_rule_of_a_set_that_is_completed_runs_whatever_another_puts_out() {
    let mut stage = Stage::new(
        r#"(event: Pass("lane"), run: [Light("a and b")]),
           (event: AllLit("a and b"), run: [Score(1), Unlight("a and b"), Light("c")]),
           (event: AllLit("a and b"), run: [Score(10)]),
           (event: AllLit("a and b"), when: [Lit("c")], run: [Score(100)]),
           (event: AllLit("c"), run: [Score(1000)]),"#,
    );
    assert_eq!([(); 3].map(|()| stage.points(PASS)), [1011, 111, 111], "c is complete once");
}

#[test]
fn sets_that_complete_each_other_do_not_do_so_for_ever() {
    let mut stage = Stage::new(
        r#"(event: Pass("lane"), run: [Light("a")]),
           (event: AllLit("a"), run: [Score(1), Unlight("a"), Light("b")]),
           (event: AllLit("b"), run: [Score(10), Unlight("b"), Light("a")]),"#,
    );
    assert_eq!(stage.points(PASS), 22);
}

#[test]
fn a_light_that_goes_out_by_itself_is_an_event() {
    let mut stage = Stage::new(
        r#"(event: Pass("lane"), run: [LightFor("a and b", 2.0)]),
           (event: Out("a"), when: [Unlit("a")], run: [Score(1), LightFor("d", 1.0)]),
           (event: Out("d"), run: [Score(10)]),"#,
    );
    stage.points(PASS);
    assert_eq!((stage.state.lights.lit(), stage.state.due_in(&stage.table)), (0b11, Some(2000)));
    let out = stage.state.pass(&stage.table, 2000);
    assert_eq!((out, stage.points(Occasion::Out(out))), (0b11, 1));
    let out = stage.state.pass(&stage.table, 1000);
    assert_eq!((out, stage.points(Occasion::Out(out)), stage.state.lights.lit()), (0b1000, 10, 0));
}

#[test]
fn rules_ask_for_balls() {
    let mut stage = Stage::new(r#"(event: Pass("lane"), run: [Serve, SaveBalls(3.0), ExtraBall])"#);
    assert_eq!(stage.effects(PASS), [Effect::Serve, Effect::ExtraBall]);
    assert_eq!((stage.state.save.is_on(), stage.state.due_in(&stage.table)), (true, Some(3000)));
}
