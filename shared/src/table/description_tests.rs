//! The examples in the description of the format are good ones: whoever copies them gets what it says.

use super::Table;
use super::format::CabinetFile;

#[test]
fn the_example_in_the_description_is_a_good_table() {
    let description = include_str!("../../tables/README.md");
    let example =
        description.split("## A whole table").nth(1).and_then(|text| text.find("    (").map(|at| &text[at..]));
    match Table::parse("README.md", example.unwrap_or_default()) {
        Ok(table) => assert_eq!(table.name, "Shed"),
        Err(error) => panic!("{error}"),
    }
    for (name, text) in [("format", super::FORMAT_VERSION), ("physics", crate::physics::PHYSICS_VERSION)] {
        let row = description.lines().find(|line| line.starts_with(&format!("| `{name}`"))).unwrap_or_default();
        assert!(row.ends_with(&format!(": {text} |")), "{row}");
    }
}

/// Its smaller examples, put into the whole table all at once.
#[test]
fn every_element_and_rule_in_the_description_is_a_good_one() {
    let description = include_str!("../../tables/README.md");
    let section = |title: &str| {
        let text = description.split(title).nth(1).unwrap_or_default();
        text.split("\n## ").next().unwrap_or_default()
    };
    let is_example = |line: &&str| line.starts_with("    ") && !line.trim_start().starts_with("//");
    let examples = |title: &str| section(title).lines().filter(is_example).collect::<Vec<_>>().join("\n");
    let elements = examples("\n## Elements");
    let rules = section("\n## Rules").lines().filter(|line| line.starts_with("    (event:"));
    let rules = rules.collect::<Vec<_>>().join("\n");
    let ball_save = section("\n## Rules").lines().find(|line| line.trim_start().starts_with("ball_save:"));
    let heads = [ball_save.unwrap_or_default(), &examples("\n## The crowd")].join("\n");
    let whole = section("\n## A whole table");
    let table = whole.find("    (").map(|at| &whole[at..]).unwrap_or_default();
    // Room for all of them, and every material that they are of.
    let table = table
        .replace("size: (0.4, 0.8)", "size: (0.514, 1.067)")
        .replace("start: (0.2, 0.6)", "start: (0.46, 0.4)")
        .replace("gravity:", &format!("{}\n floors: [(0.0, -2.5)], gravity:", examples("\n## Cabinet")))
        .replace(
            "materials: {",
            "materials: { \"plastic\": (restitution: 0.3), \"rail\": (restitution: 0.5, friction: 0.1),",
        )
        .replace(
            "elements: [",
            &format!("groups: {{ \"bank\": [\"fence\"], \"locks\": [\"lock\"] }}, elements: [\n{elements}"),
        )
        .replace("on: [", &format!("{heads}\n on: [\n{rules}\n"));
    match Table::parse("README.md", &table) {
        Ok(table) => {
            assert_eq!(table.file.cabinet, Some(CabinetFile::default()), "it states the defaults");
            assert_eq!((table.scene.magnets.len(), table.scene.hinges.len(), table.scene.saucers.len()), (1, 2, 1));
            assert!(table.scene.needs.floors && table.file.rules.on.len() == 15);
            assert_eq!(table.rules.crowd.map(|crowd| crowd.actions.len()), Some(3));
            assert_eq!((table.scene.targets, table.scene.targets_down), (1, 1));
            let save = table.rules.ball_save.map(|save| (save.lasts, save.saves, save.grace, save.light.count_ones()));
            assert_eq!(save, Some((10.0, 1, 2.0, 1)));
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_scene_in_the_description_is_a_good_scene() {
    let description = include_str!("../../tables/README.md");
    let example = description.find("    // Two balls in a box").map(|at| &description[at..]).unwrap_or_default();
    let example = example.split("\nMetres").next().unwrap_or_default();
    match Table::parse("README.md", example) {
        Ok(table) => assert_eq!((table.scene.start.len(), table.scene.kinds.len(), table.has_rules), (2, 2, false)),
        Err(error) => panic!("{error}"),
    }
}
