//! Settlement by several laws under the same forces: the table `laws.csv`, its scalars and the spread of the laws.

use super::summarise::largest;
use super::{BlockRow, Row, Scalar};
use crate::scenario::{Loading, Scenario, Seat, SettlementLaw};
use crate::units::number;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Settlement of one sleeper by one law after a block (`laws.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawRow {
    pub axles: u64,
    pub law: String,
    pub sleeper: String,
    pub x_m: f64,
    pub settlement_m: f64,
}

impl Row for LawRow {
    const FILE: &'static str = "laws.csv";
    const COLUMNS: &'static [&'static str] = &["axles", "law", "sleeper", "x_m", "settlement_m"];
}

/// Settlement by each law at one count, in the order of the scene: of every ballasted seat, m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawCount {
    pub axles: u64,
    pub settlement: Vec<Vec<f64>>,
}

/// The laws of the scene, the driving one first.
fn laws(scenario: &Scenario) -> impl Iterator<Item = &SettlementLaw> {
    std::iter::once(&scenario.solve.law).chain(&scenario.solve.other_laws)
}

/// The rows of `laws.csv`: count by count, law by law, left to right.
pub fn law_rows(scenario: &Scenario, counts: &[LawCount]) -> Vec<LawRow> {
    let track = &scenario.track;
    let ballasted: Vec<&Seat> = track.seats.iter().filter(|seat| seat.is_ballasted()).collect();
    let mut rows = Vec::new();
    for count in counts {
        for (law, settlement) in laws(scenario).zip(&count.settlement) {
            rows.extend(ballasted.iter().zip(settlement).map(|(seat, settlement)| LawRow {
                axles: count.axles,
                law: law.name.clone(),
                sleeper: track.seat_name(seat),
                x_m: seat.x,
                settlement_m: *settlement,
            }));
        }
    }
    rows
}

/// `laws.NAME.max_settlement` and `laws.NAME.far_field_settlement` after the last count, and `law_spread`: ratio of the
/// largest to the smallest `max_settlement`. No spread if the settlement by one law is zero.
pub fn summarise_laws(scenario: &Scenario, rows: &[LawRow]) -> BTreeMap<String, Scalar> {
    let mut scalars = BTreeMap::new();
    let last = rows.iter().map(|row| row.axles).max();
    let mut most = Vec::new();
    for law in laws(scenario) {
        let of_law: Vec<&LawRow> = rows.iter().filter(|r| Some(r.axles) == last && r.law == law.name).collect();
        let Some(deepest) = largest(of_law.iter().map(|row| row.settlement_m)) else { continue };
        let far_field = scenario.track.far_field(of_law.iter().map(|row| (row.x_m, row.settlement_m)).collect());
        most.push(deepest);
        scalars.insert(format!("laws.{}.max_settlement", law.name), Scalar::new(deepest, "m"));
        if let Some(far_field) = far_field {
            scalars.insert(format!("laws.{}.far_field_settlement", law.name), Scalar::new(far_field, "m"));
        }
    }
    let least = most.iter().copied().fold(f64::INFINITY, f64::min);
    if most.len() > 1 && least > 0.0 {
        let ratio = most.iter().copied().fold(0.0, f64::max) / least;
        scalars.insert("law_spread".to_owned(), Scalar::new(ratio, "1"));
    }
    scalars
}

/// Settlement too small to measure, m: under a law with a threshold, almost all forces were below the threshold.
const NOTHING: f64 = 1e-5;

/// A sentence for each law under which nothing has settled in a run with traffic, with the force that would have been
/// needed.
pub fn unsettled(scenario: &Scenario, blocks: &[BlockRow], rows: &[LawRow]) -> Vec<String> {
    let ballasted = scenario.track.seats.iter().any(|seat| seat.is_ballasted());
    if !ballasted || blocks.is_empty() || !matches!(scenario.loading, Some(Loading::Traffic(_))) {
        return Vec::new();
    }
    let force = largest(blocks.iter().map(|block| block.max_contact_force_N)).unwrap_or(0.0);
    let of_driving = largest(blocks.iter().map(|block| block.max_settlement_m)).unwrap_or(0.0);
    let most = |index: usize, law: &SettlementLaw| {
        let of_law = rows.iter().filter(|row| row.law == law.name).map(|row| row.settlement_m);
        of_law.fold(if index == 0 { of_driving } else { 0.0 }, f64::max)
    };
    laws(scenario).enumerate().filter_map(|(index, law)| sentence(law, most(index, law), force)).collect()
}

/// `None` for a law under which a sleeper has settled; `force` (N) is the largest of the run.
fn sentence(law: &SettlementLaw, most: f64, force: f64) -> Option<String> {
    let threshold = law.law.threshold();
    if most > if threshold.is_some() { NOTHING } else { 0.0 } {
        return None;
    }
    let tenths = |force: f64| number((force / 100.0).round() / 10.0);
    let threshold = threshold.map_or(String::new(), |t| format!(", and the threshold of the law is {} kN", tenths(t)));
    let (what, at_most) = match most {
        0.0 => ("nothing", String::new()),
        most => ("almost nothing", format!(", at most {} mm", number((most * 1e7).round() / 1e4))),
    };
    Some(format!(
        "{what} settled under law `{}`{at_most}: the largest contact force was {} kN per seat{threshold}",
        law.name,
        tenths(force)
    ))
}
