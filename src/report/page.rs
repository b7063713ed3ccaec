//! The report of a run: one HTML page with its pictures inside, without external parts; the page is complete without
//! its script.

use super::headline::headline;
use super::number::{plain, significant, whole};
use super::packings::packings;
use super::prose::{computed, prose, unmarked};
use super::reliance::reliance;
use super::scene::force;
use super::svg::{STYLE, escape};
use super::{Figure, check, figures, laws};
use crate::graph::Clock;
use crate::results::{Provenance, Run, SoFar, Verdict};
use crate::scenario::{Loading, Scenario, Train};
use crate::units::duration;
use std::fmt::Write;

/// Makes the whole page.
pub fn page(run: &Run) -> String {
    page_with(run, "")
}

/// The page of an unfinished run, with the results so far.
pub fn page_so_far(so_far: &SoFar) -> String {
    let notice = format!(
        "<section id=\"unfinished\"><h2>Not finished</h2><p class=\"caption\">{}. Figures and tables show the records \
         so far. Expectations are checked when the run is finished.</p></section>\n",
        prose(&standing(so_far))
    );
    page_with(&so_far.run, &notice)
}

/// Progress of an unfinished run: `40 of 500 axles after 1.2 h of computing; now trains on grains, 43 % done`.
pub fn standing(so_far: &SoFar) -> String {
    let done = match (so_far.clock, &so_far.run.scenario.loading) {
        (Clock::Axles(axles), Some(Loading::Traffic(traffic))) => {
            format!("{} of {} axles", whole(axles), whole(*traffic.total))
        }
        (clock, _) => clock.to_string(),
    };
    let stage = so_far.stage.as_ref();
    let now = stage.map_or(String::new(), |(what, share)| format!("; now {what}, {} % done", plain(100.0 * share, 2)));
    format!("{done} after {} of computing{now}", duration(so_far.seconds))
}

fn page_with(run: &Run, notice: &str) -> String {
    let mut html = opening(&run.scenario.title, &subtitle(&run.scenario));
    html += notice;
    let figures = figures(run);
    headline(&mut html, run);
    packings(&mut html, run);
    reliance(&mut html, &run.summary.reliance);
    laws::remarks(&mut html, run);
    check::remarks(&mut html, run);
    expectations(&mut html, &run.summary.expectations);
    contents(&mut html, &figures, run);
    figures.iter().for_each(|figure| picture(&mut html, figure));
    trains(&mut html, run);
    blocks(&mut html, run);
    provenance(&mut html, &run.summary.provenance);
    close(&mut html);
    html
}

/// Ends a page, with the script that its pictures share.
pub(super) fn close(html: &mut String) {
    let _ = writeln!(html, "</main><script>\n{}</script></body></html>", include_str!("page.js"));
}

/// The head of a page: its style, title and what it is about.
pub(super) fn opening(title: &str, subtitle: &str) -> String {
    format!(
        concat!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">",
            "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">",
            "<meta name=\"color-scheme\" content=\"light dark\">",
            "<title>{name}</title><style>{page}{figures}</style></head><body><main>\n",
            "<header><h1>{title}</h1><p class=\"sub\">{subtitle}</p></header>\n"
        ),
        name = escape(&unmarked(title)),
        title = prose(title),
        page = include_str!("page.css"),
        figures = STYLE,
        subtitle = prose(subtitle)
    )
}

