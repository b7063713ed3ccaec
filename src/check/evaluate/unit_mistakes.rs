//! Help for unknown units, and counts of trains converted to axles.

use super::evaluator::Evaluator;
use crate::check::text::scope::ScopeId;
use crate::diag::{Code, Diagnostic, Help, Span};
use crate::syntax::tree::{Declaration, Item, Path, UnitText, Value, ValueKind};
use crate::units::{UnitError, parse_unit};

const SUCH: &str = "examples of units: `mm`, `kN`, `MN/m`, `kN s/m`, `kg/m^3`, `km/h`, `axles`";

/// Words for trains and vehicles, which people count instead of axles.
const TRAINS: [&str; 6] = ["train", "trains", "züge", "trenes", "treinen", "passages"];
const VEHICLES: [&str; 8] = ["wagon", "wagons", "car", "cars", "vehicle", "vehicles", "coaches", "waggons"];
/// Spans of time by which other sources count traffic.
const TIMES: [&str; 12] = ["a", "y", "yr", "year", "years", "annum", "day", "d", "week", "month", "months", "jahr"];
/// Words for `per`.
const PER: [&str; 4] = ["pro", "par", "por", "je"];
/// Words for a million.
const MILLION: [&str; 5] = ["million", "millions", "mio", "mln", "millionen"];

/// Axles of a vehicle: two bogies of two axles each.
const AXLES_OF_A_VEHICLE: u64 = 4;

/// The mistake of a unit; `whole` is the unit with its number.
pub(super) fn unit_mistake(unit: &UnitText, error: &UnitError, whole: &str) -> Diagnostic {
    match error {
        UnitError::Unknown { symbol, instead } => {
            let of_unit = || {
                of_what(unit, symbol).or_else(|| {
                    let ours = instead.as_ref()?;
                    let mended = unit.text.replacen(symbol.as_str(), ours, 1);
                    // other factors may be unknown too: the offer must be legal
                    let closed = mended.split("/axle").next().unwrap_or(&mended).to_owned();
                    Some(if ours.contains('(') { Help::say(format!("write {ours}")) } else { Help::meant(closed) })
                })
            };
            let (place, help) = match by_custom(unit, symbol, whole) {
                Some(found) => found,
                None => (unit.span, of_unit().unwrap_or_else(|| Help::say(SUCH))),
            };
            Diagnostic::new(Code::E0303, format!("unknown unit `{symbol}`"))
                .label(unit.span, "not a unit")
                .advise(place, help)
        }
        UnitError::Exponent => {
            Diagnostic::new(Code::E0103, format!("the exponents of `{}` go beyond -9 .. 9", unit.text))
                .label(unit.span, "too large")
        }
        UnitError::Form => {
            let help = match unit.text.contains('°') {
                true => "degrees are written `deg`: `35 deg`",
                false => SUCH,
            };
            Diagnostic::new(Code::E0303, format!("`{}` is not a unit", unit.text))
                .label(unit.span, "not a unit")
                .help(help)
        }
    }
}

/// `MN/m/seat`: the basis of a value is written behind `per`.
fn of_what(unit: &UnitText, symbol: &str) -> Option<Help> {
    crate::schema::basis_name(symbol).then(|| {
        let rest = unit.text.replacen(symbol, "", 1);
        let rest = rest.trim_end_matches(['/', '*', ' ']);
        Help::write(format!("{}per {symbol}", if rest.is_empty() { String::new() } else { format!("{rest} ") }))
    })
}

/// Special spellings: a power of ten, a million, a count per year, `per` in another language.
fn by_custom(unit: &UnitText, symbol: &str, whole: &str) -> Option<(Span, Help)> {
    let text = unit.text.as_str();
    let start = unit.span.end.checked_sub(whole.len() as u32)?;
    let quantity = Span { start, ..unit.span };
    let say = |help: &str| Some((unit.span, Help::say(help)));
    let write = |help: Help| Some((quantity, help));
    let digits = whole.strip_suffix(text)?.trim();
    let closed: String = text.split(' ').collect();
    if closed != text && parse_unit(&closed).is_ok() {
        return Some((unit.span, Help::meant(closed)));
    }
    // `1x10^-4 s`
    if let Some(rest) = text.strip_prefix("x10^") {
        let (power, unit) = rest.split_once(' ').unwrap_or((rest, ""));
        let written = format!("{digits}e{power} {unit}").trim_end().to_owned();
        let said = format!("write powers of ten in the number: `{digits}e{power} {unit}`");
        return write(Help { said, writes: vec![written] });
    }
    if text.contains(&format!("({symbol}")) {
        return say(&format!("begin a remark with `//`: `// {symbol}`"));
    }
    let lower = symbol.to_lowercase();
    if MILLION.contains(&lower.as_str()) {
        let rest = text.replacen(symbol, "", 1).trim_start_matches(['.', ' ']).to_owned();
        return write(match rest.as_str() {
            "t" | "tonnes" | "tons" | "GT" => Help::write(format!("{digits} MGT")),
            _ => Help::write(format!("{digits}e6 {rest}")),
        });
    }
    if let Some((counted, time)) = text.split_once('/').filter(|(_, time)| TIMES.contains(time)) {
        let counts = matches!(counted, "axles" | "MGT" | "t" | "axle");
        let why = format!(": traffic is counted for the whole run, not per {time}");
        return counts.then(|| (quantity, Help::write(format!("{digits} {counted}")).and(&why)));
    }
    if TIMES.contains(&lower.as_str()) {
        return say("traffic is counted in `axles` or as the mass carried, `MGT`, not by time");
    }
    if let Some((before, _)) = text.split_once(&format!(" {symbol}")).filter(|_| PER.contains(&lower.as_str())) {
        return say(&format!("the basis of a value follows `per`: `{digits} {before} per seat`, or `per sleeper`"));
    }
    match text {
        "axle loads" | "axle load" => write(Help::write(format!("{digits} axles"))),
        "load cycles" | "load applications" => {
            let (cycles, axles) = (format!("{digits} cycles"), format!("{digits} axles"));
            let said = format!("write `{cycles}`, or `{axles}` if trains run");
            write(Help { said, writes: vec![cycles, axles] })
        }
        _ => None,
    }
}

