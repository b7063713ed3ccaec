//! The bed that holds the layers: wide enough for the sleepers and their shoulders.

use super::given::given;
use super::trackform::Built;
use crate::check::evaluate::value::Record;
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Base, Bed, BedEnds, Given};
use crate::units::number;

/// The bed, whose side walls leave room for the longest sleeper and its shoulder.
pub fn bed(track: &Record, forms: &[Built], findings: &mut Findings) -> Option<Bed> {
    let half_width = match track.get("bed_width") {
        Some(_) => Some(given(track, "bed_width")?),
        None => None,
    };
    if let Some(half) = half_width
        && let Some(widest) = forms.iter().filter_map(Footing::of_form).max_by(|a, b| a.half().total_cmp(&b.half()))
        && *half < widest.half() * (1.0 - 1e-9)
    {
        let span = track.get("bed_width").map_or(track.span, |slot| slot.span);
        findings.report(widest.too_wide_for(*half, span));
        return None;
    }
    Some(Bed {
        half_width,
        ends: if track.word("bed_ends")? == "periodic" { BedEnds::Periodic } else { BedEnds::Walls },
        base: if track.word("base")? == "quiet" { Base::Quiet } else { Base::Rigid },
    })
}

/// Sleepers with their shoulders, which must fit into the bed.
struct Footing<'a> {
    trackform: &'a str,
    /// Length of the sleepers, m, and its place in the text.
    length: f64,
    length_span: Option<Span>,
    shoulder: Option<Given>,
}

impl Footing<'_> {
    fn of_form(built: &Built) -> Option<Footing<'_>> {
        let sleeper = built.sleeper.as_ref()?;
        Some(Footing {
            trackform: &built.name,
            length: sleeper.number("length")?.value,
            length_span: sleeper.get("length")?.origin.span(),
            shoulder: built.crib.and_then(|crib| crib.shoulder),
        })
    }

    /// Half of its width, m.
    fn half(&self) -> f64 {
        self.length / 2.0 + self.shoulder.map_or(0.0, |shoulder| *shoulder)
    }

    /// The mistake of a bed with a half width, m, given at a place.
    fn too_wide_for(&self, half: f64, stated: Span) -> Diagnostic {
        let beside =
            self.shoulder.map_or(String::new(), |shoulder| format!(", with shoulders of {} m", number(*shoulder)));
        let message = format!(
            "the bed is {} m wide, but the sleepers of trackform `{}` are {} m long{beside}",
            number(2.0 * half),
            self.trackform,
            number(self.length)
        );
        let mut mistake = Diagnostic::new(Code::E0420, message).label(stated, "between its side walls");
        if let Some(span) = self.length_span {
            mistake = mistake.label(span, "length of a sleeper");
        }
        let mut as_wide = "the sleepers";
        if let Some(shoulder) = self.shoulder {
            as_wide = "the sleepers and their shoulders";
            if let Some(span) = shoulder.origin.span() {
                mistake = mistake.label(span, "beyond each end of a sleeper");
            }
        }
        mistake.help(format!(
            "write `bed_width = {} m per track` or more, or leave it out: the bed is then as wide as {as_wide}",
            number(2.0 * self.half())
        ))
    }
}
