//! `feel`: how the table feels, as a table in Markdown, as JSON, and as two plots.

use std::ops::Range;
use std::path::Path;

use plotters::prelude::*;
use shared::feel::{Report, aim, catches};

use crate::Feel;
use crate::subcommands::{print, write};

const SIZE: (u32, u32) = (960, 600);
const COLORS: [RGBColor; 4] =
    [RGBColor(0x2b, 0x7b, 0xba), RGBColor(0xc0, 0x1f, 0x3a), RGBColor(0x3a, 0x8f, 0x4d), RGBColor(0xe0, 0x8e, 0x0b)];

/// The subcommand.
pub(crate) fn feel(arguments: &Feel) -> Result<(), String> {
    let report = Report::of_all(|family| eprintln!("played: {family}"));
    print(&report.to_string())?;
    if let Some(path) = &arguments.json {
        let text = serde_json::to_string_pretty(&report).map_err(|error| format!("cannot write JSON: {error}"))?;
        write(path, &format!("{text}\n"))?;
    }
    if let Some(folder) = &arguments.svg {
        plots(folder)?;
    }
    match report.failures().as_slice() {
        [] => Ok(()),
        failures => Err(format!("out of range:\n{}", failures.join("\n"))),
    }
}

/// A curve with its name.
type Curve = (String, Vec<(f64, f64)>);

/// What is drawn.
struct Plot<'a> {
    title: &'a str,
    axes: [&'a str; 2],
    curves: Vec<Curve>,
    /// A stripe that says where something should lie, and what.
    stripe: Option<(Range<f64>, &'a str)>,
    /// Whether to draw points rather than lines, so that a jump is seen as one.
    points: bool,
    /// Where no curve is.
    legend: SeriesLabelPosition,
}

fn plots(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    let stroke = catches::stroke_ms();
    let of_speed = |speed: f64| {
        let curve = catches::live_curve(speed);
        (format!("{speed} m/s"), curve.into_iter().map(|(timing, left)| (timing, left / speed)).collect())
    };
    let live_catch = Plot {
        title: "Live catch: speed left, of the speed of arrival",
        axes: ["ms from the button to the ball's arrival", "speed left / speed of arrival"],
        curves: catches::SPEEDS.into_iter().map(of_speed).collect(),
        stripe: Some((stroke..stroke + 8.0, "8 ms from the end of the stroke")),
        points: false,
        legend: SeriesLabelPosition::UpperMiddle,
    };
    write(&folder.join("live-catch.svg"), &live_catch.svg()?)?;
    let hands = [(false, "left"), (true, "right")];
    let ways = [(aim::From::Cradle, "from the cradle"), (aim::From::Inlane, "from the inlane")];
    let curves = ways.into_iter().flat_map(|(from, way)| {
        hands.into_iter().map(move |(right, hand)| {
            let side = if right { -1.0 } else { 1.0 };
            let shots = aim::shots(from, right).into_iter();
            (format!("{hand}, {way}"), shots.map(|shot| (shot.place, side * shot.direction)).collect())
        })
    });
    let aim = Plot {
        title: "Aim: where the ball goes by where it is flipped",
        axes: ["place on the flipper, mm from the pivot", "direction, degrees to the right of up the table"],
        curves: curves.collect(),
        stripe: None,
        points: true,
        legend: SeriesLabelPosition::MiddleRight,
    };
    write(&folder.join("aim.svg"), &aim.svg()?)
}

/// From the least to the largest of the numbers, and a little more.
fn range(numbers: impl Iterator<Item = f64> + Clone) -> Range<f64> {
    let (low, high) = (numbers.clone().fold(f64::INFINITY, f64::min), numbers.fold(f64::NEG_INFINITY, f64::max));
    let margin = 0.05 * (high - low);
    low - margin..high + margin
}

impl Plot<'_> {
    fn svg(&self) -> Result<String, String> {
        let mut text = String::new();
        self.draw(&mut text).map_err(|error| format!("cannot draw {}: {error}", self.title))?;
        Ok(text)
    }

    fn draw(&self, text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let points = || self.curves.iter().flat_map(|(_, curve)| curve.iter().filter(|(_, y)| y.is_finite()));
        let (xs, ys) = (range(points().map(|(x, _)| *x)), range(points().map(|(_, y)| *y)));
        let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .caption(self.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(xs, ys.clone())?;
        chart
            .configure_mesh()
            .x_desc(self.axes[0])
            .y_desc(self.axes[1])
            .light_line_style(WHITE)
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 16))
            .draw()?;
        if let Some((stripe, what)) = &self.stripe {
            let color = BLACK.mix(0.08);
            let corners = [(stripe.start, ys.start), (stripe.end, ys.end)];
            chart
                .draw_series([Rectangle::new(corners, color.filled())])?
                .label(*what)
                .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 18, y + 5)], color.filled()));
        }
        for ((name, curve), color) in self.curves.iter().zip(COLORS) {
            let curve = curve.iter().filter(|(_, y)| y.is_finite()).copied();
            let drawn = if self.points {
                chart.draw_series(curve.map(|point| Circle::new(point, 1, color.filled())))?
            } else {
                chart.draw_series(LineSeries::new(curve, color.stroke_width(2)))?
            };
            drawn.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(3)));
        }
        chart
            .configure_series_labels()
            .position(self.legend.clone())
            .label_font(("sans-serif", 15))
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        root.present()?;
        Ok(())
    }
}
