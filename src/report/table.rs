//! Tables of a page.

use super::svg::escape;
use std::fmt::Write;

pub(super) const TABLE_END: &str = "</tbody></table></div>";

pub(super) fn table_head(title: &str, caption: &str, names: &[&str]) -> String {
    let mut html = format!(
        "<section><h2>{title}</h2><p class=\"caption\">{caption}</p><div class=\"scroll\"><table class=\"wide\"><thead><tr>"
    );
    for (k, name) in names.iter().enumerate() {
        let _ = write!(html, "<th{}>{}</th>", if k == 0 { " class=\"text\"" } else { "" }, escape(name));
    }
    html + "</tr></thead><tbody>"
}

pub(super) fn row(html: &mut String, name: &str, cells: &[String]) {
    let _ = write!(html, "<tr><td class=\"text\">{}</td>", escape(name));
    for cell in cells {
        let _ = write!(html, "<td>{}</td>", escape(cell));
    }
    *html += "</tr>";
}
