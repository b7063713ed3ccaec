//! Gradings: the sieve curve, checks of the curve, and the part that the cuts leave.

use super::given::given;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Given, Grading, Passing};
use crate::units::{Dimension, number};

/// Below this share of the mass the modelled grains no longer represent the material.
const LEAST_SHARE: f64 = 0.5;
/// Shares of mass that differ by less are equal.
const TINY: f64 = 1e-9;

/// A sieve: its size, m, the share that passes, and its place in the text.
#[derive(Clone, Copy)]
struct Sieve {
    size: f64,
    share: f64,
    span: Span,
}

/// A grading, from a complete record.
pub fn grading(record: &Record, files: &mut Files<'_>, findings: &mut Findings) -> Option<Grading> {
    let cuts = [cut(record, "cut_below"), cut(record, "cut_above")];
    let passing = passing(record, cuts, files, findings)?;
    if cuts.contains(&None) {
        return None;
    }
    let [cut_below, cut_above] = cuts.map(Option::flatten);
    let grading = Grading { name: record.name.clone(), passing, cut_below, cut_above };
    leaves_grains(record, &grading, findings)?;
    Some(grading)
}

fn passing(
    record: &Record,
    cuts: [Option<Option<Given>>; 2],
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Option<Passing> {
    let slot = record.get("passing")?;
    let (sieves, whole) = match &slot.value {
        Val::Pairs(pairs) => {
            let sieve = |(size, share): &(Slot, Slot)| match (&size.value, &share.value) {
                (Val::Number(size_value), Val::Number(share)) => {
                    Some(Sieve { size: size_value.value, share: share.value, span: size.span })
                }
                _ => None,
            };
            (pairs.iter().map(sieve).collect::<Option<Vec<_>>>()?, slot.span)
        }
        Val::Word { word, arguments } if word.name == "file" => {
            let Some(Slot { value: Val::Text(name), span, .. }) = arguments.get("name") else { return None };
            (sieves_of(name, *span, files, findings)?, *span)
        }
        Val::Word { arguments, .. } => {
            let of = |name: &str| match arguments.get(name).map(|s| &s.value) {
                Some(Val::Number(n)) => Some(n.value),
                _ => None,
            };
            return log_normal(of("median")?, of("spread")?, slot.span, cuts, findings);
        }
        _ => return None,
    };
    is_a_curve(&sieves, whole, cuts, findings)?;
    Some(Passing::Sieves(sieves.iter().map(|sieve| [sieve.size, sieve.share]).collect()))
}

/// A log-normal curve has no smallest and no largest grain: the cuts give them.
fn log_normal(
    median: f64,
    spread: f64,
    span: Span,
    cuts: [Option<Option<Given>>; 2],
    findings: &mut Findings,
) -> Option<Passing> {
    let missing: Vec<&str> = ["cut_below", "cut_above"]
        .into_iter()
        .zip(cuts)
        .filter(|(_, cut)| *cut == Some(None))
        .map(|(name, _)| name)
        .collect();
    if missing.is_empty() {
        return Some(Passing::LogNormal { median, spread });
    }
    let three = |sign: f64| number((median * (sign * 2.0 * spread).exp() * 1e3).round().max(0.001));
    findings.report(
        Diagnostic::new(Code::E0415, "a log-normal grading has neither a smallest nor a largest grain")
            .label(span, format!("without `{}`", missing.join("` and `")))
            .help(format!(
                "add both cuts; `cut_below = {} mm` and `cut_above = {} mm` leave 95 % of the mass",
                three(-1.0),
                three(1.0)
            )),
    );
    None
}

/// The columns `size` and `passing` of a data file.
fn sieves_of(name: &str, span: Span, files: &mut Files<'_>, findings: &mut Findings) -> Option<Vec<Sieve>> {
    let table = files.table(name, span, findings)?;
    let of = |wanted: &str, dimension: Dimension| {
        table.column(wanted).filter(|i| table.columns[*i].unit.dimension == dimension)
    };
    let (Some(size), Some(share)) = (of("size", Dimension::LENGTH), of("passing", Dimension::NONE)) else {
        findings.report(
            Diagnostic::new(Code::E0509, format!("`{name}` has no columns `size` and `passing`"))
                .label(table.header, "other columns")
                .label(span, "read here")
                .help("begin the file with `size_mm,passing_%`"),
        );
        return None;
    };
    let mut sieves = Vec::new();
    let mut sound = true;
    for cells in table.rows() {
        let (size, share) = (cells[size], cells[share]);
        for (wrong, cell, what) in [
            (size.value <= 0.0, size, "a size above 0 mm"),
            (!(-TINY..=1.0 + TINY).contains(&share.value), share, "a share from 0 to 100 %"),
        ] {
            if wrong {
                sound = false;
                findings.report(
                    Diagnostic::new(Code::E0510, format!("expected {what}"))
                        .label(cell.span, "out of range")
                        .label(span, "read here"),
                );
            }
        }
        sieves.push(Sieve { size: size.value, share: share.value, span: size.span });
    }
    Some(sieves).filter(|_| sound)
}

/// Checks that sizes ascend, that shares do not fall, and that the curve gives the size of every modelled grain.
fn is_a_curve(sieves: &[Sieve], whole: Span, cuts: [Option<Option<Given>>; 2], findings: &mut Findings) -> Option<()> {
    let [Some(first), Some(last)] = [sieves.first(), sieves.last()].map(|end| end.filter(|_| sieves.len() > 1)) else {
        findings.report(
            Diagnostic::new(Code::E0414, format!("a grading needs two sieves or more, found {}", sieves.len()))
                .label(whole, "no curve")
                .help("write something like `[22.4 mm: 0 %, 40 mm: 45 %, 63 mm: 100 %]`"),
        );
        return None;
    };
    if sieves.windows(2).all(|pair| pair[1].size < pair[0].size) {
        let sieve = |s: &Sieve| format!("{} mm: {} %", number(s.size * 1e3), percent(s.share));
        let ascending: Vec<String> = sieves.iter().rev().map(sieve).collect();
        findings.report(
            Diagnostic::new(Code::E0414, "the sizes of a grading must ascend")
                .label(whole, "from coarse to fine")
                .write(whole, format!("[{}]", ascending.join(", "))),
        );
        return None;
    }
    let mut sound = true;
    for pair in sieves.windows(2) {
        let mistake = if pair[1].size <= pair[0].size {
            "the sizes of a grading must ascend".to_string()
        } else if pair[1].share < pair[0].share - TINY {
            let [coarse, fine] = [pair[1], pair[0]].map(|s| (percent(s.share), number(s.size * 1e3)));
            format!(
                "a sieve of {} mm passes {} %, but a finer sieve of {} mm passes {} %",
                coarse.1, coarse.0, fine.1, fine.0
            )
        } else {
            continue;
        };
        sound = false;
        findings.report(
            Diagnostic::new(Code::E0414, mistake)
                .label(pair[1].span, "not greater than the sieve before")
                .label(pair[0].span, "the sieve before")
                .help("list the sieves from fine to coarse, each with the share of the mass that passes it"),
        );
    }
    let cut = |i: usize| cuts[i].flatten().map(|cut: Given| *cut);
    let (low, high) = (cut(0).is_some_and(|c| c >= first.size), cut(1).is_some_and(|c| c <= last.size));
    // a cut that is not understood may be the missing cut
    if sound && first.share > TINY && !low && cuts[0].is_some() {
        sound = false;
        let [size, share] = [number(first.size * 1e3), percent(first.share)];
        findings.report(
            Diagnostic::new(Code::E0414, format!("{share} % of the mass is finer than the finest sieve"))
                .label(first.span, "the finest sieve")
                .help(format!(
                    "begin with a size that no grain passes, such as `{} mm: 0 %`, or write `cut_below = {size} mm`",
                    number((first.size * 500.0 * 1e3).round() / 1e3)
                )),
        );
    }
    if sound && last.share < 1.0 - TINY && !high && cuts[1].is_some() {
        sound = false;
        let [size, share] = [number(last.size * 1e3), percent(1.0 - last.share)];
        findings.report(
            Diagnostic::new(Code::E0414, format!("{share} % of the mass is coarser than the coarsest sieve"))
                .label(last.span, "the coarsest sieve")
                .help(format!("end with a size that all grains pass, or write `cut_above = {size} mm`")),
        );
    }
    sound.then_some(())
}

/// Checks that the cuts leave grains, and enough grains to represent the material.
fn leaves_grains(record: &Record, grading: &Grading, findings: &mut Findings) -> Option<()> {
    let spans: Vec<Span> = ["cut_below", "cut_above"].iter().filter_map(|f| record.get(f)?.origin.span()).collect();
    let at = |diagnostic: Diagnostic, text: &str| match spans.split_first() {
        Some((first, [])) => diagnostic.label(*first, text.to_string()),
        Some((first, rest)) => diagnostic.label(*first, text.to_string()).label(rest[0], "and here"),
        None => diagnostic.label(record.span, text.to_string()),
    };
    let (name, [finest, coarsest]) = (&grading.name, grading.passing.ends());
    let share = if grading.smallest() < grading.largest() { grading.modelled_share() } else { 0.0 };
    if share < TINY {
        let ends = format!("its grains reach from {} mm to {} mm", mm(finest), mm(coarsest));
        let mistake = Diagnostic::new(Code::E0415, format!("the cuts leave no grains of grading `{name}`"));
        let help = if coarsest.is_finite() { ends } else { "make `cut_below` smaller than `cut_above`".into() };
        findings.report(at(mistake, "cut here").help(help));
        return None;
    }
    if share < LEAST_SHARE {
        let message = format!(
            "grading `{name}` is modelled from {} mm to {} mm: {} % of its mass, D50 {} mm",
            mm(grading.smallest()),
            mm(grading.largest()),
            percent(share),
            mm(grading.d(50.0))
        );
        findings.report(
            at(Diagnostic::new(Code::E0416, message), "cut here")
                .help("the omitted grains fill pores and carry load: state the cuts with the results, or cut less"),
        );
    }
    Some(())
}

/// A cut, `Some(None)` if there is none; `None` if it is not understood.
fn cut(record: &Record, field: &str) -> Option<Option<Given>> {
    match record.get(field).map(|slot| &slot.value) {
        Some(Val::Number(_)) => Some(given(record, field)),
        Some(Val::Word { .. }) => Some(None),
        _ => None,
    }
}

fn percent(share: f64) -> String {
    number((share * 1e3).round() / 10.0)
}

fn mm(size: f64) -> String {
    number((size * 1e5).round() / 100.0)
}
