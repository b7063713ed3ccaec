//! Texts that nobody would write, made from those that people did: run `k` always gives the same text.

use super::dice::Dice;

/// What people type, and what they should not.
const WORDS: &[&str] = &[
    "?",
    "{",
    "}",
    "[",
    "]",
    "(",
    ")",
    "=",
    ":",
    ",",
    "\n",
    "..",
    ".",
    "+",
    "-",
    "*",
    "/",
    "^",
    "<",
    "<=",
    "per",
    "use",
    "let",
    "as",
    "none",
    "auto",
    "rest",
    "all",
    "0",
    "1",
    "-1",
    "1e9",
    "1e-9",
    "1e999",
    "0.3",
    "0,3",
    "0 m",
    "-6 .. 0 m",
    "-20 .. -1 sleepers",
    "[1, 2] m",
    "22.5 tonnes",
    "30 km/hr",
    "kNs/m",
    "=>",
    ":=",
    ";",
    "#",
    "'text'",
    "\"text\"",
    "\"",
    "//",
    "///",
    "\u{feff}",
    "µ",
    "²",
    "·",
    "é",
    "\u{1F683}",
    "\t",
    "\r\n",
    "MN/m",
    "N/mm^3",
    "kN s/m",
    "axles",
    "MGT",
    "%",
    "per seat",
    "per wheelset",
    "ramp(1 .. 2)",
    "smooth(0.1 .. 0.2 N/mm^3)",
    "random(40 MN/m, cov = 10 %, correlation = 3 m)",
    "file(\"level.csv\")",
    "max(settlement)",
    "mean(settlement, over = -60 .. -40 sleepers)",
    "sqrt(2)",
    "adaptive(0.2 mm)",
    "sobol(128)",
    "clumps(2 .. 3, ratio = 0.8)",
    "mohr_coulomb(1 kPa, 30 deg)",
    "track t { sections = [open: 1 m] }",
    "study s { vary = [] }",
    "stretch s { over = -6 .. -1 sleepers, usp = usps.polyurethane }",
    "open.pad.stiffness",
    "line : base.line { }",
];

/// The text of run `number`: one of the seeds, changed in a few places.
pub fn text(seeds: &[&str], number: u64) -> String {
    let mut dice = Dice::new(number);
    let seed = dice.pick(seeds);
    changed(seed, seeds, &mut dice)
}

/// Lines of a piece at most: a grammar is reached as well by few lines, in a tenth of the time of a whole scene.
const PIECE: usize = 12;

/// The text of run `number`: some lines of one of the seeds, in one run of sixteen all of them, changed in a few
/// places.
pub fn piece(seeds: &[&str], number: u64) -> String {
    let mut dice = Dice::new(number);
    let seed = dice.pick(seeds);
    if dice.roll(16) == 0 {
        return changed(seed, seeds, &mut dice);
    }
    let lines: Vec<&str> = seed.split_inclusive('\n').collect();
    let start = dice.roll(lines.len());
    let end = (start + 1 + dice.roll(PIECE)).min(lines.len());
    changed(&lines[start..end].concat(), seeds, &mut dice)
}

fn changed(seed: &str, seeds: &[&str], dice: &mut Dice) -> String {
    let mut bytes = seed.as_bytes().to_vec();
    for _ in 0..1 + dice.roll(6) {
        change(&mut bytes, seeds, dice);
        bytes.truncate(40_000);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn change(text: &mut Vec<u8>, seeds: &[&str], dice: &mut Dice) {
    let at = dice.roll(text.len() + 1);
    let some = |dice: &mut Dice, from: &[u8], most: usize| -> Vec<u8> {
        let start = dice.roll(from.len() + 1);
        from[start..(start + dice.roll(most)).min(from.len())].to_vec()
    };
    match dice.roll(9) {
        0 => text.splice(at..at, dice.pick(WORDS).bytes()).for_each(drop),
        1 => {
            let end = (at + 1 + dice.roll(12)).min(text.len());
            text.splice(at..end, dice.pick(WORDS).bytes()).for_each(drop);
        }
        2 => drop(text.drain(at..(at + 1 + dice.roll(60)).min(text.len()).max(at))),
        3 => {
            let piece = some(dice, &text.clone(), 200);
            text.splice(at..at, piece).for_each(drop);
        }
        4 => {
            let other = dice.pick(seeds).as_bytes();
            let piece = some(dice, other, 400);
            text.splice(at..at, piece).for_each(drop);
        }
        5 => swap_tokens(text, dice),
        6 => change_number(text, dice),
        7 => {
            if let Some(byte) = text.get_mut(at) {
                *byte = (dice.roll(96) + 32) as u8;
            }
        }
        _ => {
            let piece =
                dice.pick(&["[", "(", "{", "a = ", "1 + ", "-", "x.", "use a as b\n"]).repeat(1 + dice.roll(90));
            text.splice(at..at, piece.bytes()).for_each(drop);
        }
    }
}

/// Pieces between blanks and brackets, as ranges.
fn tokens(text: &[u8]) -> Vec<(usize, usize)> {
    let inside = |b: &u8| b.is_ascii_alphanumeric() || b"._".contains(b);
    let mut found = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let end = at + text[at..].iter().take_while(|b| inside(b)).count();
        if end > at {
            found.push((at, end));
        }
        at = end + 1;
    }
    found
}

fn swap_tokens(text: &mut Vec<u8>, dice: &mut Dice) {
    let all = tokens(text);
    if all.len() < 2 {
        return;
    }
    let (one, two) = (all[dice.roll(all.len())], all[dice.roll(all.len())]);
    let (first, second) = (one.min(two), one.max(two));
    if first == second {
        return;
    }
    let (a, b) = (text[first.0..first.1].to_vec(), text[second.0..second.1].to_vec());
    text.splice(second.0..second.1, a).for_each(drop);
    text.splice(first.0..first.1, b).for_each(drop);
}

fn change_number(text: &mut Vec<u8>, dice: &mut Dice) {
    let numbers: Vec<_> = tokens(text).into_iter().filter(|(a, _)| text[*a].is_ascii_digit()).collect();
    if numbers.is_empty() {
        return;
    }
    let (a, b) = numbers[dice.roll(numbers.len())];
    let new =
        dice.pick(&["0", "1", "2", "7", "1e9", "1e-9", "1000000", "0.5", "1_0", "99999999999", "3.", "-4", "0.0001"]);
    text.splice(a..b, new.bytes()).for_each(drop);
}
