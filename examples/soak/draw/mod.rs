//! Scenes drawn at random from the schema: declarations of its kinds, each with the fields that it needs and some of
//! the others, and values of their forms. Scene `k` of an aim always has the same text.

mod aim;
mod asked;
mod number;
mod typical;
mod value;

pub use aim::Aim;

use super::dice::Dice;
use aim::{ALONE, want};
use trackbed::check::library;
use trackbed::schema::{self, COMMON, Field, Form, KINDS, Kind, Measure, Need, Role};
use typical::{Typical, object_kind};

/// What is known of the vocabulary before anything is drawn.
pub struct Known {
    typical: Typical,
    /// Kinds and full names of the entries of the library.
    library: Vec<(String, String)>,
}

impl Known {
    /// From the library and these texts.
    pub fn read<'t>(texts: impl Iterator<Item = &'t str>) -> Known {
        let library = library().into_iter().map(|entry| (entry.kind, format!("{}.{}", entry.module, entry.name)));
        Known { typical: Typical::read(texts), library: library.collect() }
    }
}

/// Scene `number` of an aim.
pub fn scene(known: &Known, aim: Aim, number: u64) -> String {
    let mut drawing = Drawing {
        known,
        aim,
        dice: Dice::new(number.wrapping_mul(8).wrapping_add(aim as u64)),
        wild: 0.0,
        declared: Vec::new(),
        texts: Vec::new(),
        sections: 1,
        transitions: Vec::new(),
        numbers: Vec::new(),
        open: 0,
    };
    // most scenes have usual numbers only, some also such as nobody writes
    drawing.wild = if drawing.chance(0.7) { 0.0 } else { 0.1 };
    drawing.scene()
}

/// A declaration that others may name.
struct Declared {
    kind: &'static str,
    name: String,
}

/// A scene under way.
struct Drawing<'k> {
    known: &'k Known,
    aim: Aim,
    dice: Dice,
    /// How often a number is drawn from its whole range.
    wild: f64,
    declared: Vec<Declared>,
    texts: Vec<String>,
    sections: usize,
    /// Names of the boundaries between sections, where they have some.
    transitions: Vec<String>,
    /// Numbers of declarations by their path, with what they may be.
    numbers: Vec<(String, String, &'static Measure)>,
    /// Objects inside objects now.
    open: usize,
}

