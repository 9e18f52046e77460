//! The plot: cost against error, one line for each model.

use plotters::prelude::*;

use super::outcome::Outcome;

const SIZE: (u32, u32) = (960, 600);
/// A model has the same color in every plot.
const MODELS: [(&str, RGBColor); 4] = [
    ("discrete", RGBColor(0x8a, 0x8a, 0x8a)),
    ("pixel", RGBColor(0x3a, 0x8f, 0x4d)),
    ("swept", RGBColor(0xe0, 0x8e, 0x0b)),
    ("exact", RGBColor(0xc0, 0x1f, 0x3a)),
];
const OTHERS: [RGBColor; 3] = [RGBColor(0x2b, 0x7b, 0xba), RGBColor(0x7a, 0x4f, 0xa3), RGBColor(0x2f, 0x2f, 0x2f)];
/// What is less is drawn here, m: all of it is rounding.
const LEAST: f64 = 1e-17;
/// What is more, or lost, is drawn here, m.
const MOST: f64 = 1.0;

/// Cost against the error at the third bounce, or the last before it that every model has, as a picture in SVG.
///
/// # Errors
/// If nothing was measured, or the drawing fails.
pub fn svg(title: &str, outcomes: &[Outcome]) -> Result<String, String> {
    let place = (0..2).rev().find(|&place| outcomes.iter().any(|outcome| outcome.error(place).is_some())).unwrap_or(0);
    let points: Vec<(&Outcome, f64, f64)> = outcomes
        .iter()
        .filter_map(|outcome| Some((outcome, outcome.cost?.median, outcome.error(place)?)))
        .map(|(outcome, cost, error)| (outcome, cost, if error.is_nan() { MOST } else { error.clamp(LEAST, MOST) }))
        .collect();
    let costs = || points.iter().map(|(_, cost, _)| *cost);
    if points.is_empty() {
        return Err("nothing was measured that could be drawn".to_owned());
    }
    let (low, high) = (costs().fold(f64::INFINITY, f64::min) / 2.0, costs().fold(0.0, f64::max) * 2.0);
    let mut text = String::new();
    draw(&mut text, title, place, &points, (low, high)).map_err(|error| format!("cannot draw the plot: {error}"))?;
    Ok(text)
}

fn draw(
    text: &mut String,
    title: &str,
    place: usize,
    points: &[(&Outcome, f64, f64)],
    (low, high): (f64, f64),
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d((low..high).log_scale(), (LEAST / 3.0..MOST * 3.0).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("ns for a simulated second")
        .y_desc(format!("error at bounce {}, m", super::outcome::BOUNCES[place]))
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .light_line_style(WHITE)
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .draw()?;
    let mut names: Vec<&str> = Vec::new();
    for (outcome, ..) in points {
        if !names.contains(&outcome.name.as_str()) {
            names.push(&outcome.name);
        }
    }
    let mut others = OTHERS.iter().cycle();
    for name in names {
        let model = MODELS.iter().find(|(model, _)| *model == name).map(|(_, color)| *color);
        let color = model.or_else(|| others.next().copied()).unwrap_or(BLACK);
        let mut line: Vec<(u32, f64, f64)> = points
            .iter()
            .filter(|(outcome, ..)| outcome.name == name)
            .map(|(outcome, cost, error)| (outcome.hz, *cost, *error))
            .collect();
        line.sort_by_key(|(hz, ..)| *hz);
        chart
            .draw_series(LineSeries::new(line.iter().map(|(_, cost, error)| (*cost, *error)), color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(3)));
        chart.draw_series(line.iter().map(|(_, cost, error)| Circle::new((*cost, *error), 4, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .label_font(("sans-serif", 15))
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    Ok(())
}
