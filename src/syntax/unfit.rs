//! Characters that no terminal, page or picture can show: reported at their place.

use super::draft::Draft;
use crate::diag::{Code, Diagnostic, Edit, Fix, Span};

/// Reports the first such character, and their number.
pub(super) fn tell(draft: &mut Draft<'_>) {
    let mut unfit = draft.original.char_indices().filter(|(_, c)| is_unfit(*c));
    let Some((start, first)) = unfit.next() else { return };
    let more = match unfit.count() {
        0 => String::new(),
        more => format!(", and {more} more such characters"),
    };
    let message = format!("the text contains a character that cannot be shown, U+{:04X}{more}", u32::from(first));
    let span = Span::new(draft.file, start, start + first.len_utf8());
    let all = draft.original.char_indices().filter(|(_, c)| is_unfit(*c));
    let edits = all.map(|(i, c)| Edit { span: draft.span(i, i + c.len_utf8()), text: String::new() });
    let fix = Fix { title: "take it out".to_owned(), edits: edits.collect() };
    draft.diagnostics.push(Diagnostic::new(Code::E0101, message).label(span, "here").help("take it out").fix(fix));
}

/// Control characters, signs that change the direction of text, and code points that are not characters.
fn is_unfit(c: char) -> bool {
    let is_control = c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    is_control || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fffe}' | '\u{ffff}')
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use crate::diag::{Code, Sources};

    #[test]
    fn what_a_terminal_or_a_picture_cannot_show_is_told_once() {
        for unfit in ['\u{1b}', '\u{9b}', '\u{202e}', '\u{fffe}'] {
            let text = format!("scenario {{ title = \"a{unfit}b\" }}\n");
            let mut sources = Sources::default();
            let (_, told) = parse(sources.add("a.track", text.as_str(), false), &text);
            assert_eq!(told.len(), 1, "{told:?}");
            assert_eq!(told[0].code, Code::E0101);
            let message = format!("the text contains a character that cannot be shown, U+{:04X}", u32::from(unfit));
            assert_eq!(told[0].message, message);
        }
        let (_, told) = parse(Sources::default().add("a.track", "", false), "// a\tb \u{e4} \u{b5}m\r\n");
        assert!(told.is_empty(), "{told:?}");
    }
}
