//! A value of each form of the schema.

use super::aim::want;
use super::{Drawing, kind};
use trackbed::schema::{Form, Role, Word};

/// Objects inside objects at most.
const DEEP: usize = 6;

impl Drawing<'_> {
    /// A value of a form; `None` where none can be drawn here. `path` is that of the field, such as `pad.stiffness`.
    pub(super) fn value(&mut self, path: &str, form: &'static Form) -> Option<String> {
        match form {
            Form::Text => Some(format!("\"drawn {}\"", self.dice.roll(1000))),
            Form::Number(measure) => self.quantity(path, measure),
            Form::Integer { min, max } => Some(self.whole(path, *min, *max)),
            Form::Words(words) => self.word(path, words),
            Form::Object(kind) => self.object(kind, false),
            Form::OneOf(forms) => self.one_of(path, forms),
            Form::List(item) => self.list(path, item),
            Form::Pairs { key, value, implied } => self.pairs(path, (key, value), *implied),
            Form::Interval(measure) => Some(self.interval(path, measure)),
            Form::Place => Some(self.place()),
            Form::Span => Some(self.span()),
            Form::Name => None,
            Form::Response => Some(self.response(path).into()),
            Form::Rule => Some(self.rule().into()),
            Form::Comparison => Some(self.comparison(path)),
            Form::Expression => Some(self.expression(path)),
            Form::Axes => self.axes(),
            Form::Settings => self.settings(),
        }
    }

    /// One of several forms, an object or a number rather than a bare word.
    fn one_of(&mut self, path: &str, forms: &'static [Form]) -> Option<String> {
        let only = want(self.aim, path).map_or(&[][..], |want| want.only);
        let may_stand = |form: &&'static Form| match form {
            Form::Number(measure) => only.is_empty() || only.contains(&measure.unit),
            Form::Object(kind) => only.is_empty() || only.contains(kind),
            _ => true,
        };
        let mut open: Vec<&'static Form> = forms.iter().filter(may_stand).collect();
        let words =
            |form: &&'static Form| matches!(form, Form::Words(words) if words.iter().all(|w| w.arguments.is_empty()));
        // a bare word mostly says that there is nothing
        let always = want(self.aim, path).is_some_and(|want| want.chance == Some(1.0));
        if open.len() > 1 && open.iter().any(|form| !words(form)) && (always || self.chance(0.95)) {
            open.retain(|form| !words(form));
        }
        while !open.is_empty() {
            let form = open.remove(self.dice.roll(open.len()));
            if let Some(value) = self.value(path, form) {
                return Some(value);
            }
        }
        None
    }

    /// A word that this version knows, with the arguments that it needs and some of the others.
    fn word(&mut self, path: &str, words: &'static [Word]) -> Option<String> {
        let only = want(self.aim, path).map_or(&[][..], |want| want.only);
        let known = |word: &&'static Word| words.iter().any(|w| only.contains(&w.name)) && only.contains(&word.name);
        let some = |word: &&'static Word| !words.iter().any(|w| only.contains(&w.name)) || known(word);
        // what is left of a depth, only stretches know
        let open: Vec<_> = words.iter().filter(|word| !word.planned && word.name != "rest").filter(some).collect();
        if open.is_empty() {
            return None;
        }
        let word = open[self.dice.roll(open.len())];
        let inside = format!("{path}.{}", word.name);
        let arguments: Vec<String> = word.arguments.iter().filter_map(|field| self.argument(&inside, field)).collect();
        // what the values of a file are of stands behind the word
        let behind = if word.arguments.iter().any(|field| field.name == "per") { " per seat" } else { "" };
        Some(match arguments.is_empty() {
            true => format!("{}{behind}", word.name),
            false => format!("{}({}){behind}", word.name, arguments.join(", ")),
        })
    }

    /// An object: of the library, declared, or written where it stands. A key is a name.
    fn object(&mut self, name: &'static str, is_key: bool) -> Option<String> {
        let kind = kind(name)?;
        let library: Vec<&String> =
            self.known.library.iter().filter(|(of, _)| of == name).map(|(_, full)| full).collect();
        let share = want(self.aim, &format!("library.{name}")).and_then(|want| want.chance).unwrap_or(0.55);
        let of_library = (!library.is_empty() && share > 0.0).then(|| library[self.dice.roll(library.len())].clone());
        let there: Vec<String> =
            self.declared.iter().filter(|d| d.kind == name && !d.name.is_empty()).map(|d| d.name.clone()).collect();
        if let (Some(full), true) = (&of_library, self.open >= DEEP || self.chance(share)) {
            return Some(full.clone());
        }
        if self.open >= DEEP {
            return None;
        }
        if !there.is_empty() && self.chance(0.35) {
            return Some(there[self.dice.roll(there.len())].clone());
        }
        self.open += 1;
        let drawn = if kind.role != Role::Nested && (is_key || self.chance(0.6)) {
            let base = of_library.filter(|_| self.chance(0.5));
            self.declare(kind, base)
        } else {
            let fields = match &of_library {
                Some(_) if self.chance(0.5) => self.changes(kind).map(|fields| (of_library, fields)),
                _ => self.fields(kind, "").map(|fields| (None, fields)),
            };
            fields.map(|(base, fields)| {
                let lines: Vec<String> = fields.iter().map(|(field, value)| format!("{field} = {value}")).collect();
                format!("{}{{ {} }}", base.map_or(String::new(), |base| base + " "), lines.join(", "))
            })
        };
        self.open -= 1;
        drawn
    }

    fn list(&mut self, path: &str, item: &'static Form) -> Option<String> {
        let count = want(self.aim, path).and_then(|want| want.items).unwrap_or([1, 2]);
        let count = self.between(count);
        let mut items: Vec<String> = (0..count).filter_map(|_| self.value(path, item)).collect();
        items.dedup();
        match items.len() {
            0 => None,
            1 if self.chance(0.6) => items.pop(),
            _ => Some(format!("[{}]", items.join(", "))),
        }
    }

    fn pairs(
        &mut self,
        path: &str,
        (key, value): (&'static Form, &'static Form),
        implied: Option<&str>,
    ) -> Option<String> {
        // the boundaries between sections have names
        if let Form::Name = key {
            let names = ["west", "middle", "east", "last"];
            self.transitions = names.iter().take(self.sections - 1).map(|name| (*name).to_string()).collect();
            let sides: Option<Vec<String>> = self
                .transitions
                .clone()
                .iter()
                .map(|name| Some(format!("{name}: {}", self.value(path, value)?)))
                .collect();
            return sides.map(|sides| format!("[{}]", sides.join(", ")));
        }
        let count = want(self.aim, path).and_then(|want| want.items).unwrap_or([1, 2]);
        let count = self.between(count);
        if let Some(shares) = self.curve(path, key, value).or_else(|| self.shares(path, key, value, count)) {
            return Some(shares);
        }
        let mut pairs = Vec::new();
        for _ in 0..count {
            let name = self.key(path, key)?;
            match implied.filter(|_| self.chance(0.5)) {
                Some(_) => pairs.push(name),
                None => pairs.push(format!("{name}: {}", self.length(path, value, pairs.len(), count)?)),
            }
        }
        if path == "track.sections" {
            self.sections = pairs.len();
        }
        Some(if implied.is_some() && pairs.len() == 1 && !pairs[0].contains(':') {
            pairs.remove(0)
        } else {
            format!("[{}]", pairs.join(", "))
        })
    }

    /// The value of a pair. Between two boundaries a length is one of whole sleepers, so that both count the same.
    fn length(&mut self, path: &str, form: &'static Form, at: usize, of: usize) -> Option<String> {
        let inner = path == "track.sections" && at > 0 && at + 1 < of;
        let mut value = self.value(path, form)?;
        while inner && !value.ends_with("sleepers") {
            value = self.value(path, form)?;
        }
        Some(value)
    }

    fn key(&mut self, path: &str, form: &'static Form) -> Option<String> {
        match form {
            Form::Object(kind) => self.object(kind, true),
            Form::OneOf(forms) => {
                let only = want(self.aim, path).map_or(&[][..], |want| want.only);
                let kinds: Vec<&'static str> = forms
                    .iter()
                    .filter_map(|form| if let Form::Object(kind) = form { Some(*kind) } else { None })
                    .filter(|kind| only.is_empty() || only.contains(kind))
                    .collect();
                let at = self.dice.roll(kinds.len());
                self.object(kinds.get(at).copied()?, true)
            }
            other => self.value(path, other),
        }
    }

    /// Numbers against shares are a curve: both ascend, the shares from nothing to all.
    fn curve(&mut self, path: &str, key: &'static Form, value: &'static Form) -> Option<String> {
        let (Form::Number(sizes), Form::Number(shares)) = (key, value) else { return None };
        if shares.unit != "%" {
            return None;
        }
        let mut size = self.within(&format!("{path}:key"), sizes);
        let steps = self.between([2, 5]);
        let mut points = Vec::new();
        for step in 0..steps {
            let share = 100.0 * step as f64 / (steps - 1) as f64;
            points.push(format!(
                "{} {}: {} %",
                super::number::plain(size),
                sizes.unit,
                super::number::plain(share.round())
            ));
            size = ((size * (1.05 + 0.25 * self.share())) * 1e4).round() / 1e4;
        }
        Some(format!("[{}]", points.join(", ")))
    }

    /// Shares of things that make up a whole.
    fn shares(&mut self, path: &str, key: &'static Form, value: &'static Form, count: usize) -> Option<String> {
        let (Form::Object(_), Form::Number(share)) = (key, value) else { return None };
        if share.unit != "%" || share.max != 100.0 {
            return None;
        }
        let names: Option<Vec<String>> = (0..count).map(|_| self.key(path, key)).collect();
        let mut names = names?;
        names.dedup();
        if let [one] = names.as_slice() {
            return Some(one.clone());
        }
        // quarters, so that each kind has whole trains
        let first = 25 * self.between([1, 3]);
        let rest = (100 - first) / (names.len() - 1);
        let of = |at: usize| if at == 0 { 100 - rest * (names.len() - 1) } else { rest };
        let pairs: Vec<String> = names.iter().enumerate().map(|(at, name)| format!("{name}: {} %", of(at))).collect();
        Some(format!("[{}]", pairs.join(", ")))
    }
}
