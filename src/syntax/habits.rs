//! Help for spellings of other languages and spreadsheets that are found at one sign or word.

use super::builder::Builder;
use super::explain::Way;
use super::grammar::Rule;
use super::token::{Kind, Token};

impl Builder<'_> {
    /// Help for a part that begins at `start` and cannot be read from `found` on.
    pub fn habit(&self, exact: Rule, start: usize, part: &str, found: Option<Token>) -> Option<Way> {
        let text = &self.prepared.text;
        let found = found?;
        let word = found.text(text);
        let (before, after) = (text[start..found.start.max(start)].trim(), &text[found.end..]);
        let rest = part.get(found.start.saturating_sub(start)..).unwrap_or_default();
        if let Some(way) = unit_or_remark(word, before, rest, after).or_else(|| blank_before_per(part)) {
            return Some(way);
        }
        let said = |help: String| Some(Way::Say(help));
        let compares = part.contains(['<', '>']) && !part.contains('=');
        if exact == Rule::exact_field && (compares || part.starts_with('[')) {
            return Some(match part.starts_with('[') {
                true => Way::Say(format!("a list is given to a field: write `that = {part}`")),
                false => Way::Write("a comparison is given to `that`: ", format!("that = [{part}]")),
            });
        }
        let fixed = match word {
            "and" | "&&" | "&" | "or" if !part.contains(['<', '>', '=']) => {
                "write several values in brackets: `[a, b]`"
            }
            "and" | "&&" | "&" => {
                "write each comparison on its own line or behind a comma; `a < x < b` is one comparison"
            }
            "or" | "||" => "there is no `or`: write comparisons that must all hold",
            "not" | "!" if before.is_empty() => "there is no `not`: reverse the comparison",
            "!=" | "<>" | "<<" => "comparisons are `<`, `<=`, `>` and `>=`",
            "±" => "a value has no tolerance: `random(mean, sd = ...)` scatters along the track, a study varies",
            "~" | "≈" => "write the number alone",
            "⁻" => "a negative power is written `m^-1`",
            "$" | "@" => "write the name without a sign before it",
            "+=" | "<-" | "->" => "a field is given with `=`",
            "::" => "join names by dots: `pads.medium`",
            "**" => "powers are written `m^3`",
            "*" if before.ends_with('*') => "powers are written `m^3`",
            "<" | ">" if before.ends_with('<') => "comparisons are `<`, `<=`, `>` and `>=`",
            "with" => "write the base before the braces: `base { field = value }`",
            "[" if before.ends_with(digit) => "write a unit without brackets: `40 MN/m`",
            "[" => "a list cannot follow a name: put arguments in `( )`, names of a module behind a dot",
            "." if before.ends_with(digit) && after.starts_with(digit) => "a number has one point",
            "\\" | ".." if after.trim_start_matches(['.', ' ', '\t']).starts_with('\n') => {
                "a line continues after a comma or an operator: remove this sign"
            }
            "/" if before.ends_with('+') => {
                "a value has no tolerance: `random(mean, sd = ...)` scatters along the track, a study varies"
            }
            "." if !after.starts_with(char::is_alphanumeric) => "remove the point at the end",
            "{" if exact == Rule::exact_field && found.start == start => "one pair of braces is enough",
            _ => "",
        };
        if !fixed.is_empty() {
            return said(fixed.to_owned());
        }
        let value = exact == Rule::exact_value || exact == Rule::exact_argument;
        if let Some(help) = library_name(word, before, found).filter(|_| value) {
            return said(help);
        }
        let equals = after.trim_start().starts_with('=') && !after.trim_start().starts_with("==");
        if value && found.kind == Kind::Word && !before.is_empty() && equals {
            return said(format!("write `, {word}`"));
        }
        if exact == Rule::exact_item && part.starts_with("expect ") && part.contains(['<', '>']) {
            return Some(Way::Write("", format!("expect {{ that = [{}] }}", part["expect".len()..].trim())));
        }
        if exact == Rule::exact_item && part.starts_with("from ") && part.contains(" import ") {
            let module = part.split_whitespace().nth(1).unwrap_or_default();
            return Some(Way::Write("", format!("use {module}")));
        }
        let plain = |text: &str| {
            text.split_whitespace().count() >= 2 && text.chars().all(|c| c.is_alphabetic() || "',- ".contains(c))
        };
        let behind_key = part.split_once(':').map_or("", |(_, text)| text.trim());
        if exact == Rule::exact_entry && plain(behind_key) && behind_key.split_whitespace().count() > 2 {
            return said(format!("a text needs quotes: write `\"{behind_key}\"`"));
        }
        let name = !before.is_empty() && before.chars().all(|c| c.is_ascii_alphanumeric() || "_.".contains(c));
        let named = name && before.starts_with(|c: char| c.is_ascii_alphabetic());
        if exact == Rule::exact_entry && part.contains(['<', '>']) && named {
            return said(match before {
                "not" => "there is no `not`: reverse the comparison".to_owned(),
                "if" | "when" | "assert" | "that" => format!("write the comparison without `{before}`"),
                _ => format!("put arguments in parentheses: `{before}(...)`"),
            });
        }
        match word {
            "=" if value && named && before.contains('.') => {
                let pair = format!("[{before}: {}]", rest.trim_start_matches('=').trim());
                Some(Way::Write("pairs need brackets: ", pair))
            }
            "=" if value && named => match self.path_before(start) {
                Some(path) => {
                    let object = format!("{{ {before} {rest} }}");
                    let help = format!("write `{path}.{before} {rest}`, or `{path} = {object}`");
                    Some(Way::Offer(help, part.len(), vec![object]))
                }
                None => said(format!("write `{before} {rest}` alone")),
            },
            ":" if exact == Rule::exact_entry && before.starts_with(digit) && after.starts_with(digit) => {
                let mut parts = part.split(':');
                let (from, step, to) = (parts.next()?, parts.next()?, parts.next()?);
                said(format!(
                    "from one value to another in steps: `steps({from} .. {to}, by = {step})`, each with its unit"
                ))
            }
            ":" if exact == Rule::exact_entry && before.contains(':') => said("separate pairs by commas".to_owned()),
            ":" if value && !before.is_empty() => {
                let line = self.items_of_line(start);
                if before.trim_start_matches(['-', '+']).chars().all(|c| c.is_ascii_digit()) {
                    return said(
                        "a span is written `-20 .. -1 sleepers`, several values are written in brackets".into(),
                    );
                }
                let list = format!("[{line}]");
                Some(Way::Offer(format!("pairs need brackets: write `{list}`"), line.len(), vec![list]))
            }
            "'" if before.ends_with(digit) && !after.starts_with(digit) => {
                let feet: f64 = before.rsplit([' ', '=']).next()?.parse().ok()?;
                let metres = crate::units::number(0.3048 * feet);
                said(format!("a length in feet? {feet} ft are {metres} m (1 ft = 0.3048 m)"))
            }
            "'" if before.ends_with(digit) => said(format!("group digits by `_`: `{before}_{}`", &rest[1..])),
            "·" | "x" if before.ends_with(digit) => said("write powers of ten in the number: `4e7 N/m`".to_owned()),
            _ if exact == Rule::exact_field => habit_of_field(part),
            _ if !value => None,
            _ if before.starts_with('"') && before.ends_with('"') && before[1..].starts_with(digit) => {
                Some(Way::Write("numbers have no quotes: ", format!("{} {rest}", &before[1..before.len() - 1])))
            }
            _ if before.starts_with('(') && before.ends_with(')') => {
                let inner = before[1..before.len() - 1].trim();
                Some(Way::Write("a unit follows its number: ", format!("{inner} {rest}")))
            }
            _ if found.kind == Kind::Number && before.ends_with(" x") => {
                said("write powers of ten in the number: `4e7 N/m`".to_owned())
            }
            _ if found.kind == Kind::Number
                && before.chars().all(|c| c.is_ascii_digit() || c == '_')
                && !before.is_empty() =>
            {
                said(format!("group digits by `_`: `{before}_{rest}`"))
            }
            _ if found.kind == Kind::Number && named => said(format!(
                "put arguments in parentheses, `{before}(...)`, and fields in braces, `{{ name = value }}`"
            )),
            _ if found.kind == Kind::Word
                && before.chars().all(|c| c.is_ascii_digit() || c == '.')
                && !before.is_empty() =>
            {
                said(format!("a product needs its sign: `{before} * {rest}`"))
            }
            _ if word == "(" && named => said(format!("put fields in braces: `{before} {{ name = value }}`")),
            _ => None,
        }
    }

    /// The path of the field whose value starts here.
    fn path_before(&self, start: usize) -> Option<&str> {
        let before = self.prepared.text[..start].trim_end().strip_suffix('=')?.trim_end();
        let at = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.').len();
        Some(&before[at..]).filter(|path| !path.is_empty())
    }
}

