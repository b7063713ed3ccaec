//! Writes SVG text: escaped, rounded to a tenth of a pixel, coloured by classes so that light and dark both work.

use std::fmt::Write;

/// A box of the picture, px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

/// Anchor of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// The style of every picture; a page states it once, a picture on its own carries it along.
pub const STYLE: &str = include_str!("figure.css");

/// A picture that is being written.
#[derive(Debug, Default)]
pub struct Svg {
    body: String,
}

impl Svg {
    pub fn line(&mut self, class: &str, from: (f64, f64), to: (f64, f64)) {
        let (x1, y1, x2, y2) = (px(from.0), px(from.1), px(to.0), px(to.1));
        let _ = write!(self.body, r#"<line class="{class}" x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}"/>"#);
    }

    pub fn rect(&mut self, class: &str, frame: Frame) {
        let (x, y, width, height) = (px(frame.x), px(frame.y), px(frame.width.max(0.0)), px(frame.height.max(0.0)));
        let _ = write!(self.body, r#"<rect class="{class}" x="{x}" y="{y}" width="{width}" height="{height}"/>"#);
    }

    /// A rectangle with the tooltip `title`.
    pub fn titled_rect(&mut self, class: &str, frame: Frame, title: &str) {
        self.body += "<g>";
        self.rect(class, frame);
        let _ = write!(self.body, "<title>{}</title></g>", escape(title));
    }

    pub fn circle(&mut self, class: &str, centre: (f64, f64), radius: f64, title: &str) {
        let (x, y, r) = (px(centre.0), px(centre.1), px(radius));
        let _ = write!(self.body, r#"<circle class="{class}" cx="{x}" cy="{y}" r="{r}""#);
        self.close("circle", title);
    }

    /// A broken line through `points`; `closed` makes it an outline.
    pub fn path(&mut self, class: &str, points: &[(f64, f64)], closed: bool, title: &str) {
        let Some((first, rest)) = points.split_first() else { return };
        let _ = write!(self.body, r#"<path class="{class}" d="M{} {}"#, px(first.0), px(first.1));
        for (index, point) in rest.iter().enumerate() {
            let command = if index == 0 { "L" } else { " " };
            let _ = write!(self.body, "{command}{} {}", px(point.0), px(point.1));
        }
        self.body += if closed { "Z\"" } else { "\"" };
        self.close("path", title);
    }

    /// Many small outlines of one class as one path.
    pub fn outlines(&mut self, class: &str, outlines: &[[(f64, f64); 4]]) {
        let _ = write!(self.body, r#"<path class="{class}" d=""#);
        for [a, rest @ ..] in outlines {
            let _ = write!(self.body, "M{} {}L", px(a.0), px(a.1));
            let corners: Vec<String> = rest.iter().map(|(x, y)| format!("{} {}", px(*x), px(*y))).collect();
            let _ = write!(self.body, "{}Z", corners.join(" "));
        }
        self.body += "\"/>";
    }

    /// Many straight lines as one path.
    pub fn strokes(&mut self, lines: &[[(f64, f64); 2]]) {
        if lines.is_empty() {
            return;
        }
        self.body += "<path d=\"";
        for [from, to] in lines {
            let _ = write!(self.body, "M{} {}L{} {}", px(from.0), px(from.1), px(to.0), px(to.1));
        }
        self.body += "\"/>";
    }

    /// Ends a tag, with its tooltip.
    fn close(&mut self, tag: &str, title: &str) {
        if title.is_empty() {
            self.body += "/>";
        } else {
            let _ = write!(self.body, "><title>{}</title></{tag}>", escape(title));
        }
    }

    pub fn text(&mut self, class: &str, at: (f64, f64), anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, text) = (px(at.0), px(at.1), escape(text));
        let _ = write!(self.body, r#"<text class="{class}" x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>"#);
    }

    /// Everything drawn by `draw` is cut at `frame`. `id` is unique on a page.
    pub fn clipped(&mut self, id: &str, frame: Frame, draw: impl FnOnce(&mut Svg)) {
        let _ = write!(self.body, r#"<clipPath id="{id}">"#);
        self.rect("", frame);
        let _ = write!(self.body, r#"</clipPath><g clip-path="url(#{id})">"#);
        draw(self);
        self.body += "</g>";
    }

    /// Gradients and the like, as XML.
    pub fn define(&mut self, xml: &str) {
        self.body += xml;
    }

    /// Everything drawn by `draw` shares `attributes`.
    pub fn group(&mut self, attributes: &str, draw: impl FnOnce(&mut Svg)) {
        let _ = write!(self.body, "<g {attributes}>");
        draw(self);
        self.body += "</g>";
    }

    /// A circle of a paint of its own.
    pub fn ball(&mut self, fill: &str, centre: (f64, f64), radius: f64) {
        let (x, y, r) = (px(centre.0), px(centre.1), fine(radius));
        let _ = write!(self.body, r#"<circle fill="{fill}" cx="{x}" cy="{y}" r="{r}"/>"#);
    }

    /// A rectangle of a paint of its own.
    pub fn swatch(&mut self, fill: &str, frame: Frame) {
        let (x, y, width, height) = (px(frame.x), px(frame.y), px(frame.width), px(frame.height));
        let _ = write!(self.body, r#"<rect fill="{fill}" x="{x}" y="{y}" width="{width}" height="{height}"/>"#);
    }

    /// An area of a paint of its own.
    pub fn polygon(&mut self, fill: &str, corners: &[(f64, f64)]) {
        let corners: Vec<String> = corners.iter().map(|(x, y)| format!("{},{}", px(*x), px(*y))).collect();
        let _ = write!(self.body, r#"<polygon fill="{fill}" points="{}"/>"#, corners.join(" "));
    }

    /// A line of a width of its own; the colour is that of the group.
    pub fn stroke(&mut self, from: (f64, f64), to: (f64, f64), width: f64) {
        let (x1, y1, x2, y2, width) = (px(from.0), px(from.1), px(to.0), px(to.1), fine(width));
        let _ = write!(self.body, r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" stroke-width="{width}"/>"#);
    }

    /// The whole picture, valid on its own.
    pub fn finish(self, width: f64, height: f64, name: &str) -> String {
        let (width, height, name, body) = (px(width), px(height), escape(name), self.body);
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" class="tb" viewBox="0 0 {width} {height}" "#,
                r#"width="{width}" height="{height}" role="img" aria-label="{name}"><style>{style}</style>"#,
                r#"<rect class="paper" width="{width}" height="{height}"/>{body}</svg>"#
            ),
            width = width,
            height = height,
            name = name,
            style = STYLE,
            body = body
        )
    }
}

/// Makes text safe between tags and inside quotes.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            '\t' | '\n' | '\r' => safe.push(letter),
            _ if letter.is_control() => safe.push('\u{fffd}'), // XML has no such character
            _ => safe.push(letter),
        }
    }
    safe
}

/// Width of a text of 13 px, roughly.
pub fn text_width(text: &str) -> f64 {
    7.4 * text.chars().count() as f64
}

fn px(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0;
    if rounded == 0.0 || !rounded.is_finite() { "0".to_owned() } else { rounded.to_string() }
}

/// Sizes to a hundredth of a pixel, for what is small.
fn fine(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    if rounded.is_finite() { rounded.to_string() } else { "0".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_pixels_are_short() {
        assert_eq!(escape("a<b & \"c\"\u{1}'"), "a&lt;b &amp; &quot;c&quot;\u{fffd}&#39;");
        assert_eq!(px(-0.04), "0");
        assert_eq!(px(12.0), "12");
        assert_eq!(px(f64::NAN), "0");
        assert_eq!(px(1.0 / 3.0), "0.3");
    }
}