/// `wagon: 1 vehicle at 200 km/h, 500 axles. Track line, 66 m: ballasted 42 m, slab_track 24 m.`
pub(super) fn subtitle(scenario: &Scenario) -> String {
    let track = &scenario.track;
    let mut text = match &scenario.loading {
        Some(Loading::Traffic(traffic)) => {
            let train = |train: &Train| {
                let count = train.vehicles.len();
                let (name, s, speed) = (&train.name, if count == 1 { "" } else { "s" }, plain(*train.speed * 3.6, 3));
                format!("train {name} ({count} vehicle{s}) at {speed} km/h")
            };
            let trains: Vec<String> = traffic.trains().map(train).collect();
            format!("{} axles of {}. ", whole(*traffic.total), trains.join(", "))
        }
        Some(Loading::Static(loads)) => {
            let list = loads.iter().map(|load| format!("{} {} kN", load.name, plain(*load.force / 1e3, 4)));
            format!("Static check: {}. ", list.collect::<Vec<_>>().join(", "))
        }
        Some(Loading::Rig(loads)) => {
            let list = loads.iter().map(|load| format!("{} {}", load.name, force(load)));
            format!("Test rig: {}. ", list.collect::<Vec<_>>().join(", "))
        }
        None => String::new(),
    };
    let metres = |length: f64| plain(length, 3);
    let sections = track.sections.iter().map(|s| format!("{} {} m", s.name, metres(s.end - s.start)));
    let sections = sections.collect::<Vec<_>>().join(", ");
    let _ = write!(text, "Track {}, {} m: {sections}.", track.name, metres(track.end() - track.start()));
    text
}

/// The contents of the page.
fn contents(html: &mut String, figures: &[Figure], run: &Run) {
    *html += "<nav id=\"contents\"><h2>Contents</h2><ol>";
    for figure in figures {
        let _ = write!(html, "<li><a href=\"#{}\">{}</a></li>", escape(&figure.id), prose(&figure.title));
    }
    if !run.trains.is_empty() {
        *html += "<li><a href=\"#trains\">Trains</a></li>";
    }
    if !run.blocks.is_empty() {
        *html += "<li><a href=\"#blocks\">Blocks</a></li>";
    }
    *html += "<li><a href=\"#provenance\">How this was made</a></li></ol></nav>\n";
}

pub(super) fn expectations(html: &mut String, verdicts: &[Verdict]) {
    if verdicts.is_empty() {
        return;
    }
    let missed = verdicts.iter().filter(|verdict| !verdict.met).count();
    let caption = match missed {
        0 => "All expectations of the scene are met.".to_owned(),
        n => format!("{n} of {} expectations are not met.", verdicts.len()),
    };
    let _ = write!(
        html,
        "<section><h2>Expectations</h2><p class=\"caption\">{caption}</p><div class=\"scroll\"><table>\
         <tr><th class=\"text\">expected</th><th class=\"text\">computed</th><th class=\"text\">verdict</th></tr>"
    );
    for verdict in verdicts {
        let (class, word) = if verdict.met { ("good", "\u{2713} met") } else { ("bad", "\u{2717} missed") };
        let _ = write!(
            html,
            "<tr><td class=\"text\"><code>{}</code></td><td class=\"text\">{}</td><td class=\"text \
            {class}\">{word}</td></tr>",
            escape(&verdict.text),
            prose(&computed(verdict))
        );
    }
    *html += "</table></div></section>\n";
}

pub(super) fn picture(html: &mut String, figure: &Figure) {
    // The page states the pictures' style once.
    let svg = figure.svg.replacen(&format!("<style>{STYLE}</style>"), "", 1);
    let (id, title, caption) = (escape(&figure.id), prose(&figure.title), prose(&figure.caption));
    let _ = writeln!(
        html,
        "<section id=\"{id}\"><h2>{title}</h2><p class=\"caption\">{caption}</p><div \
        class=\"scroll\">{svg}</div></section>"
    );
}

