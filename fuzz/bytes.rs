//! Files that nobody would write, made from such as the program writes: bytes changed anywhere, or one value of a JSON
//! text.

use super::dice::Dice;
use serde_json::Value;

/// Numbers that a file should not hold, as text.
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1e300",
    "-1e300",
    "1e-300",
    "NaN",
    "inf",
    "-inf",
    "1e999",
    "18446744073709551615",
    "4294967296",
    "0.5",
    "",
    "1,5",
];

/// Bytes of a file at most.
const LONGEST: usize = 200_000;

/// A file made from one of these by a few changes of its bytes.
pub fn changed(seed: &[u8], others: &[Vec<u8>], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..1 + dice.roll(4) {
        change(&mut bytes, others, dice);
        bytes.truncate(LONGEST);
    }
    bytes
}

fn change(bytes: &mut Vec<u8>, others: &[Vec<u8>], dice: &mut Dice) {
    let at = dice.roll(bytes.len() + 1);
    let piece = |from: &[u8], dice: &mut Dice| {
        let start = dice.roll(from.len() + 1);
        from[start..(start + dice.roll(200)).min(from.len())].to_vec()
    };
    match dice.roll(9) {
        0 => bytes.truncate(at),
        1 => bytes.get_mut(at).into_iter().for_each(|byte| *byte ^= 1 << dice.roll(8)),
        2 => bytes.get_mut(at).into_iter().for_each(|byte| *byte = dice.roll(256) as u8),
        3 => drop(bytes.drain(at..(at + 1 + dice.roll(60)).min(bytes.len()).max(at))),
        4 => {
            let again = piece(&bytes.clone(), dice);
            bytes.splice(at..at, again).for_each(drop);
        }
        5 if !others.is_empty() => {
            let other = dice.roll(others.len());
            let strange = piece(&others[other], dice);
            bytes.splice(at..at, strange).for_each(drop);
        }
        6 | 7 => number(bytes, dice),
        _ => {
            // a length or a number of a binary file
            let words: [[u8; 8]; 8] = [
                [0xff; 8],
                [0; 8],
                f64::NAN.to_le_bytes(),
                f64::INFINITY.to_le_bytes(),
                i64::MIN.to_le_bytes(),
                (1_u64 << 40).to_le_bytes(),
                [0xff, 0xff, 0xff, 0xff, 0xff, 0x7f, 0, 0],
                [0, 0, 0xc0, 0x7f, 0, 0, 0x80, 0x7f],
            ];
            let word = words[dice.roll(words.len())];
            let length = [1, 4, 8][dice.roll(3)];
            bytes.iter_mut().skip(at).zip(&word[..length]).for_each(|(byte, new)| *byte = *new);
        }
    }
}

/// Puts another number in the place of one.
fn number(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let inside = |byte: &u8| byte.is_ascii_digit() || b".eE+-".contains(byte);
    let start = dice.roll(bytes.len() + 1);
    let Some(first) = bytes[start..].iter().position(|byte| byte.is_ascii_digit()).map(|place| start + place) else {
        return;
    };
    let end = first + bytes[first..].iter().take_while(|byte| inside(byte)).count();
    bytes.splice(first..end, dice.pick(NUMBERS).bytes()).for_each(drop);
}

/// Changes values somewhere in a JSON text.
pub fn changed_json(value: &mut Value, dice: &mut Dice) {
    for _ in 0..1 + dice.roll(3) {
        change_value(value, dice);
    }
}

fn change_value(value: &mut Value, dice: &mut Dice) {
    let goes_in = dice.roll(8) > 0;
    match value {
        Value::Array(items) if goes_in && !items.is_empty() => {
            let at = dice.roll(items.len());
            change_value(&mut items[at], dice);
        }
        Value::Object(fields) if goes_in && !fields.is_empty() => {
            let at = dice.roll(fields.len());
            fields.values_mut().skip(at).take(1).for_each(|inner| change_value(inner, dice));
        }
        Value::Array(items) => match dice.roll(5) {
            0 => items.clear(),
            1 => drop(items.pop()),
            2 => items.extend(items.last().cloned()),
            3 => items.reverse(),
            _ if !items.is_empty() => drop(items.remove(dice.roll(items.len()))),
            _ => items.push(Value::Null),
        },
        Value::Object(fields) => {
            let names: Vec<String> = fields.keys().cloned().collect();
            names.get(dice.roll(names.len())).into_iter().for_each(|name| drop(fields.remove(name)));
        }
        other => *other = leaf(other, dice),
    }
}

/// Another value in the place of a number, a text or a truth.
fn leaf(old: &Value, dice: &mut Dice) -> Value {
    let number = old.as_f64().unwrap_or(1.0);
    match dice.roll(12) {
        0 => Value::Null,
        1 => Value::from(0),
        2 => Value::from(-1),
        3 => Value::from(u64::MAX),
        4 => Value::from(1_u64 << 32),
        5 => Value::from(1e300),
        6 => Value::from(-1e300),
        7 => Value::from(1e-300),
        8 => Value::from(2.0 * number),
        9 => Value::from(-number),
        10 => Value::from(number as i64 + 1),
        _ => Value::from("text"),
    }
}
