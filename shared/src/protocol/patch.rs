//! A patch: what turns one row of bytes into the next one. A state is written with numbers of fixed length, so what did
//! not change stays where it was, and a number that changed is there with its raw bits.

use super::framing::{read_varint, write_varint};

/// Unchanged bytes that are cheaper to repeat than to skip: a skip and a length take two.
const WORTH_A_SKIP: usize = 3;

/// What makes `new` of `old`: the new length, then for each run of changed bytes how many are skipped, how many follow, and
/// these. A row of another length is the old one up to the first difference and from the last one on.
pub(super) fn patch(old: &[u8], new: &[u8]) -> Vec<u8> {
    let mut patch = Vec::new();
    write_varint(&mut patch, new.len() as u64);
    if old.len() != new.len() {
        let front = old.iter().zip(new).take_while(|(a, b)| a == b).count();
        let (old_rest, new_rest) = (&old[front..], &new[front..]);
        let back = old_rest.iter().rev().zip(new_rest.iter().rev()).take_while(|(a, b)| a == b).count();
        write_varint(&mut patch, front as u64);
        write_varint(&mut patch, (new_rest.len() - back) as u64);
        patch.extend_from_slice(&new_rest[..new_rest.len() - back]);
        return patch;
    }
    let mut done = 0;
    while let Some(skip) = old[done..].iter().zip(&new[done..]).position(|(a, b)| a != b) {
        let start = done + skip;
        let mut end = start + 1;
        for place in start + 1..new.len() {
            if old[place] != new[place] {
                end = place + 1;
            } else if place + 1 - end == WORTH_A_SKIP {
                break;
            }
        }
        write_varint(&mut patch, skip as u64);
        write_varint(&mut patch, (end - start) as u64);
        patch.extend_from_slice(&new[start..end]);
        done = end;
    }
    patch
}

/// `old` as a patch changes it; `None` if the patch is none for it, or would make a row of more than `most` bytes.
pub(super) fn apply(old: &[u8], mut patch: &[u8], most: usize) -> Option<Vec<u8>> {
    let length = usize::try_from(read_varint(&mut patch)?).ok().filter(|&length| length <= most)?;
    let number = |patch: &mut &[u8]| read_varint(patch).and_then(|number| usize::try_from(number).ok());
    if length != old.len() {
        let front = number(&mut patch)?;
        let changed = number(&mut patch)?;
        let back = length.checked_sub(front.checked_add(changed)?)?;
        if patch.len() != changed || front > old.len() || back > old.len() - front {
            return None;
        }
        return Some([&old[..front], patch, &old[old.len() - back..]].concat());
    }
    let mut new = old.to_vec();
    let mut done = 0_usize;
    while !patch.is_empty() {
        let start = done.checked_add(number(&mut patch)?)?;
        let changed = number(&mut patch)?;
        done = start.checked_add(changed)?;
        let (bytes, rest) = patch.split_at_checked(changed)?;
        new.get_mut(start..done)?.copy_from_slice(bytes);
        patch = rest;
    }
    Some(new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn any_row_becomes_any_other() {
        let mut rng = Rng::new(11);
        for _ in 0..20_000 {
            let old: Vec<u8> = (0..rng.bits() % 40).map(|_| (rng.bits() % 3) as u8).collect();
            let mut new = old.clone();
            if rng.bits().is_multiple_of(2) {
                new = (0..rng.bits() % 40).map(|_| (rng.bits() % 3) as u8).collect();
            } else if !new.is_empty() {
                for _ in 0..rng.bits() % 3 {
                    let place = (rng.bits() % new.len() as u64) as usize;
                    new[place] = rng.bits() as u8;
                }
            }
            assert_eq!(apply(&old, &patch(&old, &new), 64).as_ref(), Some(&new), "{old:?}");
        }
    }

    #[test]
    fn what_did_not_change_costs_a_byte_and_a_number_what_it_has() {
        let old = [7; 100];
        assert_eq!(patch(&old, &old).len(), 1);
        let mut new = old;
        new[40..48].copy_from_slice(&0.1_f64.to_le_bytes());
        assert_eq!(patch(&old, &new).len(), 1 + 2 + 8);
    }

    #[test]
    fn hostile_patches_are_refused() {
        let mut rng = Rng::new(5);
        let old = [1, 2, 3, 4, 5];
        for _ in 0..50_000 {
            let bytes: Vec<u8> = (0..rng.bits() % 8).map(|_| rng.bits() as u8 >> (rng.bits() % 8)).collect();
            if let Some(new) = apply(&old, &bytes, 10) {
                assert!(new.len() <= 10);
            }
        }
        assert_eq!(apply(&old, &[11, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], 10), None);
    }
}
