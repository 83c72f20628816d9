//! Seeded damage: flipped bytes, cuts, splices, numbers at the edges, words of the format.

use rain_core::hash::pcg3d;

use crate::repair::repair;
use crate::target::Target;

/// Largest input that is made. Units: bytes.
pub const LONGEST: usize = 1 << 16;

/// Integers at which lengths, counts and offsets break.
const INTEGERS: [u32; 14] = [
    0,
    1,
    2,
    3,
    7,
    0x7f,
    0x80,
    0xff,
    0x7fff,
    0xffff,
    0x0001_0000,
    0x7fff_ffff,
    0xffff_fff0,
    0xffff_ffff,
];

/// Numbers as text at which parsers and domains break.
const NUMBERS: [&str; 22] = [
    "0",
    "-0",
    "-1",
    "1",
    "1e-320",
    "1e308",
    "1e309",
    "-1e309",
    "NaN",
    "nan",
    "inf",
    "-inf",
    "1e7",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775808",
    "0.1",
    "1e999999999",
    "--1",
    "0x10",
];

/// Numbers out of a hash: the same seed gives the same stream.
#[derive(Debug, Clone)]
pub struct Dice {
    seed: [u32; 2],
    count: u32,
}

impl Dice {
    /// The stream of a seed and a round.
    #[must_use]
    pub fn new(seed: u64, round: u64) -> Self {
        let mixed = pcg3d([seed as u32, (seed >> 32) as u32, round as u32]);
        Self {
            seed: [mixed[0], mixed[1] ^ (round >> 32) as u32],
            count: 0,
        }
    }

    /// Below `end` (0 where `end` is 0).
    pub fn below(&mut self, end: usize) -> usize {
        self.count = self.count.wrapping_add(1);
        let [word, ..] = pcg3d([self.seed[0], self.seed[1], self.count]);
        if end == 0 { 0 } else { word as usize % end }
    }

    fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// A piece of something `length` long, mostly short.
    fn range(&mut self, length: usize) -> core::ops::Range<usize> {
        let start = self.below(length + 1);
        let longest = if self.below(4) == 0 { length } else { 16 };
        let end = (start + self.below(longest + 1)).min(length);
        start..end
    }
}

/// Breaks `bytes` once or a few times, and every other time mends the format's shell. `others` lend pieces, `words` are
/// tokens of the format.
pub fn mutate(dice: &mut Dice, target: Target, bytes: &mut Vec<u8>, others: &[Vec<u8>], words: &[&str]) {
    // Few changes reach deep into a parser, many test its doors.
    let rounds = [1, 1, 1, 2, 3, 8][dice.below(6)];
    for _ in 0..rounds {
        once(dice, bytes, others, words);
        bytes.truncate(LONGEST);
    }
    if dice.below(2) == 0 {
        repair(target, bytes);
    }
}

fn once(dice: &mut Dice, bytes: &mut Vec<u8>, others: &[Vec<u8>], words: &[&str]) {
    let length = bytes.len();
    match dice.below(11) {
        0 if length > 0 => {
            let at = dice.below(length);
            bytes[at] ^= 1 << dice.below(8);
        }
        1 if length > 0 => {
            let at = dice.below(length);
            bytes[at] = dice.below(256) as u8;
        }
        2 => bytes.truncate(dice.below(length + 1)),
        3 => {
            let piece = dice.range(length);
            bytes.drain(piece);
        }
        4 => {
            let piece = bytes[dice.range(length)].to_vec();
            let at = dice.below(length + 1);
            bytes.splice(at..at, piece);
        }
        5 if !others.is_empty() => {
            let other = dice.pick(others).clone();
            let piece = other[dice.range(other.len())].to_vec();
            let place = dice.range(length);
            bytes.splice(place, piece);
        }
        6 if length >= 4 => {
            // Little and big end: glTF has the one, PNG the other.
            let at = dice.below(length - 3);
            let value = *dice.pick(&INTEGERS);
            let word = if dice.below(2) == 0 {
                value.to_le_bytes()
            } else {
                value.to_be_bytes()
            };
            bytes[at..at + 4].copy_from_slice(&word);
        }
        7 if length >= 4 => {
            let at = dice.below(length - 3);
            let value = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
            let step = dice.below(9) as u32;
            bytes[at..at + 4].copy_from_slice(&value.wrapping_add(step).wrapping_sub(4).to_le_bytes());
        }
        8 => number(dice, bytes),
        9 if !words.is_empty() => {
            let word = dice.pick(words).as_bytes().to_vec();
            let place = dice.range(length);
            let place = if dice.below(2) == 0 {
                place.start..place.start
            } else {
                place
            };
            bytes.splice(place, word);
        }
        _ => {
            let at = dice.below(length + 1);
            let byte = dice.below(256) as u8;
            let count = 1 + dice.below(3);
            bytes.splice(at..at, core::iter::repeat_n(byte, count));
        }
    }
}

/// Puts another number in the place of one.
fn number(dice: &mut Dice, bytes: &mut Vec<u8>) {
    let digit = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'-');
    let starts: Vec<usize> = (0..bytes.len())
        .filter(|i| digit(&bytes[*i]) && (*i == 0 || !digit(&bytes[*i - 1])))
        .collect();
    if starts.is_empty() {
        return;
    }
    let start = *dice.pick(&starts);
    let end = start + bytes[start..].iter().take_while(|b| digit(b)).count();
    let text = dice.pick(&NUMBERS).as_bytes().to_vec();
    bytes.splice(start..end, text);
}
