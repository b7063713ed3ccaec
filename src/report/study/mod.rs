//! The page of a study: the best designs beside the scene as it is, with the lines to paste; missed constraints; the
//! Pareto front, main effects, and every point.

mod differences;
mod effects;
mod front;
mod plane;
mod table;

use super::page::{close, opening};
use super::prose::prose;
use super::scene::scene_svg;
use super::svg::{STYLE, escape};
use crate::scenario::{Goal, Sampling, Scenario, Study};
use crate::study::{Answer, MetAndMissed, Miss, Row, amount};
use std::fmt::Write;
use table::table;

/// Number of best designs that the page shows in full.
const MOST_SHOWN: usize = 12;

/// Makes the whole page. `file` is the name of the scene's file, `design` the scene of the first of the best points,
/// else of the nearest.
pub fn study_page(answer: &Answer, file: &str, design: Option<&Scenario>) -> String {
    let title = format!("{}: study {}", answer.title, answer.study.name);
    let mut html = opening(&title, &subtitle(answer));
    best(&mut html, answer, file);
    constraints(&mut html, answer);
    if let (Some(design), Some(first)) = (design, answer.best().first().copied().or(answer.nearest())) {
        let row = &answer.rows[first];
        let caption = format!(
            "Point {}: {}. Places, spacings, sleepers and rail are to scale; the depth of the bed is a symbol.",
            row.number,
            answer.lines(row).join(", ")
        );
        picture(&mut html, "design", "The design", &caption, &scene_svg(design));
    }
    if let Some((svg, caption)) = front::pareto(answer) {
        picture(&mut html, "front", "Pareto front", &caption, &svg);
    }
    if let Some((svg, caption)) = differences::differences(answer) {
        picture(&mut html, "differences", "Differences from the scene as it is", &caption, &svg);
    }
    if let Some((svg, caption)) = effects::main_effects(answer) {
        picture(&mut html, "effects", "Main effects", &caption, &svg);
    }
    points(&mut html, answer);
    close(&mut html);
    html
}

/// `12 points of a grid over stiff.pad.stiffness and ore.speed. 2 left out, 1 failed. Minimise max(settlement).`
fn subtitle(answer: &Answer) -> String {
    let study = &answer.study;
    let how = match study.sampling {
        Sampling::Grid => "of a grid",
        Sampling::LatinHypercube { .. } => "of a Latin hypercube",
        Sampling::Sobol { .. } => "of a Sobol sequence",
    };
    let paths: Vec<&str> = study.axes.iter().map(|a| a.path.as_str()).collect();
    let mut text = format!("{} points {how} over {}", answer.designs().count(), paths.join(", "));
    text += match answer.as_it_is() {
        Some(row) if row.designed() => ", one of them the scene as it is",
        Some(_) => ", and the scene as it is",
        None => "",
    };
    if study.repeats.are_several() {
        let _ = write!(text, ", each on {} packings, {} runs in all", study.repeats, answer.runs());
    }
    text += ". ";
    if answer.left_out > 0 {
        let _ = write!(text, "{} more break a condition and were left out. ", answer.left_out);
    }
    match answer.failures().count() {
        0 => {}
        n => {
            let _ = write!(text, "{n} failed. ");
        }
    }
    for objective in &study.objectives {
        let _ = write!(text, "{} {}. ", goal(objective.goal), objective.of.text);
    }
    if !study.constraints.is_empty() {
        let texts: Vec<&str> = study.constraints.iter().map(|c| c.text.as_str()).collect();
        let _ = write!(text, "Subject to {}.", texts.join(", "));
    }
    text.trim_end().to_string()
}

fn goal(goal: Goal) -> &'static str {
    match goal {
        Goal::Minimise => "Minimise",
        Goal::Maximise => "Maximise",
    }
}

/// The best design or the designs of the front, each against the scene as it is; the nearest design if none meets every
/// constraint.
fn best(html: &mut String, answer: &Answer, file: &str) {
    let best = answer.best();
    if let Some(nearest) = answer.nearest() {
        return nearest_design(html, answer, nearest, file);
    }
    if answer.study.objectives.is_empty() {
        return;
    }
    let single = answer.study.objectives.len() == 1;
    let heading = if single { "Best design" } else { "Best designs" };
    let _ = write!(html, "<section id=\"best\"><h2>{heading}</h2>");
    let Some(first) = best.first() else {
        *html += "<p class=\"caption\">No point runs to its end.</p></section>\n";
        return;
    };
    let caption = match (single, best.len()) {
        (true, 1) => "No other point that meets every constraint is better.".to_owned(),
        (true, n) => format!("{n} points are equally good; the first of them is written out below."),
        (false, 1) => "One point is better than all others in every objective.".to_owned(),
        (false, n) => format!("{n} points are best: no other point is better in every objective."),
    };
    let sentences = [answer.certainty(), answer.against_as_it_is()].into_iter().flatten();
    let against: String = sentences.map(|sentence| format!(" {}", sentence.replace("+-", "\u{b1}"))).collect();
    let _ = write!(html, "<p class=\"caption\">{}</p>", prose(&format!("{caption}{against}")));
    table(html, answer, &beside_as_it_is(answer, &best[..best.len().min(MOST_SHOWN)]), false);
    if best.len() > MOST_SHOWN {
        let _ = write!(html, "<p class=\"note\">and {} more in the table of all points.</p>", best.len() - MOST_SHOWN);
    }
    written_out(html, answer, &answer.rows[*first], file);
}