impl Evaluator<'_> {
    /// `1000 trains` in axles, if all trains of the main file have the same number.
    pub(super) fn of_trains(&self, unit: &UnitText) -> Option<(Span, Help)> {
        let lower = unit.text.to_lowercase();
        let trains = TRAINS.contains(&lower.as_str());
        if !trains && !VEHICLES.contains(&lower.as_str()) {
            return None;
        }
        let (what, axles) = match trains {
            true => ("train", self.axles_of_all_trains()),
            false => ("vehicle", Some(AXLES_OF_A_VEHICLE)),
        };
        let Some(axles) = axles else {
            return Some((unit.span, Help::say("count in `axles`: each vehicle of a train has 4")));
        };
        let file = &self.files.sources.get(unit.span.file).text;
        let before = file[..unit.span.start as usize].trim_end();
        let start = match before.strip_suffix(']') {
            Some(list) => list.rfind('[')?,
            None => before.trim_end_matches(|c: char| c.is_ascii_digit() || "._e".contains(c)).len(),
        };
        let counts =
            before[start..].trim_matches(['[', ']']).split(',').map(|n| n.trim().replace('_', "").parse().ok());
        let counts: Vec<f64> = counts.collect::<Option<_>>()?;
        let told: Vec<String> = counts.iter().map(|n| grouped((n * axles as f64).round() as u64)).collect();
        let written = match before.ends_with(']') {
            true => format!("[{}] axles", told.join(", ")),
            false => format!("{} axles", told.join(", ")),
        };
        let why = format!(": a {what} here has {axles} axles");
        Some((Span { start: start as u32, ..unit.span }, Help::write(written).and(&why)))
    }

    /// The axles of a train, if all trains of the main file have the same number.
    fn axles_of_all_trains(&self) -> Option<u64> {
        let items = self.scopes[self.main].tree.items.iter();
        let trains = items.filter_map(|item| match item {
            Item::Declaration(d) if d.kind.text == "train" => Some(d),
            _ => None,
        });
        let mut axles: Vec<u64> = trains.map(|d| self.axles_of(d, self.main, 0)).collect::<Option<_>>()?;
        axles.dedup();
        <[u64; 1]>::try_from(axles).ok().map(|[axles]| axles)
    }

    /// The axles of a train as written, or of its base.
    fn axles_of(&self, train: &Declaration, scope: ScopeId, depth: u32) -> Option<u64> {
        if let Some(field) = train.fields.iter().find(|f| f.path.text() == "vehicles") {
            return Some(AXLES_OF_A_VEHICLE * vehicles(&field.value)?);
        }
        let (base, scope) = self.declared_as(train.base.as_ref()?, scope).filter(|_| depth < 16)?;
        self.axles_of(base, scope, depth + 1)
    }

    /// The declaration that a path of one or two names leads to, and its file.
    fn declared_as(&self, path: &Path, scope: ScopeId) -> Option<(&Declaration, ScopeId)> {
        let (scope, name) = match path.names.as_slice() {
            [name] => (scope, name),
            [module, name] => (*self.scopes[scope].modules.get(&module.text)?, name),
            _ => return None,
        };
        match &self.scopes[scope].tree.items[*self.scopes[scope].names.get(&name.text)?] {
            Item::Declaration(declaration) => Some((declaration, scope)),
            _ => None,
        }
    }
}

/// The number of vehicles in a value of `train.vehicles`.
fn vehicles(value: &Value) -> Option<u64> {
    let ValueKind::List { entries, .. } = &value.kind else { return Some(1) };
    let count = |value: &Value| match value.kind {
        ValueKind::Number { value, .. } => Some(value as u64),
        _ => None,
    };
    entries.iter().map(|e| if e.key.is_some() { count(&e.value) } else { Some(1) }).sum()
}

/// `4_000`
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push('_');
        }
        out.push(digit);
    }
    out
}
