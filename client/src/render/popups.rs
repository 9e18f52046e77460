//! Where points that float up stand: none over another, all in sight. Pure arithmetic, in pixels.

use macroquad::math::{Rect, Vec2};

/// Moves boxes so that none covers another: the newest, which comes last, stays where it wants to be; older ones are pushed
/// up, in the way in which they float anyway. `None` for one that there is no room for. `gap`: between two of them.
pub(super) fn apart(wanted: &[Rect], within: Rect, gap: f32) -> Vec<Option<Rect>> {
    let mut placed: Vec<Option<Rect>> = vec![None; wanted.len()];
    for (place, &own) in wanted.iter().enumerate().rev() {
        let mut own = kept(own, within);
        // Each step goes above one more of those that stand; there are no more of them than this.
        for _ in 0..wanted.len() {
            let in_the_way = placed.iter().flatten().filter(|other| overlaps(own, **other, gap));
            let Some(other) = in_the_way.min_by(|a, b| a.y.total_cmp(&b.y)) else { break };
            own.y = other.y - gap - own.h;
        }
        placed[place] = (own.y >= within.y).then_some(own);
    }
    placed
}

/// The same box, moved into another as far as it fits.
fn kept(own: Rect, within: Rect) -> Rect {
    let most = (within.point() + within.size() - own.size()).max(within.point());
    let Vec2 { x, y } = own.point().clamp(within.point(), most);
    Rect { x, y, ..own }
}

fn overlaps(a: Rect, b: Rect, gap: f32) -> bool {
    let (x, y) = (a.x < b.right() + gap && b.x < a.right() + gap, a.y < b.bottom() + gap && b.y < a.bottom() + gap);
    x && y
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELD: Rect = Rect { x: 100.0, y: 50.0, w: 300.0, h: 500.0 };

    fn boxes(corners: &[(f32, f32)]) -> Vec<Rect> {
        corners.iter().map(|&(x, y)| Rect::new(x, y, 60.0, 20.0)).collect()
    }

    #[test]
    fn what_is_apart_stays_where_it_is() {
        let wanted = boxes(&[(120.0, 100.0), (220.0, 100.0), (120.0, 200.0)]);
        assert_eq!(apart(&wanted, FIELD, 2.0), wanted.iter().copied().map(Some).collect::<Vec<_>>());
    }

    #[test]
    fn older_ones_make_room_upwards() {
        let wanted = boxes(&[(120.0, 300.0), (130.0, 305.0), (125.0, 310.0)]);
        let placed: Vec<f32> = apart(&wanted, FIELD, 2.0).into_iter().map(|one| one.unwrap().y).collect();
        assert_eq!(placed, [266.0, 288.0, 310.0]);
    }

    #[test]
    fn nothing_ever_overlaps_or_leaves_the_field() {
        for round in 0..200_i32 {
            let corner = |place: i32| {
                let of = |salt| super::super::canvas::noise(round * 64 + place, salt);
                (60.0 + 380.0 * of(1), 20.0 + 140.0 * of(2))
            };
            let wanted = boxes(&(0..24).map(corner).collect::<Vec<_>>());
            let placed: Vec<Rect> = apart(&wanted, FIELD, 3.0).into_iter().flatten().collect();
            assert!(placed.len() > 5, "round {round}: {}", placed.len());
            for (place, one) in placed.iter().enumerate() {
                assert!(one.x >= FIELD.x && one.right() <= FIELD.right());
                assert!(one.y >= FIELD.y && one.bottom() <= FIELD.bottom());
                assert!(placed[..place].iter().all(|other| !overlaps(*one, *other, 2.9)), "round {round}: {one:?}");
            }
        }
    }

    #[test]
    fn a_field_without_room_shows_nothing_and_ends() {
        let wanted = boxes(&[(0.0, 0.0); 24]);
        let tiny = Rect::new(0.0, 0.0, 10.0, 25.0);
        assert_eq!(apart(&wanted, tiny, 2.0).iter().flatten().count(), 1);
    }
}