/// Help for a field whose name or sign is wrong.
fn habit_of_field(part: &str) -> Option<Way> {
    if part.starts_with('"') {
        return Some(Way::Say("names have no quotes, and fields are given with `=`".to_owned()));
    }
    if let Some(field) = part.strip_prefix("- ") {
        return Some(Way::Write("a field has no dash before it: ", field.trim_start().to_owned()));
    }
    if part.starts_with("let ") || part.starts_with("use ") {
        return None;
    }
    let (name, value) = part.split_once('=').filter(|(_, value)| !value.starts_with('='))?;
    let name = name.trim();
    if let Some((path, first)) = name.split_once('(').filter(|(path, _)| !path.is_empty()) {
        let fields = format!("{first}={value}");
        return Some(Way::Write("", format!("{path} = {{ {} }}", fields.trim_end().trim_end_matches(')'))));
    }
    let (sign, why) =
        [('\'', "a name has no quotes: "), ('-', "a name has no dashes: "), (' ', "a name has no blanks: ")]
            .into_iter()
            .find(|(c, _)| name.contains(*c))?;
    let letters = name.chars().all(|c| c.is_ascii_alphanumeric() || "_' -".contains(c));
    let words = if sign == '\'' { name.replace('\'', "") } else { name.to_owned() };
    let joined = words.split([' ', '-']).collect::<Vec<_>>().join("_");
    letters.then(|| Way::Write(why, format!("{joined} = {}", value.trim())))
}