impl Drawing<'_> {
    fn chance(&mut self, share: f64) -> bool {
        self.share() < share
    }

    /// 0 .. 1, 1 left out.
    fn share(&mut self) -> f64 {
        self.dice.roll(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn between(&mut self, [least, most]: [usize; 2]) -> usize {
        least + self.dice.roll(most - least + 1)
    }

    fn scene(mut self) -> String {
        // the track first: what others say of places hangs on it
        let track = KINDS.iter().filter(|kind| kind.name == "track");
        let others = KINDS.iter().filter(|kind| kind.name != "track" && matches!(kind.role, Role::Scene { .. }));
        for kind in track.chain(others) {
            let wanted = want(self.aim, kind.name);
            if !self.chance(wanted.and_then(|want| want.chance).unwrap_or(0.2)) {
                continue;
            }
            let once = kind.role == Role::Scene { once: true };
            let several = wanted.and_then(|want| want.items).unwrap_or([1, if once { 1 } else { 2 }]);
            for _ in 0..self.between(several) {
                self.declare(kind, None);
            }
        }
        format!("use std\n\n{}\n", self.texts.join("\n\n"))
    }

    /// Draws a declaration and gives its name.
    fn declare(&mut self, kind: &'static Kind, base: Option<String>) -> Option<String> {
        let number = self.declared.iter().filter(|other| other.kind == kind.name).count() + 1;
        let name = format!("{}_{number}", kind.name);
        // it has its number before its parts are drawn, and may be named when it is finished
        let place = self.declared.len();
        self.declared.push(Declared { kind: kind.name, name: String::new() });
        let fields = match &base {
            Some(_) => self.changes(kind),
            None => self.fields(kind, &name),
        };
        let head = base.map_or(format!("{} {name}", kind.name), |base| format!("{} {name} : {base}", kind.name));
        let fields: Vec<String> = fields?.iter().map(|(field, value)| format!("  {field} = {value}")).collect();
        self.texts.push(format!("{head} {{\n{}\n}}", fields.join("\n")));
        self.declared[place].name.clone_from(&name);
        Some(name)
    }

    /// Fields of a new object; `None` where one that it needs cannot be drawn. `owner` is the declaration to which they
    /// belong.
    fn fields(&mut self, kind: &'static Kind, owner: &str) -> Option<Vec<(String, String)>> {
        let ways = self.ways(kind);
        let mut fields: Vec<(String, String)> = Vec::new();
        for field in kind.fields {
            let chosen = ways.iter().find(|(name, _)| *name == field.name).map(|(_, chosen)| *chosen);
            if !self.is_written(kind, field, &ways, &fields) {
                continue;
            }
            match self.value(&format!("{}.{}", kind.name, field.name), &field.form) {
                Some(value) => fields.push((field.name.into(), value)),
                None if field.need == Need::Required || chosen == Some(true) => return None,
                None => continue,
            }
            self.may_vary(owner, kind, field);
        }
        if let Some(of) = kind.changes() {
            fields.extend(self.changes_under(kind, of));
        }
        for field in COMMON {
            if self.chance(0.02) {
                fields.push((field.name.into(), self.value(&format!("{}.{}", kind.name, field.name), &field.form)?));
            }
        }
        self.count_from(kind, &mut fields);
        Some(fields)
    }

    /// Whether a field is written, where the ways that are chosen, and the fields before it, leave room for it.
    fn is_written(
        &mut self,
        kind: &Kind,
        field: &'static Field,
        ways: &[(&str, bool)],
        before: &[(String, String)],
    ) -> bool {
        let chosen = ways.iter().find(|(name, _)| *name == field.name).map(|(_, chosen)| *chosen);
        let has = |name: &str| before.iter().any(|(other, value)| other == name && value != "none");
        let comes = |name: &str| has(name) || ways.contains(&(name, true));
        let beside = ALONE.iter().filter(|(of, ..)| *of == kind.name).any(|(_, one, others)| {
            (field.name == *one && others.iter().any(|other| has(other)))
                || (comes(one) && others.contains(&field.name))
        });
        // names of boundaries: needed where there are several, and without meaning where there is none
        if let Form::Pairs { key: Form::Name, .. } = field.form {
            return self.sections > 2 || (self.sections == 2 && self.chance(0.3));
        }
        if matches!(field.form, Form::List(Form::Name)) {
            return false; // see `count_from`
        }
        let wanted = want(self.aim, &format!("{}.{}", kind.name, field.name)).and_then(|want| want.chance);
        let share = match (chosen, wanted, field.need) {
            (Some(false), ..) => 0.0,
            (_, Some(0.0), _) => 0.0,
            _ if beside => 0.0,
            (Some(true), ..) | (_, _, Need::Required) => 1.0,
            (_, Some(share), _) => share,
            (_, _, Need::Alternative) => 0.0,
            _ if field.unread => 0.02,
            _ => 0.12,
        };
        self.chance(share)
    }

    /// Of each choice of a kind one way: its fields are written, those of the other ways are not.
    fn ways(&mut self, kind: &'static Kind) -> Vec<(&'static str, bool)> {
        let mut chosen = Vec::new();
        for alternative in kind.alternatives {
            let usable = |field: &str| {
                let wanted = want(self.aim, &format!("{}.{field}", kind.name)).and_then(|want| want.chance);
                wanted != Some(0.0) && !field.contains('.')
            };
            let mut ways: Vec<_> = alternative.ways.iter().filter(|way| way.iter().any(|f| usable(f))).collect();
            // one that is rare is left out as often
            let rare = |name: &str| want(self.aim, &format!("{}.{name}", kind.name)).and_then(|want| want.chance);
            let shares: Vec<f64> = ways.iter().map(|way| rare(way[0]).unwrap_or(1.0)).collect();
            let mut shares = shares.into_iter();
            ways.retain(|_| self.chance(shares.next().unwrap_or(1.0)));
            let way = match alternative.default {
                Some((field, _))
                    if kind.field(field).is_some_and(|f| f.need == Need::Alternative) && self.chance(0.4) =>
                {
                    None
                }
                _ if ways.is_empty() => None,
                _ => Some(ways[self.dice.roll(ways.len())]),
            };
            let all = alternative.ways.iter().flat_map(|way| way.iter()).filter(|field| !field.contains('.'));
            let mut taken = way.map(|way| way.to_vec()).unwrap_or_default();
            // of fields that serve beside each other one is enough
            let beside = taken.iter().all(|name| kind.field(name).is_some_and(|f| f.need != Need::Alternative));
            if beside && taken.len() > 1 && self.chance(0.8) {
                let keep = self.dice.roll(taken.len());
                taken = vec![taken[keep]];
                if !usable_in(self.aim, kind.name, taken[0]) {
                    taken = way.map(|way| way.to_vec()).unwrap_or_default();
                }
            }
            chosen.extend(all.map(|name| (*name, taken.contains(name))));
        }
        chosen
    }

    /// Fields of an extension: one or two of its kind that stand by themselves.
    fn changes(&mut self, kind: &'static Kind) -> Option<Vec<(String, String)>> {
        let by_itself = |field: &&Field| matches!(field.form, Form::Number(_) | Form::Words(_) | Form::Integer { .. });
        let fields: Vec<&'static Field> =
            kind.fields.iter().filter(by_itself).filter(|f| f.need != Need::Alternative).collect();
        if fields.is_empty() {
            return Some(Vec::new());
        }
        let field = fields[self.dice.roll(fields.len())];
        let value = self.value(&format!("{}.{}", kind.name, field.name), &field.form)?;
        Some(vec![(field.name.into(), value)])
    }

    /// Lines of a kind that says what differs in another one: a field of it, or one inside a part of it.
    fn changes_under(&mut self, kind: &'static Kind, of: &'static Kind) -> Vec<(String, String)> {
        let allowed =
            |aim: Aim, field: &&Field| usable_in(aim, kind.name, field.name) && usable_in(aim, of.name, field.name);
        let mut fields: Vec<&'static Field> = of.fields.iter().filter(|field| allowed(self.aim, field)).collect();
        fields.retain(|field| {
            let wanted = want(self.aim, &format!("{}.{}", kind.name, field.name)).and_then(|want| want.chance);
            wanted.is_none_or(|share| self.chance(share))
        });
        let Some(field) = fields.get(self.dice.roll(fields.len())) else { return Vec::new() };
        // a part that every object has
        let always =
            want(self.aim, &format!("{}.{}", of.name, field.name)).is_some_and(|want| want.chance == Some(1.0));
        let inner = object_kind(&field.form).filter(|_| always && self.chance(0.6));
        let (name, path, form) = match inner.map(|inner| (inner, self.dice.roll(inner.fields.len()))) {
            Some((inner, at)) => {
                let part = &inner.fields[at];
                (format!("{}.{}", field.name, part.name), format!("{}.{}", inner.name, part.name), &part.form)
            }
            None => (field.name.to_string(), format!("{}.{}", of.name, field.name), &field.form),
        };
        self.value(&path, form).map(|value| (name, value)).into_iter().collect()
    }

    /// Says from which boundaries places count, where there are several or by chance.
    fn count_from(&mut self, kind: &'static Kind, fields: &mut Vec<(String, String)>) {
        let Some(from) = kind.fields.iter().find(|field| matches!(field.form, Form::List(Form::Name))) else { return };
        let is_place = |form: &Form| matches!(form, Form::Place | Form::Span | Form::List(Form::Place));
        let places = kind.fields.iter().filter(|field| is_place(&field.form));
        let counted = places.into_iter().any(|place| fields.iter().any(|(name, _)| name == place.name));
        if counted && !self.transitions.is_empty() && (self.transitions.len() > 1 || self.chance(0.3)) {
            let at = self.dice.roll(self.transitions.len());
            fields.push((from.name.into(), self.transitions[at].clone()));
        }
    }

    /// Remembers a number that a study may vary.
    fn may_vary(&mut self, owner: &str, kind: &Kind, field: &'static Field) {
        if let (Form::Number(measure), Role::Part, true) = (&field.form, kind.role, owner.starts_with(kind.name)) {
            let path = format!("{}.{}", kind.name, field.name);
            self.numbers.push((format!("{owner}.{}", field.name), path, measure));
        }
    }
}

/// Whether an aim lets a field be written.
fn usable_in(aim: Aim, kind: &str, field: &str) -> bool {
    want(aim, &format!("{kind}.{field}")).and_then(|want| want.chance) != Some(0.0)
}

/// The kind of that name.
fn kind(name: &str) -> Option<&'static Kind> {
    schema::kind(name)
}
