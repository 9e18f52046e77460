//! The broad phase: a uniform grid that knows which static shapes a ball could touch from within each of its cells.

use glam::DVec2;

use super::scene::Collider;
use super::shapes::{Arc, Bounds, Shape};

/// Most cells a side: 4 million in all.
const MOST_CELLS_A_SIDE: f64 = 2048.0;

/// Which colliders a ball whose centre is in a cell could touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    low: DVec2,
    /// Side of a cell, m.
    cell: f64,
    columns: usize,
    rows: usize,
    /// For each cell, row by row, where its items begin; one more at the end.
    starts: Vec<u32>,
    /// Places among the colliders, ascending within a cell.
    items: Vec<u16>,
}

impl Grid {
    /// A grid over all of `colliders`, with about as many cells as there are of them.
    pub(super) fn new(colliders: &[Collider], largest_radius: f64) -> Self {
        let around = colliders.iter().map(|collider| collider.bounds).reduce(Bounds::joined);
        let around = around.unwrap_or(Bounds { low: DVec2::ZERO, high: DVec2::ONE });
        let size = around.size();
        let fair = (size.x * size.y / colliders.len().max(1) as f64).sqrt();
        let least = around.extent() / MOST_CELLS_A_SIDE;
        let cell = [fair, largest_radius, least].into_iter().fold(f64::MIN_POSITIVE, |a, b| if b > a { b } else { a });
        let count = |length: f64| (length / cell).floor() as usize + 1;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut grid = Self { low: around.low, cell, columns, rows, starts: Vec::new(), items: Vec::new() };
        let mut cells: Vec<Vec<u16>> = vec![Vec::new(); columns * rows];
        for (index, collider) in (0..).zip(colliders) {
            grid.each_cell(&collider.bounds, |place, center| {
                if is_near(&collider.shape, center, 0.5 * cell, largest_radius) {
                    cells[place].push(index);
                }
            });
        }
        grid.starts.push(0);
        for cell in cells {
            grid.items.extend(cell);
            grid.starts.push(grid.items.len() as u32);
        }
        grid
    }

    /// Side of a cell, m.
    pub(super) fn cell(&self) -> f64 {
        self.cell
    }

    /// Calls `visit` with every collider that a ball could touch from within `bounds`, perhaps more than once and perhaps
    /// with some more.
    pub(super) fn visit(&self, bounds: &Bounds, mut visit: impl FnMut(u16)) {
        let (columns, rows) = self.cells_of(bounds);
        for row in rows {
            for column in columns.clone() {
                let place = row * self.columns + column;
                let (start, end) = (self.starts[place] as usize, self.starts[place + 1] as usize);
                for &item in &self.items[start..end] {
                    visit(item);
                }
            }
        }
    }

    fn each_cell(&self, bounds: &Bounds, mut visit: impl FnMut(usize, DVec2)) {
        let (columns, rows) = self.cells_of(bounds);
        for row in rows {
            for column in columns.clone() {
                let center = self.low + DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell;
                visit(row * self.columns + column, center);
            }
        }
    }

    /// Columns and rows of the cells that a box meets. Beyond the grid its outermost cells stand in.
    fn cells_of(&self, bounds: &Bounds) -> (core::ops::RangeInclusive<usize>, core::ops::RangeInclusive<usize>) {
        // A cast saturates: what is below 0 or NaN becomes 0.
        let place = |value: f64, low: f64, count: usize| (((value - low) / self.cell) as usize).min(count - 1);
        let columns = place(bounds.low.x, self.low.x, self.columns)..=place(bounds.high.x, self.low.x, self.columns);
        let rows = place(bounds.low.y, self.low.y, self.rows)..=place(bounds.high.y, self.low.y, self.rows);
        (columns, rows)
    }
}

/// Whether a ball of `radius` with its centre in the square around `center` could touch the shape.
fn is_near(shape: &Shape, center: DVec2, half: f64, radius: f64) -> bool {
    let distance = match shape {
        // A piece of an arc counts as its whole circle.
        Shape::Arc(arc) => Shape::Arc(Arc { span: None, ..*arc }).distance(center),
        segment @ Shape::Segment(_) => segment.distance(center),
    };
    // Half a cell's diagonal, and what rounding could hide.
    distance <= radius + half * 1.415 + (radius + half) * 1e-6
}
