//! The page of a study: the best designs with the lines to paste, the Pareto front, main effects, and every point.

mod effects;
mod front;
mod plane;

use super::number::plain;
use super::page::{close, opening};
use super::prose::prose;
use super::scene::scene_svg;
use super::svg::{STYLE, escape};
use crate::scenario::{Goal, Sampling, Scenario, Study};
use crate::study::{Answer, PointOutcome, Row};
use std::fmt::Write;

/// Best designs that the page spells out.
const MOST_SHOWN: usize = 12;

/// Makes the whole page. `file` is the name of the scene's file, `design` the scene of the first of the best points.
pub fn study_page(answer: &Answer, file: &str, design: Option<&Scenario>) -> String {
    let title = format!("{}: study {}", answer.title, answer.study.name);
    let mut html = opening(&title, &subtitle(answer));
    best(&mut html, answer, file);
    if let (Some(design), Some(first)) = (design, answer.best().first()) {
        let row = &answer.rows[*first];
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
    let mut text = format!("{} points {how} over {}", answer.rows.len(), paths.join(", "));
    if study.repeats > 1 {
        let _ = write!(text, ", each run {} times", study.repeats);
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

/// The best design and what it says of itself, or the designs of the front.
fn best(html: &mut String, answer: &Answer, file: &str) {
    let best = answer.best();
    if answer.study.objectives.is_empty() {
        return;
    }
    let single = answer.study.objectives.len() == 1;
    let heading = if single { "Best design" } else { "Best designs" };
    let _ = write!(html, "<section id=\"best\"><h2>{heading}</h2>");
    let Some(first) = best.first() else {
        *html += "<p class=\"caption\">No point runs to its end and meets every constraint.</p></section>\n";
        return;
    };
    let caption = match (single, best.len()) {
        (true, 1) => "No other point that meets every constraint is better.".to_owned(),
        (true, n) => format!("{n} points are equally good; the first of them is written out below."),
        (false, 1) => "One point is better than all others in every objective.".to_owned(),
        (false, n) => format!("{n} points are such that no other is better in every objective."),
    };
    let _ = write!(html, "<p class=\"caption\">{caption}</p>");
    table(html, answer, &best[..best.len().min(MOST_SHOWN)], false);
    if best.len() > MOST_SHOWN {
        let _ = write!(html, "<p class=\"note\">and {} more in the table of all points.</p>", best.len() - MOST_SHOWN);
    }
    let row = &answer.rows[*first];
    let _ = write!(
        html,
        "<p class=\"note\">Point {} as lines of the file, and as a run:</p><pre>{}\n\ntrackbed run {}{} --out best</pre></section>\n",
        row.number,
        escape(&pasted(&answer.study, row)),
        escape(file),
        escape(&flags(answer, row))
    );
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

fn points(html: &mut String, answer: &Answer) {
    let rows: Vec<usize> = (0..answer.rows.len()).collect();
    *html += "<section id=\"points\" class=\"long\"><h2>All points</h2><p class=\"caption\">In the order of the design; the best are marked. \
              The same is in <code>study.csv</code>.</p>";
    table(html, answer, &rows, true);
    *html += "</section>\n";
}

fn table(html: &mut String, answer: &Answer, rows: &[usize], whole: bool) {
    let study = &answer.study;
    let measured = study.measured();
    *html += "<div class=\"scroll\"><table><tr><th>point</th>";
    let head = |html: &mut String, name: &str, unit: &str| {
        let unit = if unit.is_empty() { String::new() } else { format!("<small>{}</small>", escape(unit)) };
        let _ = write!(html, "<th>{}{unit}</th>", breakable(name));
    };
    study.axes.iter().for_each(|axis| head(html, &axis.path, &axis.unit));
    measured.iter().for_each(|m| head(html, &m.text, &m.unit.0));
    if whole {
        *html += "<th class=\"text\">status</th>";
    }
    *html += "</tr>";
    let best = answer.best();
    for index in rows {
        let row = &answer.rows[*index];
        let _ = write!(html, "<tr><td>{}</td>", row.number);
        for level in &row.levels {
            let _ = write!(html, "<td>{}</td>", escape(&level.number.map_or(level.text.clone(), |n| plain(n, 6))));
        }
        for (i, m) in measured.iter().enumerate() {
            let cell = match &row.outcome {
                PointOutcome::Done { values, deviations, .. } => {
                    let spread = plain(deviations[i] / m.unit.1, 2);
                    let spread = if study.repeats > 1 { format!(" \u{b1} {spread}") } else { String::new() };
                    plain(values[i] / m.unit.1, 4) + &spread
                }
                PointOutcome::Failed { .. } => "\u{2013}".to_owned(),
            };
            let _ = write!(html, "<td>{cell}</td>");
        }
        if whole {
            let (class, words) = status(answer, row, best.contains(index));
            let _ = write!(html, "<td class=\"text {class}\">{}</td>", prose(&words));
        }
        *html += "</tr>";
    }
    *html += "</table></div>";
}

/// A name that a narrow column may break behind its joints.
fn breakable(name: &str) -> String {
    ['_', '.', '('].iter().fold(escape(name), |text, joint| text.replace(*joint, &format!("{joint}<wbr>")))
}

fn status(answer: &Answer, row: &Row, best: bool) -> (&'static str, String) {
    match &row.outcome {
        PointOutcome::Failed { reason, .. } => ("bad", format!("\u{2717} failed: {reason}")),
        PointOutcome::Done { met, .. } if !row.feasible() => {
            let broken = answer.study.constraints.iter().zip(met).filter(|(_, met)| !**met);
            let broken: Vec<&str> = broken.map(|(c, _)| c.text.as_str()).collect();
            ("", format!("misses {}", broken.join(", ")))
        }
        PointOutcome::Done { .. } if best => ("good", "\u{2713}\u{a0}best".to_owned()),
        PointOutcome::Done { .. } => ("", String::new()),
    }
}

fn picture(html: &mut String, id: &str, title: &str, caption: &str, svg: &str) {
    // The page states the pictures' style once.
    let svg = svg.replacen(&format!("<style>{STYLE}</style>"), "", 1);
    let caption = prose(caption);
    let _ = writeln!(
        html,
        "<section id=\"{id}\"><h2>{title}</h2><p class=\"caption\">{caption}</p><div class=\"scroll\">{svg}</div></section>"
    );
}