/// Results of each type of train at the last count, compared with its own static load.
fn trains(html: &mut String, run: &Run) {
    let Some(last) = run.trains.iter().map(|row| row.axles).max() else { return };
    let heads = [
        ("Trains so far", ""),
        ("Static wheel load", "kN"),
        ("Wheel force, largest", "kN"),
        ("Largest / static load", ""),
        ("Wheel force, least", "kN"),
        ("Wheel unloading", "%"),
        ("Rail seat load", "kN"),
        ("Contact force", "kN"),
        ("Rail moment", "kN m"),
    ];
    let heads: String = heads.iter().map(|(name, unit)| format!("<th>{name}<small>{unit}</small></th>")).collect();
    let _ = write!(
        html,
        "<section id=\"trains\"><h2>Trains</h2><p class=\"caption\">Extremes of one passage of each type of train \
         after {} axles. Each wheel is compared with its own static load. Figures of one passage show the first type; \
         histories of all types are kept.</p><div class=\"scroll\"><table><tr><th \
         class=\"text\">Train</th>{heads}</tr>",
        whole(last)
    );
    for row in run.trains.iter().filter(|row| row.axles == last) {
        let _ = write!(html, "<tr><td class=\"text\">{}</td><td>{}</td>", escape(&row.train), whole(row.passed));
        let cells = [
            row.static_wheel_load_N / 1e3,
            row.max_wheel_force_N / 1e3,
            row.dynamic_amplification,
            row.min_wheel_force_N / 1e3,
            100.0 * row.wheel_unloading,
            row.max_rail_seat_load_N / 1e3,
            row.max_contact_force_N / 1e3,
            row.max_rail_moment_N_m / 1e3,
        ];
        cells.iter().for_each(|value| *html += &format!("<td>{}</td>", significant(*value, 3)));
        *html += "</tr>";
    }
    *html += "</table></div></section>\n";
}

/// The extremes of every block.
fn blocks(html: &mut String, run: &Run) {
    if run.blocks.is_empty() {
        return;
    }
    let heads = [
        ("Axles before", ""),
        ("Axles of the block", ""),
        ("Wheel force, largest", "kN"),
        ("Wheel force, least", "kN"),
        ("Rail seat load", "kN"),
        ("Contact force", "kN"),
        ("Settlement after", "mm"),
        ("Settlement of the block", "mm"),
        ("Newton iterations per step", ""),
    ];
    let mut table = String::from("<div class=\"scroll\"><table><thead><tr>");
    for (name, unit) in heads {
        let _ = write!(table, "<th>{name}<small>{unit}</small></th>");
    }
    table += "</tr></thead><tbody>";
    for block in &run.blocks {
        let iterations = block.newton_iterations as f64 / block.time_steps.max(1) as f64;
        let of_block = if block.block_axles == 0 { "record only".to_owned() } else { whole(block.block_axles) };
        let numbers = [
            block.max_wheel_force_N / 1e3,
            block.min_wheel_force_N / 1e3,
            block.max_rail_seat_load_N / 1e3,
            block.max_contact_force_N / 1e3,
            block.max_settlement_m * 1e3,
            block.max_settlement_step_m * 1e3,
            iterations,
        ];
        let _ = write!(table, "<tr><td>{}</td><td>{of_block}</td>", whole(block.axles));
        for number in numbers {
            let _ = write!(table, "<td>{}</td>", significant(number, 3));
        }
        table += "</tr>";
    }
    table += "</tbody></table></div>";
    if run.blocks.len() > 40 {
        table = format!("<details><summary>{} blocks</summary>{table}</details>", run.blocks.len());
    }
    let _ = writeln!(
        html,
        "<section class=\"long\" id=\"blocks\"><h2>Blocks</h2><p class=\"caption\">Extremes of the passage computed \
         for each block of axles. {}</p>{table}</section>",
        prose(&super::blocks::said(run))
    );
}

pub(super) fn provenance(html: &mut String, made: &Provenance) {
    let _ = writeln!(
        html,
        "<section class=\"long\" id=\"provenance\"><h2>How this was made</h2><dl><dt>Program</dt><dd>{} \
         {}</dd><dt>File</dt><dd>{}</dd><dt>SHA-256</dt><dd><code>{}</code></dd><dt>Seed</dt><dd>{}</dd></dl>",
        escape(&made.program),
        escape(&made.version),
        escape(&made.file),
        escape(&made.source_sha256),
        made.seed
    );
    if !made.plan.is_empty() {
        let _ = writeln!(html, "<p class=\"note\">The plan</p><pre>{}</pre>", prose(&made.plan));
    }
    if !made.source.is_empty() {
        // open, so that it is printed too
        let _ = writeln!(html, "<p class=\"note\">The source</p><pre class=\"source\">{}</pre>", escape(&made.source));
    }
    *html += "</section>\n";
}