/// `150 m²per seat`: the basis is joined to the unit.
fn blank_before_per(part: &str) -> Option<Way> {
    let (unit, _) = part.split_once("per ").filter(|(unit, _)| unit.ends_with(['²', '³']) || unit.ends_with(digit))?;
    let is_value = part.starts_with(digit) || part.starts_with('-');
    is_value.then(|| Way::Write("a blank stands before `per`: ", format!("{unit} {}", &part[unit.len()..])))
}

fn digit(c: char) -> bool {
    c.is_ascii_digit()
}

/// Help for units in another spelling, and for remarks, that are found at one sign.
fn unit_or_remark(word: &str, before: &str, rest: &str, after: &str) -> Option<Way> {
    let number = before.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let rest = rest.trim_end();
    match word {
        "\\" if number && after.starts_with(char::is_alphabetic) => {
            Some(Way::Write("", format!("{before}/{}", rest.trim_start_matches('\\'))))
        }
        "." if number && before.ends_with(char::is_alphabetic) && after.starts_with(char::is_alphabetic) => {
            Some(Way::Write(
                "separate the factors of a unit by a blank: ",
                format!("{before} {}", rest.trim_start_matches('.')),
            ))
        }
        "(" if number && after.starts_with("per ") => {
            Some(Way::Write("", format!("{before} {}", rest.trim_start_matches('(').trim_end_matches(')'))))
        }
        "1" if before.ends_with(digit) && rest == "1/s" => Some(Way::Write("", format!("{before} Hz"))),
        "<=" | ">=" | "<" | ">" if before.is_empty() && after.trim_start().starts_with(digit) => {
            Some(Way::Write("a field has one value: ", rest.trim_start_matches(['<', '>', '=', ' ']).to_owned()))
        }
        _ => None,
    }
}

/// Rail profiles: the names in EN 13674, which begin with a digit, and the names in the library.
const RAILS: [(&str, &str); 8] = [
    ("60E1", "UIC60"),
    ("60E2", "UIC60"),
    ("UIC60E1", "UIC60"),
    ("54E1", "UIC54"),
    ("54E2", "UIC54"),
    ("54E3", "UIC54"),
    ("49E1", "S49"),
    ("60N", "CHN60"),
];

/// The name in the library for a name that begins with a digit, or that has a blank or a dash.
fn library_name(word: &str, before: &str, found: Token) -> Option<String> {
    let ours = |name: &str| RAILS.iter().find(|(theirs, _)| *theirs == name).map(|(_, ours)| *ours);
    if found.kind == Kind::Number && before.ends_with('.') && before.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return Some(match ours(word) {
            Some(ours) => format!("a name begins with a letter: write `{before}{ours}`"),
            None => "a name begins with a letter: `trackbed docs` lists the entries of the library".to_owned(),
        });
    }
    if let Some(ours) = ours(before).filter(|_| word == "{") {
        return Some(format!("a name begins with a letter: write `rails.{ours}`"));
    }
    let path = |text: &str| text.contains('.') && text.chars().all(|c| c.is_ascii_alphanumeric() || "._".contains(c));
    let letters = before.starts_with(|c: char| c.is_ascii_alphabetic());
    if found.kind == Kind::Number && letters && path(before) && before.ends_with(char::is_alphabetic) {
        return Some(format!("a name has no blanks: write `{before}{word}`"));
    }
    let joined = before.replace('-', "");
    let dashed = before.contains('-') && !before.contains(" -") && letters && path(&joined);
    (word == "{" && dashed).then(|| format!("a name has no dashes: write `{joined}`"))
}