/// If no design is feasible: the design with the smallest miss.
fn nearest_design(html: &mut String, answer: &Answer, nearest: usize, file: &str) {
    let row = &answer.rows[nearest];
    let _ = write!(
        html,
        "<section id=\"best\"><h2>No design meets every constraint</h2><p class=\"caption\">{}</p>",
        prose(&format!(
            "Point {} comes nearest: its largest miss, as a share of the limit, is the smallest. It misses {}.",
            row.number,
            answer.missed(row).join(" and ")
        ))
    );
    table(html, answer, &beside_as_it_is(answer, &[nearest]), true);
    written_out(html, answer, row, file);
}

/// These rows with the scene as it is in front.
fn beside_as_it_is(answer: &Answer, rows: &[usize]) -> Vec<usize> {
    let first = answer.rows.iter().position(|row| row.as_it_is);
    first.into_iter().chain(rows.iter().copied().filter(|row| Some(*row) != first)).collect()
}

fn written_out(html: &mut String, answer: &Answer, row: &Row, file: &str) {
    let _ = write!(
        html,
        "<p class=\"note\">Point {} as lines of the file, and as a run:</p><pre>{}\n\ntrackbed run {}{} --out \
        best</pre></section>\n",
        row.number,
        escape(&pasted(&answer.study, row)),
        escape(file),
        escape(&flags(answer, row))
    );
}

/// Number of designs that meet each constraint; nothing if there is no constraint.
fn constraints(html: &mut String, answer: &Answer) {
    let all = answer.constraints();
    if all.is_empty() {
        return;
    }
    *html += "<section id=\"constraints\"><h2>Constraints</h2><p class=\"caption\">Number of designs that meet and \
              miss each constraint. Shares are relative to the limit.</p><div class=\"scroll\"><table><tr><th \
              class=\"text\">constraint</th><th>met by</th><th>missed by</th><th>least miss</th><th>largest \
              miss</th></tr>";
    for MetAndMissed { text, unit, met, missed, least, largest } in &all {
        let shown = |miss: &Option<Miss>| miss.map_or("\u{2013}".to_owned(), |miss| amount(&miss, unit));
        let class = if *met == 0 && *missed > 0 { " bad" } else { "" };
        let _ = write!(
            html,
            "<tr><td \
            class=\"text{class}\"><code>{}</code></td><td>{met}</td><td>{missed}</td><td>{}</td><td>{}</td></tr>",
            escape(text),
            escape(&shown(least)),
            escape(&shown(largest))
        );
    }
    *html += "</table></div></section>\n";
}

/// Every point.
fn points(html: &mut String, answer: &Answer) {
    let rows: Vec<usize> = (0..answer.rows.len()).collect();
    *html += "<section id=\"points\" class=\"long\"><h2>All points</h2><p class=\"caption\">First the scene as it is, \
              then the points in the order of the design, each with its difference to the scene as it is. The best \
              points are marked. The file <code>study.csv</code> has the same table.";
    if answer.study.repeats.are_several() {
        *html += " A value is the mean over the packings of the point \u{b1} the standard deviation of one packing. A \
                  difference is the mean over the packings of both points \u{b1} its 95 % interval.";
    }
    *html += "</p>";
    table(html, answer, &rows, true);
    *html += "</section>\n";
}

/// `trackform stiff: pad.stiffness = 60 MN/m`, a line a value, those fixed for the study too.
fn pasted(study: &Study, row: &Row) -> String {
    let fixed = study.set.iter().map(|s| (s.path.as_str(), s.value.as_str()));
    let varied = study.axes.iter().zip(&row.levels).map(|(axis, level)| (axis.path.as_str(), level.text.as_str()));
    let line = |(path, value): (&str, &str)| match path.split_once('.') {
        Some((name, field)) => format!("{field} = {value}  // in {name}"),
        None => format!("let {path} = {value}"),
    };
    fixed.chain(varied).map(line).collect::<Vec<_>>().join("\n")
}

fn flags(answer: &Answer, row: &Row) -> String {
    let fixed = answer.study.set.iter().map(|s| s.line().replacen(" = ", "=", 1));
    let varied = answer.lines(row).into_iter().map(|line| line.replacen(" = ", "=", 1));
    fixed.chain(varied).map(|line| format!(" \\\n  --set '{line}'")).collect()
}

fn picture(html: &mut String, id: &str, title: &str, caption: &str, svg: &str) {
    // The page states the pictures' style once.
    let svg = svg.replacen(&format!("<style>{STYLE}</style>"), "", 1);
    let caption = prose(caption);
    let _ = writeln!(
        html,
        "<section id=\"{id}\"><h2>{title}</h2><p class=\"caption\">{caption}</p><div \
        class=\"scroll\">{svg}</div></section>"
    );
}
