//! The frame of a picture in SVG: where metres lie on paper, axes around them, words beside them.

use std::fmt::Write as _;

use glam::DVec2;
use shared::physics::shapes::Bounds;

/// Longer side of what is shown in metres, pixels.
const LENGTH: f64 = 900.0;
/// Least width of the whole picture, for the words.
const LEAST_WIDTH: f64 = 620.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 40.0;
const AXIS: f64 = 46.0;
/// From one line of words to the next.
const LINE: f64 = 17.0;
/// At least so many marks on the longer axis, and at most two and a half times as many.
const MARKS: f64 = 8.0;

/// A part of the plane on paper.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    low: DVec2,
    high: DVec2,
    /// What the axes count from, m.
    origin: DVec2,
    /// Pixels a metre.
    scale: f64,
}

impl Frame {
    /// For a part of a scene whose (0, 0) lies at `origin` in its file.
    pub(crate) fn around(bounds: &Bounds, origin: DVec2) -> Self {
        // Something, even where nothing has a size.
        let extent = if bounds.extent() > 0.0 { bounds.extent() } else { 1.0 };
        let margin = extent * 0.03;
        let Bounds { low, high } = bounds.grown(margin);
        Self { low, high, origin, scale: LENGTH / (extent + 2.0 * margin) }
    }

    /// The longer side, m.
    pub(crate) fn extent(&self) -> f64 {
        (self.high - self.low).max_element()
    }

    /// That many pixels, m.
    pub(crate) fn metres(&self, pixels: f64) -> f64 {
        pixels / self.scale
    }

    /// The beginning of the file, with room for so many lines of words.
    pub(crate) fn open(&self, style: &str, lines: usize) -> String {
        let size = (self.high - self.low) * self.scale;
        let width = (size.x + LEFT + RIGHT).max(LEAST_WIDTH).ceil();
        let height = (size.y + TOP + AXIS + (lines as f64 + 1.0) * LINE).ceil();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\">\n<style>{style}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n<clipPath \
             id=\"inside\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
            self.low.x,
            self.low.y,
            self.high.x - self.low.x,
            self.high.y - self.low.y,
        )
    }

    /// From here on, metres: x to the right, y up.
    pub(crate) fn open_metres(&self) -> String {
        let (x, y) = (LEFT - self.low.x * self.scale, TOP + self.high.y * self.scale);
        let scale = self.scale;
        format!("<g transform=\"matrix({scale} 0 0 {} {x} {y})\" clip-path=\"url(#inside)\">\n", -scale)
    }

    /// A grid with its numbers.
    pub(crate) fn axes(&self, text: &mut String) {
        let step = nice_step(self.extent() / MARKS);
        let digits = libm::floor(libm::log10(step) + 1e-9).min(0.0).abs() as usize;
        let place = |point: DVec2| {
            let offset = (point - self.low) * self.scale;
            (LEFT + offset.x, TOP + (self.high.y - self.low.y) * self.scale - offset.y)
        };
        let (left, bottom) = place(self.low);
        let (right, top) = place(self.high);
        let marks = |low: f64, high: f64, origin: f64| {
            let first = ((low + origin) / step).ceil();
            let count = ((high + origin) / step).floor() - first;
            (0..=count.clamp(0.0, 100.0) as u32).map(move |mark| (first + f64::from(mark)) * step)
        };
        text.push_str("<g id=\"axes\">\n");
        for number in marks(self.low.x, self.high.x, self.origin.x) {
            let (x, _) = place(DVec2::new(number - self.origin.x, self.low.y));
            let _ = writeln!(
                text,
                "<line class=\"axis\" x1=\"{x:.2}\" y1=\"{top:.2}\" x2=\"{x:.2}\" y2=\"{bottom:.2}\"/><text x=\"{x:.2}\" \
                 y=\"{:.2}\" text-anchor=\"middle\">{number:.digits$}</text>",
                bottom + 16.0
            );
        }
        for number in marks(self.low.y, self.high.y, self.origin.y) {
            let (_, y) = place(DVec2::new(self.low.x, number - self.origin.y));
            let _ = writeln!(
                text,
                "<line class=\"axis\" x1=\"{left:.2}\" y1=\"{y:.2}\" x2=\"{right:.2}\" y2=\"{y:.2}\"/><text x=\"{:.2}\" \
                 y=\"{:.2}\" text-anchor=\"end\">{number:.digits$}</text>",
                left - 6.0,
                y + 4.0
            );
        }
        let (x, y) = ((left + right) / 2.0, bottom + 34.0);
        let _ = writeln!(text, "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\">x, m</text>");
        let (x, y) = (16.0, (top + bottom) / 2.0);
        let _ = writeln!(
            text,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\" transform=\"rotate(-90 {x:.2} {y:.2})\">y, m</text>\n</g>"
        );
    }

    /// The first line above everything as a title, the others below; already escaped.
    pub(crate) fn words(&self, text: &mut String, lines: &[String]) {
        let Some((title, lines)) = lines.split_first() else { return };
        let _ = writeln!(text, "<text class=\"title\" x=\"{LEFT}\" y=\"26\">{title}</text>");
        let mut y = TOP + (self.high.y - self.low.y) * self.scale + AXIS;
        for line in lines {
            y += LINE;
            let _ = writeln!(text, "<text x=\"16\" y=\"{y:.2}\">{line}</text>");
        }
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `most`; 1 if that is no positive number.
pub(crate) fn nice_step(most: f64) -> f64 {
    if !(most > 0.0 && most.is_finite()) {
        return 1.0;
    }
    let power = libm::floor(libm::log10(most));
    // Read as it is written, a step is the nearest number to what it should be.
    let step = |times: &str| format!("{times}e{power}").parse().unwrap_or(1.0);
    ["5", "2"].into_iter().map(step).find(|step| *step <= most).unwrap_or_else(|| step("1"))
}
