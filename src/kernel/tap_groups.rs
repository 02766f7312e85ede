//! Codes of groups of taps: what a decoder makes of them on its way to a count.

use super::thermometer::Thermometer;

/// The ones among each `GROUP` of taps, or the place of the highest among them, side by side: a register of a
/// decoder on its way.
///
/// It holds the taps themselves: the model needs no more, and who shows it groups them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartialOnes<const GROUP: usize>(pub Thermometer);

/// Bits of the ones count of each group of taps.
pub const fn ones_width(group: usize) -> usize {
    group.ilog2() as usize + 1
}

/// Appends the ones count of each `group` of `count` taps to `out`, side by side: `taps` are bits in words, least
/// significant first, with zeros past the last. A group has up to 128 taps, a power of two; the last may be shorter.
pub fn partial_ones(taps: &[u64], count: usize, group: usize, out: &mut Vec<u64>) {
    of_groups(taps, count, group, out, |taps| taps.count_ones());
}

/// Appends the place of the highest one in each `group` of taps, from 1 on, or 0 if there is none, where
/// [`partial_ones`] appends its count.
pub fn partial_highest(taps: &[u64], count: usize, group: usize, out: &mut Vec<u64>) {
    of_groups(taps, count, group, out, |taps| u128::BITS - taps.leading_zeros());
}

/// Appends what `code` makes of each group: a word or two of taps at once, which mostly are all low or all high.
#[inline(always)]
fn of_groups(
    taps: &[u64],
    count: usize,
    group: usize,
    out: &mut Vec<u64>,
    code: impl Fn(u128) -> u32,
) {
    let (chunk, width) = (group.max(64), ones_width(group));
    let (groups, all) = (chunk / group, u128::MAX >> (128 - group));
    // A group whose taps are all low or all high needs no count.
    let code = |taps: u128| match taps {
        0 => 0,
        taps if taps == all => group as u64,
        taps => code(taps).into(),
    };
    let codes = |taps: u128| {
        let codes = (0..groups).map(|k| code(taps >> (group * k) & all) << (width * k));
        codes.fold(0, |codes, code| codes | code)
    };
    let (high, all_high) = (u128::MAX >> (128 - chunk), codes(u128::MAX));
    let end = out.len() + (width * count.div_ceil(group)).div_ceil(64);
    let (mut word, mut filled) = (0, 0);
    for words in taps.chunks(chunk / 64) {
        let above = words.get(1).copied().unwrap_or(0);
        let codes = match u128::from(above) << 64 | u128::from(words[0]) {
            0 => 0,
            taps if taps == high => all_high,
            taps => codes(taps),
        };
        word |= codes << filled;
        filled += width * groups;
        if filled >= 64 {
            out.push(word);
            filled -= 64;
            word = codes.unbounded_shr((width * groups - filled) as u32);
        }
    }
    out.push(word);
    // Past the last group there are zeros only.
    out.truncate(end);
}

#[cfg(test)]
mod tests {
    use bitvec::prelude::*;

    use super::*;

    #[test]
    fn partial_ones_stand_side_by_side_in_as_many_bits_as_they_need() {
        let mut out = Vec::new();
        partial_ones(&[0b11_0010_1111], 10, 4, &mut out);
        assert_eq!(out, [4 | 1 << 3 | 2 << 6]);
    }

    #[test]
    fn places_of_the_highest_stand_in_the_same_bits() {
        let mut out = Vec::new();
        partial_highest(&[0b00_0010_1011], 10, 4, &mut out);
        assert_eq!(out, [4 | 2 << 3]);
    }

    #[test]
    fn groups_of_any_size_are_coded_as_bit_by_bit() {
        let mixed = std::array::from_fn(|k| 0x9e37_79b9_7f4a_7c15 << k | 1 << (5 * k));
        let runs = [u64::MAX, u64::MAX, 0, u64::MAX << 9];
        let sizes = [(2, 256), (16, 250), (16, 256), (64, 200), (128, 256), (128, 129)];
        for (taps, (group, count)) in
            sizes.into_iter().flat_map(|size| [(mixed, size), (runs, size)])
        {
            let levels: BitVec<u64> = BitSlice::<_, Lsb0>::from_slice(&taps)[..count].to_bitvec();
            let mut taps = taps.map(|_| 0);
            levels.iter_ones().for_each(|tap| taps[tap / 64] |= 1 << (tap % 64));
            let mut codes: [BitVec<u64>; 2] = Default::default();
            for group_taps in levels.chunks(group) {
                let highest = group_taps.last_one().map_or(0, |place| place + 1);
                for (codes, code) in codes.iter_mut().zip([group_taps.count_ones(), highest]) {
                    let width = ones_width(group);
                    codes.extend_from_bitslice(&code.view_bits::<Lsb0>()[..width]);
                }
            }
            let mut out = [Vec::new(), Vec::new()];
            partial_ones(&taps, count, group, &mut out[0]);
            partial_highest(&taps, count, group, &mut out[1]);
            codes.iter_mut().for_each(|codes| codes.set_uninitialized(false));
            assert_eq!(out, codes.map(BitVec::into_vec), "{group} of {count}");
        }
    }
}
